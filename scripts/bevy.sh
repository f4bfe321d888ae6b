#!/usr/bin/env bash
# Tests of the crate for Bevy, examples/bevy: balls beside those of `luthier preview`, lamps with shadows, fog, a bake that is written anew, refusals.
#   scripts/bevy.sh [OUT]   pictures are left in OUT, by default target/bevy. The variable LUTHIER names the command; by default cargo builds it
# The first build of Bevy takes a quarter of an hour on two cores. Needs a Vulkan driver; on Debian apt-get install mesa-vulkan-drivers.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

if [ -z "${LUTHIER-}" ]; then
  cargo build --locked --release -p luthier-cli
  export LUTHIER=$PWD/target/release/luthier
fi
mkdir -p "${1:-target/bevy}"
out=$(realpath "${1:-target/bevy}")
cargo test --locked --manifest-path examples/bevy/Cargo.toml --target-dir target --test host -- "$out"

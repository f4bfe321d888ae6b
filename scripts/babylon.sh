#!/usr/bin/env bash
# Tests of the package for Babylon.js, examples/babylon: types, and balls, lamps, meshes and refusals in Chromium on the software driver, by WebGL 2 and WebGPU,
# beside `luthier preview`.
#   scripts/babylon.sh   the variable LUTHIER names the command; by default cargo builds it. CHROMIUM names the browser
# Needs a Vulkan driver, npm and Chromium; on Debian apt-get install mesa-vulkan-drivers npm chromium. Packages are installed into
# examples/babylon/node_modules/, where the pages look for them. Pictures are left in target/babylon/.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

out=target/babylon
mkdir -p "$out"
if [ -z "${LUTHIER-}" ]; then
  cargo build --locked --release -p luthier-cli
  LUTHIER=$PWD/target/release/luthier
fi
export LUTHIER

npm ci --prefix examples/babylon --ignore-scripts --no-audit --no-fund --silent
npm run --prefix examples/babylon --silent types
node examples/babylon/test.mjs "$out"

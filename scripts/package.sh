#!/usr/bin/env bash
# Packs every crate that can be published, as `cargo publish` would, and fails on any warning. Nothing is uploaded.
# `--verify` builds each package from its own files too, which takes a full build of the workspace.
set -euo pipefail
cd "$(dirname "$0")/.."

verify=--no-verify
[ "${1-}" = --verify ] && verify=

# Crates of the project alone are not published.
own=()
for manifest in $(grep -l '^publish = false$' crates/*/Cargo.toml); do
  own+=(--exclude "$(basename "$(dirname "$manifest")")")
done

log=$(mktemp)
trap 'rm -f "$log"' EXIT
cargo package --workspace "${own[@]}" --locked --allow-dirty $verify 2>&1 | tee "$log"
if grep -q '^warning' "$log"; then
  echo "error: packages with warnings"
  exit 1
fi

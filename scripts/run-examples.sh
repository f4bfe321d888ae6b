#!/usr/bin/env bash
# Bakes materials/, renders the ball of examples/scene.json with wgpu and with three.js, and compares the pictures.
# With --bevy also with Bevy, whose first build takes a while. Needs a Vulkan driver, npm and Chromium; on Debian
# apt-get install mesa-vulkan-drivers npm chromium. Pictures are left in target/examples/.
set -euo pipefail
cd "$(dirname "$0")/.."

# Mean difference, in 8-bit steps, that two drivers may have. At most 0.07 was seen between llvmpipe and SwiftShader;
# tables read without their filter make 0.4.
limit=0.25

out=target/examples
bake=$out/bake
scene=examples/scene.json
mkdir -p "$out"

step() { printf '\n== %s\n' "$1"; }
# The target folder is shared with the workspace: most of wgpu is built there already.
example() { cargo run --locked --quiet --manifest-path examples/wgpu/Cargo.toml --target-dir target --bin "$@"; }

step "bake"
cargo run --locked --quiet -p luthier-cli -- bake materials --out "$bake" --quiet

step "wgpu"
example luthier-example-wgpu "$bake" "$scene" "$out/wgpu.png"

step "three.js"
npm ci --prefix examples/three --ignore-scripts --no-audit --no-fund --silent
node examples/three/render.mjs "$bake" "$scene" "$out/three.png"
example difference "$out/wgpu.png" "$out/three.png" "$limit"

if [ "${1-}" = --bevy ]; then
  step "Bevy"
  cargo run --locked --quiet --manifest-path examples/bevy/Cargo.toml -- "$bake" "$scene" "$out/bevy.png"
  example difference "$out/wgpu.png" "$out/bevy.png" "$limit"
fi

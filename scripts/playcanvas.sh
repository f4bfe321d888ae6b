#!/usr/bin/env bash
# Tests of the package for PlayCanvas, examples/playcanvas: its types, and pictures in Chromium on the devices of WebGL 2 and WebGPU beside those of `luthier preview`.
#   scripts/playcanvas.sh        the variable LUTHIER names the command, by default cargo builds it; CHROMIUM names the browser
# PlayCanvas is installed by `npm ci` in the folder of the package. Needs Node 20, a Chromium and a Vulkan driver; on Debian
# apt-get install npm chromium mesa-vulkan-drivers. Pictures are left in target/playcanvas/.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

if [ -z "${LUTHIER-}" ]; then
  cargo build --locked --release -p luthier-cli
  LUTHIER=$PWD/target/release/luthier
fi
export LUTHIER
npm ci --prefix examples/playcanvas --ignore-scripts --no-audit --no-fund --silent
npm run --prefix examples/playcanvas --silent types
node examples/playcanvas/test.mjs target/playcanvas

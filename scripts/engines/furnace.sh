#!/usr/bin/env bash
# White furnaces in three.js and Babylon.js: what their pictures make of their own split-sum table, and of tables that luthier bakes.
#   scripts/engines/furnace.sh [--shots DIR]
# Prints a table in Markdown; the figures are left in target/engines/furnace.json. Needs npm and Chromium (on Debian apt-get install npm
# chromium). Nothing but npm uses the network. LUTHIER names the program that bakes, by default cargo builds it; CHROMIUM the browser.
#
# Each cell is the largest and the mean error over cosines from 0.05 and roughness from 0.05, against quadrature:
#   one bounce   the reflectance f0 * scale + bias, with the engine's compensation for further bounces switched off
#   white metal  f0 = 1 with compensation: 1 whatever the table says, since it cancels
#   grey metal   f0 = 0.5 with compensation, by the formula of the engine
#   sheen        the blue channel of Babylon.js
# `picture against reads` is the largest difference between the pixels and bilinear reads of the table: it says that the engine reads it.
set -euo pipefail
cd "$(dirname "$0")/../.."

shots=()
if [ "${1-}" = --shots ]; then shots=("$2"); fi

luthier() { if [ -n "${LUTHIER-}" ]; then "$LUTHIER" "$@"; else cargo run --quiet --release --locked -p luthier-cli -- "$@"; fi; }

here=scripts/engines
out=target/engines
mkdir -p "$out/tables"
npm ci --prefix "$here" --ignore-scripts --no-audit --no-fund --silent
node "$here/extract.mjs" "$out/tables/own" >"$out/tables/own.jsonl"
luthier table dfg --preset three -o "$out/tables/DFGLUTData.js" >&2
luthier table dfg --preset bevy --no-zstd -o "$out/tables/bevy.ktx2" >&2
# Not every version bakes it.
rm -f "$out/tables/babylon"
luthier table dfg --preset babylon -o "$out/tables/babylon.png" >&2 && mv "$out/tables/babylon.png" "$out/tables/babylon" || true
node "$here/furnace.mjs" "$out/tables" "$out" "${shots[@]}"

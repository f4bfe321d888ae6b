#!/usr/bin/env bash
# Audits the tables that engines ship in packages of npm and crates.io, renders furnaces with three.js and Babylon.js, and prints a page:
#   scripts/engine-tables.sh > docs/pages/engine-tables.md
# Takes four minutes after the first build. Needs npm, Chromium, Python and a C compiler (on Debian apt-get install npm chromium python3-venv gcc). LUTHIER names the program that
# bakes, by default cargo builds it. Furnaces of Bevy, whose build takes a quarter of an hour, are apart: scripts/engines-bevy.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ -z "${LUTHIER-}" ]; then
  cargo build --quiet --release --locked -p luthier-cli
  export LUTHIER=$PWD/target/release/luthier
fi
out=target/engines
mkdir -p "$out/shipped"

npm ci --prefix scripts/engines --ignore-scripts --no-audit --no-fund --silent
node scripts/engines/extract.mjs "$out/shipped" >"$out/shipped.jsonl"

# Bevy's table lies in the sources of a crate.
manifest=scripts/engines-bevy/Cargo.toml
folder=$(cargo metadata --locked --format-version 1 --manifest-path "$manifest" |
  node -e 'const { packages } = JSON.parse(require("fs").readFileSync(0)); const p = packages.find((p) => p.name === "bevy_pbr");
           console.log(p.version + " " + require("path").dirname(p.manifest_path))')
version=${folder%% *} folder=${folder#* }
source=src/environment_map/dfg.ktx2
cp "$folder/$source" "$out/shipped/bevy-dfg.ktx2"
printf '{"engine":"Bevy","version":"%s","table":"dfg","source":"%s","shipped":%s,"size":[64,64],"channels":2,"samples":"half","audit":["%s","--preset","bevy"]}\n' \
  "$version" "$source" "$(stat -c %s "$out/shipped/bevy-dfg.ktx2")" "$out/shipped/bevy-dfg.ktx2" >>"$out/shipped.jsonl"

# A baker, whose masking is Schlick's with k = alpha / 2.
cargo build --quiet --release --manifest-path scripts/bench-dfg/Cargo.toml
scripts/bench-dfg/target/release/luthier-bench-dfg --write "$out/shipped/forge-dfg.bin"
for model in ggx-correlated ggx-schlick-half; do
  printf '{"engine":"forge-ibl-bake","version":"0.1.0","table":"dfg, as %s","other":true,"source":"bake_brdf_lut","shipped":65536,"size":[128,128],"channels":2,"samples":"half","audit":["%s","--size","128x128","--channels","2","--samples","half","--model","%s","--axes","cos_theta,roughness","--values","scale,bias"]}\n' \
    "$model" "$out/shipped/forge-dfg.bin" "$model" >>"$out/shipped.jsonl"
done

node scripts/engines/tables.mjs "$out/shipped.jsonl"

cat <<'TEXT'

## Area lights

Linearly transformed cosines of GGX, 64 x 64, as three.js, Babylon.js and Bevy read them (the tables of three.js and Bevy are one), and as `luthier
table ltc` bakes them. The error of energy is half the L1 distance of the light that lobe and BRDF reflect, over the albedo, for cos_theta from 0.02
and alpha from 0.002 on; *rectangles* are four lights of radiance 1 at 42 places each, over the albedo.

| table | energy, between texels: median | 95 % below | largest | rectangles: median | 95 % below | largest |
|---|--:|--:|--:|--:|--:|--:|
TEXT
cat "$out/shipped/three-ltc-1.bin" "$out/shipped/three-ltc-2.bin" >"$out/ltc.bin"
cargo run --quiet --release --locked -p luthier-table --example judge_ltc -- 'three.js, Bevy' "$out/ltc.bin"

cat <<'TEXT'

## Furnaces

Balls under a uniform environment of radiance 1, rendered by each engine in headless Chromium with its own table and with those of luthier
(`scripts/engines/furnace.sh`). Each cell has the largest and the mean error over cosines and roughnesses from 0.05 on, against quadrature: *one
bounce* with the engine's compensation switched off, *white* and *grey metal* (f0 = 1 and 0.5) with it. A white metal under compensation is white whatever
the table holds, because the table cancels: that furnace proves nothing. *Picture against reads* is the largest difference between pixels and
bilinear reads of the file: it shows that the engine reads it.

TEXT
scripts/engines/furnace.sh 2>/dev/null
cat <<'TEXT'

## Other readers

Files of the presets, read by programs that know nothing of luthier (`scripts/engines/readers.py`), and values in their middle against a quadrature over
visible normals in Python. Texels are moved by up to 1e-3, so that reads between them err less, and rounded to the type of the file.

TEXT
[ -d "$out/venv" ] || python3 -m venv "$out/venv"
"$out/venv/bin/pip" install --quiet --disable-pip-version-check OpenImageIO==3.2.2.0 numpy==2.4.6
"$out/venv/bin/python" scripts/engines/readers.py "$LUTHIER"
cat <<'TEXT'

## Bevy

Bevy is a program of its own (`cargo run --manifest-path scripts/engines-bevy/Cargo.toml -- dfg.ktx2`, a quarter of an hour of building):

TEXT
cat docs/measurements/engines-bevy.md

#!/usr/bin/env bash
# Exports all materials of the repository, and asks judges of others about the files: Khronos' validator of glTF (npm), and MaterialX (PyPI), whose
# libraries must know each node and input, and make a shader of each material. Blender (PyPI) reads a glTF file, and Cycles draws its materials beside
# `luthier preview`.
#   scripts/formats.sh            checks
#   scripts/formats.sh FOLDER     leaves the pictures of Cycles, and a page about them, in FOLDER: exported.md and exported.png
# Needs npm, Python 3.11 (that of Blender's module) with venv, and a Vulkan driver: on Debian 12 apt-get install npm python3-venv libxi6 libxxf86vm1 libxfixes3
# libxrender1 libgl1 libxkbcommon0 libsm6 libice6 mesa-vulkan-drivers. Blender is a gigabyte. LUTHIER names the program, by default cargo builds it.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ -z "${LUTHIER-}" ]; then
  cargo build --locked --release -p luthier-cli
  LUTHIER=$PWD/target/release/luthier
fi

here=scripts/formats
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
npm ci --prefix "$here" --ignore-scripts --no-audit --no-fund --silent
python3 -m venv "$work/python"
"$work/python/bin/pip" install --quiet --disable-pip-version-check materialx==1.39.5 bpy==5.0.1

for folder in materials materials/papers materials/textured/board; do
  for format in gltf openpbr standard-surface; do
    "$LUTHIER" export --to "$format" "$folder" -o "$work/$format/${folder//\//-}" --noise 0.05 >/dev/null
  done
done
node "$here/validate.mjs" "$work"/gltf/*/materials.gltf
"$work/python/bin/python" "$here/validate.py" "$work"/{openpbr,standard-surface}/*/materials.mtlx
"$work/python/bin/python" "$here/blender.py" "$LUTHIER" "${1-$work}" "$work/gltf/materials/materials.gltf" \
  materials/{polished-gold,house-paint,brushed-aluminium,red-lacquer,car-paint}.toml

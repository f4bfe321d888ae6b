#!/usr/bin/env bash
# Exports all materials of the repository, and asks judges of others about the files: Khronos' validator of glTF (npm), and MaterialX (PyPI), whose
# libraries must know each node and input, and make a shader of each material.
#   scripts/formats.sh
# Needs npm and Python 3 with venv (on Debian apt-get install npm python3-venv). LUTHIER names the program, by default cargo builds it.
set -euo pipefail
cd "$(dirname "$0")/.."

luthier() { if [ -n "${LUTHIER-}" ]; then "$LUTHIER" "$@"; else cargo run --quiet --release --locked -p luthier-cli -- "$@"; fi; }

here=scripts/formats
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
npm ci --prefix "$here" --ignore-scripts --no-audit --no-fund --silent
python3 -m venv "$work/python"
"$work/python/bin/pip" install --quiet --disable-pip-version-check materialx==1.39.5

for folder in materials materials/papers materials/textured/board; do
  for format in gltf openpbr standard-surface; do
    luthier export --to "$format" "$folder" -o "$work/$format/${folder//\//-}" --noise 0.05 >/dev/null
  done
done
node "$here/validate.mjs" "$work"/gltf/*/materials.gltf
"$work/python/bin/python" "$here/validate.py" "$work"/{openpbr,standard-surface}/*/materials.mtlx

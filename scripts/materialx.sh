#!/usr/bin/env bash
# Tests of the library for MaterialX, examples/materialx, in MaterialX 1.39.5: shaders of six targets through compilers, balls by MaterialX' renderer beside those
# of `luthier preview`, and bakes that are refused.
#   scripts/materialx.sh         the variable LUTHIER names the command; by default cargo builds it
# From PyPI: what examples/materialx/requirements.txt lists, in target/materialx/venv. Needs glslangValidator, an X display without a screen, and drivers for OpenGL
# and Vulkan; on Debian apt-get install glslang-tools xvfb xauth libgl1 libglx-mesa0 libgl1-mesa-dri libxt6 mesa-vulkan-drivers. Pictures are left in target/materialx/.
set -euo pipefail
cd "$(dirname "$0")/.."
for program in python3 glslangValidator xvfb-run; do
  command -v "$program" >/dev/null || { echo "error: $program is missing; on Debian: apt-get install glslang-tools xvfb xauth" >&2; exit 3; }
done
out=$PWD/target/materialx
mkdir -p "$out"
# One store for the bakes and pictures of this run.
export LUTHIER_CACHE=$out/store PYTHONDONTWRITEBYTECODE=1
rm -rf "$LUTHIER_CACHE"

python3 -m venv "$out/venv"
python=$out/venv/bin/python
# The compiler of Slang is in a package that would bring PyTorch, too.
"$python" -m pip install --quiet --no-deps --requirement examples/materialx/requirements.txt
tools=$("$python" -c 'import pathlib, sysconfig; print(pathlib.Path(sysconfig.get_path("purelib")) / "slangtorch/bin")')
chmod +x "$tools/slangc"
export SLANGC=$tools/slangc
if [ -z "${LUTHIER-}" ]; then
  cargo build --locked --release -p luthier-cli
  export LUTHIER=$PWD/target/release/luthier
fi
xvfb-run --auto-servernum "$python" examples/materialx/test_library.py "$out"

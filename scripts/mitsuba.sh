#!/usr/bin/env bash
# Tests of the plugin for Mitsuba 3, examples/mitsuba: values, a chi-square test of its draws, a white furnace, and a ball beside that of `luthier preview`.
#   scripts/mitsuba.sh [TEST...]   all, or some (test_plugin.Furnace). The variable LUTHIER names the command; by default cargo builds it
# The module is installed from a wheel, in a new virtual environment. From PyPI: maturin, numpy, mitsuba. Needs a Vulkan driver, and LLVM 17 or later as a
# library, which Mitsuba loads; on Debian apt-get install mesa-vulkan-drivers libllvm19. Pictures are left in target/mitsuba/.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# With an older one Mitsuba ends in the middle of a test.
newest() {
  PATH=$PATH:/sbin:/usr/sbin ldconfig -p |
    awk '/libLLVM/ { version = $1; sub(/^libLLVM(-|\.so\.)/, "", version); if (version + 0 >= 17) print version + 0, $NF }' | sort -n | tail -n 1 | cut -d " " -f 2
}
if [ -z "${DRJIT_LIBLLVM_PATH-}" ] && [ "$(uname -s)" = Linux ]; then
  DRJIT_LIBLLVM_PATH=$(newest)
  [ -n "$DRJIT_LIBLLVM_PATH" ] || { echo "error: Mitsuba wants LLVM 17 or later as a library: on Debian apt-get install libllvm19" >&2 && exit 3; }
  export DRJIT_LIBLLVM_PATH
fi

if [ -z "${LUTHIER-}" ]; then
  cargo build --locked --release -p luthier-cli
  LUTHIER=$PWD/target/release/luthier
fi
export LUTHIER PICTURES=$PWD/target/mitsuba PYTHONDONTWRITEBYTECODE=1
python3 -m venv "$work/venv"
python=$work/venv/bin/python
"$python" -m pip wheel --quiet --no-deps --wheel-dir "$work" ./crates/luthier-python
"$python" -m pip install --quiet "$work"/*.whl mitsuba
cd examples/mitsuba
"$python" -m unittest "${@:-test_plugin}"

#!/usr/bin/env bash
# Tests of the Python module crates/luthier-python.
#   scripts/python.sh [TEST...]   lays the package out beside the extension module that cargo has built, and runs crates/luthier-python/tests, or some
#                                 (test_arrays, test_physics.Draws), with NumPy alone. Takes the command from LUTHIER, the module from beside it or deps. `cargo test`
#                                 calls it (tests/python.rs). Exits with 3 where no Python has NumPy
#   scripts/python.sh --install   makes a wheel, installs it in a new virtual environment, and runs there the tests, the notebook, the examples and bench.py.
#                                 From PyPI: maturin, numpy, matplotlib, nbclient, ipykernel. The wheel stays in target/wheels/
set -euo pipefail
cd "$(dirname "$0")/.."
crate=$PWD/crates/luthier-python
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Fits that the command and the module share.
export LUTHIER_TEST_STORE=${LUTHIER_TEST_STORE:-$work/store}

if [ "${1-}" = --install ]; then
  python3 -m venv "$work/venv"
  python=$work/venv/bin/python
  started=$SECONDS
  rm -rf target/wheels
  "$python" -m pip wheel --quiet --no-deps --wheel-dir target/wheels ./crates/luthier-python
  ls -l target/wheels/*.whl | awk '{ print $NF ": " $5 " bytes" }'
  echo "made in $((SECONDS - started)) s"
  "$python" -m pip install --quiet target/wheels/*.whl matplotlib nbclient ipykernel
  # Away from the sources, so that the wheel is what is imported.
  cd "$work"
  "$python" -m unittest discover --start-directory "$crate/tests"
  "$python" "$crate/examples/run_notebook.py" "$crate/examples/notebook.ipynb" "$work/notebook.ipynb"
  "$python" "$crate/examples/coats.py" "$work/coats.png"
  "$python" "$crate/bench.py"
  exit
fi

export LUTHIER=${LUTHIER:-$PWD/target/debug/luthier}
# `cargo test` leaves the module in `deps`; `cargo build` also beside the command.
for name in lib_luthier.so lib_luthier.dylib deps/lib_luthier.so deps/lib_luthier.dylib; do
  [ ! -e "$(dirname "$LUTHIER")/$name" ] || built=$(dirname "$LUTHIER")/$name
done
[ -n "${built-}" ] || { echo "error: no extension module beside $LUTHIER or in deps; build the workspace first"; exit 1; }
# The python3 that is found first may be one without NumPy, beside a system that has it.
for python in python3 /usr/bin/python3 none; do
  ! "$python" -c 'import numpy' 2>/dev/null || break
done
[ "$python" != none ] || { echo "error: no Python with NumPy (Debian: python3-numpy; scripts/wants.sh installs it)"; exit 3; }
cp -r "$crate/python/luthier" "$work"
cp "$built" "$work/luthier/_luthier.abi3.so"
export PYTHONPATH=$work:$crate/tests PYTHONDONTWRITEBYTECODE=1
if [ $# -gt 0 ]; then "$python" -m unittest "$@"; else "$python" -m unittest discover --start-directory "$crate/tests"; fi

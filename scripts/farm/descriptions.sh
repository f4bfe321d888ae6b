#!/usr/bin/env bash
# Checks the jobs for engines that are not run here: examples/farm/kubernetes against the schema of Kubernetes, and
# examples/farm/opencue by OpenCue's own library, which writes the specification that a server would get. Then runs the commands
# that they describe, one after the other on this machine, and compares the packages with a plain bake. Needs Python with venv (on
# Debian: apt-get install python3-venv) and PyPI.
# The environment variable LUTHIER names the program; by default cargo builds it.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/farm/program.sh

python3 -c 'import venv, ensurepip' 2>/dev/null || {
  echo "error: Python cannot make virtual environments. On Debian: apt-get install python3-venv" >&2
  exit 1
}
take_luthier --release

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check kubernetes-validate==1.37.0 opencue-pyoutline==1.37.0 opencue-pycue==1.37.0

"$work/venv/bin/kubernetes-validate" --strict examples/farm/kubernetes/*.yaml
# OpenCue's library keeps a folder for each outline in the home folder.
HOME=$work "$work/venv/bin/python" scripts/farm/descriptions.py "$work"

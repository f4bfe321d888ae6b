# Sourced by the scripts of this folder. It looks for the program, makes a folder for the test and two reference bakes: `old` has a map, and files that
# `new` lacks. `LUTHIER=path` names the program; otherwise target/debug/luthier is taken, and built without graphics if it is not there.
# Wants Linux, and of Debian: gcc, libc6-dev, python3, util-linux.
set -euo pipefail
crash=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$crash/../.."

fail() {
  printf 'error: %s\n' "$1" >&2
  exit 1
}
need() { command -v "$1" >/dev/null || fail "$1 is missing: install the Debian package $2"; }

[ "$(uname -s)" = Linux ] || fail "these tests want Linux"
need python3 python3
python=$(python3 -c 'import sys; print(sys.executable)')
if [ -z "${LUTHIER-}" ] && [ ! -x target/debug/luthier ]; then
  cargo build --locked -p luthier-cli --no-default-features
fi
luthier=$(realpath "${LUTHIER:-target/debug/luthier}")
[ -x "$luthier" ] || fail "$luthier is not a program"

# No store: every bake does all its work.
export LUTHIER_CACHE=
work=$(realpath "$(mktemp -d)")
children=()
finish() {
  local child
  for child in "${children[@]}"; do kill -KILL "$child" 2>/dev/null || true; done
  [ "$(type -t tidy)" = function ] && tidy
  rm -rf "$work"
}
trap finish EXIT

cp -r "$crash/materials" "$work/materials"
cd "$work"
declare -A source=([old]=materials/worn.toml [new]=materials/gold.toml)

# bake NAME FOLDER: one of the two generations into a folder; under names with hashes where `hashed` is set.
bake() { "$luthier" bake "${source[$1]}" --no-fit --no-search ${hashed:+--hashed-names} --out "$2" --quiet; }

bake old "$work/ref-old"
bake new "$work/ref-new"

# What two readers see in a folder: one that knows `.luthier-ready/`, and one that does not.
seen() { "$python" -S "$crash/generation.py" name "$1" old="$work/ref-old" new="$work/ref-new"; }

# is_whole FOLDER NAME: a folder holds exactly what an undisturbed bake writes, and no folder more. Under names with hashes the files of the generation before
# are there, too, and no others.
is_whole() {
  if [ -z "${hashed-}" ]; then
    diff -r "$1" "$work/ref-$2"
  else
    [ "$(seen "$1")" = "$2 $2" ] && "$python" -S "$crash/generation.py" tidy "$1"
  fi
}

# has FOLDER NAME: a reader that has read the manifest of a generation before finds its files.
has() { "$python" -S "$crash/generation.py" has "$1" "$work/ref-$2/manifest.json"; }

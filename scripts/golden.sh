#!/usr/bin/env bash
# Compares everything that bakes write with two lists of hashes: of `materials` and the package inside it, of each scene, and of fitted lobes.
#   tests/golden/identity.sha256  numbers: what textures, maps and images hold once they are decoded, and material buffers
#   tests/golden/form.sha256      containers, texts of shaders, manifests
# Another number changes both lists, another codec or wording the second alone.
#   scripts/golden.sh                     compares, and says in which list a difference is
#   scripts/golden.sh --update            writes the lists anew, and says which have changed
#   scripts/golden.sh --keep DIR          compares, and leaves the bakes in DIR, which does not exist before
#   scripts/golden.sh --of DIR LISTS [--update]   makes no bakes: takes those in DIR, and lists in the folder LISTS
# Text shaders count without comments and blank lines, manifests without hashes of shaders, classes of materials and
# paths of material files: words for readers may change, and these paths lead from the folder of the bake.
# LUTHIER and LUTHIER_LAB name the programs. Takes half a minute of two cores in release.
set -euo pipefail
export LC_ALL=C
here=$PWD
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=
luthier=${LUTHIER:-$PWD/target/release/luthier}
lab=${LUTHIER_LAB:-$PWD/target/release/luthier-lab}

lists=tests/golden
bakes=
update=
kept=
while [ $# -gt 0 ]; do
  case $1 in
    --update) update=yes ;;
    --keep) kept=$2 && shift ;;
    --of) bakes=$(cd "$here" && realpath "$2") && lists=$(cd "$here" && realpath "$3") && shift 2 ;;
    *) echo "error: unknown option $1" >&2 && exit 2 ;;
  esac
  shift
done

now=$(mktemp -d)
trap 'rm -rf "$now"' EXIT
if [ -z "$bakes" ]; then
  bakes=${kept:-$now/bakes}
  mkdir "$bakes"
  bake() { "$luthier" bake "$@" --quiet 2>/dev/null; }
  bake materials --no-fit --out "$bakes/materials"
  for scene in materials/scenes/*.toml; do
    bake "$scene" --no-fit --out "$bakes/$(basename "$scene" .toml)"
  done
  # A uniform stack, rows over a factor, over the azimuth, and over the amount of a patina.
  bake materials/red-lacquer.toml tests/golden/worn-lacquer.toml tests/golden/lacquered-brushed.toml materials/copper-patina.toml \
    --out "$bakes/fitted"
fi

# What of a file counts for its form.
content() {
  case $1 in
    */shaders/*) sed -E 's,[[:space:]]*//.*$,,' "$1" | grep -v '^[[:space:]]*$' ;;
    */manifest.json) sed '/"path": "shaders\//{n;d;};/^ *"class": /d;/^ *"source": ".*\.toml"/d' "$1" ;;
    *) cat "$1" ;;
  esac
}

"$lab" texels "$bakes" >"$now/identity.sha256"
(cd "$bakes" && find . -type f ! -path '*/.*/*' ! -name '.*' ! -name '*.bin' | sort) | sed 's,^\./,,' | while read -r file; do
  printf '%s  %s\n' "$(content "$bakes/$file" | sha256sum | cut -d' ' -f1)" "$file"
done >"$now/form.sha256"

changed=()
for list in identity form; do
  touch "$now/none"
  old=$lists/$list.sha256
  [ -e "$old" ] || old=$now/none
  diff "$old" "$now/$list.sha256" || changed+=("$list")
done
[ -z "$update" ] || cp "$now/identity.sha256" "$now/form.sha256" "$lists"
case ${changed[*]-} in
  "") echo "identity and form are as in $lists: $(wc -l <"$now/identity.sha256") files of numbers, $(wc -l <"$now/form.sha256") of forms" && exit ;;
  form) what="form alone: containers, texts of shaders or manifests; every number is as it was" ;;
  identity) what="identity alone: numbers of material buffers" ;;
  *) what="identity: numbers of textures or of material buffers, and with them the form" ;;
esac
echo "changed: $what"
[ -n "$update" ] && exit
echo "error: bakes differ from $lists; if they should, say why in the commit and run scripts/golden.sh --update"
exit 1

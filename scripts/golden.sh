#!/usr/bin/env bash
# Compares everything that a bake of `materials` and of each scene writes with tests/golden.sha256; `--update` writes that list anew,
# `--keep DIR` compares and leaves the bakes in DIR, which does not exist before.
# Text shaders count without comments and blank lines, the manifest without their hashes and without classes of materials: words for readers may change.
# Nothing is simulated (`--no-fit`).
# Takes half a minute of baking in release.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

list=tests/golden.sha256
luthier=${LUTHIER:-./target/release/luthier}
if [ "${1-}" = --keep ]; then
  work=$2
  mkdir "$work"
else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi

"$luthier" bake materials --no-fit --out "$work/materials" --quiet 2>/dev/null
for scene in materials/scenes/*.toml; do
  "$luthier" bake "$scene" --no-fit --out "$work/$(basename "$scene" .toml)" --quiet 2>/dev/null
done

# What of a file counts.
content() {
  case $1 in
    */shaders/*) sed -E 's,[[:space:]]*//.*$,,' "$1" | grep -v '^[[:space:]]*$' ;;
    */manifest.json) sed '/"path": "shaders\//{n;d;};/^ *"class": /d' "$1" ;;
    *) cat "$1" ;;
  esac
}

(cd "$work" && find . -type f ! -path '*/.*/*' ! -name '.*' | sort) | sed 's,^\./,,' | while read -r file; do
  printf '%s  %s\n' "$(content "$work/$file" | sha256sum | cut -d' ' -f1)" "$file"
done >"$work/.list"

if [ "${1-}" = --update ]; then
  cp "$work/.list" "$list"
elif ! diff "$list" "$work/.list"; then
  echo "error: bakes differ from $list; if they should, say why in the commit and run scripts/golden.sh --update"
  exit 1
else
  echo "$(wc -l <"$list") files are as in $list"
fi

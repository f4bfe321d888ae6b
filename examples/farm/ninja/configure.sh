#!/usr/bin/env bash
# Writes build.ninja into the current folder: a graph whose edges bake the shares of a folder of materials, and merge them into
# out/. Needs Ninja (on Debian: apt-get install ninja-build) and luthier.
#   mkdir build && cd build && path/to/configure.sh MATERIALS [OPTIONS OF BAKE] && ninja
# LUTHIER names the program, LUTHIER_CACHE the store (by default store/), SHARDS the number of shares (4), and LAUNCH a command that
# goes before the program, such as srun --ntasks=1.
set -euo pipefail

materials=$(realpath "${1:?names no folder of materials}")
options=("${@:2}")
program=$(realpath "$(command -v "${LUTHIER:-luthier}")")
store=${LUTHIER_CACHE:-store}
shards=${SHARDS:-4}

# A name as a path of the graph, and words as a shell reads them in a command of the graph.
path() { sed -E 's/[$ :]/$&/g' <<<"$1"; }
words() { [ $# = 0 ] || printf '%q ' "$@" | sed 's/\$/$$/g'; }

inputs=
for file in "$materials"/*.toml "$materials"/luthier.lock; do
  [ ! -e "$file" ] || inputs+=" $(path "$file")"
done

{
  cat <<GRAPH
# Written by configure.sh.
ninja_required_version = 1.5

rule share
  command = ${LAUNCH-} $(words "$program") bake $(words "$materials" "${options[@]}") --shard \$index/$shards --cache $(words "$store") --threads 1 --quiet && touch \$out
  description = share \$index of $shards

# The depfile names what the package was made of: materials, and the files that these refer to. luthier does not write a manifest
# that would stay the same, so its date is set here.
rule merge
  command = ${LAUNCH-} $(words "$program") merge $(words "$materials" "${options[@]}") --cache $(words "$store") --out out --depfile merge.d --quiet && touch \$out
  depfile = merge.d
  deps = gcc
  description = merge

# The date of the folder changes when a material or the lock comes or goes.
rule configure
  command = LUTHIER=$(words "$program") LUTHIER_CACHE=$(words "$store") SHARDS=$shards LAUNCH=$(words "${LAUNCH-}") $(words "$(realpath "$0")" "$materials" "${options[@]}")
  generator = 1
build build.ninja: configure $(path "$(realpath "$0")") $(path "$materials")

GRAPH
  shares=
  for index in $(seq "$shards"); do
    printf 'build share-%s: share |%s %s\n  index = %s\n' "$index" "$inputs" "$(path "$program")" "$index"
    shares+=" share-$index"
  done
  printf 'build out/manifest.json: merge |%s\n' "$shares"
  printf 'build materials: phony out/manifest.json\ndefault materials\n'
} >build.ninja.new
mv build.ninja.new build.ninja

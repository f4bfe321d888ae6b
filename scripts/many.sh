#!/usr/bin/env bash
# Bakes libraries of 100, 1,000 and 10,000 generated materials (or of the sizes given), and writes time, memory and bytes to
# docs/pages/scale.md; with lobes, libraries of 8, 16 and 32, and the last of them in 1, 2, 4 and 8 shares. Needs GNU time (on Debian: apt-get install time).
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

sizes=("$@")
[ ${#sizes[@]} -gt 0 ] || sizes=(100 1000 10000)
out=target/many
page=docs/pages/scale.md
mkdir -p "$out"

cargo build --locked --quiet --release -p luthier-cli
luthier=target/release/luthier

size_of() { # bytes of some files together
  find "$@" -type f -printf '%s\n' | awk '{ sum += $1 } END { printf "%d", sum }'
}
mega() { awk -v bytes="$1" 'BEGIN { printf "%.1f", bytes / 1e6 }'; }

seconds() { awk '{ print $1 }' "$1"; }
processor() { awk '{ print $2 + $3 }' "$1"; }
bake() { # NAME ARGUMENT...: bakes without fits, and keeps the time, the processor time and the memory that it took in a file, and what it told in another
  local name=$1
  shift
  /usr/bin/time -f '%e %U %S %M' -o "$here/$name.time" "$luthier" bake "$@" --no-fit --json --cache "$here/store" 2>/dev/null >"$here/$name.json"
}
median() { sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }

{
  cat <<HEAD
# Many materials

\`scripts/many.sh\` made this page: libraries of generated materials (\`crates/luthier-material/examples/library\`, seed 1) of one to four layers,
baked by \`luthier bake FOLDER --no-fit\` with \`$(nproc)\` cores. Times are those of the whole command. Sizes are in MB of 10^6 bytes.
[manifest.md](../manifest.md) states the limits.

## Time

- *Cold*: the store is empty, and everything is computed.
- *All kept*: into another folder, with all results in the store. This is what a bake costs beside its jobs: reading files, planning, assembling,
  encoding, shaders, publishing.
- *Nothing changed*: into the first folder again; the median of nine. The files are read and compared, the outputs looked at.
- *One changed*: one material has another index, and \`luthier.lock\` keeps sizes, axes and formats. All files that hold its tiles are written
  anew, and these are all tables, because each is one texture for all materials.
- *One changed, no lock*: the search for sizes, axes and formats is made anew as well.

- *Apart*: of one changed, the time that is neither its own jobs nor the encoding and writing of files: reading, planning, looking up what is kept,
  assembling, shaders.

| materials | layers | cold s | processor s | ms each | memory MB | all kept s | ms each | nothing changed ms | one changed s | apart ms | no lock s |
|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|
HEAD
} >"$page.new"
sizes_table=$(mktemp)

for count in "${sizes[@]}"; do
  here=$out/$count
  rm -rf "$here" && mkdir -p "$here"
  cargo run --locked --quiet -p luthier-material --example library -- "$count" "$here/materials"
  layers=$(cat "$here/materials/"*.toml | grep -c '^type = "\(dielectric\|conductor\|diffuse\)"')
  bake cold "$here/materials" --out "$here/out"
  bake kept "$here/materials" --out "$here/kept"
  diff -r "$here/out" "$here/kept"
  nothing=$(for _ in 1 2 3 4 5 6 7 8 9; do
    started=$(date +%s%N)
    bake nothing "$here/materials" --out "$here/out"
    echo $((($(date +%s%N) - started) / 1000))
  done | median)
  first=$here/materials/$(ls "$here/materials" | sed -n 1p)
  sed -i '0,/^ior = [0-9.]*$/s//ior = 1.4321/' "$first"
  grep -q 'ior = 1.4321' "$first"
  bake unlocked "$here/materials" --out "$here/kept"
  bake locking "$here/materials" --out "$here/out" --relock
  sed -i 's/ior = 1.4321/ior = 1.4322/' "$first"
  bake changed "$here/materials" --out "$here/out"
  apart=$(python3 -c 'import json, sys
told = json.load(sys.stdin)
phases, jobs = told["phases"], sum(told["seconds"].values())
print(round(1000 * (phases["read"] + phases["make"] - jobs)))' <"$here/changed.json")
  bake=$here/out
  printf '| %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s |\n' "$count" "$layers" "$(seconds "$here/cold.time")" \
    "$(processor "$here/cold.time")" "$(awk -v n="$count" '{ printf "%.1f", 1000 * ($2 + $3) / n }' "$here/cold.time")" \
    "$(mega $(($(awk '{ print $4 }' "$here/cold.time") * 1024)))" "$(seconds "$here/kept.time")" \
    "$(awk -v n="$count" '{ printf "%.2f", 1000 * ($2 + $3) / n }' "$here/kept.time")" \
    "$(awk -v us="$nothing" 'BEGIN { printf "%.0f", us / 1000 }')" "$(seconds "$here/changed.time")" "$apart" \
    "$(seconds "$here/unlocked.time")" |
    tee -a "$page.new"
  printf '| %s | %s | %s | %s | %s | %s | %s |\n' "$count" "$(mega "$(size_of "$bake/tables" -name '*.ktx2')")" \
    "$(mega "$(size_of "$bake/tables" -not -name '*.ktx2')")" "$(mega "$(size_of "$bake/materials.bin")")" \
    "$(mega "$(size_of "$bake/manifest.json")")" "$(mega "$(size_of "$bake/shaders")")" \
    "$(mega "$(size_of "$here/store/objects")")" >>"$sizes_table"
done

{
  cat <<'HEAD'

Milliseconds each are of processor time, for each material.

## Sizes

The column tables has the KTX2 files of the package.

| materials | tables | truth and pictures | material buffer | manifest | shaders | store |
|--:|--:|--:|--:|--:|--:|--:|
HEAD
  cat "$sizes_table"
} >>"$page.new"
rm "$sizes_table"

# Libraries whose stacks are all simulated, and all new.
here=$out/lobes
rm -rf "$here" && mkdir -p "$here"
fit() { # NAME STORE ARGUMENT...: bakes with lobes, and keeps the time
  local name=$1 store=$2
  shift 2
  /usr/bin/time -f '%e %U %S %M' -o "$here/$name.time" "$luthier" "$@" --model lobes --quiet --cache "$here/$store" 2>/dev/null
}
{
  cat <<'HEAD'

## Lobes

All stacks are simulated (`--model lobes`), and no result is kept.

| materials | seconds | processor s | processor s each | memory MB |
|--:|--:|--:|--:|--:|
HEAD
  for count in 8 16 32; do
    cargo run --locked --quiet -p luthier-material --example library -- "$count" "$here/$count"
    fit "cold-$count" "store-$count" bake "$here/$count" --out "$here/out-$count"
    printf '| %s | %s | %s | %s | %s |\n' "$count" "$(seconds "$here/cold-$count.time")" "$(processor "$here/cold-$count.time")" \
      "$(awk -v n="$count" '{ printf "%.2f", ($2 + $3) / n }' "$here/cold-$count.time")" \
      "$(mega $(($(awk '{ print $4 }' "$here/cold-$count.time") * 1024)))"
  done
  cat <<'HEAD'

The 32 in shares, one after the other, each on one core (`--shard I/N --threads 1`) and into one store; then `luthier merge`.
The bytes are those of the bake above. The longest share decides how long so many machines take.

| shares | processor s of all | longest s | mean s | longest over mean | merge s |
|--:|--:|--:|--:|--:|--:|
HEAD
  for shares in 1 2 4 8; do
    for share in $(seq "$shares"); do
      fit "share-$share" "shares-$shares" bake "$here/32" --out "$here/merged-$shares" --shard "$share/$shares" --threads 1 >/dev/null
    done
    for share in $(seq "$shares"); do cat "$here/share-$share.time"; done >"$here/shares-$shares.times"
    fit merge "shares-$shares" merge "$here/32" --out "$here/merged-$shares"
    diff -r "$here/out-32" "$here/merged-$shares"
    awk -v merge="$(seconds "$here/merge.time")" '{ cpu += $2 + $3; all += $1; if ($1 > most) most = $1 }
      END { printf "| %d | %.1f | %.1f | %.1f | %.2f | %s |\n", NR, cpu, most, all / NR, most / (all / NR), merge }' "$here/shares-$shares.times"
  done
} >>"$page.new"
mv "$page.new" "$page"

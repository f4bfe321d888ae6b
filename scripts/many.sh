#!/usr/bin/env bash
# Bakes libraries of 100, 1,000 and 10,000 generated materials (or of the sizes given), and writes time, memory and bytes to
# docs/pages/scale.md. Needs GNU time (on Debian: apt-get install time).
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

{
  echo "# Many materials"
  echo
  echo "Made by \`scripts/many.sh\`: libraries of generated materials (\`crates/luthier-material/examples/library\`, seed 1) of one to four"
  echo "layers, baked by \`luthier bake FOLDER --no-fit\` with \`$(nproc)\` cores. Time is that of the whole command, and memory its largest resident set."
  echo "The column tables has the KTX2 files of the package. Sizes are in MB of 10^6 bytes. [manifest.md](../manifest.md) states the limits."
  echo
  echo "| materials | layers | seconds | processor seconds | memory MB | tables | truth and pictures | material buffer | manifest | shaders |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
} >"$page.new"

for count in "${sizes[@]}"; do
  rm -rf "$out/$count" && mkdir -p "$out/$count"
  cargo run --locked --quiet -p luthier-material --example library -- "$count" "$out/$count/materials"
  layers=$(cat "$out/$count/materials/"*.toml | grep -c '^type = "\(dielectric\|conductor\|diffuse\)"')
  /usr/bin/time -f '%e %U %S %M' -o "$out/$count/time" "$luthier" bake "$out/$count/materials" --out "$out/$count/out" --no-fit --quiet 2>/dev/null
  read -r elapsed user system kib <"$out/$count/time"
  bake=$out/$count/out
  printf '| %s | %s | %s | %s | %s | %s | %s | %s | %s | %s |\n' "$count" "$layers" "$elapsed" \
    "$(awk -v u="$user" -v s="$system" 'BEGIN { print u + s }')" "$(mega $((kib * 1024)))" \
    "$(mega "$(size_of "$bake/tables" -name '*.ktx2')")" "$(mega "$(size_of "$bake/tables" -not -name '*.ktx2')")" \
    "$(mega "$(size_of "$bake/materials.bin")")" "$(mega "$(size_of "$bake/manifest.json")")" \
    "$(mega "$(size_of "$bake/shaders")")" | tee -a "$page.new"
done

mv "$page.new" "$page"

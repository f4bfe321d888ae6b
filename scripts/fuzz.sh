#!/usr/bin/env bash
# Searches for inputs that bring a parser down: libFuzzer by coverage, on stable Rust. docs/fuzzing.md has the targets and the findings.
#   scripts/fuzz.sh [SECONDS [TARGET...]]   600 seconds unless said otherwise, split over all targets or those named
#   KEEP=N scripts/fuzz.sh ...              adds N new inputs of each target to the corpus that is checked in
# It fails with the path of the input where one makes a parser panic, take 10 seconds, or hold 512 MiB. New inputs are reduced to those that
# reach code which no other one reaches, and stay in target/fuzz/new/ for the next run. The figures go to docs/measurements/fuzzing.tsv and
# docs/fuzzing.md.
# Wants a C++ compiler (Debian: g++), which compiles libFuzzer.
set -euo pipefail
cd "$(dirname "$0")/.."

timeout_s=10
memory_mib=512
longest_input=16384
kept_bytes=512

seconds=${1:-600}
[[ $seconds =~ ^[1-9][0-9]*$ ]] || { echo "error: \`$seconds\` is not a number of seconds"; exit 1; }
shift $(($# > 0))
command -v g++ >/dev/null || command -v clang++ >/dev/null || { echo "error: there is no C++ compiler (Debian: g++)"; exit 1; }

# Every edge counts, and comparisons say what they wanted: the passes of LLVM that a sanitizer would bring.
flags=(-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 -Cllvm-args=-sanitizer-coverage-inline-8bit-counters
  -Cllvm-args=-sanitizer-coverage-pc-table -Cllvm-args=-sanitizer-coverage-trace-compares)
host=$(rustc -vV | sed -n 's/^host: //p')
echo "building the targets"
# With a target of its own, so that build scripts and macros are compiled without these flags.
RUSTFLAGS="${flags[*]}" cargo build --locked --quiet --profile fuzz --target "$host" --target-dir target/fuzz \
  -p luthier-fuzz --features guided
engine=$PWD/target/fuzz/$host/fuzz/luthier-fuzz

list=$(LUTHIER_FUZZ_TARGET=list "$engine" 2>/dev/null)
mapfile -t known < <(cut -f1 <<<"$list")
[ $# -gt 0 ] && chosen=("$@") || chosen=("${known[@]}")
for target in "${chosen[@]}"; do
  grep -q "^$target	" <<<"$list" || { echo "error: there is no target \`$target\`; there are ${known[*]}"; exit 1; }
done

new=$PWD/target/fuzz/new findings=$PWD/target/fuzz/findings
logs=$(mktemp -d)
running=()
trap '[ ${#running[@]} = 0 ] || kill "${running[@]}" 2>/dev/null || true; rm -rf "$logs"' EXIT

# Folders of inputs that are checked in.
seeds() {
  echo "crates/luthier-fuzz/corpus/$1"
  grep "^$1	" <<<"$list" | cut -f5 | tr ' ' '\n' | sed '/^$/d'
}

# What is written in the inputs, word by word.
words() {
  local folder
  for folder in $(seeds "$1"); do find "$folder" -maxdepth 1 -name '*.toml' -o -maxdepth 1 -name '*.json' -o -maxdepth 1 -name '*.csv' -o -maxdepth 1 -name '*.txt'; done |
    xargs -r grep -ahoE '[A-Za-z_][A-Za-z0-9_.-]{1,30}' | LC_ALL=C sort -u | sed 's/.*/"&"/'
}

fuzz() {
  local target=$1 share=$2
  mkdir -p "$new/$target" "$findings/$target"
  words "$target" >"$logs/$target.words"
  local folders=() dictionary=()
  mapfile -t folders < <(seeds "$target")
  [ ! -s "$logs/$target.words" ] || dictionary=(-dict="$logs/$target.words")
  LUTHIER_FUZZ_TARGET=$target exec "$engine" "$new/$target" "${folders[@]}" -max_total_time="$share" -timeout=$timeout_s \
    -rss_limit_mb=$memory_mib -max_len=$longest_input -artifact_prefix="$findings/$target/" "${dictionary[@]}" \
    -print_final_stats=1 >"$logs/$target.log" 2>&1
}

# Leaves, of the new inputs, those that reach more than what is checked in.
reduce() {
  local target=$1 folder base
  base=$(mktemp -d "$logs/$target.XXXX")
  mkdir "$base/all" "$base/new"
  for folder in $(seeds "$target"); do find "$folder" -maxdepth 1 -type f -exec cp {} "$base/all" \;; done
  ls "$base/all" >"$base/old"
  LUTHIER_FUZZ_TARGET=$target "$engine" -merge=1 -timeout=$timeout_s -rss_limit_mb=$memory_mib -max_len=$longest_input \
    "$base/all" "$new/$target" >"$logs/$target.merge" 2>&1 || return 0
  (cd "$base/all" && while read -r file; do rm -f "$file"; done <"$base/old")
  rm -rf "${new:?}/$target"
  mv "$base/all" "$new/$target"
}

# Adds some of the new inputs to what is checked in: of the small ones the largest, which reach most.
keep() {
  local file
  while read -r file; do
    mv "$file" "crates/luthier-fuzz/corpus/$1/"
  done < <(find "$new/$1" -type f -size -$((kept_bytes + 1))c -printf '%s %p\n' | sort -rn | head -n "$KEEP" | cut -d' ' -f2-)
}

# The targets run side by side, one for each core.
cores=$(nproc)
[ "$cores" -le ${#chosen[@]} ] || cores=${#chosen[@]}
share=$((seconds * cores / ${#chosen[@]}))
[ "$share" -gt 0 ] || share=1
echo "${#chosen[@]} targets, $share seconds each, $cores at a time"
declare -A name status
collect() {
  local pid code=0
  wait -n -p pid "${running[@]}" || code=$?
  status[${name[$pid]}]=$code
  local left=() other
  for other in "${running[@]}"; do [ "$other" = "$pid" ] || left+=("$other"); done
  running=("${left[@]}")
}
for target in "${chosen[@]}"; do
  [ ${#running[@]} -lt "$cores" ] || collect
  fuzz "$target" "$share" &
  name[$!]=$target
  running+=($!)
done
while [ ${#running[@]} -gt 0 ]; do collect; done

figures=docs/measurements/fuzzing.tsv
touch "$figures"
failed=0
printf '%-10s %12s %8s %9s %6s\n' target executions edges features new
for target in "${chosen[@]}"; do
  log=$logs/$target.log
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  [ -n "$executions" ] || executions=$(sed -n 's/^#\([0-9]*\)\t.*/\1/p' "$log" | tail -1)
  read -r edges features < <(sed -n 's/.* cov: \([0-9]*\) ft: \([0-9]*\) .*/\1 \2/p' "$log" | tail -1) || true
  if [ "${status[$target]}" != 0 ]; then
    failed=1
    tail -40 "$log"
    input=$(sed -n 's/.*Test unit written to //p' "$log" | tail -1)
    echo "error: the target \`$target\` failed on ${input:-an input that was not kept}"
  fi
  reduce "$target"
  count=$(find "$new/$target" -type f | wc -l)
  [ -z "${KEEP-}" ] || keep "$target"
  printf '%-10s %12s %8s %9s %6s\n' "$target" "${executions:-0}" "${edges:-0}" "${features:-0}" "$count"
  before=$(grep "^$target	" "$figures" | cut -f2 || true)
  sed -i "/^$target	/d" "$figures"
  printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$target" $((${before:-0} + ${executions:-0})) "${executions:-0}" "${edges:-0}" "${features:-0}" \
    "$(date -u +%F)" >>"$figures"
done

page=docs/fuzzing.md
table() {
  echo '| target | parser | input | checked | executions so far | of the last run | edges | features | last run |'
  echo '|---|---|---|---|--:|--:|--:|--:|---|'
  while IFS=$'\t' read -r target parser reads holds _; do
    local all=0 last=0 edges=0 features=0 day=never
    IFS=$'\t' read -r _ all last edges features day < <(grep "^$target	" "$figures" || printf '%s\t0\t0\t0\t0\tnever\n' "$target")
    printf '| `%s` | `%s` | %s | %s | %s | %s | %s | %s | %s |\n' \
      "$target" "$parser" "$reads" "$holds" "$all" "$last" "$edges" "$features" "$day"
  done <<<"$list"
}
if grep -q '^<!-- figures -->$' "$page"; then
  table >"$logs/table"
  sed -i -e "/^<!-- figures -->$/,/^<!-- end of figures -->$/{ /^<!--/!d; }" -e "/^<!-- figures -->$/r $logs/table" "$page"
fi
exit $failed

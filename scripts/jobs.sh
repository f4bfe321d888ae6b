#!/usr/bin/env bash
# Counts and times each kind of job on one core, and writes how far it is from the limits of the machine to docs/pages/jobs.md: three minutes on two
# cores. Needs valgrind, objdump and Python 3 (on Debian: apt-get install valgrind binutils python3).
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

cargo build --locked --quiet --release -p luthier-cli
cargo build --locked --quiet --release -p luthier-bake --example machine
luthier=target/release/luthier
work=target/jobs
rm -rf "$work" && mkdir -p "$work"

# Materials that need every kind of job between them.
inputs=(papers/yamaguchi-brushed:--no-fit papers/chromium-car-paint:--no-fit soap-film:--no-fit varnished-brass:--no-fit
  papers/granier-film:--no-fit red-lacquer:--model=lobes)

target/release/examples/machine >"$work/machine.json"
for input in "${inputs[@]}"; do
  name=${input%%:*}
  for run in 1 2 3; do
    "$luthier" bake "materials/$name.toml" "${input#*:}" --threads 1 --json --out "$work/out" >"$work/${name##*/}.$run.json" 2>/dev/null
  done
done

# Every run of a job is counted by itself, and written to a file of its own.
run='*as luthier_bake::graph::job::Job>::run'
count() {
  local name=${1%%:*}
  valgrind --tool=callgrind --dump-instr=yes --compress-pos=no --compress-strings=no --toggle-collect="$run" --zero-before="$run" \
    --dump-after="$run" --callgrind-out-file="$work/${name##*/}.calls" \
    "$luthier" bake "materials/$name.toml" "${1#*:}" --threads 1 --out "$work/counted-${name##*/}" >"$work/${name##*/}.log" 2>&1
}
export -f count
export luthier work run
printf '%s\n' "${inputs[@]}" | xargs -P "$(nproc)" -I{} bash -euc 'count {}'

objdump -d --no-show-raw-insn "$luthier" | python3 scripts/jobs.py "$work" >docs/pages/jobs.md.new
mv docs/pages/jobs.md.new docs/pages/jobs.md

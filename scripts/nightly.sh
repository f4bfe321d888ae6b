#!/usr/bin/env bash
# Checks that take too long for every change, and a page with their results: docs/pages/nightly.md.
#   scripts/nightly.sh            all: an hour and a half on two cores; scripts/pages.sh makes the long pages
#   scripts/nightly.sh STEP...    some, by the names of the functions below
#   scripts/nightly.sh --check    fails where a step has not passed since the bytes of bakes last changed (tests/golden)
# Wants what scripts/test.sh installs, GNU time, a C++ compiler (Debian: g++), and the packages that scripts/farm/*.sh and
# scripts/other-architecture.sh name.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

steps=(tests random fuzz release examples engines kind packages scale crash farm book)
# By its name only, because an emulator takes half an hour: architecture.
declare -A says=(
  [tests]='tests that are ignored elsewhere: the whole stability suite, and audits of tables with planted mistakes'
  [random]='property tests with new random seeds'
  [fuzz]='ten minutes of search for inputs that bring a parser down (`docs/fuzzing.md`)'
  [release]='release builds write the bytes of debug builds, and name the Cargo feature of a verb that they lack'
  [examples]='the renderers in `examples` show the shipped tables, in a browser too'
  [engines]='three.js and Babylon.js read the tables of `luthier table`, in furnaces in a browser'
  [kind]='a kind of table is added by the six files of CONTRIBUTING.md, baked and judged'
  [packages]='every crate is packed, and built from its package'
  [crash]='bakes are killed at every call that changes files and at random moments, interrupted, run side by side, and given faulty files'
  [scale]='libraries of 100 and 1,000 generated materials are baked'
  [farm]='Slurm, Ninja, CMake and Make bake shares and merge them, a Slurm node is killed, jobs for Kubernetes and OpenCue are checked, and machines share a store of the S3 protocol that lies, refuses and is gone'
  [book]='mdBook builds the book of `docs/`; tests of every change follow its links, samples and tutorial'
  [architecture]='a program for aarch64, emulated, writes the bytes of one for x86-64'
)

tests() { CI=true cargo test --locked --workspace --features luthier-cli/view --tests -- --ignored; }
random() { ./scripts/random-tests.sh 1; }
fuzz() { ./scripts/fuzz.sh 600; }
release() {
  local work said
  work=$(mktemp -d)
  cargo build --locked --release -p luthier-cli
  cargo build --locked --workspace --features luthier-cli/view
  said=$(./target/release/luthier view 2>&1) && return 1
  grep -q -- '--features view' <<<"$said"
  for profile in debug release; do
    "./target/$profile/luthier" bake materials --out "$work/$profile" --quiet 2>/dev/null
  done
  diff -r "$work/debug" "$work/release"
  rm -rf "$work"
}
examples() {
  cargo build --locked --release -p luthier-cli
  LUTHIER=$PWD/target/release/luthier ./scripts/run-examples.sh
}
engines() {
  cargo build --locked --release -p luthier-cli
  LUTHIER=$PWD/target/release/luthier ./scripts/engines/furnace.sh
}
kind() { ./scripts/add-kind.sh; }
book() { ./scripts/book.sh; }
packages() { ./scripts/package.sh --verify; }
crash() {
  cargo build --locked --release -p luthier-cli
  LUTHIER=$PWD/target/release/luthier ./tests/crash/all.sh
}
scale() { ./scripts/many.sh 100 1000 >/dev/null; }
farm() {
  cargo build --locked --release -p luthier-cli
  for script in slurm builds descriptions; do LUTHIER=$PWD/target/release/luthier "./scripts/farm/$script.sh"; done
  ./scripts/farm/s3.sh
}
architecture() {
  cargo build --locked --release -p luthier-cli
  LUTHIER=$PWD/target/release/luthier ./scripts/other-architecture.sh
}

results=docs/measurements/nightly.tsv
page=docs/pages/nightly.md
golden=$(cat tests/golden/*.sha256 | sha256sum | cut -c1-16)
touch "$results"

if [ "${1-}" = --check ]; then
  for step in "${steps[@]}"; do
    if ! grep -q "^$step	$golden	" "$results"; then
      echo "error: the bytes of bakes have changed since the nightly step \`$step\` passed; run scripts/nightly.sh $step and commit $page"
      exit 1
    fi
  done
  echo "every nightly step has passed since the bytes of bakes last changed"
  exit
fi

write() {
  cat <<'HEAD'
# Nightly checks

`scripts/nightly.sh` writes this page. Each step takes too long for every change. A step is out of date, and the tests fail, when the bytes
that bakes write have changed since the step passed: the last column identifies them.

| step | check | seconds | passed on | bytes |
|---|---|--:|---|---|
HEAD
  for step in "${steps[@]}"; do
    local sha=- seconds=- day='not since this page began'
    IFS=$'\t' read -r _ sha seconds day < <(grep "^$step	" "$results" || printf '%s\t-\t-\tnever\n' "$step")
    printf '| `%s` | %s | %s | %s | `%s` |\n' "$step" "${says[$step]}" "$seconds" "$day" "$sha"
  done
}

[ $# -gt 0 ] && chosen=("$@") || chosen=("${steps[@]}")
for step in "${chosen[@]}"; do
  printf '\n== %s\n' "$step"
  sed -i "/^$step	/d" "$results"
  started=$SECONDS
  # In a shell of its own, because a function under `if` does not stop at its first failure.
  bash -c "set -euo pipefail; $(declare -f "$step"); $step"
  printf '%s\t%s\t%s\t%s\n' "$step" "$golden" $((SECONDS - started)) "$(date -u +%F)" >>"$results"
  write >"$page"
done

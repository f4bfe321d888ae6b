#!/usr/bin/env bash
# All tests. What fails stops nothing but the steps that need what it makes, and is told once more at the end. The first step installs what
# the others need (scripts/wants.sh); without it they need nothing but a Rust toolchain.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/steps.sh
work=$(mktemp -d)
# Everything is computed, once: no results of earlier runs, and one store for the tests of this one.
export LUTHIER_CACHE= LUTHIER_TEST_STORE=$work/store
trap 'rm -rf "$work"' EXIT

tests=(cargo test --workspace --locked --features luthier-cli/view)
all-tests() {
  "${tests[@]}" --no-fail-fast 2>&1 | tee "$work/log" && return
  grep -E '^test .* FAILED$|^error: doctest failed|^    `-p ' "$work/log" | LC_ALL=C sort -u >"$details"
  return 1
}
lean() {
  if cargo tree --locked -p luthier-cli --no-default-features -e normal | grep -E '\b(wgpu|ash)\b'; then
    echo "error: the lean build depends on wgpu or on Vulkan (ash)"
    return 1
  fi
}
pages() {
  cp -r docs/pages docs/reference.md "$work"
  ./scripts/pages.sh --cheap
  if ! diff -r "$work/pages" docs/pages || ! diff "$work/reference.md" docs/reference.md; then
    echo "error: these pages were out of date, and have been made anew: commit them"
    return 1
  fi
}
crashes() {
  if [ "$(uname -s)" = Linux ]; then
    ./tests/crash/all.sh --quick
  else
    echo "skipped: these tests want Linux"
  fi
}
judge() {
  local device=()
  [ -z "$(./scripts/wants.sh --missing)" ] || device=(--no-device)
  "$LUTHIER" report --out "$work/golden/$1" "${device[@]}" --max-error "$2" || return
  local json=$work/golden/$1/report/report.json
  [ ! -e "$json" ] || awk -F '[:,]' '/"max_error":/ { exit !($2 <= 2e-2) }' "$json"
}

c-programs() {
  if [ "$(uname -s)" = Linux ]; then
    ./scripts/c-host.sh --quick
  else
    echo "skipped: these programs want EGL without a window"
  fi
}

attempt "what the tests need" ./scripts/wants.sh
attempt "the lean build has neither wgpu nor Vulkan" lean
attempt "nightly steps" ./scripts/nightly.sh --check
attempt "build" "${tests[@]}" --no-run
attempt "unit and integration tests" after "build" all-tests
# The programs that the tests have built and run. scripts/nightly.sh compares release builds.
export LUTHIER=$PWD/target/debug/luthier LUTHIER_LAB=$PWD/target/debug/luthier-lab
attempt "same bytes as in tests/golden" after "build" ./scripts/golden.sh --keep "$work/golden"
attempt "kills, signals, bakes side by side, and faults of files" after "build" crashes
attempt "pages are up to date" after "build" pages
# Shaders are held to 2e-2. Of the tables that miss their aim, only the film of soap is off by more (docs/film-table.md).
attempt "judging the bake of materials" after "build" judge materials 0.11
attempt "judging the bake of materials/papers" after "build" judge materials/papers 2e-2
attempt "a host in C reads a bake and draws its ball" after "build" c-programs
summary

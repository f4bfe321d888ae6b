#!/usr/bin/env bash
# Property tests with new random seeds, ten rounds or as many as the argument says; `cargo test` draws the same cases at every run.
# A case that fails is kept in a crate's `proptest-regressions/`: commit it with what mends it.
set -euo pipefail
cd "$(dirname "$0")/.."

crates=$(git grep -l 'proptest!' -- 'crates/*.rs' | cut -d/ -f2 | sort -u)
packages=()
for crate in $crates; do packages+=(-p "$crate"); done

for round in $(seq "${1:-10}"); do
  seed=$(od -An -N6 -tu8 /dev/urandom | tr -d ' ')
  printf '\n== round %s, seed %s\n' "$round" "$seed"
  PROPTEST_RNG_SEED=$seed cargo test --locked --quiet "${packages[@]}"
done

#!/usr/bin/env bash
# Plants mistakes in a crate, runs its own tests on each, and writes docs/measurements/mutants-CRATE.txt: how many were found, and those that were not.
#   scripts/mutants.sh CRATE          all mistakes: an hour for a thousand
#   scripts/mutants.sh CRATE 0/24     every 24th of them, from the first on
# Wants cargo-mutants (`cargo install cargo-mutants`) and a clean tree, of which it makes a copy.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
crate=${1:?the name of a crate is missing}
shard=${2:-0/1}
if [ -n "$(git status --porcelain)" ]; then
  echo "error: commit first: the list is of a commit" >&2
  exit 1
fi
work=$(mktemp -d)
trap 'git worktree remove --force "$work/tree" 2>/dev/null; rm -rf "$work"' EXIT
git worktree add -q --detach "$work/tree"
# Mistakes that are not found are no failure of the run (2), nor are those that never end (3).
(cd "$work/tree" && cargo mutants --in-place -p "$crate" --test-package "$crate" --shard "$shard" --sharding round-robin \
  --output "$work/found" --timeout 120 --colors never --cargo-arg=--locked) || [ $? -le 3 ]
found=$work/found/mutants.out
count() { wc -l <"$found/$1.txt" | tr -d ' '; }
{
  echo "# $crate at $(git rev-parse --short=8 HEAD), mistakes $shard: $(count caught) found, $(count timeout) without an end, $(count unviable) do not compile, $(count missed) not found:"
  sort "$found/missed.txt"
} >"docs/measurements/mutants-$crate.txt"
head -1 "docs/measurements/mutants-$crate.txt"

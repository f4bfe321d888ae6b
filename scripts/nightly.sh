#!/usr/bin/env bash
# What takes too long for every change: property tests with new seeds, packages built from their own files, libraries of a hundred and of a
# thousand materials, and every generated page made anew. Wants what scripts/test.sh installs, and GNU time. Two hours on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

./scripts/random-tests.sh 5
./scripts/package.sh --verify
./scripts/many.sh 100 1000
./scripts/pages.sh
git --no-pager diff --stat -- docs crates/luthier-scene/data

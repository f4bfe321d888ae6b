#!/usr/bin/env bash
# Makes every generated page and measurement of this repository anew, in an order in which each finds what it reads. Wants the
# software Vulkan drivers of Debian's mesa-vulkan-drivers, and half an hour on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

luthier() { cargo run --quiet --release --locked -p luthier-cli -- "$@"; }

sheet=()
for name in red-lacquer anodised-titanium car-paint brass-foil soap-film chromium-car-paint brushed-aluminium yamaguchi-brushed; do
  sheet+=("materials/$name.toml")
done
luthier gallery "${sheet[@]}" -o docs/images/materials.png --size 232 --columns 4
# The example of the README, as it stands there.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
awk '/^```toml$/ { on = 1; next } /^```$/ { on = 0 } on' README.md >"$work/enamel.toml"
luthier preview "$work/enamel.toml" -o docs/images/enamel.png --size 192
# Scenes choose by these costs: they are part of the program.
luthier cost materials materials/scenes/still-life --shapes -o crates/luthier-scene/data/cost.json
luthier cost materials -o docs/cost.md
luthier cost materials --json -o docs/measurements/gpu-cost.json
luthier budgets materials -o docs/budgets.md
luthier bake materials/scenes --budgets 1,0.3,0.1,0.03 --allow-miss >docs/scenes.md
luthier parity materials -o docs/parity.md
luthier stability --json -o docs/measurements/stability.json
luthier stability -o docs/stability.md
luthier figures -o docs/figures --size 96
luthier models --judge materials >docs/models.md
luthier bench materials/car-paint.toml materials/red-lacquer.toml --json -o docs/measurements/bench-llvmpipe.json
scripts/shader-size.sh >docs/shader-size.md
scripts/compare-distribution.sh >docs/distribution-table.md
scripts/bench-table.sh >docs/speed.md

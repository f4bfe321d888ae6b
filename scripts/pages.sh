#!/usr/bin/env bash
# Makes every generated page and measurement of this repository anew, in an order in which each finds what it reads. Wants the
# software Vulkan drivers of Debian's mesa-vulkan-drivers, and half an hour on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

luthier() { cargo run --quiet --release --locked -p luthier-cli -- "$@"; }
luthier-lab() { cargo run --quiet --release --locked -p luthier-lab -- "$@"; }

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
luthier-lab shapes materials materials/scenes/still-life -o crates/luthier-scene/data/cost.json
luthier cost materials -o docs/pages/cost.md
luthier cost materials --json -o docs/measurements/gpu-cost.json
luthier-lab papers materials -o docs/papers.md
luthier-lab budgets materials -o docs/pages/budgets.md
luthier bake materials/scenes --budgets 1,0.3,0.1,0.03 --allow-miss >docs/pages/scenes.md
luthier-lab parity materials -o docs/pages/parity.md
luthier-lab stability --json -o docs/measurements/stability.json
luthier-lab stability -o docs/pages/stability.md
luthier-lab figures -o docs/pages/figures --size 96
luthier-lab judge materials >docs/pages/models.md
luthier bench materials/car-paint.toml materials/red-lacquer.toml --json -o docs/measurements/bench-llvmpipe.json
scripts/shader-size.sh >docs/pages/shader-size.md
scripts/compare-distribution.sh >docs/pages/distribution-table.md
scripts/bench-table.sh >docs/pages/speed.md

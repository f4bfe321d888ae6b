#!/usr/bin/env bash
# Makes every generated page and measurement of this repository anew, in an order in which each finds what it reads. Wants the
# software Vulkan drivers of Debian's mesa-vulkan-drivers, and half an hour on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

luthier() { cargo run --quiet --release --locked -p luthier-cli -- "$@"; }
luthier-lab() { cargo run --quiet --release --locked -p luthier-lab -- "$@"; }

for name in red-lacquer brass-foil car-paint copper-patina anodised-titanium soap-film sugar silver-paint; do
  luthier preview "materials/$name.toml" -o "docs/images/$name.png" --size 192
done
# Scenes choose by these costs: they are part of the program.
luthier-lab shapes materials materials/scenes/still-life -o crates/luthier-scene/data/cost.json
luthier cost materials -o docs/cost.md
luthier cost materials --json -o docs/measurements/gpu-cost.json
luthier-lab papers materials -o docs/papers.md
luthier-lab budgets materials -o docs/budgets.md
luthier bake materials/scenes --budgets 1,0.3,0.1,0.03 --allow-miss >docs/scenes.md
luthier-lab parity materials -o docs/parity.md
luthier-lab stability --json -o docs/measurements/stability.json
luthier-lab stability -o docs/stability.md
luthier-lab figures -o docs/figures --size 96
luthier-lab judge materials >docs/models.md
luthier bench materials/car-paint.toml materials/red-lacquer.toml --json -o docs/measurements/bench-llvmpipe.json
scripts/shader-size.sh >docs/shader-size.md
scripts/compare-distribution.sh >docs/distribution-table.md
scripts/bench-table.sh >docs/speed.md

#!/usr/bin/env bash
# Makes generated pages and measurements of this repository anew, in an order in which each finds what it reads.
#   scripts/pages.sh              all: half an hour on two cores
#   scripts/pages.sh NAME...      some, by the names of the functions below
#   scripts/pages.sh --cheap      those that take seconds and are alike on every machine; the tests make them too, and compare
# Wants the software Vulkan drivers of Debian's mesa-vulkan-drivers, and Python 3. LUTHIER and LUTHIER_LAB name the programs; by default cargo builds them.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

luthier() { if [ -n "${LUTHIER-}" ]; then "$LUTHIER" "$@"; else cargo run --quiet --release --locked -p luthier-cli -- "$@"; fi; }
luthier-lab() { if [ -n "${LUTHIER_LAB-}" ]; then "$LUTHIER_LAB" "$@"; else cargo run --quiet --release --locked -p luthier-lab -- "$@"; fi; }
export -f luthier

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The 22 stacks that are shipped, each once: the sheets of the papers, and what has no sheet. Pages that compare models take these.
stacks=(materials/papers materials/{anodised-titanium,brushed-aluminium,polished-gold,soap-film,varnished-brass}.toml)

materials() {
  luthier gallery materials/textured/board/{varnished-oak,worn-brass}.toml materials/soap-film.toml materials/textured/board/{celadon-tile,anodised-plate,scratched-car-paint}.toml \
    materials/{anodised-titanium,brushed-aluminium}.toml --sky softbox-studio --background --size 390 --columns 4 --samples 3 -o docs/images/materials.png
  # The example of the README, as it stands there.
  awk '/^```toml$/ { on = 1; next } /^```$/ { on = 0 } on' README.md >"$work/enamel.toml"
  luthier preview "$work/enamel.toml" -o docs/images/enamel.png --size 192
  luthier gallery materials/red-lacquer.toml -o docs/images/grid.png --grid slope_deg=1..30 layer.1.albedo.0=0.1..0.9 --steps 4 --size 96 --no-fit
  luthier preview materials/surfaces/lepidolite.toml -o docs/images/lepidolite.png --size 192 --shape sphere
}
# Scenes choose by these costs: they are part of the program.
devices() { luthier-lab devices "${stacks[@]}" -o docs/pages/devices.md; }
layouts() { luthier-lab layouts materials/papers/{car-paint,gold-paint,red-lacquer,frosted-acrylic,latex}.toml materials/varnished-brass.toml -o docs/pages/layouts.md; }
ladder() { luthier-lab ladder "${stacks[@]}" materials/textured/board --stacks 200 --chart docs/pages/ladder.svg -o docs/pages/ladder.md; }
sets() { luthier-lab sets "${stacks[@]}" -o docs/pages/sets.md; }
shapes() { luthier-lab shapes "${stacks[@]}" materials/scenes/still-life -o crates/luthier-scene/data/cost.json; }
cost() {
  luthier cost "${stacks[@]}" -o docs/pages/cost.md
  luthier cost "${stacks[@]}" --json -o docs/measurements/gpu-cost.json
}
papers() { luthier-lab papers "${stacks[@]}" -o docs/pages/papers-cost.md; }
budgets() { luthier-lab budgets "${stacks[@]}" -o docs/pages/budgets.md; }
scenes() { luthier bake materials/scenes --budgets 1,0.3,0.1,0.03 --allow-miss >docs/pages/scenes.md; }
parity() { luthier-lab parity "${stacks[@]}" -o docs/pages/parity.md; }
places() { luthier-lab places -o docs/pages/places.md; }
textured() { luthier-lab textured "${stacks[@]}" -o docs/pages/textured.md; }
# The page of foreign files, from the outcomes that are kept: `luthier-lab foreign --help` says how a collection at hand is tried.
foreign() { luthier-lab foreign --data docs/measurements/foreign.json --page docs/pages/foreign.md; }
# By its name only: wants Blender as a module (`pip install bpy==5.0.1`) in the Python that BPY_PYTHON names, and the program by LUTHIER.
furnaces() { "${BPY_PYTHON:-python3}" scripts/furnaces.py "${LUTHIER:?names the program}" docs/pages/cycles.md; }
# By its name only: wants Chromium, MaterialX (`pip install materialx==1.39.5`) in the Python that MATERIALX_PYTHON names, and the program by LUTHIER.
furnaces-mtlx() { "${MATERIALX_PYTHON:-python3}" scripts/furnaces-mtlx.py "${LUTHIER:?names the program}" docs/pages/materialx.md; }
stability() {
  luthier-lab stability --json -o docs/measurements/stability.json
  luthier-lab stability -o docs/pages/stability.md
}
figures() { luthier-lab figures -o docs/pages/figures; }
models() { luthier-lab judge "${stacks[@]}" >docs/pages/models.md; }
lobes() { luthier-lab lobes "${stacks[@]}" --random 200 -o docs/pages/lobes.md; }
# An hour of two cores; with the noise of other pages (.005) six.
families() { luthier-lab families --noise 0.012 -o docs/pages/families.md; }
# By its name only: groups with plastics, at fewer places.
families-plastic() { luthier-lab families --group plastic --group tinted --group bare --places 60 --noise 0.012 -o docs/pages/families-plastic.md; }
# By its name only: the first group with the noise of other pages.
families-metal() { luthier-lab families --group metal --noise 0.005 -o docs/pages/families-metal.md; }
coats() { luthier-lab coats --noise 0.005 -o docs/pages/coats.md; }
# Of the materials of papers those that `materials` lacks.
formats() {
  local papers=(acrylic-lacquer blue-metallic-paint brass-foil ceramic-glaze chromium-car-paint gold-metallic-paint granier-{film,iridescent} silver-paint sugar yamaguchi-{aligned,brushed})
  local files=("${papers[@]/#/materials/papers/}")
  luthier-lab formats materials "${files[@]/%/.toml}" materials/textured/board -o docs/pages/formats.md
}
# By its name only: wants npm and Blender.
exported() { LUTHIER=${LUTHIER:?names the program} scripts/formats.sh docs/pages; }
# By its name only: wants what the hosts want, and half an hour.
hosts() {
  LUTHIER=${LUTHIER:?names the program} scripts/hosts.sh >docs/pages/hosts.md
  cp target/hosts/hosts.png docs/pages/hosts.png
}
# By its name only: wants the module installed in the Python that LUTHIER_PYTHON names, and a processor with nothing else to do.
python-speed() { "${LUTHIER_PYTHON:-python3}" crates/luthier-python/bench.py >docs/pages/python-speed.md; }
five-ways() { luthier-lab five-ways -o docs/pages/five-ways.md; }
varying() { luthier-lab varying --random 8 --noise 0.015 -o docs/pages/varying.md; }
anisotropic() {
  luthier-lab anisotropic materials/{brushed-aluminium,papers/yamaguchi-brushed}.toml --random 6 --noise 0.015 -o docs/pages/anisotropic.md
}
environment() {
  luthier-lab environment materials/papers/{silver-paint,latex,frosted-acrylic}.toml --size 18 --rows 128 --random 2 -o docs/pages/environment.md
}
simulation() {
  luthier-lab simulation materials/papers/{yamaguchi-brushed,silver-paint}.toml --size 32 --samples 512 --time-size 16 \
    --data docs/measurements/simulation-llvmpipe.json -o docs/pages/simulation.md
}
bench() {
  # Small runs: three numbers of lights and three yardsticks for each of eight models.
  local few=(--evaluations 65536 --repeats 10 --json)
  luthier bench materials/papers/car-paint.toml materials/papers/red-lacquer.toml "${few[@]}" -o docs/measurements/bench-llvmpipe.json
  luthier bench materials/papers/{car-paint,latex,red-lacquer}.toml --per-pixel 1,3 "${few[@]}" -o docs/measurements/per-pixel-llvmpipe.json
}
throughput() { luthier-lab throughput "${stacks[@]}" -o docs/pages/throughput.md; }
# By its name only, because it wants a GPU: pages and measurements of one, beside those of the software adapter. `scripts/gpu.sh` makes them, where there are no sources, too.
on-gpu() {
  scripts/gpu.sh pack "$work"
  tar -C "$work" -xJf "$work/luthier-gpu.tar.xz"
  # What failed is told; the rest is kept.
  "$work/luthier-gpu/gpu.sh" run "$work/on-gpu" 3600 || true
  grep -q '"software": false' "$work/on-gpu/steps.json" || { echo "error: there is no GPU here" >&2 && exit 1; }
  cp -r "$work/on-gpu/docs" .
}
shader-size() { scripts/shader-size.sh >docs/pages/shader-size.md; }
distribution-table() { scripts/compare-distribution.sh >docs/pages/distribution-table.md; }
speed() { scripts/bench-table.sh >docs/pages/speed.md; }
dfg() { scripts/bench-dfg.sh >docs/pages/dfg.md; }
engine-tables() { scripts/engine-tables.sh >docs/pages/engine-tables.md; }
by-hand() {
  [ -n "${LUTHIER-}" ] || cargo build --quiet --release --locked -p luthier-cli
  python3 scripts/independent/papers.py "${LUTHIER-target/release/luthier}" >docs/pages/by-hand.md
}
choices() {
  [ -n "${LUTHIER-}" ] || cargo build --quiet --release --locked -p luthier-cli
  python3 scripts/choices.py "${LUTHIER-target/release/luthier}" >docs/pages/choices.md
}
reflectance-table() {
  [ -n "${LUTHIER-}" ] || cargo build --quiet --release --locked -p luthier-cli
  python3 scripts/reflectance-table.py "${LUTHIER-target/release/luthier}" >docs/pages/reflectance-table.md
}
reference() { luthier man --markdown >docs/reference.md; }
grammar() { luthier-lab grammar --pictures docs/images/grammar -o docs/grammar.md; }
# Each file of the page, under its name.
recipes() {
  awk -v work="$work" '/^```toml$/ { on = 1; text = ""; next } /^```$/ { if (on) print text > file; on = 0 }
    on { text = text $0 "\n"; if (/^name = /) { split($0, parts, "\""); file = work "/" parts[2] ".toml" } }' docs/recipes.md
  mkdir -p docs/images/recipes
  for file in "$work"/recipe-*.toml; do
    luthier preview "$file" --shape sphere --size 160 -o "docs/images/recipes/$(basename "$file" .toml).png"
  done
}
# The test that checks the materials of public collections takes what they show; their pictures come first.
assets() {
  python3 scripts/asset-pictures.py crates/luthier-material/tests/assets
  LUTHIER_ACCEPT=1 cargo test --quiet --locked -p luthier-cli --features view --test cli -- check::assets
}
# The test that follows the tutorial takes its outputs and pictures.
tutorial() { LUTHIER_ACCEPT=1 cargo test --quiet --locked -p luthier-cli --features view --test cli -- tutorial; }

all=(materials cost shapes devices layouts ladder sets papers budgets scenes parity places textured stability figures models lobes varying families coats formats five-ways anisotropic environment simulation bench throughput shader-size distribution-table speed dfg engine-tables by-hand choices reflectance-table reference grammar recipes assets tutorial)
case ${1-} in
  "") pages=("${all[@]}") ;;
  --cheap) pages=(shader-size reference) ;;
  *) pages=("$@") ;;
esac
for page in "${pages[@]}"; do
  printf '%s\n' "$page" >&2
  "$page"
done

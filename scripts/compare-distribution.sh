#!/usr/bin/env bash
# Bakes the slope distribution in every mapping and texel format and prints a page of the measured errors, relative to the peak of D:
# scripts/compare-distribution.sh > docs/pages/distribution-table.md. Takes a minute; needs python3 for the JSON.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=
cargo build --release --locked -p luthier-cli >&2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

row() {
  local label=$1 settings=$2
  for distribution in beckmann ggx; do
    cat > "$work/$distribution.toml" <<TOML
schema = 1
name = "$distribution"
[[layer]]
type = "conductor"
ior = "al"
alpha = 0.2
distribution = "$distribution"
[bake]
color = "three-wavelengths"
fgd = { size = [8, 8] }
distribution = { $settings }
TOML
  done
  ./target/release/luthier bake "$work/beckmann.toml" "$work/ggx.toml" --out "$work/out" --quiet
  python3 - "$label" "$work/out/manifest.json" <<'PY'
import json, sys
label, path = sys.argv[1:]
table = next(t for t in json.load(open(path))["tables"] if t["kind"] == "distribution")
cells = [label, f'{table["texel_bytes"] / 2 / 1024:.0f} KiB']
for tile in table["tiles"]:
    e = tile["error"]
    cells.append(f'{e["max_abs_err"]:.1e} | {e["rms_err"]:.1e} | {e["worst"]["at"][0]:.4f}, {e["worst"]["at"][1]:.4f}')
print("| " + " | ".join(cells) + " |")
PY
}

cat <<'HEAD'
# The slope distribution, in every mapping

The errors are those of the table of pi alpha^2 D as a device samples it: quantised texels, filtered bilinearly with 8-bit weights. The peak of pi alpha^2 D is
about 1, so that they are relative to the peak of D. "Worst at" is (theta_h or cos theta_h, alpha). Made by `scripts/compare-distribution.sh > docs/pages/distribution-table.md`.
A bake has this table only where a material asks for it in `[bake.distribution]`, because the closed forms cost less.

HEAD
echo "| mapping, 512 x 512 | bytes | Beckmann max | rms | worst at | GGX max | rms | worst at |"
echo "|---|---|---|---|---|---|---|---|"
row "u^8, log alpha, rg16float split root (default format)" 'size = [512, 512]'
row "u^8, log alpha, r16float" 'format = "r16float"'
row "u^8, log alpha, r32float" 'format = "r32float"'
row "u^8, linear alpha, r16float (Elek)" 'format = "r16float", alpha_mapping = "linear"'
row "u^4, log alpha, r16float" 'format = "r16float", exponent = 4'
row "linear angle, log alpha, r16float" 'format = "r16float", mapping = "linear"'
row "(N.H)^8, log alpha, r16float" 'format = "r16float", mapping = "cos-power"'
cat <<'TAIL'

- A linear alpha axis, which Elek's paper implies, cannot hold alpha near 0, where D is a spike of no width: the worst point is the first row. The
  logarithmic axis ends at alpha = 0.001, the smoothest surface that the model evaluates.
- A linear angle axis misses narrow lobes. So does u = (N.H)^8, another way to read the paper.
- A single half float is as good at the peak as the split root, but loses the tail of the lobe. It stores 0 below 6e-8 of the peak. Where the lobe falls
  by orders of magnitude between texels, linear interpolation is off by percents of the local value. `luthier report` measures that error. Because of it the
  split root is the default format, at twice the bytes.
TAIL

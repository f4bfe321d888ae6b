#!/usr/bin/env bash
# Bakes the slope distribution in every mapping and texel format and prints a Markdown table of the measured errors, relative
# to the peak of D. Takes a minute; needs python3 for the JSON.
set -euo pipefail
cd "$(dirname "$0")/.."
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

echo "| mapping, 512 x 512 | bytes | Beckmann max | rms | worst at | GGX max | rms | worst at |"
echo "|---|---|---|---|---|---|---|---|"
row "u^8, log alpha, rg16float split root (default)" ''
row "u^8, log alpha, r16float" 'format = "r16float"'
row "u^8, log alpha, r32float" 'format = "r32float"'
row "u^8, linear alpha, r16float (Elek)" 'format = "r16float", alpha_mapping = "linear"'
row "u^4, log alpha, r16float" 'format = "r16float", exponent = 4'
row "linear angle, log alpha, r16float" 'format = "r16float", mapping = "linear"'
row "(N.H)^8, log alpha, r16float" 'format = "r16float", mapping = "cos-power"'

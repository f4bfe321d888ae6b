#!/usr/bin/env bash
# Walks the steps of CONTRIBUTING.md: adds a kind of table to a copy of the last commit by six files (scripts/add-kind.patch), builds it,
# bakes a material that asks for the kind, and judges the bake. Ten minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

files=$(grep -c '^diff --git' scripts/add-kind.patch)
if [ "$files" -gt 6 ]; then
  echo "error: scripts/add-kind.patch touches $files files"
  exit 1
fi
. scripts/patched.sh
patched add-kind --no-default-features

cat >"$work/masked.toml" <<'EOF'
schema = 1
name = "masked"
description = "Gold with a table of masking."

[[layer]]
type = "conductor"
ior = "au"
alpha = 0.3
distribution = "ggx"

[bake]
tables = ["masking"]
EOF
luthier bake "$work/masked.toml" --out "$work/out" --quiet
grep -q 'fn luthier_lookup_masking' "$work/out/shaders/baked.wgsl"
luthier report --out "$work/out" --no-device --max-abs 5e-2
echo "a kind of table by $files files"

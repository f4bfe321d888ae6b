#!/usr/bin/env bash
# Walks the steps of CONTRIBUTING.md: adds a reflectance model to a copy of the last commit by one folder and one row (scripts/add-model.patch),
# builds it, bakes a material that asks for the model, and compares the shader with the f64 twin on a device. Ten minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

. scripts/patched.sh
patched add-model

cat >"$work/gold.toml" <<'EOF'
schema = 1
name = "gold"
description = "Gold whose facets hide nothing from each other."

[[layer]]
type = "conductor"
ior = "au"
alpha = 0.3
distribution = "ggx"

[bake]
model = "neumann"
EOF
luthier bake "$work/gold.toml" --out "$work/out" --functions sample,albedo --quiet
grep -q 'fn luthier_eval_neumann' "$work/out/shaders/baked.wgsl"
grep -q 'fn luthier_parts_neumann' "$work/out/shaders/baked.wgsl"
luthier report --out "$work/out" --max-error 1e-2
luthier eval "$work/gold.toml" --model neumann --albedo
echo "a model by one folder and one row"

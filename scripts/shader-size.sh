#!/bin/sh
# Lines and bytes of the emitted shader for three scenes, as a Markdown table: what a scene does not use is not in its code.
#   scripts/shader-size.sh > docs/pages/shader-size.md
set -eu
cd "$(dirname "$0")/.."
luthier=${LUTHIER-}
if [ -z "$luthier" ]; then
  cargo build --quiet --release --locked -p luthier-cli --no-default-features
  luthier=./target/release/luthier
fi
shader() { "$luthier" shader "$@" 2>/dev/null; }
code() { grep -v '^ *//' | grep -v '^ *$'; }
row() {
  name=$1
  shift
  for form in baked full; do
    wgsl=$(shader "$@" --target wgsl --form $form)
    lines=$(printf '%s\n' "$wgsl" | code | wc -l)
    bytes=$(printf '%s\n' "$wgsl" | code | wc -c)
    spirv=$(shader "$@" --target spirv --form $form | wc -c)
    printf '| %s | %s | %d | %d | %d |\n' "$name" $form "$lines" "$bytes" "$spirv"
  done
}
cat <<'HEAD'
# Size of the emitted shader

The shader of a scene contains only the code that its materials use. The table has the lines and bytes of WGSL without comments and blank
lines, and the bytes of the SPIR-V library. Made by `scripts/shader-size.sh`.

| scene | form | WGSL lines | WGSL bytes | SPIR-V bytes |
|---|---|--:|--:|--:|
HEAD
row 'one metal: `polished-gold`' materials/polished-gold.toml
row 'a coat over a diffuse base: `red-lacquer` of the papers' materials/papers/red-lacquer.toml
row 'the 19 materials of the papers' materials/papers
row 'the 12 other materials, without fits' materials --no-fit
row 'the same, shaded by `phong`' materials --model phong

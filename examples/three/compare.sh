#!/usr/bin/env bash
# Shows .glb files in three.js, by WebGL 2 and by WebGPU, with the materials that `luthier import` and `luthier bake` make of theirs, and compares the
# pictures with those of `luthier preview`: compare.sh OUT [FILE.glb...]. Without files, those of samples.mjs. Pictures are left in OUT. Three lamps light
# them and cast shadows; the surroundings are black.
# Needs a Vulkan driver, Chromium, and `npm ci` in this folder. The environment variable LUTHIER names the program that bakes; by default cargo builds it.
set -euo pipefail
[ $# -gt 0 ] || { echo "usage: compare.sh OUT [FILE.glb...]" >&2; exit 2; }
mkdir -p "$1"
out=$(realpath "$1")
shift
files=()
for file in "$@"; do files+=("$(realpath "$file")"); done
cd "$(dirname "$0")/../.."

# The most that pixels may be apart in the median, in 8-bit steps of the channel that is farthest.
limits=(3)
size=512
# Irradiance of each lamp, and directions to them.
irradiance=1.0,0.95,0.9
lights=(-0.45,0.7,0.6 0.8,0.3,0.6 0.1,-0.4,0.9)

luthier() { if [ -n "${LUTHIER-}" ]; then "$LUTHIER" "$@"; else cargo run --locked --quiet -p luthier-cli --bin luthier -- "$@"; fi; }
if [ ${#files[@]} -eq 0 ]; then
  node examples/three/samples.mjs "$out"
  files=("$out"/{placed,coated,brushed}.glb)
  # And that 95 of 100 pixels may be: 1 was seen. A texture left out, misplaced or misread makes 5 or more, and the median of a scene with several
  # materials may not show it.
  limits+=(3)
fi
# Two black texels.
{ printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n' && head -c 8 /dev/zero; } >"$out/black.hdr"
lamps=()
for light in "${lights[@]}"; do lamps+=(--light "$light"); done
directions=$(printf '[%s],' "${lights[@]}")
failed=0
for file in "${files[@]}"; do
  name=$(basename "$file" .glb)
  [ "$file" -ef "$out/$name.glb" ] || cp "$file" "$out/$name.glb"
  luthier import "$file" -o "$out/$name" --force >/dev/null
  luthier bake "$out/$name" --out "$out/$name-bake" --target wgsl,glsl-es300 --form baked --functions surface --quiet
  # The camera of `preview`, which is 7 away and .3 above the level; the angular radius of its lights.
  cat >"$out/$name.json" <<JSON
{ "file": "$name.glb", "import": "$name/import.json", "size": $size, "eye": [0, 2.0686414, 6.687355], "half_extent": 1.1,
  "light_angular_radius": 0.05, "irradiance": [$irradiance], "lights": [${directions%,}] }
JSON
  luthier preview "$file" -o "$out/$name-preview.png" --size "$size" --samples 1 "${lamps[@]}" --light-color "$irradiance" \
    --environment "$out/black.hdr" --background --environment-samples 1 --tone none
  for renderer in webgl webgpu; do
    sed "s/{ /{ \"renderer\": \"$renderer\", /" "$out/$name.json" >"$out/$name-$renderer.json"
    node examples/browser.mjs examples/three/gltf.html "$out/$name-bake" "$out/$name-$renderer.json" "$out/$name-$renderer.png"
    node examples/web/difference.mjs "$out/$name-preview.png" "$out/$name-$renderer.png" "${limits[@]}" || failed=1
  done
done
exit "$failed"

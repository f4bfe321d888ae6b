#!/usr/bin/env bash
# Bakes materials/papers, renders the ball of examples/scene.json with wgpu, with three.js and in plain WebGL 2, and compares the pictures. Of three.js also
# the tests of its package, and .glb files with imported materials, against `luthier preview`.
# Needs a Vulkan driver, npm and Chromium; on Debian apt-get install mesa-vulkan-drivers npm chromium. Pictures are left in target/examples/. The environment variable LUTHIER names
# the program that bakes; by default cargo builds it.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

# Mean difference, in 8-bit steps, that two drivers may have. At most 0.07 was seen between llvmpipe and SwiftShader;
# tables read without their filter make 0.4.
limit=0.25

out=target/examples
bake=$out/bake
plain=$out/plain
mkdir -p "$out"

step() { printf '\n== %s\n' "$1"; }
luthier() { if [ -n "${LUTHIER-}" ]; then "$LUTHIER" "$@"; else cargo run --locked --quiet -p luthier-cli --bin luthier -- "$@"; fi; }
# The target folder is shared with the workspace: most of wgpu is built there already.
example() { cargo run --locked --quiet --manifest-path examples/wgpu/Cargo.toml --target-dir target --bin "$@"; }
# The scene with another material.
scene() { sed "s/\"material\": \"[a-z-]*\"/\"material\": \"$1\"/" examples/scene.json >"$out/$1.json"; echo "$out/$1.json"; }

step "bake"
# The models of papers, and a film.
luthier bake materials/papers materials/soap-film.toml --functions surface --out "$bake" --quiet
luthier bake materials/papers materials/soap-film.toml --out "$plain" --no-zstd --quiet

# What all four programs show, and materials that read the other tables.
step "wgpu"
materials=(car-paint soap-film granier-film yamaguchi-brushed copper-patina)
for name in "${materials[@]}"; do example luthier-example-wgpu "$bake" "$(scene "$name")" "$out/wgpu-$name.png"; done

step "wgpu, a bake of the build script"
example luthier-example-wgpu - "$(scene car-paint)" "$out/wgpu-built-in.png"
example difference "$out/wgpu-car-paint.png" "$out/wgpu-built-in.png" "$limit"

step "wgpu, with surroundings"
luthier environment --sky strip-studio --size 128 --layout cube --out "$out/studio"
luthier bake materials/red-lacquer.toml --model lobes --functions environment --target wgsl --out "$out/lit" --quiet
example luthier-example-wgpu "$out/lit" "$(scene red-lacquer)" "$out/wgpu-surroundings.png" "$out/studio"

step "plain WebGL 2"
for name in "${materials[@]}"; do
  node examples/browser.mjs examples/plain-webgl "$plain" "$(scene "$name")" "$out/plain-$name.png"
  example difference "$out/wgpu-$name.png" "$out/plain-$name.png" "$limit"
done

step "rows of lobes in a buffer, and in a texture of whole numbers"
for layout in filtered steps; do
  luthier bake materials/papers/car-paint.toml --model lobes --layout "$layout" --no-zstd --out "$out/$layout" --quiet
  example luthier-example-wgpu "$out/$layout" "$(scene car-paint)" "$out/wgpu-$layout.png"
done
node examples/browser.mjs examples/plain-webgl "$out/steps" "$(scene car-paint)" "$out/plain-steps.png"
for picture in wgpu-steps plain-steps; do example difference "$out/wgpu-filtered.png" "$out/$picture.png" "$limit"; done

step "three.js"
npm ci --prefix examples/three --ignore-scripts --no-audit --no-fund --silent
node examples/browser.mjs examples/three "$bake" "$(scene car-paint)" "$out/three.png"
example difference "$out/wgpu-car-paint.png" "$out/three.png" "$limit"

step "three.js, types of the package"
npm run --prefix examples/three --silent types

step "three.js, tests of the package"
node examples/three/test.mjs "$out/package"

step "three.js, .glb files with textures"
examples/three/compare.sh "$out/gltf"

# Among others the records of the material lie beyond the first row of the material texture, and its rows elsewhere in the tables.
step "the same material in a library"
cargo run --locked --quiet -p luthier-material --example library -- 60 "$out/library"
luthier bake "$out/library" materials/papers --out "$out/many" --target wgsl,glsl-es300 --form baked --functions surface --no-fit --quiet
example luthier-example-wgpu "$out/many" "$(scene car-paint)" "$out/many-wgpu.png"
node examples/browser.mjs examples/three "$out/many" "$(scene car-paint)" "$out/many-three.png"
example difference "$out/many-wgpu.png" "$out/many-three.png" "$limit"

step "two bakes in one program of WebGPU"
node examples/web/test.mjs "$out/web"

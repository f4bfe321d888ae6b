#!/usr/bin/env bash
# Checks what programs without luthier's code have: examples/c and examples/shaders. Compiles luthier.h as C99 and C++11, gives it faulty files under sanitisers,
# compares its JSON with Python's and the pictures of its ball with those of `luthier preview`, and compiles the fragment shaders for Vulkan and runs them in OpenGL.
#   scripts/c-host.sh            all; installs on Debian and its relatives what it needs, and elsewhere says what is missing
#   scripts/c-host.sh --quick    one bake of one material, and one picture
# Pictures are left in target/c-host/. The environment variable LUTHIER names the program that bakes, with `preview`; by default cargo builds it.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(gcc g++ libc6-dev libegl-dev libgl-dev libopengl-dev libegl-mesa0 libgl1-mesa-dri mesa-vulkan-drivers libvulkan1 glslang-tools spirv-tools spirv-cross python3)
missing() {
  for program in gcc g++ glslangValidator spirv-val spirv-cross python3; do command -v "$program" >/dev/null || echo "$program"; done
  for header in EGL/egl.h GL/glcorearb.h; do [ -e "/usr/include/$header" ] || echo "$header"; done
  for library in libEGL libOpenGL libEGL_mesa libvulkan; do ldconfig -p 2>/dev/null | grep "$library\.so" >/dev/null || echo "$library"; done
}
need=$(missing)
if [ -n "$need" ]; then
  as_root=""
  [ "$(id -u)" = 0 ] || as_root=sudo
  if ! command -v apt-get >/dev/null || { [ -n "$as_root" ] && ! command -v sudo >/dev/null; }; then
    printf 'error: missing:\n%s\nOn Debian: apt-get install %s\n' "$need" "${packages[*]}" >&2
    exit 3
  fi
  $as_root apt-get update -q
  DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -q --no-install-recommends "${packages[@]}"
fi

out=target/c-host
mkdir -p "$out"
# One store for the bakes and pictures of this run.
export LUTHIER_CACHE=$PWD/$out/store
rm -rf "$LUTHIER_CACHE"

# Median of the differences, and what 99 of 100 pixels are within, in steps of 1/255. 0 and 1 were seen. For soap-film the latter is 5 without filters, 125 without
# luthier_film_place, 206 under a light without size, and 234 with tables at other numbers.
limits=(1 2)

step() { printf '\n== %s\n' "$1"; }
luthier() { if [ -n "${LUTHIER-}" ]; then "$LUTHIER" "$@"; else cargo run --locked --quiet -p luthier-cli --bin luthier -- "$@"; fi; }

step "luthier.h in C99 and C++11"
lines=$(wc -l <examples/c/luthier.h)
echo "$lines lines"
[ "$lines" -le 300 ] || { echo "error: luthier.h has more than 300 lines" >&2; exit 1; }
strict=(-Wall -Wextra -Wconversion -Wshadow -pedantic -Werror -DLUTHIER_IMPLEMENTATION -c -o /dev/null)
gcc -x c -std=c99 "${strict[@]}" examples/c/luthier.h
g++ -x c++ -std=c++11 "${strict[@]}" examples/c/luthier.h
warnings=(-std=c99 -Wall -Wextra -Wshadow -Werror)
gcc "${warnings[@]}" -O1 examples/c/ball.c -o "$out/ball" -lEGL -lOpenGL
gcc "${warnings[@]}" -O1 examples/shaders/run.c -o "$out/run" -lEGL -lOpenGL
gcc "${warnings[@]}" -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all examples/c/tests.c -o "$out/tests"

# Tables of all kinds, layouts of rows of lobes, and formats that material files may ask for.
materials=(materials/papers/{car-paint,granier-film,yamaguchi-brushed}.toml materials/soap-film.toml)
layouts=(filtered steps)
formats=(fresnel:rgba8unorm fresnel:rgba16unorm fresnel:rgba32float distribution:r16float distribution:r32float fgd:bc6h-rgb-ufloat)
if [ "${1-}" = --quick ]; then materials=(materials/papers/car-paint.toml) layouts=() formats=(); fi

step "bakes"
languages=(--no-zstd --target wgsl,glsl450,hlsl --form baked --quiet)
luthier bake "${materials[@]}" "${languages[@]}" --functions surface --out "$out/kinds"
luthier bake materials/papers/car-paint.toml "${languages[@]}" --out "$out/eval"
luthier bake materials/papers/car-paint.toml "${languages[@]}" --prefix car --out "$out/prefixed"
for layout in "${layouts[@]}"; do
  luthier bake materials/papers/car-paint.toml --model lobes --layout "$layout" "${languages[@]}" --functions surface --out "$out/$layout"
  luthier bake materials/papers/car-paint.toml --model lobes --layout "$layout" "${languages[@]}" --out "$out/eval-$layout"
done
for format in "${formats[@]}"; do
  name=${format/:/-}
  case $format in fresnel:*) paper=car-paint ;; distribution:*) paper=granier-film ;; fgd:*) paper=yamaguchi-brushed ;; esac
  { cat "materials/papers/$paper.toml" && printf '\n[bake.%s]\nformat = "%s"\n' "${format%:*}" "${format#*:}"; } >"$out/$name.toml"
  luthier bake "$out/$name.toml" "${languages[@]}" --functions surface --out "$out/$name"
  [ "$(python3 -c 'import json, sys; print(*[t["format"] for t in json.load(open(sys.argv[1]))["tables"] if t["kind"] == sys.argv[2]])' \
    "$out/$name/manifest.json" "${format%:*}")" = "${format#*:}" ] || { echo "error: $name has another format" >&2; exit 1; }
done

step "faulty files, under the sanitisers of addresses, leaks and undefined behaviour"
small=(eval "${layouts[@]:1}")
"$out/tests" "${small[@]/#/$out/}"

step "JSON as Python reads it"
mkdir -p "$out/texts"
python3 - "$out/texts/manifest.json" <<'PYTHON'
import json, sys
texts = ['', '"\\/\b\f\n\r\t', '\x01\x1f\x7f', 'é߿ࠀ€￿', '𐀀😀\U0010ffff', 'a' * 1000]
numbers = [0, -1, 1.5, -2.5e-300, 1e21]
manifest = {'schema': 4, 'materials': [], 'tables': [], 'shaders': [], 'bindings': [], 'material_buffer': {'path': 'a'},
            'texts': texts, 'numbers': numbers, 'others': [True, False, None, [], {}, [[{}]], {'a': {'b': []}}]}
# Escaped and as they are.
text = json.dumps(manifest)[:-1] + ', "plain": ' + json.dumps(texts, ensure_ascii=False, indent=3) + '}'
open(sys.argv[1], 'w', encoding='utf-8').write(text)
PYTHON
for bake in texts kinds prefixed "${small[@]}"; do
  "$out/tests" --json "$out/$bake" >"$out/$bake.values"
  python3 - "$out/$bake/manifest.json" >"$out/$bake.expected" <<'PYTHON'
import json, sys
class Number(str): pass
class Members(list): pass
def show(value):
    if isinstance(value, Members):
        print('{')
        for name, member in value: show(name), show(member)
        print('}')
    elif isinstance(value, list):
        print('[')
        for item in value: show(item)
        print(']')
    elif isinstance(value, Number): print('0' + value)
    elif isinstance(value, str): print('"' + value.encode().hex())
    else: print({True: 't', False: 'f', None: 'n'}[value])
show(json.load(open(sys.argv[1], encoding='utf-8'), object_pairs_hook=Members, parse_int=Number, parse_float=Number))
PYTHON
  cmp "$out/$bake.values" "$out/$bake.expected"
  echo "$bake: $(wc -l <"$out/$bake.values") values and ends"
done

step "the ball in OpenGL, and that of preview"
# Two black texels: the ball has one light, and no light from all around.
{ printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n' && head -c 8 /dev/zero; } >"$out/black.hdr"
# compare BAKE MATERIAL LIMIT...
compare() {
  local name=$1-$2
  luthier preview "$2" --out "$out/$1" -o "$out/$name-preview.png" --shape sphere --size 512 --samples 1 --tone none --light=-0.45,0.7,0.6 \
    --environment "$out/black.hdr" --background --environment-samples 1
  "$out/ball" "$out/$1" "$2" "$out/$name-ball.ppm" >"$out/driver"
  python3 examples/c/difference.py "$2 in $1 by OpenGL against preview" "$out/$name-preview.png" "$out/$name-ball.ppm" "${@:3}"
}
for file in "${materials[@]}"; do compare kinds "$(basename "$file" .toml)" "${limits[@]}"; done
for layout in "${layouts[@]}"; do compare "$layout" car-paint "${limits[@]}"; done
for format in "${formats[@]}"; do
  case $format in fresnel:*) paper=car-paint ;; distribution:*) paper=granier-film ;; fgd:*) paper=yamaguchi-brushed ;; esac
  compare "${format/:/-}" "$paper" "${limits[@]}"
done
# luthier_eval alone knows no light with a size: its highlight is smaller.
compare eval car-paint "${limits[0]}"
cut -d, -f2- "$out/driver"
if "$out/ball" "$out/kinds" no-such-material "$out/none.ppm" 2>"$out/refused"; then exit 1; fi
grep -q 'no material no-such-material' "$out/refused"

step "fragment shaders for Vulkan, from GLSL and from HLSL"
# shaders BAKE: their SPIR-V.
shaders() {
  glslangValidator -V -I"$out/$1/shaders" examples/shaders/ball.frag -o "$out/$1-glsl.spv" >&2
  glslangValidator -D -V -S frag -e main -I"$out/$1/shaders" examples/shaders/ball.hlsl -o "$out/$1-hlsl.spv" >&2
  for language in glsl hlsl; do spirv-val --target-env vulkan1.1 "$out/$1-$language.spv"; done
}
shaders kinds
for bake in eval "${layouts[@]/#/eval-}"; do
  shaders "$bake"
  # Pictures of luthier_eval, which ball.c calls, too, in these bakes. Its sphere has no triangles: pixels of the silhouette differ.
  "$out/ball" "$out/$bake" car-paint "$out/$bake-ball.ppm" >/dev/null
  for language in glsl hlsl; do
    spirv-cross "$out/$bake-$language.spv" --version 450 --no-es >"$out/$bake-$language.glsl"
    "$out/run" "$out/$bake" car-paint "$out/$bake-$language.ppm" "$out/$bake-$language.glsl"
    python3 examples/c/difference.py "$bake by Vulkan $language against OpenGL" "$out/$bake-ball.ppm" "$out/$bake-$language.ppm" "${limits[@]}"
  done
done

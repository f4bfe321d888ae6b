#!/usr/bin/env bash
# Bakes materials by the build systems of examples/farm: Ninja, CMake with two generators, and Make. Each builds in an empty folder
# and has to give the bytes of a plain bake. Building again runs nothing; neither does a file that no material names. A material
# that changes, comes or goes, and a file that a material names, bake again. On Debian: apt-get install cmake ninja-build make.
#   scripts/farm/builds.sh [ninja | cmake-ninja | cmake-make | make]...
# The environment variable LUTHIER names the program; by default cargo builds it.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/farm/program.sh

systems=("$@")
[ ${#systems[@]} -gt 0 ] || systems=(ninja cmake-ninja cmake-make make)
need 'cmake ninja-build make' cmake ninja make
take_luthier --release
program=$LUTHIER
examples=$PWD/examples/farm
options=(--no-fit --target wgsl)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "error: $system: $1" >&2
  [ ! -f "$work/log" ] || tail -n 20 "$work/log" >&2
  exit 1
}

# What the build calls: it keeps a list of its calls.
cat >"$work/luthier" <<CALL
#!/usr/bin/env bash
echo "\$*" >>"$work/calls"
exec "$program" "\$@"
CALL
chmod +x "$work/luthier"
export LUTHIER=$work/luthier LUTHIER_CACHE SHARDS=4

configure() {
  case $system in
    ninja) "$examples/ninja/configure.sh" "$work/materials" "${options[@]}" ;;
    cmake-ninja) cmake -S "$examples/cmake" -B . -G Ninja -DLUTHIER="$LUTHIER" -DMATERIALS="$work/materials" \
      -DMATERIALS_OPTIONS="$(IFS=';' && echo "${options[*]}")" ;;
    cmake-make) cmake -S "$examples/cmake" -B . -G 'Unix Makefiles' -DLUTHIER="$LUTHIER" -DMATERIALS="$work/materials" \
      -DMATERIALS_OPTIONS="$(IFS=';' && echo "${options[*]}")" ;;
    make) ;;
    *) fail "there is no such example" ;;
  esac
}
build() {
  case $system in
    ninja) ninja -j 2 ;;
    cmake-*) cmake --build . -j 2 --target materials ;;
    make) make -j 2 -f "$examples/make/Makefile" MATERIALS="$work/materials" OPTIONS="${options[*]}" ;;
  esac
}
# Dates of files are compared: a build must not fall into the moment of a change.
later() { sleep 0.02; }

# expect BAKES WHAT: builds, and compares the package with a plain bake. BAKES says what the build has to have called: all (each
# share and the merge), some (at least the merge), none.
expect() {
  : >"$work/calls"
  later
  (cd "$work/$system" && build) &>"$work/log" || fail "the build failed: $2"
  later
  local calls merges
  calls=$(wc -l <"$work/calls")
  merges=$(grep -c '^merge ' "$work/calls" || true)
  case $1 in
    all) [ "$calls" = 5 ] && [ "$merges" = 1 ] || fail "$calls calls instead of four shares and a merge: $2" ;;
    some) [ "$merges" = 1 ] || fail "$merges merges instead of one: $2" ;;
    none)
      [ "$calls" = 0 ] || fail "$calls calls instead of none: $2: $(cat "$work/calls")"
      [ "$system" != ninja ] || grep -q 'no work to do' "$work/log" || fail "Ninja had work to do: $2"
      ;;
  esac
  LUTHIER_CACHE="$work/plain-store" "$program" bake "$work/materials" "${options[@]}" --out "$work/plain/$package" --quiet 2>/dev/null
  diff -rq "$work/plain/$package" "$work/$system/$package" >&2 || fail "other bytes than those of a plain bake: $2"
  printf '%-14s %s calls: %s\n' "$system" "$calls" "$2"
}

for system in "${systems[@]}"; do
  step "$system"
  rm -rf "$work/materials" "$work/plain"
  mkdir -p "$work/$system" "$work/materials"
  cp materials/{soap-film,polished-gold}.toml materials/papers/{car-paint,sugar}.toml "$work/materials"
  sed -e 's/^name = .*/name = "measured"/' -e 's/^ior = .*/ior = "measured.csv"/' materials/polished-gold.toml >"$work/materials/measured.toml"
  printf 'wavelength_nm,n,k\n360,1.6,1.9\n550,0.4,2.4\n830,0.2,5.1\n' >"$work/materials/measured.csv"
  echo first >"$work/materials/notes.txt"
  package=out LUTHIER_CACHE=store
  [[ $system != cmake-* ]] || package=assets/materials
  (cd "$work/$system" && configure) &>"$work/log" || fail "could not be configured"

  expect all "an empty folder"
  expect none "again"
  echo second >"$work/materials/notes.txt"
  expect none "a file that no material names"
  touch "$work/materials/sugar.toml"
  expect all "a new date, the same content"
  expect none "again"
  sed -i 's/^roughness = .*/roughness = 0.33/; s/^slope_deg = .*/slope_deg = 9.5/' "$work/materials/car-paint.toml"
  expect all "a material changed"
  expect none "again"
  sed -i 's/^550,0.4/550,0.5/' "$work/materials/measured.csv"
  expect some "a file that a material names changed"
  expect none "again"
  cp materials/papers/red-lacquer.toml "$work/materials"
  expect all "a new material"
  expect none "again"
  LUTHIER_CACHE="$work/plain-store" "$program" bake "$work/materials" "${options[@]}" --relock --out "$work/locked" --quiet 2>/dev/null
  expect all "sizes written into a lock"
  expect none "again"
  rm "$work/materials/soap-film.toml"
  expect some "a material removed"
  expect none "again"
done

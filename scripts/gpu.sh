#!/usr/bin/env bash
# Tests, comparisons and times on a GPU of a machine that has a Vulkan driver and nothing else: no Rust, no sources.
#   scripts/gpu.sh pack DIR [PROFILE]     here: builds the programs (PROFILE is release or dev, release by default), and packs them into DIR/luthier-gpu.tar.xz
#   scripts/gpu.sh try [PROFILE]          here: packs, unpacks elsewhere, and runs there; as root out of sight of the sources
#   luthier-gpu/gpu.sh run OUT [SECONDS]  there, from the unpacked folder: runs all in SECONDS (360 by default), and leaves results in OUT
# A step has a limit, and one that fails stops no other. The first are the most important: later ones have what is left. OUT/steps.json has the device,
# and the exit code and seconds of each step, OUT/logs what they said. OUT/docs has pages and measurements by the names that they have in this repository, where `cp -r OUT/docs .` puts them. On a software adapter all
# sizes are small: its results show that everything runs. LUTHIER, LUTHIER_LAB and LUTHIER_DEVICE_TESTS name programs that are built already.
set -euo pipefail

# What a pack may have at most.
limit_mib=64
# Generated materials for the largest set that is timed with a material for each thread.
library=300

# built CRATE PROGRAM: builds a program, and says where it is.
built() { cargo build --quiet --locked "${profile[@]}" -p "$1" && echo "$target/$2"; }
device_tests() {
  cargo test --quiet --locked "${profile[@]}" -p luthier-gpu --test device --no-run --message-format json \
    | sed -n 's/.*"name":"device".*"executable":"\([^"]*\)".*/\1/p'
}
pack() {
  local out=$1 stage profile=() target=target/debug bytes
  case ${2-release} in
    dev) ;;
    release) profile=(--release) target=target/release ;;
    *) echo "error: the profile is release or dev, not $2" >&2 && exit 2 ;;
  esac
  mkdir -p "$out"
  out=$(cd "$out" && pwd)
  cd "$(dirname "$0")/.."
  stage=$out/luthier-gpu
  rm -rf "$stage" "$stage.tar.xz"
  mkdir -p "$stage/bin"
  LUTHIER=${LUTHIER-$(built luthier-cli luthier)}
  LUTHIER_LAB=${LUTHIER_LAB-$(built luthier-lab luthier-lab)}
  LUTHIER_DEVICE_TESTS=${LUTHIER_DEVICE_TESTS-$(device_tests)}
  strip -o "$stage/bin/luthier" "$LUTHIER"
  strip -o "$stage/bin/luthier-lab" "$LUTHIER_LAB"
  strip -o "$stage/bin/device-tests" "$LUTHIER_DEVICE_TESTS"
  cp -r materials "$stage/materials"
  cp -r crates/luthier-lab/maps "$stage/maps"
  cp scripts/gpu.sh "$stage/gpu.sh"
  cargo run --quiet --locked "${profile[@]}" -p luthier-material --example library -- "$library" "$stage/library"
  git rev-parse HEAD >"$stage/commit"
  tar -C "$out" -cf - luthier-gpu | xz -T0 >"$stage.tar.xz"
  rm -rf "$stage"
  bytes=$(stat -c %s "$stage.tar.xz")
  echo "$stage.tar.xz: $((bytes / 1024)) KiB"
  if [ "$bytes" -gt $((limit_mib << 20)) ]; then
    echo "error: the pack has $((bytes >> 20)) MiB, and may have $limit_mib: leave materials out, or make the programs smaller" >&2
    exit 1
  fi
}

try() {
  local work rc=0
  work=$(mktemp -d)
  pack "$work" "${1-release}"
  tar -C "$work" -xJf "$work/luthier-gpu.tar.xz"
  if unshare -m true 2>/dev/null; then
    unshare -m sh -c 'mount -t tmpfs none "$1" && cd "$2" && luthier-gpu/gpu.sh run out' sh "$PWD" "$work" || rc=$?
  else
    (cd "$work" && luthier-gpu/gpu.sh run out) || rc=$?
  fi
  cat "$work/out/steps.json"
  rm -rf "$work"
  return $rc
}

# now: seconds since the script began, with fractions.
now() { awk "BEGIN { print $(date +%s.%N) - $began }"; }
# step NAME LIMIT COMMAND...: runs a program, for as long as is left and LIMIT of 360 seconds at most.
step() {
  local name=$1 most start left rc=0
  most=$(($2 * deadline / 360))
  shift 2
  start=$(now)
  left=$(awk "BEGIN { left = $deadline - $start; print (left < $most) ? int(left) : $most }")
  if [ "$left" -lt 2 ]; then
    rc=null
  else
    timeout -k 5 "$left" "$@" >"$out/logs/$name.out" 2>"$out/logs/$name.err" </dev/null || rc=$?
  fi
  rows+=("$(printf '    { "step": "%s", "rc": %s, "seconds": %.1f, "limit": %d }' "$name" "$rc" "$(awk "BEGIN { print $(now) - $start }")" "$((left > 0 ? left : 0))")")
  printf '%-18s rc %-4s %6.1f s\n' "$name" "$rc" "$(awk "BEGIN { print $(now) - $start }")"
  [ "$rc" = 0 ] || failed=1
}
# field NAME FILE: the first value of a name in a JSON file of one name to a line.
field() { sed -n "s/^ *\"$1\": \"\{0,1\}\([^\"]*[^\",]\)\"\{0,1\},\{0,1\}\$/\1/p" "$2" 2>/dev/null | head -1; }

run() {
  began=$(date +%s.%N)
  here=$(cd "$(dirname "$0")" && pwd)
  mkdir -p "$1"
  out=$(cd "$1" && pwd)
  deadline=${2-360}
  rows=()
  failed=0
  mkdir -p "$out/logs" "$out/docs/pages" "$out/docs/measurements"
  # Pages state the command that made them: paths are as in the repository.
  cd "$out"
  ln -sfn "$here/materials" materials
  ln -sfn "$here/library" library
  PATH=$here/bin:$PATH
  export PATH LUTHIER_CACHE=$out/store LUTHIER_LAB_MAPS=$here/maps
  # Tests that find no adapter fail.
  export CI=true
  [ -n "${XDG_RUNTIME_DIR-}" ] || export XDG_RUNTIME_DIR=$out

  local two=(materials/papers/car-paint.toml materials/papers/red-lacquer.toml) tiny=(--evaluations 1024 --repeats 1 --warm-up 0)
  local stacks=(materials/papers materials/{anodised-titanium,brushed-aluminium,polished-gold,soap-film,varnished-brass}.toml)
  step adapter 30 luthier bench "${two[0]}" --model phong --lights 1 "${tiny[@]}" --json -o logs/adapter.json
  local name software
  name=$(field name logs/adapter.json)
  software=$(field software logs/adapter.json)
  local evaluations=60000000 repeats=30 sets=1,22 many=1,$library_size pairs=20000 places=2000 size=256 samples=8192 time_size=512 models=() place_models=() repeats_of_pictures=3 tests=100 pictures=60 mixed=("${stacks[@]}") simulated=(materials/papers/{yamaguchi-brushed,silver-paint}.toml)
  if [ "$software" != false ]; then
    # What fits on two cores.
    evaluations=16384 repeats=3 sets=1,3 many=4 pairs=200 places=100 size=8 samples=16 time_size=8 repeats_of_pictures=1 tests=200
    models=(--model elek --model belcour) place_models=(--model microfacet) simulated=(materials/papers/yamaguchi-brushed.toml) pictures=100
    two=("${two[0]}") stacks=("${two[0]}" materials/papers/red-lacquer.toml)
    mixed=(materials/papers/{car-paint,latex,red-lacquer}.toml)
  fi
  local times=(--evaluations "$evaluations" --repeats "$repeats")
  step bench 60 luthier bench "${two[@]}" "${times[@]}" --json -o docs/measurements/bench-gpu.json
  step device-tests "$tests" device-tests
  step per-pixel 40 luthier bench "${mixed[@]}" --per-pixel "$sets" "${times[@]}" --json -o docs/measurements/per-pixel-gpu.json
  step per-pixel-lobes 40 luthier bench "${mixed[@]}" --model lobes --per-pixel "$sets" "${times[@]}" --json -o docs/measurements/per-pixel-lobes-gpu.json
  step per-pixel-many 60 luthier bench library --lights 1 --per-pixel "$many" "${times[@]}" --json -o docs/measurements/per-pixel-many-gpu.json
  step throughput 30 luthier-lab throughput "${stacks[@]}" "${times[@]}" --data docs/measurements/throughput-gpu.json -o docs/pages/gpu-throughput.md
  step places 60 luthier-lab places "${place_models[@]}" --pairs "$places" -o docs/pages/gpu-places.md
  step simulation "$pictures" luthier-lab simulation "${simulated[@]}" --size "$size" --samples "$samples" --time-size "$time_size" \
    --repeats "$repeats_of_pictures" --data docs/measurements/simulation-gpu.json -o docs/pages/gpu-simulation.md
  step parity 300 luthier-lab parity "${stacks[@]}" "${models[@]}" --pairs "$pairs" -o docs/pages/gpu-parity.md
  rm -rf materials library store
  {
    printf '{\n  "device": "%s",\n  "driver": "%s",\n  "software": %s,\n  "commit": "%s",\n  "seconds": %.1f,\n  "steps": [\n' \
      "$name" "$(field driver logs/adapter.json)" "${software:-null}" "$(cat "$here/commit")" "$(now)"
    local i
    for i in "${!rows[@]}"; do printf '%s%s\n' "${rows[i]}" "$([ "$((i + 1))" = "${#rows[@]}" ] || echo ,)"; done
    printf '  ]\n}\n'
  } >steps.json
  return $failed
}

case ${1-} in
  pack) [ $# -ge 2 ] && pack "${@:2}" ;;
  try) try "${@:2}" ;;
  run) [ $# -ge 2 ] && library_size=$library run "${@:2}" ;;
  *) sed -n '3,5p' "$0" >&2 && exit 2 ;;
esac

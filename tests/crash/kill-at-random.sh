#!/usr/bin/env bash
# Kills bakes at random moments. After each kill a reader sees the old generation or the new one whole, and the next bake leaves what an
# undisturbed one writes. Half of the kills fall anywhere in the bake, half into its last part, in which it writes.
#   tests/crash/kill-at-random.sh [COUNT=200] [SEED]   that many kills
# Wants what prepare.sh wants. The seed is printed; the moments depend on the machine as well.
. "$(dirname "$0")/prepare.sh"

count=${1:-200}
seed=${2:-$(($(date +%s) % 32768))}
RANDOM=$seed
now=0
tick() { now=${EPOCHREALTIME//[.,]/}; }

# start: a bake of `new` into a folder that holds `old`, in the background. With `exec` the shell's child is the program itself.
start() {
  rm -rf out
  cp -a ref-old out
  (exec "$luthier" bake "${source[new]}" --no-fit --no-search --out out --quiet) 2>said &
  child=$!
  children=("$child")
}
writes() { [ -e out/.luthier-new ] || [ -e out/.luthier-ready ] || [ out/manifest.json -nt ref-new/manifest.json ]; }

# Microseconds that a bake takes, and of these its last part: the means of a few.
whole=0 part=0
for _ in 1 2 3 4 5 6 7 8; do
  start
  tick
  begun=$now
  until writes; do :; done
  tick
  writing=$now
  wait "$child"
  tick
  ended=$now
  children=()
  whole=$((whole + (ended - begun) / 8))
  part=$((part + (ended - writing) / 8))
done
printf 'seed %d; a bake takes %d us, its last part %d us\n' "$seed" "$whole" "$part"

declare -A found=([old]=0 [new]=0) left=([nothing]=0 [.luthier-new]=0 [.luthier-ready]=0)
ended=0 mixed=0 i=0
# Bakes that end before their kill do not count.
while [ $((i - ended)) -lt "$count" ]; do
  i=$((i + 1))
  [ "$i" -le $((10 * count)) ] || fail "most bakes end before their kill"
  start
  delay=$((RANDOM * whole / 32768))
  if [ $((i % 2)) = 0 ]; then
    until writes; do :; done
    delay=$((RANDOM * part / 32768))
  fi
  tick
  then=$((now + delay))
  while [ "$now" -lt "$then" ]; do tick; done
  kill -KILL "$child" 2>/dev/null || true
  code=0
  wait "$child" 2>/dev/null || code=$?
  children=()
  case $code in
    0) ended=$((ended + 1)) ;;
    137) ;;
    *) fail "bake $i: exit code $code: $(cat said)" ;;
  esac
  read -r reader plain < <(seen out)
  case $reader in
    old | new) found[$reader]=$((${found[$reader]} + 1)) ;;
    *) fail "bake $i, killed after $delay us: a reader sees a $reader generation" ;;
  esac
  [ "$plain" != mixed ] || mixed=$((mixed + 1))
  trace=nothing
  for kind in .luthier-new .luthier-ready; do [ ! -e "out/$kind" ] || trace=$kind; done
  left[$trace]=$((${left[$trace]} + 1))
  next=new
  [ $((RANDOM % 2)) = 1 ] || next=old
  bake "$next" out 2>said || fail "bake $i: the next bake failed: $(cat said)"
  is_whole out "$next" || fail "bake $i: the next bake did not sweep"
done
[ $((found[old] + found[new])) = "$i" ] || fail "not all bakes were checked"
printf '%d bakes, %d of them ended before their kill; old %d, new %d, mixed 0; left .luthier-new %d, .luthier-ready %d; mixed for plain readers %d\n' \
  "$i" "$ended" "${found[old]}" "${found[new]}" "${left[.luthier-new]}" "${left[.luthier-ready]}" "$mixed"

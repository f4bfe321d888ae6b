#!/usr/bin/env bash
# Sends SIGINT, SIGTERM and SIGHUP to bakes: at moments over their whole length, while they write, and while they wait for another program.
# Each ends with exit code 130, leaves nothing behind, and the folder holds the old generation or the new one. A signal that whoever started
# the bake has it ignore (`nohup`) does not end it.
#   tests/crash/signals.sh           40 moments for each signal
#   tests/crash/signals.sh --quick   8
# Wants what prepare.sh wants.
. "$(dirname "$0")/prepare.sh"
need cc gcc
need flock util-linux
# With this library each rename of the bake takes a while, so that signals come between them.
cat >slow.c <<'C'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <unistd.h>
int rename(const char *from, const char *to) {
    usleep(10000);
    return ((int (*)(const char *, const char *))dlsym(RTLD_NEXT, "rename"))(from, to);
}
C
cc -shared -fPIC -O1 -o slow.so slow.c -ldl

moments=40
[ "${1-}" != --quick ] || moments=8

# start HOW SIGNAL: a bake of `new` into `out` in the background, its number in `child`. Shells have children in the background ignore SIGINT.
start() {
  (LD_PRELOAD=$work/slow.so exec env "--$1-signal=$2" "$luthier" bake "${source[new]}" --no-fit --no-search --out out --quiet) 2>said &
  child=$!
  children=("$child")
}
ended() {
  code=0
  wait "$child" 2>/dev/null || code=$?
  children=()
}
pause() { sleep "$(printf '0.%03d' "$1")"; }

rm -rf out
cp -a ref-old out
begun=$(date +%s%N)
start default INT
ended
whole=$((($(date +%s%N) - begun) / 1000000))

printf '%-6s %8s %8s %6s %6s %6s\n' signal moments 'exit 130' 'exit 0' old new
for signal in INT TERM HUP; do
  declare -A count=([130]=0 [0]=0 [old]=0 [new]=0)
  for moment in $(seq "$moments"); do
    rm -rf out
    cp -a ref-old out
    start default "$signal"
    # Before the program runs, the signal would end a shell.
    pause $((10 + whole * moment / moments))
    kill "-$signal" "$child" 2>/dev/null || true
    ended
    problem="SIG$signal, moment $moment of $moments"
    [ "$code" = 130 ] || [ "$code" = 0 ] || fail "$problem: exit code $code: $(cat said)"
    [ ! -s said ] || fail "$problem: it said $(cat said)"
    read -r reader _ < <(seen out)
    case $reader in old | new) ;; *) fail "$problem: a $reader generation" ;; esac
    is_whole out "$reader" || fail "$problem: something was left"
    count[$code]=$((${count[$code]} + 1))
    count[$reader]=$((${count[$reader]} + 1))
  done
  [ "${count[130]}" -gt 0 ] || fail "no SIG$signal came in time"
  printf '%-6s %8d %8d %6d %6d %6d\n' "$signal" "$moments" "${count[130]}" "${count[0]}" "${count[old]}" "${count[new]}"

  # While another program has the folder.
  rm -rf out
  cp -a ref-old out
  mkfifo "$signal"
  (flock 9; read -r _ <"$signal") 9<out &
  other=$!
  until ! flock --nonblock out true; do :; done
  start default "$signal"
  children+=("$other")
  pause $((100 + 2 * whole))
  kill "-$signal" "$child"
  for _ in $(seq 100); do kill -0 "$child" 2>/dev/null || break; pause 20; done
  # The shell has not asked for its end yet: a child that is gone is a zombie.
  state=$(cut -d' ' -f3 "/proc/$child/stat" 2>/dev/null || echo gone)
  case $state in Z | gone) ;; *) fail "SIG$signal does not end a bake that waits for another program's lock" ;; esac
  ended
  [ "$code" = 130 ] || fail "SIG$signal while a bake waits: exit code $code"
  is_whole out old || fail "SIG$signal while a bake waits: something was left"
  echo >"$signal"
  wait "$other"

  # Ignored.
  start ignore "$signal"
  pause $((10 + whole / 2))
  kill "-$signal" "$child" 2>/dev/null || true
  ended
  [ "$code" = 0 ] || fail "SIG$signal that is ignored: exit code $code"
  is_whole out new || fail "SIG$signal that is ignored: not the new generation"
done

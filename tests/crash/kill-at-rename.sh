#!/usr/bin/env bash
# Kills a bake before and after every call that changes the folder, and has every such call fail. A program that is loaded first (kill.c) counts
# the calls. After each kill a reader sees the old generation or the new one whole, and the next bake leaves what an undisturbed one writes. After
# each failure there is one line of error and exit code 3, and the folder is as before, or the new generation is published.
#   tests/crash/kill-at-rename.sh           all calls (rename, unlink, rmdir, mkdir, opening for writing, write, close, sync), three starts: a bake
#                                           in place, none, and a bake that was killed half-way; four minutes with a debug build
#   tests/crash/kill-at-rename.sh --quick   renames and removals, with a bake in place
#   tests/crash/kill-at-rename.sh --hashed-names [--quick]   bakes whose names contain hashes
# Wants what prepare.sh wants. The last column of the table counts the kills after which a reader that does not know `.luthier-ready/` finds a
# mixed folder, until the next bake. Of names with hashes there must be none, and who has read the old manifest finds all of its files.
hashed=
if [ "${1-}" = --hashed-names ]; then
  hashed=1
  shift
fi
. "$(dirname "$0")/prepare.sh"
need cc gcc
cc -shared -fPIC -O1 -Wall -Wextra -Werror -o kill.so "$crash/kill.c" -ldl

all=rename,unlink,rmdir,mkdir,open,write,close,sync
removals=rename,unlink,rmdir

# begin START: the folder `out` before the bake that is killed.
begin() {
  rm -rf out
  case $1 in
    nothing) ;;
    bake) cp -a ref-old out ;;
    killed) cp -a left out ;;
  esac
}

# disturbed CALLS K WHEN NAME: bakes into `out` with a kill or failure at call K. The calls that counted are in `calls`, the exit code in `code`.
disturbed() {
  rm -f calls
  : >calls
  code=0
  # A shell of its own has the message that something was killed.
  (KILL_IN=$work/out KILL_CALLS=$1 KILL_AT=$2 KILL_WHEN=$3 KILL_LOG=$work/calls LD_PRELOAD=$work/kill.so bake "$4" out) 2>said || code=$?
}

# sweep START WHEN CALLS NAME: a kill or failure at each call of a bake of NAME.
sweep() {
  local start=$1 when=$2 calls=$3 name=$4 k=0 reader plain next problem
  local -A count=([old]=0 [new]=0 [none]=0 [plain]=0)
  while :; do
    k=$((k + 1))
    begin "$start"
    disturbed "$calls" "$k" "$when" "$name"
    [ "$(wc -l <calls)" -ge "$k" ] || break
    problem="$start, $when call $k ($(sed -n "${k}p" calls | cut -d' ' -f2-))"
    read -r reader plain < <(seen out)
    case $reader in
      old | new) ;;
      none) [ "$start" = nothing ] || fail "$problem: there is no bake" ;;
      *) fail "$problem: a reader sees a $reader generation" ;;
    esac
    if [[ $when =~ ^[0-9]+$ ]]; then
      failed "$problem" "$reader" "$start"
    else
      [ "$code" = 137 ] || fail "$problem: exit code $code instead of a kill; $(cat said)"
    fi
    count[$reader]=$((${count[$reader]} + 1))
    [ "$plain" != mixed ] || count[plain]=$((count[plain] + 1))
    if [ -n "$hashed" ]; then
      [ "$plain" != mixed ] || fail "$problem: a reader of the manifest alone sees a mixed generation"
      [ "$start" != bake ] || has out old || fail "$problem: files of the generation before are missing"
    fi
    # The next bake may be of either generation.
    next=new
    [ $((k % 2)) = 1 ] || next=old
    bake "$next" out 2>said || fail "$problem: the next bake failed: $(cat said)"
    is_whole out "$next" || fail "$problem: the next bake did not sweep"
  done
  [ "$k" -gt 1 ] || fail "no call was counted ($(cat said)): does $luthier load a library first, and call libc?"
  [ "$code" = 0 ] && is_whole out "$name" || fail "$start, $when: the undisturbed bake failed"
  local kind=kill
  [[ $when =~ ^[0-9]+$ ]] && kind="error" && when="$when"
  printf '%-8s %-6s %-6s %6d %6d %6d %6d %6d %6d\n' "$start" "$kind" "$when" $((k - 1)) \
    "${count[old]}" "${count[new]}" "${count[none]}" 0 "${count[plain]}"
}

# failed PROBLEM READER START: what a bake leaves when a call has failed.
failed() {
  if [ "$code" = 0 ]; then
    # What fails was not needed: a folder is not empty, or closing tells too late.
    [ "$2" = new ] && ! compgen -G 'out/.luthier-*' >/dev/null || fail "$1: exit code 0, and yet a $2 generation or a trace"
    return
  fi
  [ "$code" = 3 ] || fail "$1: exit code $code"
  [ "$(wc -l <said)" = 1 ] && grep -q '^error: cannot ' said || fail "$1: not one line of error: $(cat said)"
  case $2/$3 in
    new/*) ;;
    none/nothing) [ ! -e out ] || fail "$1: a folder was left: $(find out)" ;;
    old/bake) is_whole out old || fail "$1: a trace was left" ;;
  esac
}

printf '%-8s %-6s %-6s %6s %6s %6s %6s %6s %6s\n' start how when points old new none mixed plain
if [ "${1-}" = --quick ]; then
  sweep bake before "$removals" new
  sweep bake after "$removals" new
  sweep bake 28 rename,mkdir,open new
  exit
fi

# A bake that was killed when half of its files were at their places.
begin bake
disturbed rename 0 before new
half=$(($(wc -l <calls) / 2))
begin bake
disturbed rename "$half" after new
[ -e out/.luthier-ready ] || fail "a bake that was killed at rename $half left nothing"
cp -a out left

for start in bake nothing; do
  for when in before after; do sweep "$start" "$when" "$all" new; done
  sweep "$start" half write new
  # No space (28), read-only (30), input/output error (5).
  for errno in 28 30 5; do sweep "$start" "$errno" rename,unlink,mkdir,open,write,sync new; done
done
for when in before after; do sweep killed "$when" "$all" old; done

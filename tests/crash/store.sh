#!/usr/bin/env bash
# The store of results under kills, failures, damage and many bakes at once. Whatever happens to it, a bake writes the same bytes.
#   tests/crash/store.sh           four minutes with a debug build
#   tests/crash/store.sh --quick   fewer kills, six bakes at once in place of sixteen
# Wants what prepare.sh wants, and gcc.
. "$(dirname "$0")/prepare.sh"
need cc gcc
cc -shared -fPIC -O1 -Wall -Wextra -Werror -o kill.so "$crash/kill.c" -ldl
calls=rename,unlink,mkdir,open,write,close step=1 many=16
[ "${1-}" != --quick ] || calls=rename,write step=3 many=6

# with FOLDER NAME OUT: a bake with the store in a folder.
with() { LUTHIER_CACHE=$work/$1 bake "$2" "$3"; }
verified() { "$luthier" cache verify --cache "$work/$1" >verified || fail "$2: $(cat verified)"; }
entries() { find "$1/objects" -type f | sort; }

with cache old out && with cache new out
count=$(entries cache | wc -l)
[ "$count" -gt 2 ] || fail "the store holds $count results"

# disturbed FOLDER K WHEN CALLS COMMAND...: a command with a kill or failure at call K on the folder.
disturbed() {
  local folder=$1 k=$2 when=$3 calls=$4 code=0
  shift 4
  rm -f calls
  : >calls
  (KILL_IN=$work/$folder KILL_CALLS=$calls KILL_AT=$k KILL_WHEN=$when KILL_LOG=$work/calls LD_PRELOAD=$work/kill.so "$@") 2>said || code=$?
  printf '%d' "$code" >code
}

for when in before after 28 5; do
  k=1
  while :; do
    rm -rf store out
    disturbed store "$k" "$when" "$calls" with store old out
    [ "$(wc -l <calls)" -ge "$k" ] || break
    problem="$when call $k ($(sed -n "${k}p" calls | cut -d' ' -f2-))"
    case $when/$(cat code) in
      before/137 | after/137) ;;
      # The folder of the store cannot be made, and was asked for.
      */3) grep -q '^error: cannot .*/store' said || fail "$problem: $(cat said)" ;;
      */0)
        grep -qv '^warning: ' said && fail "$problem: $(cat said)"
        is_whole out old || fail "$problem: a failure of the store changes a bake"
        ;;
      *) fail "$problem: exit code $(cat code); $(cat said)" ;;
    esac
    with store old out 2>said || fail "$problem: the next bake failed: $(cat said)"
    [ ! -s said ] || fail "$problem: the next bake says $(cat said)"
    is_whole out old || fail "$problem: the next bake writes other bytes"
    verified store "$problem"
    k=$((k + step))
  done
  [ "$k" -gt 1 ] || fail "no call of the store was counted: $(cat said)"
  printf 'store, %-6s each %s call of %d: the bytes are the same\n' "$when" "$step." $(((k - 1)))
done

# A bake that was killed while it wrote into its folder, and a store that knows the bake before.
k=1
while :; do
  rm -rf out
  with cache old out
  disturbed out "$k" before rename,unlink,rmdir,write with cache new out
  [ "$(wc -l <calls)" -ge "$k" ] || break
  with cache old out || fail "folder, call $k: the next bake failed"
  is_whole out old || fail "folder, before call $k ($(sed -n "${k}p" calls)): the next bake takes the folder for its own"
  k=$((k + step))
done
printf 'folder, before each %d. call of %d: the bake before is baked again\n' "$step" $((k - 1))

# Damage: a byte, the end, everything; files that are none.
for damage in byte end empty folder; do
  rm -rf store out
  cp -a cache store
  rm -rf ref-out
  entries store | while read -r entry; do
    case $damage in
      byte) printf '\377' | dd of="$entry" bs=1 seek=80 conv=notrunc status=none ;;
      end) truncate -s -1 "$entry" ;;
      empty) : >"$entry" ;;
      folder) rm "$entry" && mkdir "$entry" ;;
    esac
  done
  code=0
  with store old out 2>said || code=$?
  [ "$code" = 0 ] && is_whole out old || fail "damage ($damage): exit code $code; $(cat said)"
  [ "$(grep -c '^warning: ' said)" = 1 ] && [ "$(wc -l <said)" = 1 ] || fail "damage ($damage): not one warning: $(cat said)"
  [ "$damage" = folder ] && continue
  cp -a cache damaged
  entries damaged | while read -r entry; do : >"$entry"; done
  code=0
  "$luthier" cache verify --cache "$work/damaged" >verified || code=$?
  [ "$code" = 1 ] && grep -q "$count were damaged" verified || fail "damage: exit code $code; $(cat verified)"
  verified damaged 'after damaged results were removed'
  rm -rf damaged
done
echo 'damage: bytes, ends, whole entries: found, one warning, the bytes are the same'

# Many at once, with one store: each into its folder, then all into one.
rm -rf store out
for into in out-I out; do
  children=()
  for i in $(seq "$many"); do
    name=old
    [ $((i % 2)) = 1 ] || name=new
    with store "$name" "${into/I/$i}" 2>"said-$i" &
    children+=($!)
  done
  for child in "${children[@]}"; do wait "$child" || fail "many at once: a bake failed: $(cat said-*)"; done
  children=()
  [ -z "$(cat said-*)" ] || fail "many at once: $(cat said-*)"
  verified store 'many at once'
  [ "$into" = out ] && continue
  for i in $(seq "$many"); do is_whole "out-$i" "$([ $((i % 2)) = 1 ] && echo old || echo new)" || fail "many at once: bake $i"; done
done
for name in old new old; do
  with store "$name" out
  is_whole out "$name" || fail "after many into one folder: the store takes another bake for that of $name"
done
printf 'many: %d bakes at once with one store\n' "$many"

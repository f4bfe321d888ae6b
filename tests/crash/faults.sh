#!/usr/bin/env bash
# Faults of files and folders: a full disk, no permission, something in the way, inputs that are gone, a standard output that takes nothing. Each
# case has its exit code and its message in messages.txt; there is one line of error, no panic, and nothing is left: the folder of
# the case is as before, where the case does not say otherwise.
#   tests/crash/faults.sh            all cases that this user can make; root makes all, others leave out those that mount something
#   LUTHIER_ACCEPT=1 tests/crash/faults.sh   writes messages.txt anew
# Wants what prepare.sh wants. Cases about permissions run as the user 65534 where root starts this.
. "$(dirname "$0")/prepare.sh"
need setpriv util-linux
need mountpoint util-linux

messages=$crash/messages.txt
: >found
cases=0 left_out=()
mounts=()
tidy() {
  local folder
  for folder in "${mounts[@]}"; do umount "$folder" 2>/dev/null || true; done
}

is_root=
[ "$(id -u)" != 0 ] || is_root=1
# The user of the cases about permissions reads the program and the materials, and owns the folder of the case.
chmod 755 "$work"
plain() {
  if [ -n "$is_root" ]; then setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; else "$@"; fi
}
own() { [ -z "$is_root" ] || chown -R 65534:65534 "$@"; }
[ -z "$is_root" ] || plain test -x "$luthier" || {
  cp "$luthier" program
  luthier=$work/program
}

# Whether this user can mount; a case that cannot be made is named at the end.
can_mount() {
  [ -n "$is_root" ] && mkdir -p mnt && mount -t tmpfs -o size=4k luthier-test mnt 2>/dev/null && umount mnt
}
mount_one() {
  mkdir -p "$2"
  mount -t tmpfs -o "$1" luthier-test "$2"
  mounts+=("$work/$2")
}

# State of a folder: names, kinds, and contents.
state() { (cd "$1" && find . -printf '%p %y %l\n' -type f -exec cksum {} + 2>/dev/null | sort); }

# begin: a folder `case` with a bake in `case/out`, and the materials beside it.
begin() {
  chmod -R u+rwX case 2>/dev/null || true
  rm -rf case
  mkdir case
  cp -r "$crash/materials" case/m
  cp -a ref-old case/out
}

# wrong WORDS: something is wrong; the cases go on.
wrongs=0
wrong() {
  printf 'error: %s\n' "$1" >&2
  wrongs=$((wrongs + 1))
}

# fault NAME COMMAND...: runs a command in `case`, whose standard output goes to ${to:-/dev/null}. With `leaves=yes` the folder may change. With
# `any=yes` it does not matter which file the message is about.
fault() {
  local name=$1 before code=0
  shift
  cases=$((cases + 1))
  before=$(state case)
  (cd case && "$@" >"${to:-/dev/null}" 2>"$work/said") || code=$?
  if grep -q panicked said || [ "$code" -gt 3 ]; then wrong "$name: exit code $code; $(cat said)"; fi
  if [ "$code" = 0 ]; then
    [ ! -s said ] || wrong "$name: exit code 0, and yet: $(cat said)"
  else
    # What is wrong within a material is shown before the line that sums it up; a hint may follow.
    sed -i '/^hint: /d' said
    [ "$(grep -vc '^error: ' said)" = 0 ] || [ "$code" = 1 ] || wrong "$name: not one line of error: $(cat said)"
    [ "$(tail -1 said | grep -c '^error: ')" = 1 ] || wrong "$name: no line of error: $(cat said)"
  fi
  if [ "${leaves-}" != yes ]; then
    diff <(printf '%s\n' "$before") <(state case) || wrong "$name: the folder has changed"
  fi
  [ "${any-}" != yes ] || sed -i 's/cannot write [^:]*:/cannot write FILE:/' said
  printf '%s: exit %d: %s\n' "$name" "$code" "$(grep '^error: ' said | paste -sd ';' | sed -E 's#(.)\1{99,}#\1…#; s#(y/){99,}#y…#')" >>found
}

new=(bake m/gold.toml --no-fit --no-search --quiet --out)

begin
fault 'a material that is not there' "$luthier" bake m/none.toml --out out
begin && mkdir empty && mv empty case/empty
fault 'a folder without materials' "$luthier" bake empty --out out
begin && ln -s nowhere.toml case/m/broken.toml
fault 'a material that is a broken link' "$luthier" bake m/broken.toml --out out
fault 'a folder with a broken link among its materials' "$luthier" bake m --no-fit --no-search --quiet --out out
begin && ln -s loop.toml case/m/loop.toml
fault 'a material that is a link to itself' "$luthier" bake m/loop.toml --out out
begin && mkfifo case/m/pipe.toml
fault 'a material that is a pipe' "$luthier" bake m/pipe.toml --out out
begin && mkdir case/m/folder.toml && touch case/m/folder.toml/x
fault 'a material below a file' "$luthier" bake m/gold.toml/x.toml --out out
begin
fault 'a material whose name is too long' "$luthier" bake "m/$(printf 'x%.0s' {1..300}).toml" --out out
begin && chmod 000 case/m/gold.toml && own case
fault 'a material without permission' plain "$luthier" "${new[@]}" out
begin && rm case/m/rough.png
fault 'a map that has vanished' "$luthier" bake m/worn.toml --no-fit --no-search --quiet --out out
begin && sed -i 's/"ag"/"gone.csv"/' case/m/worn.toml
fault 'an index that has vanished' "$luthier" bake m/worn.toml --no-fit --no-search --quiet --out out

begin && rm -r case/out && touch case/out
fault 'the folder is a file' "$luthier" "${new[@]}" out
begin && touch case/file
fault 'the folder lies below a file' "$luthier" "${new[@]}" file/out
begin
fault 'the name of the folder is too long' "$luthier" "${new[@]}" "$(printf 'x%.0s' {1..300})"
begin
fault 'the path of the folder is too long' "$luthier" "${new[@]}" "$(printf 'x%.0s' {1..200})/$(printf 'y/%.0s' {1..2100})"
begin && ln -s nowhere case/link
fault 'the folder is a broken link' "$luthier" "${new[@]}" link
begin && ln -s loop case/loop
fault 'the folder is a link to itself' "$luthier" "${new[@]}" loop
begin && rm -r case/out/tables && touch case/out/tables
fault 'a file where a folder of the bake belongs' "$luthier" "${new[@]}" out
begin && rm case/out/materials.bin && mkdir case/out/materials.bin
fault 'a folder where a file of the bake belongs' "$luthier" "${new[@]}" out
begin && chmod 555 case/out && own case
fault 'a folder without permission' plain "$luthier" "${new[@]}" out
begin && own case && chmod 000 case/out
fault 'a folder that is closed' plain "$luthier" "${new[@]}" out
chmod 755 case/out
begin && own case && chmod 555 case
fault 'a folder that cannot be made' plain "$luthier" "${new[@]}" fresh
begin && own case && chmod 555 case/out/tables
fault 'a folder within the bake without permission' plain "$luthier" "${new[@]}" out
begin && own case && chmod 555 case/out/maps
fault 'a folder within the bake before without permission' plain "$luthier" "${new[@]}" out
if [ -n "$is_root" ]; then
  begin && mkdir case/out/.luthier-new && touch case/out/.luthier-new/x && chmod 755 case/out/.luthier-new && own case && chown -R 0 case/out/.luthier-new
  fault "what another user's bake left" plain "$luthier" "${new[@]}" out
else
  left_out+=("what another user's bake left")
fi
begin
any=yes fault 'files larger than the limit' bash -c 'trap "" XFSZ; ulimit -f 1; exec "$@"' - "$luthier" "${new[@]}" out
begin
any=yes fault 'a new folder, and files larger than the limit' bash -c 'trap "" XFSZ; ulimit -f 1; exec "$@"' - "$luthier" "${new[@]}" deep/fresh
begin
fault 'no more open files' bash -c 'ulimit -n 5; exec "$@"' - "$luthier" "${new[@]}" out

if can_mount; then
  begin && mount_one size=32k case/full && cp -r case/out/maps case/full/ && cp case/out/materials.bin case/full/
  any=yes fault 'a full disk' "$luthier" "${new[@]}" full
  umount case/full
  begin && mount_one size=4m,ro case/read-only
  fault 'a disk that is read only' "$luthier" "${new[@]}" read-only
  umount case/read-only
  begin && mount_one size=4m case/out/tables
  cp ref-old/tables/* case/out/tables
  fault 'a folder within the bake on another disk' "$luthier" "${new[@]}" out
  umount case/out/tables
else
  left_out+=('a full disk' 'a disk that is read only' 'a folder within the bake on another disk')
fi

begin
fault 'a report where there is no bake' "$luthier" report --out m --no-device
begin && rm case/out/tables/fresnel.ktx2
fault 'a report on a bake that lacks a file' "$luthier" report --out out --no-device --pairs 1
begin && sed -i 's,"../materials/worn.toml","../m/gone.toml",' case/out/manifest.json
fault 'a report whose material has vanished' "$luthier" report --out out --no-device --pairs 1
begin && mv case/m case/materials && chmod 555 case/out && own case
fault 'a report without permission' plain "$luthier" report --out out --no-device --pairs 1
# A grey picture.
begin && { printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n'; printf '\200%.0s' {1..8192}; } >case/grey.hdr
fault 'an environment into a file' "$luthier" environment grey.hdr --size 32 --layout equirect --out m/gold.toml
begin
to=/dev/full leaves=yes fault 'a full standard output' "$luthier" bake m/gold.toml --no-fit --no-search --out out
is_whole_but_source() { diff -r -x manifest.json case/out ref-new; }
is_whole_but_source || wrong "a full standard output: the bake is not published"
begin
leaves=yes fault 'a closed standard output' bash -c 'exec "$@" >&-' - "$luthier" bake m/gold.toml --no-fit --no-search --out out
is_whole_but_source || wrong "a closed standard output: the bake is not published"
begin
leaves=yes fault 'a reader of standard output that is gone' bash -c 'set -o pipefail; { sleep 0.2; "$@"; } | true' - "$luthier" bake m/gold.toml --no-fit --no-search --out out
is_whole_but_source || wrong "a reader of standard output that is gone: the bake is not published"
begin
leaves=yes fault 'a folder whose parent is missing' "$luthier" "${new[@]}" deep/deeper/out
diff -r -x manifest.json case/deep/deeper/out ref-new || wrong "a folder whose parent is missing: the bake is not published"

if [ -n "${LUTHIER_ACCEPT-}" ]; then
  [ ${#left_out[@]} = 0 ] || fail "messages.txt lacks cases that only root can make"
  cp found "$messages"
fi
cp "$messages" expected
for name in "${left_out[@]}"; do
  printf 'left out, because it wants root: %s\n' "$name"
  grep -v -F "$name: exit" expected >kept
  mv kept expected
done
diff expected found || wrong "these messages are not those of $messages"
[ "$wrongs" = 0 ] || fail "$wrongs things are wrong in $cases cases"
printf '%d cases, messages as listed\n' "$cases"

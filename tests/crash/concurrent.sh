#!/usr/bin/env bash
# Several bakes of two generations into one folder at once, again and again, while readers read it. Every bake ends with exit code 0, the folder
# holds one generation whole at the end, and no reader under the shared lock sees a mix. Then the same with `luthier report`, which reads a bake and
# writes its report beside it: the report is on the bake that is there.
#   tests/crash/concurrent.sh           8 bakes at a time, 20 rounds
#   tests/crash/concurrent.sh --quick   4 at a time, 4 rounds
# Wants what prepare.sh wants.
. "$(dirname "$0")/prepare.sh"

bakes=8 rounds=20
[ "${1-}" != --quick ] || bakes=4 rounds=4

# together ROUND: bakes of both generations at once, all of which succeed.
together() {
  local i child
  children=()
  for i in $(seq "$bakes"); do
    ("$luthier" bake "${source[$([ $((i % 2)) = 1 ] && echo old || echo new)]}" --no-fit --no-search --threads 1 --out out --quiet) 2>"said-$i" &
    children+=($!)
  done
  for child in "${children[@]}"; do wait "$child" || fail "round $1: a bake failed: $(cat said-*)"; done
  children=()
}

readers=()
tidy() {
  local reader
  for reader in "${readers[@]}"; do kill "$reader" 2>/dev/null || true; done
}
cp -a ref-old out
for kind in '' --no-lock; do
  "$python" -S "$crash/generation.py" watch out "$work/end$kind" old=ref-old new=ref-new $kind >"read$kind" &
  readers+=($!)
done
for round in $(seq "$rounds"); do
  together "$round"
  read -r reader _ < <(seen out)
  case $reader in old | new) ;; *) fail "round $round: a $reader generation" ;; esac
  is_whole out "$reader" || fail "round $round: not one generation alone"
done
touch end end--no-lock
wait "${readers[0]}" || fail "a reader under the lock saw a mix: $(cat read)"
wait "${readers[1]}"
printf '%d bakes at a time, %d rounds; reads under the lock: %s; without it: %s\n' "$bakes" "$rounds" "$(cat read)" "$(cat read--no-lock)"

judged=0 rebaked=0
for round in $(seq "$rounds"); do
  (together "$round") &
  pid=$!
  while kill -0 "$pid" 2>/dev/null; do
    code=0
    "$luthier" report --out out --no-device --pairs 1 >report.txt 2>said || code=$?
    case $code in
      0) judged=$((judged + 1)) ;;
      1) grep -q 'holds another bake than the one that was read' said || fail "round $round: $(cat said)"
        rebaked=$((rebaked + 1)) ;;
      *) fail "round $round: a report ended with exit code $code: $(cat said)" ;;
    esac
    # A report that is there is on the bake that is there.
    "$python" - out <<'P' || fail "round $round: the report is on another bake"
import fcntl, hashlib, os, sys
lock = os.open(sys.argv[1], os.O_RDONLY)
fcntl.flock(lock, fcntl.LOCK_SH)
read = lambda path: open(os.path.join(sys.argv[1], path), "rb").read()
try:
    report = read("report/report.json").decode()
except FileNotFoundError:
    sys.exit(0)
sys.exit(hashlib.sha256(read("manifest.json")).hexdigest() not in report)
P
  done
  wait "$pid" || fail "round $round: a bake failed"
done
printf 'reports at the same time: %d judged, %d found another bake at their end\n' "$judged" "$rebaked"
[ "$judged" -gt 0 ] || fail "no report was written"

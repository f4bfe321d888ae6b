#!/usr/bin/env bash
# Bakes on several "machines" (folders of their own) that share a store of the S3 protocol, and compares every package with a bake by
# one machine alone, byte for byte: the second machine computes nothing; a server that lies, refuses, is gone or never answers costs
# one warning. Starts a server of its own (moto, from PyPI, with the versions of scripts/farm/s3-requirements.txt) and ends it.
# Needs Python 3.10 or later with venv, and the network of packages; on Debian: apt-get install python3-venv. Takes one minute.
#   scripts/farm/s3.sh [MATERIALS... [OPTIONS OF BAKE]]
# The environment variable LUTHIER names a program with the Cargo feature `remote`; by default cargo builds it. PYTHON names an
# interpreter that has the packages already.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/farm/program.sh

arguments=("$@")
if [ ${#arguments[@]} = 0 ]; then
  for name in papers/ceramic-glaze polished-gold papers/red-lacquer soap-film varnished-brass; do
    arguments+=("$PWD/materials/$name.toml")
  done
fi

fail() {
  echo "error: $1" >&2
  exit 1
}

need python3-venv python3
take_luthier --no-default-features --features remote

work=$(mktemp -d)
started=()
finish() {
  local code=$?
  for process in "${started[@]}"; do
    kill "$process" 2>/dev/null || true
    wait "$process" 2>/dev/null || true
  done
  if [ $code != 0 ]; then
    tail -n 5 "$work"/*.log "$work"/*.err 2>/dev/null || true
  fi
  rm -rf "$work"
  exit $code
}
trap finish EXIT
trap 'exit 130' INT TERM HUP

if [ -z "${PYTHON-}" ]; then
  python3 -m venv "$work/venv" 2>"$work/venv.log" || fail "python3 makes no virtual environment. On Debian: apt-get install python3-venv"
  PYTHON=$work/venv/bin/python
  "$PYTHON" -m pip install --quiet --disable-pip-version-check -r scripts/farm/s3-requirements.txt
fi
python() { "$PYTHON" scripts/farm/s3.py "$@"; }

# Nothing of the user's own: no credentials, no proxies, no store.
for variable in $(compgen -e | grep -E '^(AWS_|LUTHIER_)|_proxy$|_PROXY$'); do
  [ "$variable" = LUTHIER ] || unset "$variable"
done
export AWS_ACCESS_KEY_ID=luthier AWS_SECRET_ACCESS_KEY=secret AWS_ALLOW_HTTP=true AWS_EC2_METADATA_DISABLED=true

store=s3://luthier/farm
# serve NAME: starts a server with an empty bucket, and has luthier use it.
serve() {
  local port
  port=$(python port)
  "$PYTHON" -m moto.server -H 127.0.0.1 -p "$port" >"$work/$1.log" 2>&1 &
  started+=($!)
  export AWS_ENDPOINT_URL=http://127.0.0.1:$port
  python make luthier
}
# bake MACHINE [OPTIONS]: bakes with the folder of that machine. Sets `said`, what it says beside what materials give rise to, and `ran`, the
# kinds of jobs that it ran.
bake() {
  local machine=$1 start=$EPOCHREALTIME
  "$LUTHIER" "${verb-bake}" "${arguments[@]}" --cache "$work/$machine.cache" --out "$work/$machine" --json "${@:2}" \
    >"$work/$machine.json" 2>"$work/$machine.err" || fail "$machine: the bake has failed"
  said=$(grep -vxF -f "$work/alone.err" "$work/$machine.err" || true)
  ran=$(python3 -c 'import json, sys; print(*json.load(open(sys.argv[1]))["seconds"])' "$work/$machine.json")
  printf '%s: %.1f s; jobs that ran: %s\n' "$machine" "$(awk "BEGIN { print $EPOCHREALTIME - $start }")" "${ran:-none}"
  if [ "$machine" != alone ]; then
    diff -r "$work/alone" "$work/$machine" || fail "$machine: the package differs from that of one machine alone"
  fi
}
# The results of jobs that a machine has. Stamps of bakes stay on their machine.
results() { (cd "$work/$1.cache/objects" && find . -type f ! -name '*-stamp' | sort); }
hashes() { (cd "$work/$1.cache/objects" && results "$1" | xargs sha256sum); }
entries() { results "$1" | wc -l; }
# warned TEXT: the last bake has written one line, a warning that says so.
warned() {
  echo "$said"
  [ "$(wc -l <<<"$said")" = 1 ] || fail "this is not one line"
  [[ $said == "warning: the shared store $store "*"$1"* ]] || fail "no warning says: $1"
}
quiet() { [ -z "$said" ] || fail "a warning without a reason: $said"; }
computed_nothing() {
  quiet
  [ -z "$ran" ] || fail "jobs ran whose results are in the store: $ran"
}

step "one machine alone"
bake alone
[ -n "$ran" ] || fail "no job ran"
echo "$(find "$work/alone" -type f | wc -l) files, $(entries alone) entries"

step "two machines, one store"
serve server
bake one --store $store
quiet
python list luthier farm >"$work/sent"
[ "$(wc -l <"$work/sent")" = "$(entries one)" ] || fail "the store has $(wc -l <"$work/sent") objects, and the machine $(entries one) entries"
results one | sed 's,^\./,farm/,' | diff "$work/sent" - || fail "names of objects differ from those of entries"
bake two --store $store
computed_nothing
diff <(hashes one) <(hashes two) || fail "entries differ from those of the other machine"
echo "$(entries two) entries fetched, equal to those of the first machine"

step "the variable LUTHIER_STORE names the store, and --no-cache wants none"
LUTHIER_STORE=$store bake three
computed_nothing
"$LUTHIER" bake "${arguments[0]}" --out "$work/no-cache" --quiet --no-cache --store $store 2>"$work/refused.log" && fail "--store beside --no-cache is not refused"
"$LUTHIER" bake "${arguments[0]}" --out "$work/no-cache" --quiet --store ftp://host/store 2>"$work/refused.log" && fail "an address of no store is not refused"
grep -h '^error: ' "$work/refused.log"

step "shares of two machines, merged by a third"
store=s3://luthier/shares
for share in 1 2; do
  "$LUTHIER" bake "${arguments[@]}" --shard $share/2 --cache "$work/share-$share.cache" --store $store 2>"$work/share-$share.err"
done
verb=merge bake merged --store $store
quiet
# Rows of lobes wait for the fits of all shares.
[[ " $ran " != *" fit "* ]] || fail "a fit ran that a share has computed"
store=s3://luthier/farm

step "a server that lies: objects exchanged, damaged, cut short and emptied"
python lie luthier farm
bake deceived --store $store
warned "has damaged entries"
[ -n "$ran" ] || fail "no job ran"
bake after --store $store
computed_nothing
echo "the store is whole again"

step "a server that is gone"
kill "${started[-1]}"
wait "${started[-1]}" 2>/dev/null || true
unset 'started[-1]'
bake cut-off --store $store
warned "is not used any more"

step "a server that refuses"
# The first request makes the bucket.
INITIAL_NO_AUTH_ACTION_COUNT=1 serve strict
bake refused --store $store
warned "access is denied"

step "a bucket that does not exist"
serve empty
store=s3://another/farm
bake lost --store $store
warned "does not exist"
store=s3://luthier/farm

step "a server that never answers"
port=$(python port)
"$PYTHON" scripts/farm/s3.py mute "$port" &
started+=($!)
AWS_ENDPOINT_URL=http://127.0.0.1:$port bake waiting --store $store
warned "it takes too long to answer"

printf '\nall packages are equal\n'

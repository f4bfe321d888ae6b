#!/usr/bin/env bash
# Runs the tests of the hosts in examples/ that draw bakes, and prints the page of their pictures beside those of `luthier preview`,
# docs/pages/hosts.md; its picture is left as target/hosts/hosts.png.
#   scripts/hosts.sh            all: half an hour on two cores
#   scripts/hosts.sh HOST...    some; the page has the latest runs of the others, from target/hosts/
#   scripts/hosts.sh --page     none: the page of the latest runs, those of nightly steps among them
# Wants what the scripts of the hosts name. The variable LUTHIER names the command; by default cargo builds it.
set -euo pipefail
cd "$(dirname "$0")/.."

hosts=(three babylon playcanvas bevy godot materialx c web)
if [ -z "${LUTHIER-}" ] && [ "${1-}" != --page ]; then
  cargo build --locked --release -p luthier-cli >&2
  export LUTHIER=$PWD/target/release/luthier
fi
logs=target/hosts
mkdir -p "$logs"
three() {
  npm ci --prefix examples/three --ignore-scripts --no-audit --no-fund --silent
  LUTHIER_CACHE='' node examples/three/test.mjs target/three
}
case ${1-} in
  "") asked=("${hosts[@]}") ;;
  --page) asked=() ;;
  *) asked=("$@") ;;
esac
for host in "${asked[@]}"; do
  echo "$host" >&2
  case $host in
    three) three ;;
    c) scripts/c-host.sh ;;
    web) LUTHIER_CACHE='' node examples/web/test.mjs target/web ;;
    *) "scripts/$host.sh" ;;
  esac >"$logs/$host.new"
  mv "$logs/$host.new" "$logs/$host.log"
done
for host in "${hosts[@]}"; do if [ -e "$logs/$host.log" ]; then echo "$logs/$host.log"; fi; done | xargs python3 scripts/hosts.py "$logs/hosts.png"

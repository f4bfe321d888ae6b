#!/usr/bin/env bash
# Runs the tests of this folder and prints what each found.
#   tests/crash/all.sh           everything: a quarter of an hour with a debug build on two cores
#   tests/crash/all.sh --quick   fewer kills, moments and bakes: a minute
# Wants what prepare.sh wants; `LUTHIER=path` names the program. Faults that want a mount are left out where root does not run this.
set -euo pipefail
cd "$(dirname "$0")/../.."

quick=()
kills=200
if [ "${1-}" = --quick ]; then
  quick=(--quick)
  kills=20
fi
if [ -z "${LUTHIER-}" ] && [ ! -x target/debug/luthier ]; then
  cargo build --locked -p luthier-cli --no-default-features
fi

said=$(mktemp -d)
trap 'rm -rf "$said"' EXIT
tests=(kill-at-rename hashed-names kill-at-random signals concurrent store faults)
failed=()
for test in "${tests[@]}"; do
  words=("${quick[@]}")
  case $test in
    kill-at-random) words=("$kills") ;;
    faults) words=() ;;
    hashed-names) words=(--hashed-names "${quick[@]}") ;;
  esac
  script=$test
  [ "$test" != hashed-names ] || script=kill-at-rename
  printf '\n== %s %s\n' "$test" "${words[*]}"
  started=$SECONDS
  "tests/crash/$script.sh" "${words[@]}" 2>&1 | tee "$said/$test" || failed+=("$test")
  printf '%s\t%d\n' "$test" $((SECONDS - started)) >>"$said/seconds"
done

printf '\n%-16s %-6s %7s  %s\n' test result seconds 'last line'
while IFS=$'\t' read -r test seconds; do
  result=passed
  case " ${failed[*]} " in *" $test "*) result=FAILED ;; esac
  printf '%-16s %-6s %7d  %s\n' "$test" "$result" "$seconds" "$(tail -1 "$said/$test")"
done <"$said/seconds"
[ ${#failed[@]} = 0 ] || exit 1

# Steps of a script, each of which runs even where others have failed: for bash scripts under `set -euo pipefail`, which source this file.
#   attempt NAME [after OTHER] COMMAND...   runs a program or a function, unless OTHER failed or did not run; what fails is remembered
#   summary                                 says what failed and what did not run, and ends the script: with 1 if there was anything
# A step may write more about its failure into the file $details, line by line.
declare -A broken=()
told=()
details=$(mktemp)

attempt() {
  local name=$1 status line
  shift
  if [ "$1" = after ]; then
    if [ -n "${broken[$2]-}" ]; then
      broken[$name]=yes
      told+=("not run: $name, because of: $2")
      return
    fi
    shift 2
  fi
  printf '\n== %s\n' "$name"
  : >"$details"
  # In a shell of its own, and not under `if`, where a function does not stop at its first failure.
  set +e
  (set -e; "$@")
  status=$?
  set -e
  [ $status != 0 ] || return 0
  broken[$name]=yes
  told+=("failed with $status: $name")
  while IFS= read -r line; do told+=("    $line"); done <"$details"
}

summary() {
  rm -f "$details"
  printf '\n== summary\n'
  if [ ${#told[@]} = 0 ]; then
    echo "all steps passed"
    exit 0
  fi
  printf '%s\n' "${told[@]}"
  exit 1
}

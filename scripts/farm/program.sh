# Sourced by the scripts beside it: what they have in common.

step() { printf '\n== %s\n' "$1"; }

# Fails unless some programs are there: need 'DEBIAN PACKAGES' PROGRAM...
need() {
  local packages=$1 program
  shift
  for program in "$@"; do
    command -v "$program" >/dev/null || {
      echo "error: $program is missing. On Debian: apt-get install $packages" >&2
      exit 1
    }
  done
}

# Names the program under test in LUTHIER, by its whole path; cargo builds it where none is named, with these arguments beside its crate.
take_luthier() {
  if [ -z "${LUTHIER-}" ]; then
    cargo build --locked --quiet -p luthier-cli "$@"
    local profile=debug
    [[ " $* " != *' --release '* ]] || profile=release
    LUTHIER=${CARGO_TARGET_DIR:-target}/$profile/luthier
  fi
  LUTHIER=$(realpath "$LUTHIER")
  export LUTHIER
}

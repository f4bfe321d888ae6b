#!/usr/bin/env bash
# Bakes materials/ with the program of another architecture, aarch64, under an emulator, without fits and with them, and two of them
# with the model of fitted lobes, and compares the bytes with those of the program of this machine. Needs the target of the toolchain (rustup target add
# aarch64-unknown-linux-gnu) and an emulator with a C library; on Debian: apt-get install --no-install-recommends qemu-user-static
# gcc-aarch64-linux-gnu libc6-dev-arm64-cross. It builds luthier, and an emulator takes twenty times as long as the machine.
#   scripts/other-architecture.sh [MATERIALS... [OPTIONS OF BAKE]]
# With arguments there is one bake, of these. The environment variable LUTHIER names the program of this machine; by default cargo builds it.
set -euo pipefail
cd "$(dirname "$0")/.."

target=aarch64-unknown-linux-gnu
folder=target/other-architecture
sysroot=/usr/aarch64-linux-gnu
bakes=("materials --no-fit" "materials" "materials/papers/car-paint.toml materials/papers/red-lacquer.toml --model lobes")
[ $# = 0 ] || bakes=("$*")

need() { # COMMAND HINT
  command -v "$1" >/dev/null || {
    echo "error: $1 is missing. $2" >&2
    exit 1
  }
}
need qemu-aarch64-static "On Debian: apt-get install qemu-user-static"
need aarch64-linux-gnu-gcc "On Debian: apt-get install gcc-aarch64-linux-gnu libc6-dev-arm64-cross"
[ -d "$(rustc --print sysroot)/lib/rustlib/$target" ] || {
  echo "error: the toolchain cannot build for $target. Run: rustup target add $target" >&2
  exit 1
}

step() { printf '\n== %s\n' "$1"; }
sums() { (cd "$1" && find . -type f -print0 | sort -z | xargs -0 sha256sum); }

step "programs"
# The command without graphics: what bakes is in it.
CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
  cargo build --locked --quiet --release -p luthier-cli --no-default-features --target $target --target-dir $folder
other=$folder/$target/release/luthier
if [ -z "${LUTHIER-}" ]; then
  cargo build --locked --quiet --release -p luthier-cli --no-default-features --target-dir $folder
  LUTHIER=$folder/release/luthier
fi
# ELF files name their machine in bytes 18 and 19: 62 is x86-64, 183 is aarch64.
machine() { od -An -j 18 -N 2 -t u2 "$1" | tr -d ' '; }
[ "$(machine "$other")" = 183 ] || { echo "error: $other is no program of aarch64" >&2; exit 1; }
[ "$(machine "$LUTHIER")" != 183 ] || { echo "error: $LUTHIER is of the same architecture: nothing would be compared" >&2; exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# A store would hand the results of one program to the other.
export LUTHIER_CACHE=

differ=0
for arguments in "${bakes[@]}"; do
  step "bake $arguments"
  read -ra words <<<"$arguments"
  "$LUTHIER" bake "${words[@]}" --out "$work/here" --quiet 2>/dev/null
  begin=$SECONDS
  qemu-aarch64-static -L $sysroot "$other" bake "${words[@]}" --out "$work/other" --quiet 2>/dev/null
  echo "$((SECONDS - begin)) s under the emulator"
  sums "$work/here" >"$work/here.sums"
  sums "$work/other" >"$work/other.sums"
  if diff "$work/here.sums" "$work/other.sums"; then
    echo "$(wc -l <"$work/here.sums") files with equal bytes"
  else
    differ=1
  fi
  rm -rf "$work/here" "$work/other"
done
[ $differ = 0 ] || { echo "error: the bytes depend on the architecture" >&2; exit 1; }

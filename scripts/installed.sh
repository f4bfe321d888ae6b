#!/usr/bin/env bash
# luthier as a user installs it: `cargo install` of the packed crates with an empty cargo home, and static programs for Linux without the verbs that need a
# graphics driver: for x86-64, and for aarch64 where the toolchain has its target. Lists sizes. Needs the network, and two or three release builds.
# The targets: rustup target add x86_64-unknown-linux-musl aarch64-unknown-linux-musl. With qemu-aarch64-static (Debian: qemu-user-static) the second runs, too.
#   scripts/installed.sh          all
#   scripts/installed.sh --debug  unoptimised, in half of the time
set -euo pipefail
cd "$(dirname "$0")/.."
export LUTHIER_CACHE=
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
debug=() profile=(--release) built=release
[ "${1-}" != --debug ] || { debug=(--debug) profile=() built=debug; }

step() { printf '\n== %s\n' "$1"; }
size() { printf '%s: %d KiB\n' "$1" $(($(stat --format %s "$2") / 1024)); }
# works COMMAND...: a program, or one under an emulator, checks and bakes a material.
works() {
  rm -rf "$work/out"
  printf 'schema = 1\nname = "gold"\n[[layer]]\ntype = "conductor"\nior = "au"\nroughness = 0.3\n' >"$work/gold.toml"
  "$@" check "$work/gold.toml"
  "$@" bake "$work/gold.toml" --out "$work/out" --quiet
  test -s "$work/out/manifest.json"
}

step "packed crates"
rm -f target/package/*.crate
./scripts/package.sh >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }
crates=$work/crates
mkdir "$crates"
for file in target/package/*.crate; do tar -xzf "$file" -C "$crates"; done
ls "$crates" | tr '\n' ' '
# A workspace of what was unpacked stands for a registry that has it. Versions of other crates are those that are tested.
{
  printf '[workspace]\nresolver = "3"\nmembers = ["*"]\n[patch.crates-io]\n'
  for folder in "$crates"/*/; do
    name=$(basename "$folder")
    printf '%s = { path = "%s" }\n' "${name%-*}" "$name"
  done
} >"$crates/Cargo.toml"
cp Cargo.lock "$crates"

step "cargo install, empty cargo home"
export CARGO_HOME=$work/home
cargo metadata --format-version 1 --manifest-path "$crates/Cargo.toml" >/dev/null
cargo install --locked --quiet "${debug[@]}" --path "$crates"/luthier-cli-[0-9]* --root "$work/root" --target-dir "$work/target"
works "$work/root/bin/luthier"
size "luthier, all verbs but the window" "$work/root/bin/luthier"
rm -rf "$work/target"
unset CARGO_HOME

step "static, without the verbs that need a driver"
# musl where the toolchain has it, else the C library of this machine.
target=x86_64-unknown-linux-musl
[ -d "$(rustc --print sysroot)/lib/rustlib/$target" ] || target=x86_64-unknown-linux-gnu
RUSTFLAGS="-C target-feature=+crt-static" \
  cargo build --locked --quiet "${profile[@]}" -p luthier-cli --no-default-features --target "$target" --target-dir target/static
static=target/static/$target/$built/luthier
# The loader of shared programs has no place in it.
stands_alone() {
  ! readelf --program-headers "$1" | grep -q INTERP || { echo "error: $1 asks for a loader" && exit 1; }
}
stands_alone "$static"
env -i LUTHIER_CACHE= "$(command -v bash)" -c "cd / && '$PWD/$static' --version"
works "$static"
for verb in preview compare bench cost view report; do
  code=0
  said=$("$static" "$verb" --out "$work/out" 2>&1) || code=$?
  [ $code = 4 ] && grep -qE -- "--features|feature \`gpu\`" <<<"$said" || {
    echo "error: $verb ends with $code, and says: $said"
    exit 1
  }
done
size "luthier, static, $target" "$static"

step "static, aarch64"
target=aarch64-unknown-linux-musl
if [ ! -d "$(rustc --print sysroot)/lib/rustlib/$target" ]; then
  echo "not built: the toolchain has no $target"
  exit
fi
# No C is compiled, and the linker is that of the toolchain: nothing of the other architecture has to be installed.
CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld \
  cargo build --locked --quiet "${profile[@]}" -p luthier-cli --no-default-features --target "$target" --target-dir target/static
static=target/static/$target/$built/luthier
stands_alone "$static"
size "luthier, static, $target" "$static"
if command -v qemu-aarch64-static >/dev/null; then
  here=$work/x86
  mv "$work/out" "$here"
  works qemu-aarch64-static "$static"
  diff -r "$here" "$work/out"
  echo "it runs under an emulator, and bakes the same bytes"
else
  echo "not run: there is no qemu-aarch64-static"
fi

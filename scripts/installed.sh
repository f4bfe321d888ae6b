#!/usr/bin/env bash
# luthier as a user installs it: `cargo install` of the packed crates with an empty cargo home, and a static program for x86-64 Linux without the verbs
# that need a graphics driver. Lists sizes. Needs the network, and two release builds.
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
# A program checks and bakes a material.
works() {
  printf 'schema = 1\nname = "gold"\n[[layer]]\ntype = "conductor"\nior = "au"\nroughness = 0.3\n' >"$work/gold.toml"
  "$1" check "$work/gold.toml"
  "$1" bake "$work/gold.toml" --out "$work/out" --quiet
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
if readelf --program-headers "$static" | grep -q INTERP; then
  echo "error: $static asks for a loader"
  exit 1
fi
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

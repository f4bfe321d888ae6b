#!/usr/bin/env bash
# All tests. On Debian and its relatives it installs what they need (the software Vulkan driver, the shader validators, a
# display without a screen, a browser, shells, groff, a C compiler and Python for tests that kill bakes, and Tint from npm); elsewhere it says what is missing. Needs nothing but a Rust toolchain otherwise.
set -euo pipefail
cd "$(dirname "$0")/.."
# Everything is computed: no results of earlier runs.
export LUTHIER_CACHE=

packages=(mesa-vulkan-drivers libvulkan1 glslang-tools spirv-tools xvfb libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0 chromium groff-base zsh fish
  gcc libc6-dev python3 util-linux)

step() { printf '\n== %s\n' "$1"; }

missing() {
  command -v glslangValidator >/dev/null || echo glslangValidator
  command -v spirv-val >/dev/null || echo spirv-val
  ldconfig -p 2>/dev/null | grep 'libvulkan\.so' >/dev/null || echo 'the Vulkan loader'
  compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null || compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null ||
    echo 'a Vulkan driver'
  command -v Xvfb >/dev/null || echo Xvfb
  for program in groff zsh fish cc python3 setpriv; do
    command -v "$program" >/dev/null || echo "$program"
  done
  command -v chromium chromium-browser google-chrome >/dev/null || echo Chromium
  for library in libX11-xcb libXcursor libXi libxkbcommon-x11; do
    ldconfig -p 2>/dev/null | grep "$library\.so" >/dev/null || echo "$library"
  done
}

need=$(missing || true)
if [ -n "$need" ]; then
  step "installing what the tests need"
  as_root=""
  [ "$(id -u)" = 0 ] || as_root=sudo
  if command -v apt-get >/dev/null && { [ -z "$as_root" ] || command -v sudo >/dev/null; }; then
    $as_root apt-get update -q
    DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -q --no-install-recommends "${packages[@]}"
  else
    printf 'missing:\n%s\nOn Debian: apt-get install %s\nTests that need them are skipped, or fail when CI is set.\n' \
      "$need" "${packages[*]}"
  fi
fi

step "installing Tint"
if ! command -v npm >/dev/null && [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
  apt-get update -q
  DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends nodejs npm
fi
if command -v npm >/dev/null; then
  [ -d scripts/tint/node_modules/webgpu ] || npm ci --prefix scripts/tint --ignore-scripts --no-audit --no-fund
else
  echo "missing: npm (Debian packages nodejs, npm). Tests of WGSL by Tint are skipped, or fail when CI is set."
fi

step "unit and integration tests"
cargo test --workspace --locked --features luthier-cli/view

step "the lean build has neither wgpu nor Vulkan"
if cargo tree --locked -p luthier-cli --no-default-features -e normal | grep -E '\b(wgpu|ash)\b'; then
  echo "error: the lean build depends on wgpu or on Vulkan (ash)"
  exit 1
fi

# The programs that the tests above have built and run. scripts/nightly.sh compares release builds.
export LUTHIER=$PWD/target/debug/luthier LUTHIER_LAB=$PWD/target/debug/luthier-lab

step "same bytes as in tests/golden"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
./scripts/golden.sh --keep "$work/golden"

step "kills, signals, bakes side by side, and faults of files"
if [ "$(uname -s)" = Linux ]; then
  ./tests/crash/all.sh --quick
else
  echo "skipped: these tests want Linux"
fi

step "pages are up to date"
./scripts/nightly.sh --check
cp -r docs/pages docs/reference.md "$work"
./scripts/pages.sh --cheap
if ! diff -r "$work/pages" docs/pages || ! diff "$work/reference.md" docs/reference.md; then
  echo "error: these pages were out of date, and have been made anew: commit them"
  exit 1
fi

step "judging the bakes"
[ -z "$(missing)" ] && device=() || device=(--no-device)
for package in materials materials/papers; do
  "$LUTHIER" report --out "$work/golden/$package" "${device[@]}" --max-error 2e-2
done

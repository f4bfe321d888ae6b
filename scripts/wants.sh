#!/usr/bin/env bash
# Installs what the tests need, on Debian and its relatives: the software Vulkan driver, the shader validators, a display without a screen, a
# browser, shells, groff, a C compiler and Python for tests that kill bakes, NumPy for those of the Python module, and Tint from npm. Elsewhere it
# says what is missing.
#   scripts/wants.sh             installs
#   scripts/wants.sh --missing   prints what is missing, without Tint
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(mesa-vulkan-drivers libvulkan1 glslang-tools spirv-tools xvfb libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0 chromium groff-base zsh fish
  gcc libc6-dev python3 python3-numpy util-linux make ninja-build)

missing() {
  command -v glslangValidator >/dev/null || echo glslangValidator
  command -v spirv-val >/dev/null || echo spirv-val
  ldconfig -p 2>/dev/null | grep 'libvulkan\.so' >/dev/null || echo 'the Vulkan loader'
  compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null || compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null ||
    echo 'a Vulkan driver'
  command -v Xvfb >/dev/null || echo Xvfb
  for program in groff zsh fish cc python3 setpriv make ninja; do
    command -v "$program" >/dev/null || echo "$program"
  done
  # As in scripts/python.sh: the python3 that is found first may be one without NumPy, beside a system that has it.
  python3 -c 'import numpy' 2>/dev/null || /usr/bin/python3 -c 'import numpy' 2>/dev/null || echo NumPy
  command -v chromium chromium-browser google-chrome >/dev/null || echo Chromium
  for library in libX11-xcb libXcursor libXi libxkbcommon-x11; do
    ldconfig -p 2>/dev/null | grep "$library\.so" >/dev/null || echo "$library"
  done
}

if [ "${1-}" = --missing ]; then
  missing || true
  exit
fi

need=$(missing || true)
if [ -n "$need" ]; then
  echo "installing what the tests need"
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

if ! command -v npm >/dev/null && [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
  apt-get update -q
  DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends nodejs npm
fi
if command -v npm >/dev/null; then
  [ -d scripts/tint/node_modules/webgpu ] || npm ci --prefix scripts/tint --ignore-scripts --no-audit --no-fund
else
  echo "missing: npm (Debian packages nodejs, npm). Tests of WGSL by Tint are skipped, or fail when CI is set."
fi

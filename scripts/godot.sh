#!/usr/bin/env bash
# Tests of the addon for Godot, examples/godot: balls by the three renderers of Godot 4 and by Godot 3.6 beside those of `luthier preview`, lamps with shadows,
# materials saved as resources, and wrong bakes.
#   scripts/godot.sh
# LUTHIER names the program that bakes; by default cargo builds it. GODOT and GODOT3 name Godot 4 and 3.6. Without GODOT both, and software drivers for them,
# are taken from Debian's sid into target/godot/debian, beside whatever release this is. Needs node 20.15, and on Debian apt-get install xvfb xauth; for sid
# debian-archive-keyring. Pictures are left in target/godot/.
set -euo pipefail
cd "$(dirname "$0")/.."
for program in node xvfb-run; do
  command -v "$program" >/dev/null || { echo "error: no $program. On Debian: apt-get install nodejs xvfb xauth" >&2; exit 3; }
done

out=$PWD/target/godot
mkdir -p "$out"
# A store for the bakes of this run.
export LUTHIER_CACHE=$out/store
rm -rf "$LUTHIER_CACHE"

# Downloads packages of sid with all that they need, unpacks them, and writes a program that runs one of them with its own libraries.
from_sid() {
  local root=$out/debian keys=/usr/share/keyrings/debian-archive-keyring.gpg file name
  command -v apt-get >/dev/null && [ -e "$keys" ] || { echo "error: no Godot. Name it by GODOT, and Godot 3.6 by GODOT3" >&2; exit 3; }
  mkdir -p "$root"/{lists,cache/archives}/partial "$root/files" "$root/home"
  : >"$root/status"
  echo "deb [signed-by=$keys] http://deb.debian.org/debian sid main" >"$root/sources.list"
  local apt=(apt-get -qq -o "Dir::Etc::SourceList=$root/sources.list" -o Dir::Etc::SourceParts=- -o "Dir::State=$root" -o "Dir::State::Status=$root/status"
    -o "Dir::Cache=$root/cache" -o Debug::NoLocking=1 -o "APT::Sandbox::User=$(id -un)")
  "${apt[@]}" update
  "${apt[@]}" install --yes --download-only --no-install-recommends godot godot3 mesa-vulkan-drivers libgl1-mesa-dri libgl1 libegl1 libvulkan1 \
    libx11-6 libxcursor1 libxext6 libxi6 libxinerama1 libxkbcommon0 libxrandr2 libxrender1
  for file in "$root"/cache/archives/*.deb; do dpkg-deb -x "$file" "$root/files"; done
  for name in godot godot3; do
    cat >"$out/$name" <<PROGRAM
#!/bin/sh
libraries=$root/files/usr/lib/x86_64-linux-gnu
export LIBGL_DRIVERS_PATH=\$libraries/dri __EGL_VENDOR_LIBRARY_DIRS=$root/files/usr/share/glvnd/egl_vendor.d
export VK_DRIVER_FILES=$root/files/usr/share/vulkan/icd.d/lvp_icd.json
export XDG_DATA_HOME=$root/home XDG_CONFIG_HOME=$root/home XDG_CACHE_HOME=$root/home
exec "\$libraries/ld-linux-x86-64.so.2" --library-path "\$libraries:\$libraries/pulseaudio" $root/files/usr/bin/$name "\$@"
PROGRAM
    chmod +x "$out/$name"
  done
}

if [ -z "${GODOT-}" ]; then
  [ -x "$out/godot" ] || from_sid
  export GODOT=$out/godot GODOT3=$out/godot3
fi
"$GODOT" --version
node examples/godot/test.mjs "$out"

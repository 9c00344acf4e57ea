#!/bin/sh
# Sets the project up on Debian 12: installs the packages that are missing, configures, builds. Both commands of the README
# start with it and share its build folder, build/. Arguments are CMake targets; without any everything is built, and what
# tests hold results against is installed too.
set -eu
cd "$(dirname "$0")/.."

# openimageio-tools: the CMake files of libopenimageio-dev check that its programs exist.
packages="g++ cmake ninja-build pkg-config
  libopenexr-dev libopenimageio-dev openimageio-tools libopencolorio-dev libcli11-dev nlohmann-json3-dev
  libtbb-dev libhwy-dev libdeflate-dev zlib1g-dev libgtest-dev libbenchmark-dev fonts-dejavu-core"

# scikit-image is an independent measure; a browser, driven by node, opens the report page.
if [ $# -eq 0 ]; then
  packages="$packages python3-skimage"
  command -v chromium >/dev/null || packages="$packages chromium"
  command -v npm >/dev/null || packages="$packages npm"
fi

missing=""
for package in $packages; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing="$missing $package"
done

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "setup: packages are missing and need root to be installed:$missing" >&2
    exit 1
  fi
}

if [ -n "$missing" ] && ! command -v apt-get >/dev/null; then
  echo "setup: this is no Debian system; going on with what is installed" >&2
elif [ -n "$missing" ]; then
  echo "setup: installing$missing"
  as_root apt-get update -qq
  # shellcheck disable=SC2086
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends $missing
fi

cmake --preset release --log-level=WARNING
if [ $# -eq 0 ]; then
  cmake --build --preset release
else
  cmake --build --preset release --target "$@"
fi

#!/bin/sh
# Makes a sample sequence, runs the default preset over it, and leaves the frames and one picture of them. Does all the
# set-up by itself (packages, configure, build); running it again overwrites its results.
# AFTERSHADE_BIN: a folder with the programs, instead of building them; AFTERSHADE_OUT: where results go.
set -eu
cd "$(dirname "$0")/../.."

if [ -z "${AFTERSHADE_BIN:-}" ]; then
  tests/setup.sh aftershade make_scene
  AFTERSHADE_BIN=build/bin
fi
bin=$AFTERSHADE_BIN
out=${AFTERSHADE_OUT:-out/quickstart}
mkdir -p "$out/in" "$out/out"

echo "quickstart: making a sample sequence"
"$bin/make_scene" garden -o "$out/in" --frames 1-8 --size 640x360 --samples 16

echo "quickstart: ambient occlusion and motion blur"
"$bin/aftershade" render "$out/in/garden.####.exr" -o "$out/out" --preset high-dx11 --ao

"$bin/aftershade" sheet "$out/in" "$out/out" --frames 2,5,8 --cell-width 400 -o "$out/sheet.png"

echo
echo "input frames   $out/in"
echo "output frames  $out/out"
echo "picture        $out/sheet.png"

#!/bin/sh
# Blurs a sample sequence with several methods. Leaves the frames, a picture of one frame before and after each method,
# and one of its true blur to compare with. Does all the set-up by itself (packages, configure, build); running it again
# overwrites its results.
# AFTERSHADE_BIN: a folder with the programs, instead of building them; AFTERSHADE_OUT: where results go.
set -eu
cd "$(dirname "$0")/../.."

if [ -z "${AFTERSHADE_BIN:-}" ]; then
  tests/setup.sh aftershade make_scene
  AFTERSHADE_BIN=build/bin
fi
bin=$AFTERSHADE_BIN
out=${AFTERSHADE_OUT:-out/motion-blur}
mkdir -p "$out/in" "$out/truth"

echo "motion-blur: making a sample sequence, and the true blur of one frame"
"$bin/make_scene" crossing -o "$out/in" --frames 1-8 --size 480x270 --samples 4
"$bin/make_scene" crossing -o "$out/truth" --frames 4-4 --size 480x270 --samples 4 --truth blur --blur-samples 32

picture() {
  "$bin/aftershade" sheet "$out/in/crossing.####.exr" "$1" --frames 4 --cell-width 960 -o "$2" --quiet
}
picture "$out/truth/crossing_blur.####.exr" "$out/truth.png"

# One preset for all: blur.json holds a single stage, of which --set changes the method and its parameters.
blur() {
  method=$1
  shift
  mkdir -p "$out/$method"
  echo "motion-blur: $method"
  "$bin/aftershade" render "$out/in/crossing.####.exr" -o "$out/$method" --frames 3-5 --existing overwrite \
    --preset examples/motion-blur/blur.json --set "motion_blur.method=$method" "$@"
  picture "$out/$method" "$out/$method.png"
}

blur scalable-motion-blur --set motion_blur.max_radius_px=0
blur guertin2014 --set motion_blur.max_radius_px=0
blur gather-plus
blur reconstruct

echo
echo "input frames        $out/in"
echo "blurred frames      $out/METHOD"
echo "before and after    $out/METHOD.png"
echo "before and truth    $out/truth.png"

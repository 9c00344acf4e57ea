#!/bin/sh
# Makes a sample sequence, runs the default preset over it, and leaves the frames and one picture of them. Does all the
# set-up by itself (packages, configure, build); running it again overwrites its results.
set -eu
cd "$(dirname "$0")/../.."

tests/setup.sh aftershade make_scene

bin=build/bin
out=out/quickstart
mkdir -p "$out/in" "$out/out"

echo "quickstart: making a sample sequence"
"$bin/make_scene" garden -o "$out/in" --frames 1-8 --size 640x360 --samples 4

echo "quickstart: ambient occlusion and motion blur"
"$bin/aftershade" render "$out/in/garden.####.exr" -o "$out/out" --preset high-dx11 --ao

"$bin/aftershade" sheet "$out/in" "$out/out" --frames 2,5,8 -o "$out/sheet.png"

echo
echo "input frames   $PWD/$out/in"
echo "output frames  $PWD/$out/out"
echo "picture        $PWD/$out/sheet.png"

#!/bin/sh
# Two comparisons that the makers of the effects showed, on synthetic scenes with exact truth: Vicarious Visions'
# current-gen set against DX11 (SIGGRAPH 2012), and what the temporal filters of Battlefield 3 do to flicker and trails
# (GDC 2012). Leaves reports, pictures and a table, and fails when the table does not show what it should. Does all the
# set-up by itself (packages, configure, build); running it again overwrites its results.
# AFTERSHADE_BIN: a folder with the programs, instead of building them; AFTERSHADE_OUT: where results go.
set -eu
cd "$(dirname "$0")/../.."

if [ -z "${AFTERSHADE_BIN:-}" ]; then
  tests/setup.sh aftershade make_scene
  AFTERSHADE_BIN=build/bin
fi
bin=$AFTERSHADE_BIN
out=${AFTERSHADE_OUT:-out/compare-generations}
own=examples/compare-generations/presets
mkdir -p "$out/in" "$out/truth"

echo "compare-generations: making a garden, a sliding box, and the garden's true AO and motion blur"
"$bin/make_scene" garden -o "$out/in" --frames 1-10 --size 320x180 --samples 4
"$bin/make_scene" trail -o "$out/in" --frames 1-12 --size 320x180 --samples 1
"$bin/make_scene" garden -o "$out/truth" --frames 8-10 --size 320x180 --samples 4 \
  --truth ao,blur --ao-rays 64 --blur-samples 16

# compare NAME SCENE [OPTION]...: reports and perhaps a sheet in $out/NAME
compare() {
  echo
  echo "compare-generations: $1"
  name=$1 scene=$2
  shift 2
  "$bin/aftershade" compare "$out/in/$scene.####.exr" -o "$out/$name" --quiet "$@"
}

current_gen=low-current-gen,high-current-gen,ultra-current-gen
dx11=low-dx11,high-dx11,ultra-dx11
compare generations-ao garden --frames 8-10 -p "$current_gen,$dx11,battlefield3-high,offline" --skip motion_blur \
  --reference "$out/truth/garden_ao.####.exr" --sheet ao --sheet-frames 9
compare generations-blur garden --frames 8-10 -p "$current_gen,$dx11,$own/dx11-many-taps.json,$own/dx11-no-limit.json" \
  --reference "$out/truth/garden_blur.####.exr" --only motion_blur --write-frames \
  --sheet color --sheet-frames 9 --sheet-region 150,95,120x60
compare generations-likeness garden --frames 8-10 -p high-current-gen,battlefield3-high --reference high-dx11 \
  --skip motion_blur --no-cost

# Flicker: what changes along the motion of surfaces. What stays behind movers, and where they were: against the same AO
# without a filter, so that what the AO itself has wrong does not count.
filters=$own/no-filter.json,$own/everywhere.json,battlefield3-high
variants=$own/everywhere-epsilon-inf.json,$own/everywhere-epsilon-0.1.json,$own/not-dilated.json
compare filters-flicker garden --frames 6-10 -p "$filters,$variants" --skip apply --no-cost
compare filters-trail trail --frames 6-12 -p "$filters,$variants" --skip apply --no-cost \
  --reference "$own/no-filter.json"
compare filters garden --frames 8-10 -p "$filters" --skip apply --sheet ao --sheet-frames 8-10 \
  --sheet-region 70,45,240x135

# score NAME PRESET METRIC: of the whole sequence, from $out/NAME/report.csv
score() {
  awk -F, -v preset="$2" -v metric="$3" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == metric) column = i }
    $1 == preset && $2 == "all" { print $column }' "$out/$1/report.csv"
}
# row PRESET NAME:METRIC...: a line of the table
row() {
  line="| $1" preset=$1
  shift
  for cell; do
    line="$line | $(score "${cell%%:*}" "$preset" "${cell#*:}" | awk '{ printf ($1 >= 1 ? "%.2f" : "%.4f"), $1 }')"
  done
  echo "$line |"
}
table() {
  echo "| AO beside the truth | ao_rmse | ao_correlation | ao_ssim |"
  echo "|---|---|---|---|"
  for preset in low-current-gen low-dx11 high-current-gen high-dx11 ultra-current-gen ultra-dx11 battlefield3-high \
    offline; do
    row $preset generations-ao:ao_rmse generations-ao:ao_correlation generations-ao:ao_ssim
  done
  echo
  echo "| motion blur beside the truth | psnr | ssim | ldr_flip |"
  echo "|---|---|---|---|"
  for preset in low-current-gen low-dx11 high-current-gen high-dx11 dx11-many-taps dx11-no-limit; do
    row $preset generations-blur:psnr generations-blur:ssim generations-blur:ldr_flip
  done
  echo
  echo "| frames with AO beside high-dx11 | ao_correlation | ssim | ldr_flip |"
  echo "|---|---|---|---|"
  for preset in high-current-gen battlefield3-high; do
    row $preset generations-likeness:ao_correlation generations-likeness:ssim generations-likeness:ldr_flip
  done
  echo
  echo "| temporal filter | flicker, unstable | flicker, stable | trail | visible share | disocclusion |"
  echo "|---|---|---|---|---|---|"
  for preset in no-filter everywhere-epsilon-inf everywhere-epsilon-0.1 everywhere not-dilated battlefield3-high; do
    row $preset filters-flicker:ao_flicker_unstable filters-flicker:ao_flicker_stable filters-trail:ao_trail \
      filters-trail:ao_trail_visible filters-trail:ao_disocclusion_error
  done
}
echo
table | tee "$out/table.md"

# What must come out, with room for other compilers and machines.
failed=0
claim() {
  if awk "BEGIN { exit !($2) }"; then echo "holds: $1"; else echo "DOES NOT HOLD: $1 ($2)"; failed=1; fi
}
ao() { score generations-ao "$1" ao_correlation; }
blur() { score generations-blur "$1" psnr; }
flicker() { score filters-flicker "$1" ao_flicker_unstable; }
trail() { score filters-trail "$1" "$2"; }
echo
for level in low high ultra; do
  claim "$level: the AO of DX11 is nearer to the truth than current-gen's" \
    "$(ao $level-dx11) > $(ao $level-current-gen) + 0.1"
done
claim "three times the taps change the blur little" "$(blur dx11-many-taps) < $(blur high-dx11) + 1"
claim "the temporal filter removes flicker" "$(flicker everywhere) < 0.5 * $(flicker no-filter)"
claim "it leaves dark trails behind movers" "$(trail everywhere ao_trail) < -0.02"
claim "the selective filter removes flicker too" "$(flicker battlefield3-high) < 0.5 * $(flicker no-filter)"
claim "and leaves no trails on stable pixels" \
  "$(trail battlefield3-high ao_trail_visible) < 0.1 * $(trail everywhere ao_trail_visible)"
claim "undilated it misses pixels that flicker" "$(flicker not-dilated) > 1.3 * $(flicker battlefield3-high)"
claim "epsilon 0.1 % leaves flicker" "$(flicker everywhere-epsilon-0.1) > 1.5 * $(flicker everywhere)"
claim "epsilon +Inf leaves ghosts" \
  "$(trail everywhere-epsilon-inf ao_disocclusion_error) > $(trail everywhere ao_disocclusion_error)"
"$bin/aftershade" score "$out/generations-blur/high-dx11" "$out/truth/garden_blur.####.exr" --require 'psnr>=25' --quiet

echo
echo "reports    $out/*/report.html"
echo "pictures   $out/*/sheet.png"
echo "table      $out/table.md"
exit $failed

#!/bin/sh
# Compares all shipped presets on real frames with ray-traced AO and true motion blur, and drives the page in a browser.
#   yard_report.sh AFTERSHADE FOLDER    the report goes to FOLDER/report, screenshots to FOLDER
# Exit status 77 without the frames of $AFTERSHADE_DATA, or without a browser.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
program=$1 folder=$2
yard=${AFTERSHADE_DATA:-$here/../../../shared/data}/yard
if [ ! -f "$yard/yard.0006.exr" ]; then
  echo "SKIPPED: THE REPORT OF REAL FRAMES WAS NOT MADE: there is no $yard" >&2
  exit 77
fi
mkdir -p "$folder"
"$program" compare "$yard/yard.####.exr" -p all --reference "$yard/yard_blur.####.exr" --reference "$yard/yard_ao.####.exr" \
  --frames 6-7 -o "$folder/report" -q
for preset in $("$program" presets list | cut -d ' ' -f 1); do
  grep -q "^$preset,all," "$folder/report/report.csv" || { echo "report.csv has no line of $preset" >&2; exit 1; }
done
size=$(wc -c < "$folder/report/report.html")
[ "$size" -le $((24 * 1024 * 1024)) ] || { echo "report.html has $size bytes" >&2; exit 1; }
exec "$here/browser/run.sh" --page "$folder/report/report.html" "$folder"

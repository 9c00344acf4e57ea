#!/bin/sh
# Opens report pages in a real browser and checks what they do (check.mjs).
#   run.sh MAKE_REPORT FOLDER        makes pages from made-up comparisons in FOLDER, then checks them in detail
#   run.sh --page REPORT.html FOLDER checks any report; screenshots go to FOLDER
# Exit status 77 where npm, node or chromium is missing. CHROMIUM names another browser.
set -eu
here=$(cd "$(dirname "$0")" && pwd)

browser=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)}
for need in node npm; do
  command -v "$need" >/dev/null || { echo "SKIPPED: THE REPORT PAGE WAS NOT TESTED: there is no $need" >&2; exit 77; }
done
[ -n "$browser" ] || { echo "SKIPPED: THE REPORT PAGE WAS NOT TESTED: there is no chromium" >&2; exit 77; }

if [ "$1" = --page ]; then
  page=$2 folder=$3
else
  page="" folder=$2
fi
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
cp "$here/package.json" "$here/package-lock.json" "$here"/*.mjs "$folder/"
if ! cmp -s "$here/package-lock.json" "$folder/node_modules/.installed"; then
  if ! (cd "$folder" && npm ci --no-audit --no-fund --ignore-scripts >npm.log 2>&1); then
    cat "$folder/npm.log" >&2
    echo "SKIPPED: THE REPORT PAGE WAS NOT TESTED: npm cannot install playwright-core" >&2
    exit 77
  fi
  cp "$here/package-lock.json" "$folder/node_modules/.installed"
fi

if [ -n "$page" ]; then
  node "$folder/check.mjs" --browser "$browser" --page "$page" --screenshots "$folder"
else
  "$1" "$folder"
  node "$folder/check.mjs" --browser "$browser" --samples "$folder" --screenshots "$folder"
fi

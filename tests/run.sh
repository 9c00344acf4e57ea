#!/bin/sh
# Builds and runs every test; all the set-up is done by itself. Arguments go to ctest: tests/run.sh -R preset
# Tests on real frames read the folder AFTERSHADE_DATA, by default ../shared/data beside the project; without it they skip.
set -eu
cd "$(dirname "$0")/.."

tests/setup.sh

if [ -z "${AFTERSHADE_DATA:-}" ] && [ -d ../shared/data ]; then
  AFTERSHADE_DATA=$(cd ../shared/data && pwd)
fi
if [ -n "${AFTERSHADE_DATA:-}" ]; then
  export AFTERSHADE_DATA
else
  echo "tests: AFTERSHADE_DATA is not set and ../shared/data does not exist: TESTS ON REAL FRAMES WILL BE SKIPPED" >&2
fi

exec ctest --preset release -j "$(nproc)" "$@"

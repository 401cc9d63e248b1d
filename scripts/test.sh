#!/bin/sh
# scripts/test.sh [CTEST-OPTION...]: builds and tests the release and the sanitizer preset. The
# last lines are ctest's own summary.
set -eu
for preset in release asan; do
    echo "== $preset"
    scripts/build.sh "$preset"
    ctest --preset "$preset" -j "$(nproc)" "$@"
done

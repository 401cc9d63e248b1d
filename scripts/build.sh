#!/bin/sh
# scripts/build.sh PRESET [TARGET]: configures (once) and builds a preset, or one target of it, on
# all cores.
set -eu
preset=$1
if [ ! -f "build/$preset/build.ninja" ]; then
    cmake --preset "$preset" > /dev/null
fi
cmake --build --preset "$preset" -j "$(nproc)" --target "${2:-all}"

#!/bin/sh
# tests/fuzz/run.sh SECONDS: builds the preset `fuzz` and runs each fuzzer for so long, starting from
# its seeds and from what earlier runs found. An input that fails stays in build/fuzz/found; replay it
# with build/fuzz/tests/fuzz/fuzz_NAME_replay FILE.
set -eu
seconds=${1:-60}
if ! command -v clang > /dev/null; then
    echo "run.sh: the fuzzers need clang; please run: apt-get install clang libclang-rt-dev" >&2
    exit 1
fi
scripts/build.sh fuzz fuzzers
here=build/fuzz/tests/fuzz
found=build/fuzz/found
mkdir -p "$found"
failed=
while read -r name max; do
    echo "== $name, $seconds s"
    corpus=build/fuzz/corpus/$name
    mkdir -p "$corpus"
    "$here/${name}_replay" --seeds "$corpus"
    if ! "$here/$name" -max_total_time="$seconds" -max_len="$max" -timeout=10 \
        -rss_limit_mb=2048 -malloc_limit_mb=1024 -print_final_stats=1 -verbosity=0 \
        -artifact_prefix="$found/$name-" "$corpus" 2> "$found/$name.log"; then
        failed="$failed $name"
        tail -n 30 "$found/$name.log"
    fi
    grep -E 'number_of_executed|average_exec|peak_rss' "$found/$name.log" || true
    echo "   $(find "$corpus" -type f | wc -l) inputs that reach something of their own"
done < "$here/list.txt"
if [ -n "$failed" ]; then
    echo "failed:$failed; the inputs are in $found" >&2
    exit 1
fi

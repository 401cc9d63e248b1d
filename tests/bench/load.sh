#!/bin/sh
# What a walk within a budget misses when another program takes a core in the middle of it.
#
#   tests/bench/load.sh [OPTION...] PROGRAM FOLDER MODEL:PATH...
#     -b LIST budgets in milliseconds ("33")
#     -s W,H  resolution (640,360)
#     -f N    frames a run (400)
#     -r N    runs of each (3)
#     -c N    core to load (the last)
#     -S NAME selector (the program's default)
#
# MODEL is a .prom file, PATH a camera path or `auto`. When a run has come
# to its middle, of which it writes a picture, a busy loop pinned to the core starts and runs to the
# end. Wanted are at most 8 misses in the first 30 frames after it starts, and at most 3 in the next
# 100; more is in bold. The first row shows the same of a run without the load. `infeasible` are
# those of the 130 frames in which even the cheapest cut was predicted above the budget.
# It measures times, so nothing else should keep the machine busy.
# Reports stay in FOLDER; FOLDER/load.md is the table, also printed.
set -eu
here=$(dirname "$0")
# shellcheck source-path=SCRIPTDIR
. "$here/common.sh"
budgets=33
size=640,360
frames=400
runs=3
core=$(($(nproc) - 1))
selector=""
while getopts b:s:f:r:c:S: option; do
    case $option in
    b) budgets=$OPTARG ;;
    s) size=$OPTARG ;;
    f) frames=$OPTARG ;;
    r) runs=$OPTARG ;;
    c) core=$OPTARG ;;
    S) selector=$OPTARG ;;
    *) usage ;;
    esac
done
shift $((OPTIND - 1))
[ $# -ge 3 ] || usage
program=$1
out=$2
shift 2
need jq awk taskset
[ "$frames" -ge 260 ] || die "-f $frames: 130 frames are looked at after the middle, 260 are needed"
taskset -c "$core" true 2> /dev/null || die "-c $core: there is no such core"
middle=$((frames / 2))
check_walks "$@"
mkdir -p "$out"

load=""
unload() {
    [ -z "$load" ] || kill "$load" 2> /dev/null || true
    load=""
}
trap unload EXIT
trap 'exit 1' INT TERM

# The load, from when the file $1 is there on; the time of its start goes into the file $2.
start_load() {
    (
        while [ ! -e "$1" ]; do sleep 0.05; done
        date +%s.%N > "$2"
        exec taskset -c "$core" sh -c 'while :; do :; done'
    ) &
    load=$!
}

# bench NAME: one run, kept as NAME.json and NAME.csv.
bench() {
    echo "$1: $frames frames" >&2
    "$program" bench "$model" --path "$path" --resolution "$size" --budget-ms "$budget" \
        --frames "$frames" --quality-frames 0 --keep-frames "$out/$1" --every "$middle" \
        ${selector:+--selector "$selector"} --report "$out/$1.json" --csv "$out/$1.csv" --quiet \
        > /dev/null
}

# middle_of NAME: when the frame after the picture began, in seconds since 1970.
middle_of() {
    awk -F, -v frame=$((middle + 1)) '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == "start_unix_s") column = i; next }
        $1 == frame { print $column; exit }' "$out/$1.csv"
}

# row NAME WHAT TIME: misses before and after a time.
row() {
    awk -F, -v from="$3" '
        NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
        {
            miss = $column["frame_ms"] > $column["budget_ms"]
            ms = $column["frame_ms"]
            if ($column["start_unix_s"] < from) { before++; missed += miss; calm += ms; next }
            k = after++
            if (k < 130) unfit += !$column["feasible"]
            if (k < 30) first += miss
            else if (k < 130) { next_ones += miss; loaded += ms }
            run = miss ? run + 1 : 0
            if (run > longest) longest = run
        }
        END {
            print before, missed + 0, after + 0, first + 0, next_ones + 0, longest + 0,
                before ? calm / before : 0, loaded / 100, unfit + 0
        }' "$out/$1.csv" | {
        read -r before missed after first next longest calm loaded unfit
        [ "$after" -ge 130 ] ||
            die "$1: only $after frames after the load began"
        echo "| $scene | $(echo "$size" | tr , x) | $budget | $2 | $before | $missed |" \
            "$(mark "$first" 8) | $(mark "$next" 3) | $longest |" \
            "$(printf '%.1f' "$calm") | $(printf '%.1f' "$loaded") | $unfit |"
    }
}

within() {
    tag=$(tag_of "$scene")-$(tag_of "$size")-$budget
    bench "$tag-calm"
    row "$tag-calm" none "$(middle_of "$tag-calm")"
    for run in $(seq "$runs"); do
        rm -rf "$out/$tag-$run" # the picture of an earlier run would start it at once
        start_load "$out/$tag-$run/frame-$(printf '%05d' "$middle").png" "$out/$tag-$run.start"
        bench "$tag-$run"
        unload
        row "$tag-$run" "core $core" "$(cat "$out/$tag-$run.start")"
    done
}

{
    echo "| scene | size | budget ms | load | frames before | misses before |" \
        "misses in the first 30 | in the next 100 | longest run after | mean ms before |" \
        "in the next 100 | infeasible |"
    echo "| --- | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    for pair in "$@"; do
        take_walk "$pair"
        for budget in $budgets; do within; done
    done
} | tee "$out/load.md"

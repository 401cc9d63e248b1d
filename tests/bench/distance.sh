#!/bin/sh
# `distance` against `greedy` at the same mean frame time: what fixed switching distances, the
# artists' own where the scene has some, show of a scene in the time that greedy takes.
#
#   tests/bench/distance.sh [OPTION...] PROGRAM FOLDER MODEL:PATH...
#     -f N    frames a run (300)
#     -a N    frames compared with full detail (30)
#     -s W,H  resolutions, with blanks between ("1280,720 640,360")
#     -b LIST budgets in percent of what `distance` takes by itself ("130 100"; greedy keeps some
#             20 % of its budget back)
#     -m LIST budgets in milliseconds instead
#
# MODEL is a .prom file, PATH a camera path or `auto`. For each budget greedy walks first; then the
# factor on the distances (--rule-scale) is found with which `distance` takes the same mean
# time: doubled or halved until the time is passed, then by bisection, until both are within 3 %
# in runs one after the other, whose figures are the rows. Where no factor does (within
# 1/64 to 64), the nearest is kept, and `ratio` says how far off it is.
# It measures times, so nothing else should keep the machine busy.
# Reports stay in FOLDER; FOLDER/distance.md is the table, also printed.
set -eu
here=$(dirname "$0")
# shellcheck source-path=SCRIPTDIR
. "$here/common.sh"
frames=300
compared=30
sizes="1280,720 640,360"
percents="130 100"
budgets=""
near=0.03
while getopts f:a:s:b:m: option; do
    case $option in
    f) frames=$OPTARG ;;
    a) compared=$OPTARG ;;
    s) sizes=$OPTARG ;;
    b) percents=$OPTARG ;;
    m) budgets=$OPTARG ;;
    *) usage ;;
    esac
done
shift $((OPTIND - 1))
[ $# -ge 3 ] || usage
program=$1
out=$2
shift 2
mkdir -p "$out"

mean_of() {
    jq -r '.runs[0].frame_ms.mean' "$out/$1.json"
}

# bench NAME SELECTOR BUDGET SCALE FRAMES COMPARED: one run on $model and $path at $size, kept as
# NAME.json and NAME.csv.
bench() {
    "$program" bench "$model" --path "$path" --resolution "$size" --selector "$2" \
        --budget-ms "$3" --rule-scale "$4" --frames "$5" --check-accuracy "$6" \
        --quality-frames "$6" --report "$out/$1.json" --csv "$out/$1.csv" --quiet > /dev/null
}

# try_scale: sets $time to the mean of `distance` at $factor.
try_scale() {
    bench "$tag-distance" distance "$budget" "$factor" "$frames" 0
    time=$(mean_of "$tag-distance")
    echo "$tag: scale $factor takes $time ms, greedy $target ms" >&2
}

# row SELECTOR SCALE RATIO
row() {
    jq -r --arg scene "$scene" --arg budget "$budget" --arg scale "$2" --arg ratio "$3" '
        def r(d): . * pow(10; d) | round / pow(10; d);
        .runs[0] | "| \($scene) | \(.resolution | join("x")) | \($budget | tonumber | r(1)) | " +
        "\(.selector) | \($scale) | \(.frame_ms.mean | r(1)) | \($ratio) | " +
        "\(.frame_ms.p95 | r(1)) | \(.accuracy.mean * 100 | r(2)) | " +
        "\(.accuracy.min * 100 | r(2)) | \(.accuracy.predicted * 100 | r(2)) | " +
        "\(.triangles.mean | round) |"' "$out/$tag-$1.json"
}

# compare: greedy at $budget and `distance` in the same time. What the machine does meanwhile
# moves both, so the search goes on from a new run of greedy when the last pair disagrees.
compare() {
    factor=1
    bench "$tag-greedy" greedy "$budget" 1 "$frames" 0
    for _ in 1 2 3; do
        target=$(mean_of "$tag-greedy")
        find_factor try_scale $near 0.03
        bench "$tag-greedy" greedy "$budget" 1 "$frames" "$compared"
        bench "$tag-distance" distance "$budget" "$factor" "$frames" "$compared"
        target=$(mean_of "$tag-greedy")
        time=$(mean_of "$tag-distance")
        if is_near $near || [ -n "$limit" ]; then break; fi
    done
    row greedy "" 1
    row distance "$(calc "$factor")" "$(calc "int(1000 * $time / $target + 0.5) / 1000")"
}

walk() {
    name=$(tag_of "$scene")-$(tag_of "$size")
    list=$budgets
    if [ -z "$list" ]; then
        bench "$name" distance 1000000 1 "$frames" 0
        mean=$(mean_of "$name")
        for percent in $percents; do
            list="$list $(calc "int($mean * $percent + 0.5) / 100")"
        done
    fi
    for budget in $list; do
        tag=$name-$budget
        compare
    done
}

{
    echo "| scene | size | budget ms | selector | scale | mean ms | ratio | p95 | accuracy % |" \
        "worst % | predicted % | triangles |"
    echo "| --- | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    for pair in "$@"; do
        take_walk "$pair"
        for size in $sizes; do walk; done
    done
} | tee "$out/distance.md"

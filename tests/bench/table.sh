#!/bin/sh
# The table of frame times: each selector on each model at 40, 20 and 10 % of the mean time of
# full detail, at two resolutions.
#
#   tests/bench/table.sh [OPTION...] PROGRAM FOLDER MODEL:PATH...
#     -f N   frames a run (300)
#     -F N   frames of `full`, which may be slow (60)
#     -s W,H resolutions, with blanks between ("1280,720 640,360")
#     -b LIST budgets in percent of the full mean ("40 20 10")
#
# MODEL is a .prom file, PATH a camera path or `auto`. Every report stays in FOLDER (JSON, and the
# same in CSV); FOLDER/table.md is the table, also printed.
set -eu
frames=300
full_frames=60
sizes="1280,720 640,360"
percents="40 20 10"
while getopts f:F:s:b: option; do
    case $option in
    f) frames=$OPTARG ;;
    F) full_frames=$OPTARG ;;
    s) sizes=$OPTARG ;;
    b) percents=$OPTARG ;;
    *) sed -n '2,12s/^# \{0,1\}//p' "$0" >&2; exit 1 ;;
    esac
done
shift $((OPTIND - 1))
if [ $# -lt 3 ]; then
    sed -n '2,12s/^# \{0,1\}//p' "$0" >&2
    exit 1
fi
program=$1
out=$2
shift 2
mkdir -p "$out"

# bench NAME MODEL PATH SIZE SELECTOR BUDGET FRAMES COMPARED: one run, kept as NAME.json, NAME.csv
# and NAME.txt.
bench() {
    echo "$1: $7 frames" >&2
    "$program" bench "$2" --path "$3" --resolution "$4" --selector "$5" --budget-ms "$6" \
        --frames "$7" --check-holes "$8" --check-accuracy "$8" --quality-frames "$8" \
        --report "$out/$1.json" --csv "$out/$1.csv" --quiet > "$out/$1.txt"
}

# row NAME SCENE SIZE BUDGET: one row of the table from a report. Misses are counted in the rows of
# the frames, so that a run that heeds no budget serves for each of them.
row() {
    misses=$(awk -F, -v b="$4" 'NR > 1 && $4 > b { n++ } END { printf "%.1f", 100 * n / (NR - 1) }' \
        "$out/$1.csv")
    jq -r --arg scene "$2" --arg size "$3" --arg budget "$4" --arg misses "$misses" '
        def r(d): . * pow(10; d) | round / pow(10; d);
        .runs[0] | ($budget | tonumber) as $b |
        "| \($scene) | \($size) | \($b | r(1)) | \(.selector) | \(.frame_ms.mean | r(1)) | " +
        "\(.frame_ms.p50 | r(1)) | \(.frame_ms.p95 | r(1)) | \(.frame_ms.max | r(1)) | " +
        "\($misses) | \(.frame_ms.mean / $b * 100 | round) | \(.triangles.mean | round) | " +
        "\(.select_ms.mean | r(2)) | \(.cut_nodes.mean | round) | " +
        "\(if .holes then .holes.mean * 100 | r(3) else "-" end) | " +
        "\(if .accuracy then .accuracy.mean * 100 | r(2) else "-" end) | " +
        "\(if .least_budget_ms then .least_budget_ms | r(1) else "" end) |"' "$out/$1.json"
}

# walk MODEL PATH SCENE SIZE: all selectors. `full`, `distance` and `coarsest` heed no budget and
# run once.
walk() {
    model=$1 path=$2 scene=$3 size=$4
    tag=$(echo "$scene" | tr / -)-$(echo "$size" | tr , x)
    bench "$tag-full" "$model" "$path" "$size" full 1000000 "$full_frames" 0
    for selector in distance coarsest; do
        bench "$tag-$selector" "$model" "$path" "$size" "$selector" 1000000 "$frames" 5
    done
    mean=$(jq -r '.runs[0].frame_ms.mean' "$out/$tag-full.json")
    for percent in $percents; do
        budget=$(jq -n "$mean * $percent | round / 100")
        for selector in meta greedy; do
            name=$tag-$selector-$percent
            bench "$name" "$model" "$path" "$size" "$selector" "$budget" "$frames" 5
            row "$name" "$scene" "$size" "$budget"
        done
        for selector in distance full coarsest; do
            row "$tag-$selector" "$scene" "$size" "$budget"
        done
    done
}

{
    echo "| scene | size | budget ms | selector | mean ms | p50 | p95 | max | misses % | use % |" \
        "triangles | select ms | nodes | holes % | accuracy % | least ms |"
    echo "| --- | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |" \
        "---: | ---: | ---: | ---: |"
    for pair in "$@"; do
        scene=$(basename "${pair%:*}" .prom)
        [ "${pair##*:}" = auto ] || scene=$scene/$(basename "${pair##*:}" .path)
        for size in $sizes; do walk "${pair%:*}" "${pair##*:}" "$scene" "$size"; done
    done
} | tee "$out/table.md"

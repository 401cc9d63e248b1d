#!/bin/sh
# What it is worth to know what is hidden: `greedy` with and without visibility, at the same
# budgets.
#
#   tests/bench/visibility.sh [OPTION...] PROGRAM FOLDER MODEL:PATH...
#     -f N    frames a run (300)
#     -q N    frames compared with full detail (30)
#     -s W,H  resolutions, with blanks between ("1280,720 640,360")
#     -b LIST budgets in percent of what `full` takes ("20 40 60 80")
#     -v LIST modes of --visibility ("none frame"; for models with view cells "none frame cells
#             both")
#
# MODEL is a .prom file, PATH a camera path or `auto`. `time for the same loss` is the part of the
# frame time of `none` that a mode needs for the loss that `none` has at that budget, interpolated
# between its runs; empty where none of its runs lost as much or as little.
# It measures times, so nothing else should keep the machine busy.
# Reports stay in FOLDER; FOLDER/visibility.md is the table, also printed.
set -eu
here=$(dirname "$0")
# shellcheck source-path=SCRIPTDIR
. "$here/common.sh"
frames=300
compared=30
sizes="1280,720 640,360"
percents="20 40 60 80"
modes="none frame"
while getopts f:q:s:b:v: option; do
    case $option in
    f) frames=$OPTARG ;;
    q) compared=$OPTARG ;;
    s) sizes=$OPTARG ;;
    b) percents=$OPTARG ;;
    v) modes=$OPTARG ;;
    *) usage ;;
    esac
done
shift $((OPTIND - 1))
[ $# -ge 3 ] || usage
program=$1
out=$2
shift 2
mkdir -p "$out"

# bench NAME SELECTOR MODE BUDGET COMPARED: one run on $model and $path at $size, as NAME.json.
bench() {
    "$program" bench "$model" --path "$path" --resolution "$size" --selector "$2" \
        --visibility "$3" --budget-ms "$4" --frames "$frames" --quality-frames "$5" \
        --check-holes "$5" --report "$out/$1.json" --csv "$out/$1.csv" --quiet > /dev/null
}

# All runs of one walk, so that the loss of one can be looked up among those of another.
rows() {
    jq -r -s --arg scene "$scene" --arg full "$full" '
        def r(d): . * pow(10; d) | round / pow(10; d);
        def time_at(loss): sort_by(.quality.loss) as $s
            | [range(0; ($s | length) - 1)
               | {a: $s[.], b: $s[. + 1]}
               | select(.a.quality.loss <= loss and loss <= .b.quality.loss)]
            | if length == 0 then null else .[0]
              | (.b.quality.loss - .a.quality.loss) as $d
              | (if $d > 0 then (loss - .a.quality.loss) / $d else 0 end) as $t
              | .a.frame_ms.mean + $t * (.b.frame_ms.mean - .a.frame_ms.mean) end;
        [.[].runs[0]] as $all
        | $all[]
        | . as $run
        | ([$all[] | select(.visibility == "none" and .budget_ms == $run.budget_ms)] | .[0])
          as $none
        | ([$all[] | select(.visibility == $run.visibility)] | time_at($none.quality.loss))
          as $time
        | "| \($scene) | \(.resolution | join("x")) | \(.budget_ms | r(1)) | " +
          "\(.budget_ms / ($full | tonumber) * 100 | round) | \(.visibility) | " +
          "\(.frame_ms.mean | r(1)) | \(.frame_ms.p95 | r(1)) | \(.miss_rate * 100 | r(1)) | " +
          "\(.infeasible_frames) | \(.quality.mean | r(4)) | \(.quality.loss * 100 | r(2)) | " +
          "\(if .visibility == "none" or $time == null then ""
             else $time / $none.frame_ms.mean | r(2) end) | " +
          "\(.quality.hidden_cost * 100 | r(1)) | \(.cut_nodes.mean | round) | " +
          "\(.triangles.mean | round) | \(.select_ms.mean | r(2)) | \(.predict.mape * 100 | r(1)) | " +
          "\(.predict.worst_under * 100 | round) | \(.holes.max * 100 | r(3)) |"' "$@"
}

walk() {
    name=$(echo "$scene" | tr / -)-$(echo "$size" | tr , x)
    bench "$name-full" full none 1000000 0
    full=$(jq -r '.runs[0].frame_ms.mean' "$out/$name-full.json")
    files=""
    for percent in $percents; do
        budget=$(awk "BEGIN { printf \"%.2f\", $full * $percent / 100 }" < /dev/null)
        for mode in $modes; do
            echo "$name: $percent % of $full ms, $mode" >&2
            bench "$name-$percent-$mode" greedy "$mode" "$budget" "$compared"
            files="$files $out/$name-$percent-$mode.json"
        done
    done
    # shellcheck disable=SC2086 # names without blanks
    rows $files
}

{
    echo "| scene | size | budget ms | % of full | visibility | mean ms | p95 | misses % |" \
        "infeasible | FLIP | loss % | time for the same loss | hidden cost % | nodes |" \
        "triangles | select ms | predict error % | worst under % | worst holes % |"
    echo "| --- | --- | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |" \
        "---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    for walk in "$@"; do
        model=${walk%%:*}
        path=${walk#*:}
        scene=$(basename "$model" .prom)/$(basename "$path" .path)
        for size in $sizes; do walk; done
    done
} | tee "$out/visibility.md"

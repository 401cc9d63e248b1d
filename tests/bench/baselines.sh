#!/bin/sh
# What each baseline loses at the same p95 of frame time as the default.
#
#   tests/bench/baselines.sh [OPTION...] PROGRAM FOLDER MODEL:PATH...
#     -f N    frames a run (300)
#     -q N    frames compared with full detail (30)
#     -F N    frames of `full`, which may be slow (60)
#     -s W,H  resolutions, with blanks between ("640,360")
#     -b LIST budgets in percent of the full mean ("10 20 40")
#     -t LIST budgets in milliseconds instead
#     -S NAME what they are compared with (the program's default)
#     -B LIST baselines ("meta funkhouser feedback distance pixels sse")
#     -P FILE a cost profile: nothing is measured, and the mean predicted time of drawing takes
#             the place of p95; -b does not work then
#
# MODEL is a .prom file, PATH a camera path or `auto`. For each budget, each baseline's parameter is
# searched until its p95 is within 5 % of the default's, which walks just before it each time:
# --budget-ms of `meta`, `funkhouser` and `feedback`, --rule-scale of the others, doubled or halved
# until the time is passed, then by bisection. Where none does (within 1/64 to 64 of where it
# began), the nearest is kept, and `ratio` says how far off it is. Both then walk once more,
# compared with full detail; these are the rows. In bold: FLIP and loss that are less than the
# default's.
# It measures times, so nothing else should keep the machine busy, but with -P.
# Reports stay in FOLDER; FOLDER/baselines.md is the table, also printed.
set -eu
here=$(dirname "$0")
# shellcheck source-path=SCRIPTDIR
. "$here/common.sh"
frames=300
compared=30
full_frames=60
sizes="640,360"
percents="10 20 40"
budgets=""
ours=""
baselines="meta funkhouser feedback distance pixels sse"
profile=""
near=0.05
while getopts f:q:F:s:b:t:S:B:P: option; do
    case $option in
    f) frames=$OPTARG ;;
    q) compared=$OPTARG ;;
    F) full_frames=$OPTARG ;;
    s) sizes=$OPTARG ;;
    b) percents=$OPTARG ;;
    t) budgets=$OPTARG ;;
    S) ours=$OPTARG ;;
    B) baselines=$OPTARG ;;
    P) profile=$OPTARG near=0.02 ;;
    *) usage ;;
    esac
done
shift $((OPTIND - 1))
[ $# -ge 3 ] || usage
[ -z "$profile" ] || [ -n "$budgets" ] || die "-P needs -t: full detail is not timed"
program=$1
out=$2
shift 2
need jq awk
check_walks "$@"
mkdir -p "$out"

# bench NAME COMPARED OPTION...: one run, kept as NAME.json.
bench() {
    name=$1 quality=$2
    shift 2
    "$program" bench "$model" --path "$path" --resolution "$size" --frames "$frames" \
        --quality-frames "$quality" --report "$out/$name.json" --quiet \
        ${profile:+--profile "$profile"} "$@" > /dev/null
}

bench_ours() {
    bench "$tag-ours" "$1" --budget-ms "$budget" ${ours:+--selector "$ours"}
}

# bench_baseline COMPARED: $baseline with its parameter at $factor of where the search began.
bench_baseline() {
    case $baseline in
    meta | funkhouser | feedback)
        value=$(calc "$budget * $factor")
        set -- "$1" --budget-ms "$value" ;;
    *)
        value=$(calc "$factor")
        set -- "$1" --budget-ms "$budget" --rule-scale "$value" ;;
    esac
    quality=$1
    shift
    bench "$tag-$baseline" "$quality" --selector "$baseline" "$@"
}

# time_of NAME: what is made equal.
if [ -n "$profile" ]; then time_key=predicted_ms.mean; else time_key=frame_ms.p95; fi
time_of() {
    jq -r ".runs[0].$time_key" "$out/$1.json"
}

# pair [COMPARED]: ours and the baseline one after the other, since what the machine does meanwhile
# moves both; sets $target and $time.
pair() {
    bench_ours "${1:-0}"
    bench_baseline "${1:-0}"
    target=$(time_of "$tag-ours")
    time=$(time_of "$tag-$baseline")
    echo "$tag: $baseline at $value takes $time ms ($time_key), ours $target" >&2
}

# row NAME PARAMETER: against the run of ours.
row() {
    jq -r -s --arg scene "$scene" --arg budget "$budget" --arg parameter "$2" '
        def r(d): . * pow(10; d) | round / pow(10; d);
        def least(text; mine; theirs): if mine < theirs then "**\(text)**" else "\(text)" end;
        .[1].runs[0] as $ours | .[0].runs[0]
        | "| \($scene) | \(.resolution | join("x")) | \($budget | tonumber | r(1)) | " +
          "\(.selector) | \($parameter) | \(.frame_ms.mean | r(1)) | \(.frame_ms.p95 | r(1)) | " +
          "\(.'"$time_key"' / $ours.'"$time_key"' | r(2)) | \(.miss_rate * 100 | r(1)) | " +
          "\(least(.quality.mean | r(4); .quality.mean; $ours.quality.mean)) | " +
          "\(least(.quality.loss * 100 | r(2); .quality.loss; $ours.quality.loss)) | " +
          "\(.switches.mean | r(1)) | \(.triangles.mean | round) |"' \
        "$out/$1.json" "$out/$tag-ours.json"
}

# compare: searches, then looks at the pictures; again from there where noise has misled it.
compare() {
    factor=1
    for _ in 1 2 3; do
        find_factor pair $near 0.02
        pair "$compared"
        if is_near $near || [ -n "$limit" ]; then break; fi
    done
    row "$tag-ours" "$budget ms"
    case $baseline in
    meta | funkhouser | feedback) row "$tag-$baseline" "$value ms" ;;
    *) row "$tag-$baseline" "scale $value" ;;
    esac
}

walk() {
    list=$budgets
    name=$(tag_of "$scene")-$(tag_of "$size")
    if [ -z "$list" ]; then
        mean=$(full_mean "$name-full" "$full_frames")
        for percent in $percents; do
            list="$list $(calc "int($mean * $percent + 0.5) / 100")"
        done
    fi
    for budget in $list; do
        tag=$name-$budget
        for baseline in $baselines; do compare; done
    done
}

{
    echo "| scene | size | budget ms | selector | parameter | mean ms | p95 | ratio | misses % |" \
        "FLIP | loss % | switches | triangles |"
    echo "| --- | --- | ---: | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    for walk in "$@"; do
        take_walk "$walk"
        for size in $sizes; do walk; done
    done
} | tee "$out/baselines.md"

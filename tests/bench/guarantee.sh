#!/bin/sh
# Whether frames keep to their budgets, and use them: walks within shares of what full detail takes,
# and within fixed times, beside the noise floor of the machine.
#
#   tests/bench/guarantee.sh [OPTION...] PROGRAM FOLDER [MODEL:PATH]...
#     -m DIR  walk the four shared scenes too, as run.sh has built them in DIR/models; their paths
#             come from $PROM_SHARED/scenes/paths (../shared)
#     -f N    frames a run (300)
#     -F N    frames of `full`, which may be slow (60)
#     -n N    frames of the noise floor, one fixed cut drawn between the walk's frames (300)
#     -a A    misses that are accepted (0.01)
#     -s W,H  resolutions, with blanks between ("1280,720 640,360")
#     -b LIST budgets in percent of the full mean ("10 20 40")
#     -t LIST budgets in milliseconds ("16 33 66")
#     -S NAME selector (the program's default)
#
# MODEL is a .prom file, PATH a camera path or `auto`. `use` and `std` are those of the contested
# frames (full detail would exceed the budget, the cheapest cut fits) against the fixed cut's mean
# / p99 and standard deviation; `misses` are those of the whole run, with the interval that holds
# the true rate at 95 %, and in each quarter. `falls short` names what is not as wanted: use below
# 0.9, std above 1.5, misses (the whole interval above A; of the contested frames where others
# cannot fit), quarter (as many misses in one have a chance of 2.5 % or less at A), run (longest
# above 2), turn (more than 3 in the 100 frames after one), gap (mean above 3 %, p99 above 20 %).
# It measures times, so nothing else should keep the machine busy.
# Reports stay in FOLDER; FOLDER/guarantee.md is the table, also printed.
set -eu
here=$(dirname "$0")
# shellcheck source-path=SCRIPTDIR
. "$here/common.sh"
frames=300
full_frames=60
floor=300
accepted=0.01
sizes="1280,720 640,360"
percents="10 20 40"
times="16 33 66"
selector=""
built=""
while getopts m:f:F:n:a:s:b:t:S: option; do
    case $option in
    m) built=$OPTARG ;;
    f) frames=$OPTARG ;;
    F) full_frames=$OPTARG ;;
    n) floor=$OPTARG ;;
    a) accepted=$OPTARG ;;
    s) sizes=$OPTARG ;;
    b) percents=$OPTARG ;;
    t) times=$OPTARG ;;
    S) selector=$OPTARG ;;
    *) usage ;;
    esac
done
shift $((OPTIND - 1))
[ $# -ge 2 ] || usage
program=$1
out=$2
shift 2
need jq awk
paths=${PROM_SHARED:-../shared}/scenes/paths
if [ -n "$built" ]; then
    set -- "$@" "$built/models/sponza.prom:$paths/sponza_court.path" \
        "$built/models/candela_city.prom:$paths/candela_city_walk.path" \
        "$built/models/black_forest.prom:$paths/black_forest_walk.path" \
        "$built/models/forza.prom:auto"
fi
[ $# -ge 1 ] || usage
check_walks "$@"
mkdir -p "$out"

# row NAME SHARE: one row of the table; SHARE of the full mean, or empty.
row() {
    jq -r --arg scene "$scene" --arg share "$2" --argjson a "$accepted" '
        def r(d): . * pow(10; d) | round / pow(10; d);
        def cell(f): if . == null then "" else f end;
        # The chance of k misses or more in n frames.
        def chance(n; k): reduce range(0; k) as $i
            ({left: 1, term: pow(1 - $a; n)};
             {left: (.left - .term), term: (.term * (n - $i) / ($i + 1) * $a / (1 - $a))}) | .left;
        .runs[0] | . as $run
        | (.contested // {frames: 0}) as $c
        | (if .infeasible_frames > 0 and $c.frames > 0 then $c.misses else .misses end) as $fair
        | [if .use_of_floor != null and .use_of_floor < 0.9 then "use" else empty end,
           if .std_of_floor != null and .std_of_floor > 1.5 then "std" else empty end,
           if $fair.rate_low > $a then "misses" else empty end,
           if .infeasible_frames == 0 and
              any(.misses.quarters[]; . > 0 and chance($run.frames / 4; .) <= 0.025)
           then "quarter" else empty end,
           if $fair.longest_run > 2 then "run" else empty end,
           if .infeasible_frames == 0 and (.after_turn.most_misses // 0) > 3
           then "turn" else empty end,
           if .gap != null and (.gap.mean > 0.03 or .gap.p99 > 0.2) then "gap" else empty end
          ] as $short
        | "| \($scene) | \(.resolution | join("x")) | \(.budget_ms | r(1)) | \($share) | " +
          "\($c.frames) | \(.use_of_floor | cell(r(2))) | \(.std_of_floor | cell(r(2))) | " +
          "\(.miss_rate * 100 | r(2)) | \(.misses.rate_low * 100 | r(2)) to " +
          "\(.misses.rate_high * 100 | r(2)) | \(.misses.quarters | map(tostring) | join(" ")) | " +
          "\($c.misses.count // 0) | \(.misses.longest_run) | " +
          "\(.after_turn.most_misses // 0) of \(.after_turn.turns // 0) turns | " +
          "\(.infeasible_frames) | \(.gap | cell(.mean * 100 | r(2))) | " +
          "\(.gap | cell(.p99 * 100 | r(2))) | \($short | join(", ")) |"' "$out/$1.json"
}

# within BUDGET SHARE: one run and its row.
within() {
    name=$tag-$1
    echo "$name: $frames frames" >&2
    "$program" bench "$model" --path "$path" --resolution "$size" --budget-ms "$1" \
        --miss-rate "$accepted" --frames "$frames" --noise-floor "$floor" --quality-frames 0 \
        ${selector:+--selector "$selector"} --report "$out/$name.json" --csv "$out/$name.csv" \
        --quiet > "$out/$name.txt"
    row "$name" "$2"
}

walk() {
    tag=$(tag_of "$scene")-$(tag_of "$size")
    mean=$(full_mean "$tag-full" "$full_frames")
    for percent in $percents; do
        within "$(calc "int($mean * $percent + 0.5) / 100")" "$percent"
    done
    for budget in $times; do
        within "$budget" "$(calc "int(100 * $budget / $mean + 0.5)")"
    done
}

{
    echo "| scene | size | budget ms | % of full | contested | use of floor | std of floor |" \
        "misses % | interval % | by quarter | contested misses | longest run | after turns |" \
        "infeasible | gap mean % | gap p99 % | falls short |"
    echo "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | --- | --- | ---: | ---: |" \
        "---: | ---: | ---: | ---: | --- |"
    for pair in "$@"; do
        take_walk "$pair"
        for size in $sizes; do walk; done
    done
} | tee "$out/guarantee.md"

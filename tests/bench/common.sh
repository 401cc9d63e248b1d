# shellcheck shell=sh
# What the bench scripts share; `. "$(dirname "$0")/common.sh"`.

# usage: the comment at the top of the script, up to the first line of code.
usage() {
    awk 'NR > 1 { if (!/^#/) exit; sub(/^# ?/, ""); print }' "$0" >&2
    exit 1
}

die() {
    echo "$(basename "$0"): $*" >&2
    exit 1
}

# need TOOL...: fails early where one is missing.
need() {
    for tool in "$@"; do
        command -v "$tool" > /dev/null || die "needs \`$tool\`, which is not installed"
    done
}

# calc EXPRESSION: its value, by awk.
calc() {
    awk "BEGIN { printf \"%.6g\", ($1) }" < /dev/null
}

# holds CONDITION: whether it is true, by awk.
holds() {
    awk "BEGIN { exit !($1) }" < /dev/null
}

# check_walks MODEL:PATH...: that all of them can be read.
check_walks() {
    for pair in "$@"; do
        case $pair in *:*) ;; *) die "$pair: expected MODEL:PATH" ;; esac
        [ -r "${pair%:*}" ] || die "${pair%:*}: cannot be read"
        [ "${pair##*:}" = auto ] || [ -r "${pair##*:}" ] || die "${pair##*:}: cannot be read"
    done
}

# take_walk MODEL:PATH: sets $model, $path and $scene.
take_walk() {
    model=${1%:*}
    path=${1##*:}
    scene=$(basename "$model" .prom)
    [ "$path" = auto ] || scene=$scene/$(basename "$path" .path)
}

# tag_of TEXT: TEXT as part of a file's name.
tag_of() {
    echo "$1" | tr '/, ' '-x-'
}

# mark N LIMIT: for a cell of a table, in bold where it is above the limit.
mark() {
    if holds "$1 > $2"; then echo "**$1**"; else echo "$1"; fi
}

# find_factor TRY NEAR APART: doubles or halves $factor until TRY's $time has passed $target, then
# bisects, until they are within NEAR of each other (0.05: 5 %). Ends too where two factors with
# nothing between them differ by less than APART; sets $limit when it would have to go beyond 1/64
# or 64. TRY is a command that sets $time and $target.
# shellcheck disable=SC2034,SC2154 # limit is for the caller; time, target are set by TRY
find_factor() {
    low="" high="" limit=""
    for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14; do
        "$1"
        if is_near "$2"; then return; fi
        if holds "$time < $target"; then low=$factor; else high=$factor; fi
        if [ -z "$high" ]; then
            if holds "$low >= 64"; then limit=yes && return; fi
            factor=$(calc "$low * 2 < 64 ? $low * 2 : 64")
        elif [ -z "$low" ]; then
            if holds "$high <= 1 / 64"; then limit=yes && return; fi
            factor=$(calc "$high / 2 > 1 / 64 ? $high / 2 : 1 / 64")
        else
            # It jumps, or noise has put one on the wrong side: there is nothing between them.
            if holds "$high / $low < 1 + $3"; then return; fi
            factor=$(calc "sqrt($low * $high)")
        fi
    done
}

# is_near NEAR: whether $time is within NEAR of $target.
is_near() {
    holds "$time / $target <= 1 + $1 && $time / $target >= 1 - $1"
}

# full_mean NAME FRAMES: mean time of full detail on $model and $path at $size, by a run of
# $program kept as $out/NAME.json.
# shellcheck disable=SC2154 # set by the script
full_mean() {
    "$program" bench "$model" --path "$path" --resolution "$size" --selector full \
        --budget-ms 1000000 --frames "$2" --quality-frames 0 --report "$out/$1.json" --quiet \
        > /dev/null
    jq -r '.runs[0].frame_ms.mean' "$out/$1.json"
}

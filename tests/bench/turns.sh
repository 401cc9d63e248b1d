#!/bin/sh
# How soon the picture is as good as it gets after a quick turn, a step round a corner and a jump,
# with each mode of --visibility.
#
#   tests/bench/turns.sh [OPTION...] PROGRAM FOLDER MODEL:PATH:KEY[:STEP]...
#     -b MS   budget (33)
#     -s W,H  resolution (1280,720)
#     -v LIST modes ("none frame"; with view cells "none frame cells both")
#     -p      keep pictures of the first frames after each event
#
# KEY is the key of the camera path (from 0) at which all starts. After 30 frames there:
#   turn      90 degrees to the left in 3 frames;
#   corner    STEP keys (60) further along the path in 4 frames;
#   jump      to the key half the path away, at once.
# Then 30 frames of rest. `settled` is the mean loss of the last ten; `frames` how many frames of
# rest pass until the loss stays within 10 % of it (or a thousandth of the picture, which nobody
# sees); `first` the loss of the first of them.
# FOLDER/turns.md is the table, also printed.
set -eu
here=$(dirname "$0")
# shellcheck source-path=SCRIPTDIR
. "$here/common.sh"
budget=33
size="1280,720"
modes="none frame"
pictures=""
while getopts b:s:v:p option; do
    case $option in
    b) budget=$OPTARG ;;
    s) size=$OPTARG ;;
    v) modes=$OPTARG ;;
    p) pictures=yes ;;
    *) usage ;;
    esac
done
shift $((OPTIND - 1))
[ $# -ge 3 ] || usage
program=$1
out=$2
shift 2
mkdir -p "$out"

# make_path EVENT: the camera path of an event from $path, key $key, on stdout.
make_path() {
    grep -v '^#' "$path" | awk -v event="$1" -v from="$key" -v step="$step" '
        function put(k, turn, c, s, x, y, z, w) {
            split(keys[k], f)
            c = cos(turn / 2); s = sin(turn / 2) # turned about +y, to the left
            x = f[5]; y = f[6]; z = f[7]; w = f[8]
            printf "%.4f %s %s %s %.9f %.9f %.9f %.9f\n", (n++) / 30, f[2], f[3], f[4],
                c * x + s * z, c * y + s * w, c * z - s * x, c * w - s * y
        }
        function key(k) { return k < count ? k : count - 1 }
        { keys[count++] = $0 }
        END {
            for (i = 0; i < 30; i++) put(key(from), 0)
            if (event == "turn") {
                for (i = 1; i <= 3; i++) put(key(from), i * atan2(1, 0) / 3)
                for (i = 0; i < 30; i++) put(key(from), atan2(1, 0))
            } else if (event == "corner") {
                for (i = 1; i <= 4; i++) put(key(from + int(i * step / 4)), 0)
                for (i = 0; i < 30; i++) put(key(from + step), 0)
            } else {
                to = (from + int(count / 2)) % count
                for (i = 0; i < 30; i++) put(key(to), 0)
            }
        }'
}

# row EVENT MODE: from the CSV; the last 30 frames are those of rest.
row() {
    awk -F, -v scene="$scene" -v event="$1" -v mode="$2" '
        NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
        { loss[n] = $column["loss"]; flip[n] = $column["flip"]; holes[n++] = $column["holes"] }
        END {
            start = n - 30
            for (i = n - 10; i < n; i++) settled += loss[i] / 10
            for (i = n - 1; i >= start; i--)
                if (loss[i] > settled * 1.1 + 0.001) break
            for (k = 0; k < n; k++) if (holes[k] > worst) worst = holes[k]
            printf "| %s | %s | %s | %.2f | %.2f | %d | %.4f | %.4f | %.3f |\n", scene, event, mode,
                loss[start] * 100, settled * 100, i + 1 - start, flip[start], flip[n - 1],
                worst * 100
        }' "$out/$name.csv"
}

event() {
    make_path "$1" > "$out/$tag-$1.path"
    frames=$(wc -l < "$out/$tag-$1.path")
    for mode in $modes; do
        name=$tag-$1-$mode
        set -- "$1" --report "$out/$name.json"
        if [ -n "$pictures" ]; then
            set -- "$@" --keep-frames "$out/$name" --every 1
        fi
        event=$1
        shift
        "$program" bench "$model" --path "$out/$tag-$event.path" --resolution "$size" \
            --visibility "$mode" --budget-ms "$budget" --frames "$frames" \
            --quality-frames "$frames" --check-holes "$frames" --csv "$out/$name.csv" "$@" \
            --quiet > /dev/null
        row "$event" "$mode"
        set -- "$event"
    done
}

{
    echo "| scene | event | visibility | first loss % | settled % | frames | first FLIP |" \
        "settled FLIP | worst holes % |"
    echo "| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |"
    for walk in "$@"; do
        model=${walk%%:*}
        rest=${walk#*:}
        path=${rest%%:*}
        rest=${rest#*:}
        key=${rest%%:*}
        step=60
        [ "$key" = "$rest" ] || step=${rest#*:}
        scene=$(basename "$model" .prom)/$(basename "$path" .path)
        tag=$(echo "$scene" | tr / -)-$key
        for kind in turn corner jump; do event $kind; done
    done
} | tee "$out/turns.md"

#!/bin/sh
# Our simplification against meshoptimizer's and OpenSceneGraph's: distance, looks and time at some
# numbers of triangles.
#
#   tests/bench/simplify.sh [OPTION...] PROGRAM FOLDER MODEL...
#     -p LIST  percent of the triangles to keep ("50 25 10 5 2")
#     -b FILE  the program bench_simplify (tests/bench_simplify in PROGRAM's build folder)
#     -l S     seconds that OpenSceneGraph may take for a model (900); 0 leaves it out
#
# OpenSceneGraph takes part where its headers are installed (pkg-config openscenegraph-osgUtil); its
# program is compiled into FOLDER. All start from the model as `simplify` mends it, and are compared
# with that by `compare-mesh` (26 views at 256 px). Times are of simplification alone. The least
# value among those who came within 2 % of the number is in bold. FOLDER/MODEL.md is the table,
# also printed.
set -eu
here=$(dirname "$0")
# shellcheck source-path=SCRIPTDIR
. "$here/common.sh"
percents="50 25 10 5 2"
bench=""
limit_s=900
while getopts p:b:l: option; do
    case $option in
    p) percents=$OPTARG ;;
    b) bench=$OPTARG ;;
    l) limit_s=$OPTARG ;;
    *) usage ;;
    esac
done
shift $((OPTIND - 1))
[ $# -ge 3 ] || usage
program=$1
out=$2
shift 2
bench=${bench:-$(dirname "$program")/../tests/bench_simplify}
need jq awk
[ -x "$bench" ] || die "$bench: is not there; build it (\`ninja bench_simplify\`) or name it by -b"
for model in "$@"; do
    [ -r "$model" ] || die "$model: cannot be read"
done
mkdir -p "$out"

# build_osg: sets $osg to OpenSceneGraph's program, or to nothing.
build_osg() {
    osg=""
    [ "$limit_s" != 0 ] || return 0
    if ! pkg-config --exists openscenegraph-osgUtil 2> /dev/null; then
        echo "$(basename "$0"): without OpenSceneGraph, which is not installed" >&2
        return 0
    fi
    osg=$out/bench_osg_simplify
    # shellcheck disable=SC2046 # a list of flags
    "${CXX:-c++}" -std=c++17 -O2 -o "$osg" "$here/bench_osg_simplify.cpp" \
        $(pkg-config --cflags --libs openscenegraph-osgUtil)
}

# simplify MODEL DIR: all meshes, and DIR/times.csv.
simplify() {
    # shellcheck disable=SC2086 # a list
    "$bench" "$1" "$2" $percents > "$2/times.csv" 2> "$2/err" ||
        die "$1: $(tail -n 1 "$2/err")"
    [ -n "$osg" ] || return 0
    # shellcheck disable=SC2086
    timeout "$limit_s" "$osg" "$2" $percents >> "$2/times.csv" 2>> "$2/err" ||
        echo "$(basename "$0"): $1: OpenSceneGraph did not end in $limit_s s" >&2
}

# measure DIR: adds to each line of times.csv RMS and Hausdorff distance in percent, and FLIP.
measure() {
    while IFS=, read -r method percent target triangles ms; do
        report=$1/$method-$percent.json
        found="-,-,-"
        if [ "$triangles" -gt 0 ] && "$program" compare-mesh "$1/base.obj" \
            "$1/$method-$percent.obj" --size-px 256 --report "$report" --quiet \
            > /dev/null 2> "$1/err"; then
            found=$(jq -r '[.rms_percent, .hausdorff_percent,
                (.looks[] | select(.metric == "flip") | .mean)] | @csv' "$report")
        fi
        echo "$method,$percent,$target,$triangles,$ms,$found"
    done < "$1/times.csv" > "$1/all.csv"
}

# table DIR
table() {
    awk -F, -v percents="$percents" '
        function cell(value, best, format) {
            if (value == "-") return "-"
            text = sprintf(format, value)
            return value == best ? "**" text "**" : text
        }
        { row[NR] = $0 }
        # Who keeps more triangles than were asked for has an easy time.
        $4 <= 1.02 * $3 + 2 {
            for (k = 5; k <= 8; k++)
                if ($k != "-" && (!(($2, k) in best) || $k + 0 < best[$2, k])) best[$2, k] = $k + 0
        }
        $1 == "meshoptimizer" { theirs[$2] = $5 }
        END {
            print "| % | method | triangles | RMS % | Hausdorff % | FLIP | ms | x meshoptimizer |"
            print "| ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: |"
            count = split(percents, list, " ")
            for (p = 1; p <= count; p++)
                for (i = 1; i <= NR; i++) {
                    split(row[i], f, ",")
                    if (f[2] != list[p]) continue
                    missed = f[4] > 1.02 * f[3] + 2 ? " (not " f[3] ")" : ""
                    printf "| %s | %s | %s%s | %s | %s | %s | %s | %.1f |\n", f[2], f[1], f[4],
                        missed, cell(f[6], best[f[2], 6], "%.4f"),
                        cell(f[7], best[f[2], 7], "%.3f"), cell(f[8], best[f[2], 8], "%.5f"),
                        cell(f[5], best[f[2], 5], "%.0f"), f[5] / theirs[f[2]]
                }
        }' "$1/all.csv"
}

build_osg
for model in "$@"; do
    name=$(basename "$model")
    name=${name%.*}
    mkdir -p "$out/$name"
    simplify "$model" "$out/$name"
    measure "$out/$name"
    {
        echo "### $name"
        echo
        table "$out/$name"
        echo
    } | tee "$out/$name.md"
done

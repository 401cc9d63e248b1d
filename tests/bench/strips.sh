#!/bin/sh
# A strip of pictures of one frame: full detail, `meta` and `greedy` at three budgets, and what
# `greedy` chose in false colours.
#
#   tests/bench/strips.sh PROGRAM MODEL PATH FRAME SIZE OUT.png BUDGET_MS...
#
# Rows: full; meta; greedy; greedy by kind (meshes green, clusters blue, average boxes red,
# textured boxes orange). Columns: the budgets as given. Needs ImageMagick's montage.
set -eu
if [ $# -lt 7 ]; then
    sed -n '2,9s/^# \{0,1\}//p' "$0" >&2
    exit 1
fi
program=$1 model=$2 path=$3 frame=$4 size=$5 out=$6
shift 6
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# shot NAME OPTION...
shot() {
    name=$1
    shift
    "$program" shot "$model" --path "$path" --frame "$frame" --resolution "$size" --quiet \
        -o "$folder/$name.png" "$@" > /dev/null
}

shot full --selector full
for budget in "$@"; do
    for selector in meta greedy; do
        shot "$selector-$budget" --selector "$selector" --budget-ms "$budget"
    done
    shot "kind-$budget" --selector greedy --budget-ms "$budget" --false-colours
done

# montage labels each picture by the text before its name; null: is an empty place.
pictures="-label full $folder/full.png"
i=1
while [ $i -lt $# ]; do
    pictures="$pictures null:"
    i=$((i + 1))
done
for row in meta greedy kind; do
    for budget in "$@"; do
        pictures="$pictures -label $row:${budget}ms $folder/$row-$budget.png"
    done
done
# shellcheck disable=SC2086 # words
montage $pictures -tile "$#x" -geometry 640x360+4+4 -pointsize 20 "$out"

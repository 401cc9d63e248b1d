#!/bin/sh
# scripts/demo.sh PROGRAM FOLDER: makes the default city, builds it, walks it at 33 ms a frame and
# leaves pictures, reports and FOLDER/index.html. With a display and a person at the terminal, it
# opens the viewer at last.
set -eu
program=$1
out=$2
budget=33
size=1280,720
frames=300
shots="00050 00150 00250"
selectors="full meta greedy"

say() {
    echo "== $*"
}

# One figure of a selector's report, through jq's own arithmetic and rounding.
figure() {
    jq -r ".runs[0] | $2" "$out/$1.json"
}

row() {
    echo "<tr><td>$1"
    figure "$1" '"<td>\(.frame_ms.mean * 10 | round / 10)<td>\(.frame_ms.p95 * 10 | round / 10)
        <td>\(.frame_ms.max * 10 | round / 10)<td>\(.miss_rate * 1000 | round / 10) %
        <td>\(.use_of_budget * 100 | round) %<td>\(.triangles.mean | round)
        <td>\(.cut_nodes.mean | round)<td>\(.select_ms.mean * 100 | round / 100)
        <td>\(if .holes then .holes.mean * 100000 | round / 1000 else "-" end) %"'
}

picture() {
    echo "<figure><a href=\"$1\"><img src=\"$1\" loading=lazy alt=\"$2\"></a>"
    echo "<figcaption>$2</figcaption></figure>"
}

escape() {
    sed -e 's/&/\&amp;/g' -e 's/</\&lt;/g' -e 's/>/\&gt;/g'
}

page() {
    cat << HEAD
<!doctype html>
<html lang=en><meta charset=utf-8><title>Promenade: demo</title>
<style>
body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem }
table { border-collapse: collapse } td, th { padding: .2rem .8rem; text-align: right }
td:first-child, th:first-child { text-align: left } tr + tr { border-top: 1px solid #ccc }
.strip { display: grid; grid-template-columns: repeat(3, 1fr); gap: .5rem; margin: 1rem 0 }
.two { grid-template-columns: repeat(2, 1fr) }
figure { margin: 0 } img { width: 100%; display: block } figcaption { font-size: .85rem }
pre { background: #f4f4f4; padding: 1rem; overflow: auto }
</style>
<h1>A walk through a generated city within $budget ms a frame</h1>
<p>$(figure greedy '.device.renderer' | escape), $(figure greedy '.device.cores') cores,
$(echo "$size" | tr , x) pixels, $frames frames along the streets. <code>full</code> draws every
triangle; <code>meta</code> and <code>greedy</code> choose what shows the most within the budget.
A frame over the budget is a miss; holes are pixels that full detail covers and the choice does
not.</p>
<table><tr><th>selector<th>mean ms<th>p95<th>max<th>misses<th>budget used<th>triangles<th>nodes
<th>selection ms<th>holes
HEAD
    for selector in $selectors; do row "$selector"; done
    echo "</table>"
    for frame in $shots; do
        echo "<h2>Frame $frame</h2><div class=strip>"
        for selector in $selectors; do
            picture "$selector-frames/frame-$frame.png" "$selector"
        done
        for selector in $selectors; do
            picture "$selector-frames/frame-$frame-colours.png" "$selector, by kind"
        done
        echo "</div>"
    done
    cat << LEGEND
<p>By kind: meshes of objects green (dark is finest), cluster meshes blue, average-colour boxes
red, textured boxes orange. More pictures of the walks are in <a href="full-frames">full-frames</a>,
<a href="meta-frames">meta-frames</a> and <a href="greedy-frames">greedy-frames</a>; every frame's
figures in <a href="full.csv">full.csv</a>, <a href="meta.csv">meta.csv</a> and
<a href="greedy.csv">greedy.csv</a>.</p>
<h2>One place, four ways</h2><div class="strip two">
LEGEND
    picture shot-full.png "full detail"
    picture shot-wireframe.png "its edges"
    picture shot-budget.png "greedy, $budget ms, by prediction alone"
    picture shot-colours.png "by kind"
    cat << MODEL
</div>
<h2>The model</h2><pre>
MODEL
    escape < "$out/info.txt"
    echo "</pre></html>"
}

mkdir -p "$out"
say "a city"
"$program" scene city -o "$out/city.glb" --path "$out/city.path"
say "its model"
"$program" build "$out/city.glb" -o "$out/city.prom"
"$program" info "$out/city.prom" > "$out/info.txt"
for selector in $selectors; do
    say "walking: $selector"
    rm -rf "$out/$selector-frames"
    "$program" bench "$out/city.prom" --path "$out/city.path" --selector "$selector" \
        --budget-ms "$budget" --resolution "$size" --frames "$frames" --check-holes 10 \
        --keep-frames "$out/$selector-frames" --every 50 --false-colours \
        --report "$out/$selector.json" --csv "$out/$selector.csv"
done
say "pictures"
# shot NAME OPTION...: a picture of the walk's frame 60.
shot() {
    name=$1
    shift
    "$program" shot "$out/city.prom" --path "$out/city.path" --frame 60 --resolution "$size" \
        -o "$out/shot-$name.png" "$@"
}
shot full
shot wireframe --wireframe
shot budget --budget-ms "$budget"
shot colours --budget-ms "$budget" --false-colours
page > "$out/index.html.part"
mv "$out/index.html.part" "$out/index.html"
say "done: open $out/index.html"
viewer="$program walk $out/city.prom --path $out/city.path --budget-ms $budget"
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && [ -z "${CI:-}" ] && [ -t 2 ]; then
    say "walk there yourself: click and look around, W A S D, P plays the path, Esc ends"
    # Without GL in a window (code 3) the demo is complete all the same.
    $viewer --resolution "$size" || [ $? = 3 ]
else
    say "to walk there yourself: $viewer"
fi

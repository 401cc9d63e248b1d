#!/bin/sh
# scripts/demo.sh PROGRAM FOLDER: makes the default city and gallery, builds them, walks them at 33
# ms a frame and leaves pictures, reports and FOLDER/index.html. With a display and a person at
# the terminal, it opens the viewer at last.
set -eu
program=$1
out=$2
budget=33
size=1280,720
say() {
    echo "== $*"
}

# Of a scene: frames to walk, frames to show, selectors.
frames_of() {
    case $1 in city) echo 600 ;; gallery) echo 400 ;; esac
}

shots_of() {
    case $1 in city) echo 00100 00250 00400 00550 ;; gallery) echo 00100 00200 00350 ;; esac
}

selectors_of() {
    case $1 in city) echo full meta greedy ;; gallery) echo full greedy ;; esac
}

# One figure of a selector's report, through jq's own arithmetic and rounding.
figure() {
    jq -r ".runs[0] | $3" "$out/$1/$2.json"
}

row() {
    echo "<tr><td>$2"
    figure "$1" "$2" '"<td>\(.frame_ms.mean * 10 | round / 10)<td>\(.frame_ms.p95 * 10 | round / 10)
        <td>\(.frame_ms.max * 10 | round / 10)<td>\(.miss_rate * 1000 | round / 10) %
        <td>\(.use_of_budget * 100 | round) %<td>\(.triangles.mean | round)
        <td>\(.cut_nodes.mean | round)<td>\(.select_ms.mean * 100 | round / 100)
        <td>\(if .holes then .holes.mean * 100000 | round / 1000 else "-" end) %
        <td>\(if .accuracy then .accuracy.mean * 10000 | round / 100 else "-" end) %"'
}

picture() {
    echo "<figure><a href=\"$1\"><img src=\"$1\" loading=lazy alt=\"$2\"></a>"
    echo "<figcaption>$2</figcaption></figure>"
}

escape() {
    sed -e 's/&/\&amp;/g' -e 's/</\&lt;/g' -e 's/>/\&gt;/g'
}

# What a walk through a scene gave.
section() {
    scene=$1
    cat << HEAD
<h1>$2</h1>
<p>$(figure "$scene" greedy '.device.renderer' | escape), $(figure "$scene" greedy '.device.cores')
cores, $(echo "$size" | tr , x) pixels, $(frames_of "$scene") frames, $budget ms a frame.
<code>full</code> draws every triangle; the others choose what shows the most within the budget.
A frame over the budget is a miss; holes are pixels that full detail covers and the choice does
not; accuracy is how much the picture looks like full detail.</p>
<table><tr><th>selector<th>mean ms<th>p95<th>max<th>misses<th>budget used<th>triangles<th>nodes
<th>selection ms<th>holes<th>accuracy
HEAD
    for selector in $(selectors_of "$scene"); do row "$scene" "$selector"; done
    echo "</table>"
    for frame in $(shots_of "$scene"); do
        echo "<h2>Frame $frame</h2><div class=\"strip $scene\">"
        for colours in "" -colours; do
            for selector in $(selectors_of "$scene"); do
                picture "$scene/$selector-frames/frame-$frame$colours.png" \
                    "$selector${colours:+, by kind}"
            done
        done
        echo "</div>"
    done
    echo "<h2>The model</h2><pre>"
    escape < "$out/$scene/info.txt"
    echo "</pre>"
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
.gallery, .two { grid-template-columns: repeat(2, 1fr) }
figure { margin: 0 } img { width: 100%; display: block } figcaption { font-size: .85rem }
pre { background: #f4f4f4; padding: 1rem; overflow: auto }
</style>
HEAD
    section city "A walk through a generated city"
    section gallery "A walk through a generated gallery"
    cat << LEGEND
<p>By kind: meshes of objects green (dark is finest), cluster meshes blue, average-colour boxes
red, textured boxes orange. More pictures and every frame's figures are in <a href="city">city</a>
and <a href="gallery">gallery</a>.</p>
<h1>One place, four ways</h1><div class="strip two">
LEGEND
    picture shot-full.png "full detail"
    picture shot-wireframe.png "its edges"
    picture shot-budget.png "greedy, $budget ms, by prediction alone"
    picture shot-colours.png "by kind"
    echo "</div></html>"
}

# Makes, builds and walks a scene.
run() {
    scene=$1
    mkdir -p "$out/$scene"
    say "a $scene"
    "$program" scene "$scene" -o "$out/$scene.glb" --path "$out/$scene.path"
    say "its model"
    "$program" build "$out/$scene.glb" -o "$out/$scene.prom"
    "$program" info "$out/$scene.prom" > "$out/$scene/info.txt"
    for selector in $(selectors_of "$scene"); do
        say "walking: $selector"
        rm -rf "$out/$scene/$selector-frames"
        "$program" bench "$out/$scene.prom" --path "$out/$scene.path" --selector "$selector" \
            --budget-ms "$budget" --resolution "$size" --frames "$(frames_of "$scene")" \
            --check-holes 10 --check-accuracy 10 --quality-frames 10 \
            --keep-frames "$out/$scene/$selector-frames" --every 50 --false-colours \
            --report "$out/$scene/$selector.json" \
            --csv "$out/$scene/$selector.csv"
    done
}

run city
run gallery
say "pictures"
# shot NAME OPTION...: a picture of the city walk's frame 260.
shot() {
    name=$1
    shift
    "$program" shot "$out/city.prom" --path "$out/city.path" --frame 260 --resolution "$size" \
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

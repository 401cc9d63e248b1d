#!/bin/sh
# Draws how long selection takes against how many objects a scene has, from what bench_select
# writes: both axes logarithmic, a line for each selector.
#
#   tests/bench/scaling.sh [OPTION...] FILE.csv FILE.svg
#     -x NAME column of the horizontal axis (objects)
#     -y NAME column of the vertical axis, in milliseconds (ms)
#     -g NAME column that tells the lines apart (selector)
#     -t TEXT title ("Selection time at the same screen content")
#     -l MS   a dashed line, as a limit to compare with (1; 0: none)
#
# Rows of one line and one number of objects are averaged; a cell that is empty or not above 0 is
# left out. FILE.png is made too where rsvg-convert is installed.
set -eu
here=$(dirname "$0")
# shellcheck source-path=SCRIPTDIR
. "$here/common.sh"
x=objects
y=ms
group=selector
title="Selection time at the same screen content"
limit=1
while getopts x:y:g:t:l: option; do
    case $option in
    x) x=$OPTARG ;;
    y) y=$OPTARG ;;
    g) group=$OPTARG ;;
    t) title=$OPTARG ;;
    l) limit=$OPTARG ;;
    *) usage ;;
    esac
done
shift $((OPTIND - 1))
[ $# -eq 2 ] || usage
need awk
table=$1
plot=$2
[ -r "$table" ] || die "$table: cannot be read"
for column in "$x" "$y" "$group"; do
    head -n 1 "$table" | tr -d '\r' | tr ',' '\n' | grep -qxF -e "$column" ||
        die "$table: its first line names no column \`$column\`"
done
trap 'rm -f "$plot.part"' EXIT

# The colours are those of Okabe and Ito 2008: told apart with every kind of colour vision.
awk -F, -v x_name="$x" -v y_name="$y" -v group_name="$group" -v title="$title" -v limit="$limit" '
    function log10(v) { return sprintf("%.9f", log(v) / log(10)) + 0 } # powers of ten exact
    function floor(v, i) { i = int(v); return i > v ? i - 1 : i }
    function across(v) { return LEFT + WIDTH * (log10(v) - x0) / (x1 - x0) }
    function down(v) { return TOP + HEIGHT * (y1 - log10(v)) / (y1 - y0) }
    function text(at_x, at_y, anchor, what) {
        gsub(/&/, "\\&amp;", what); gsub(/</, "\\&lt;", what)
        printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", at_x, at_y, anchor,
            what
    }
    function line(ax, ay, bx, by, style) {
        printf "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", ax, ay, bx, by, style
    }
    function number(decade) {
        if (decade >= 6) return 10 ^ (decade - 6) " million"
        return sprintf("%.*f", decade < 0 ? -decade : 0, 10 ^ decade)
    }
    # A curve with discs; its name stands at its end. The second nine are dashed.
    function curve(name, colour, dashes, i, j, v, points, count, at) {
        points = ""; count = 0
        for (i = 1; i <= steps; i++) {
            if (!((name, xs[i]) in sum)) continue
            v = sum[name, xs[i]] / rows[name, xs[i]]
            points = points sprintf("%.1f,%.1f ", across(xs[i]), down(v))
            dots[++count] = sprintf("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>",
                                    across(xs[i]), down(v), colour)
        }
        printf "<polyline points=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\"%s/>\n",
            points, colour, dashes
        for (j = 1; j <= count; j++) print dots[j]
        at = label_y[name]
        printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", LEFT + WIDTH + 16, at,
            colour
        text(LEFT + WIDTH + 26, at + 4, "start", name)
    }
    { sub(/\r$/, "") }
    NR == 1 {
        for (i = 1; i <= NF; i++) column[$i] = i
        next
    }
    $column[x_name] > 0 && $column[y_name] > 0 {
        a = $column[x_name] + 0; v = $column[y_name] + 0; name = $column[group_name]
        if (!(name in known)) { known[name] = 1; names[++groups] = name }
        if (!(a in there)) { there[a] = 1; xs[++steps] = a }
        sum[name, a] += v; rows[name, a]++
        if (!filled++ || a < least_x) least_x = a
        if (a > most_x) most_x = a
        if (filled == 1 || v < least_y) least_y = v
        if (v > most_y) most_y = v
        last[name] = a >= last_x[name] ? v : last[name]
        if (a > last_x[name]) last_x[name] = a
    }
    END {
        if (!filled) exit 1
        LEFT = 76; TOP = 48; WIDTH = 560; HEIGHT = 400
        split("#0072b2,#d55e00,#009e73,#cc79a7,#e69f00,#56b4e9,#000000,#f0e442,#888888", colours)
        for (i = 2; i <= steps; i++)
            for (j = i; j > 1 && xs[j] < xs[j - 1]; j--) {
                v = xs[j]; xs[j] = xs[j - 1]; xs[j - 1] = v
            }
        # Names in the order of the ends of their lines, from the top.
        for (i = 2; i <= groups; i++)
            for (j = i; j > 1 && last[names[j]] > last[names[j - 1]]; j--) {
                name = names[j]; names[j] = names[j - 1]; names[j - 1] = name
            }
        if (limit > 0 && limit < least_y) least_y = limit
        if (limit > 0 && limit > most_y) most_y = limit
        x0 = floor(log10(least_x)); x1 = -floor(-log10(most_x)); if (x1 == x0) x1++
        y0 = floor(log10(least_y)); y1 = -floor(-log10(most_y)); if (y1 == y0) y1++
        printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"800\" height=\"510\" " \
            "font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\">\n" \
            "<rect width=\"800\" height=\"510\" fill=\"#fff\"/>\n"
        text(LEFT, 26, "start", title)
        for (d = x0; d <= x1; d++) {
            line(across(10 ^ d), TOP, across(10 ^ d), TOP + HEIGHT, "stroke=\"#ddd\"")
            text(across(10 ^ d), TOP + HEIGHT + 20, "middle", number(d))
        }
        for (d = y0; d <= y1; d++) {
            line(LEFT, down(10 ^ d), LEFT + WIDTH, down(10 ^ d), "stroke=\"#ddd\"")
            text(LEFT - 8, down(10 ^ d) + 4, "end", number(d))
        }
        text(LEFT + WIDTH / 2, TOP + HEIGHT + 44, "middle", x_name)
        text(LEFT - 8, TOP - 10, "end", "ms")
        if (limit > 0)
            line(LEFT, down(limit), LEFT + WIDTH, down(limit),
                 "stroke=\"#666\" stroke-dasharray=\"6 4\"")
        for (k = 1; k <= groups; k++) {
            at = down(last[names[k]])
            if (k > 1 && at < label_y[names[k - 1]] + 17) at = label_y[names[k - 1]] + 17
            label_y[names[k]] = at
        }
        # What does not fit at the bottom pushes up what is above it.
        for (k = groups; k >= 1; k--) {
            most = k == groups ? TOP + HEIGHT : label_y[names[k + 1]] - 17
            if (label_y[names[k]] > most) label_y[names[k]] = most
        }
        for (k = 1; k <= groups; k++)
            curve(names[k], colours[(k - 1) % 9 + 1], k > 9 ? " stroke-dasharray=\"3 3\"" : "")
        print "</svg>"
    }' "$table" > "$plot.part" || die "$table: no row with \`$x\` and \`$y\` above 0"
mv "$plot.part" "$plot"
if command -v rsvg-convert > /dev/null; then rsvg-convert "$plot" -o "${plot%.svg}.png"; fi

#!/bin/sh
# 25 dragons: a grid of 5 x 5 with the artist's three levels of one scan, walked in 40 frames at
# 960x540 within 200, 100 and 50 ms. VTK 9.1's vtkLODProp3D on the same scene used 45 to 54 % of
# 200 ms, missed 18, 4 and 0 of 40 frames at 100 ms in three runs, and 3 to 5 at 50 ms.
#
#   tests/bench/dragons.sh [OPTION...] PROGRAM FOLDER
#     -b LIST budgets in milliseconds ("200 100 50")
#     -r N    runs of each (3)
#     -S NAME selector (the program's default)
#
# Environment: PROM_SHARED, the folder whose scenes/ holds the dragon and its path (../shared).
# Each budget is walked N times with what the frames teach (misses, use), and N times with
# `--profile`, with which all runs must choose the same cuts. The scene, its model, the profile and
# all reports stay in FOLDER; FOLDER/dragons.md is the table, also printed.
set -eu
here=$(dirname "$0")
# shellcheck source-path=SCRIPTDIR
. "$here/common.sh"
budgets="200 100 50"
runs=3
selector=""
while getopts b:r:S: option; do
    case $option in
    b) budgets=$OPTARG ;;
    r) runs=$OPTARG ;;
    S) selector=$OPTARG ;;
    *) usage ;;
    esac
done
shift $((OPTIND - 1))
[ $# -eq 2 ] || usage
program=$1
out=$2
shared=${PROM_SHARED:-../shared}/scenes
path=$shared/paths/dragons25.path
need jq awk python3
for file in "$path" "$shared/dragon/dragon_vrip_res2.ply"; do
    [ -r "$file" ] || die "$file: cannot be read; set PROM_SHARED"
done
mkdir -p "$out"

# The scene as glTF: the levels as `extras.lods`, whose distances (chosen by taste; a dragon is
# 0.2 m long) only `distance` heeds.
write_scene() {
    python3 - "$shared/dragon" "$out" << 'END'
import json, struct, sys

folder, out = sys.argv[1:]
levels = [("res2", 0.5), ("res3", 1.0), ("res4", 1000.0)]
blob, accessors, views, meshes = bytearray(), [], [], []


def read_ply(path):
    """Vertices and triangles of an ASCII PLY file of positions and faces."""
    with open(path) as file:
        counts = {}
        for line in file:
            words = line.split()
            if words[0] == "element":
                counts[words[1]] = int(words[2])
            if words[0] == "end_header":
                break
        vertices = [tuple(map(float, next(file).split()[:3])) for _ in range(counts["vertex"])]
        faces = [tuple(map(int, next(file).split())) for _ in range(counts["face"])]
    if any(face[0] != 3 for face in faces):
        raise SystemExit(f"{path}: not all faces are triangles")
    return vertices, [face[1:] for face in faces]


def add(data, count, target, **accessor):
    views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data), "target": target})
    blob.extend(data)
    accessors.append({"bufferView": len(views) - 1, "count": count, **accessor})
    return len(accessors) - 1


for name, _ in levels:
    vertices, faces = read_ply(f"{folder}/dragon_vrip_{name}.ply")
    positions = add(b"".join(struct.pack("<3f", *v) for v in vertices), len(vertices), 34962,
                    componentType=5126, type="VEC3",
                    min=[min(c) for c in zip(*vertices)], max=[max(c) for c in zip(*vertices)])
    indices = add(b"".join(struct.pack("<3I", *f) for f in faces), 3 * len(faces), 34963,
                  componentType=5125, type="SCALAR")
    meshes.append({"name": name, "primitives": [
        {"attributes": {"POSITION": positions}, "indices": indices, "material": 0}]})

lods = [{"mesh": k, "distance": distance} for k, (_, distance) in enumerate(levels)]
nodes = [{"name": f"dragon_{i}_{j}", "mesh": 0, "translation": [0.25 * i, 0, 0.25 * j],
          "extras": {"lods": lods}} for i in range(5) for j in range(5)]
material = {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.55, 0.45, 1]}}
scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
         "nodes": nodes, "meshes": meshes, "materials": [material], "accessors": accessors,
         "bufferViews": views, "buffers": [{"uri": "dragons.bin", "byteLength": len(blob)}]}
with open(f"{out}/dragons.bin", "wb") as file:
    file.write(blob)
with open(f"{out}/dragons.gltf", "w") as file:
    json.dump(scene, file)
END
}

# bench NAME BUDGET OPTION...: one run, kept as NAME.json, NAME.csv and NAME.err.
bench() {
    name=$1 budget=$2
    shift 2
    "$program" bench "$out/dragons.prom" --path "$path" --resolution 960,540 --frames 40 \
        --budget-ms "$budget" --quality-frames 0 ${selector:+--selector "$selector"} \
        --report "$out/$name.json" --csv "$out/$name.csv" "$@" > /dev/null 2> "$out/$name.err" ||
        die "$name: $(tail -n 1 "$out/$name.err")"
}

# all_of EXPRESSION FILE...: its value in each report, with commas between.
all_of() {
    expression=$1
    shift
    jq -r ".runs[0] | $expression" "$@" | paste -sd, | sed 's/,/, /g'
}

# row BUDGET: of its runs.
row() {
    files="" fixed=""
    for run in $(seq "$runs"); do
        files="$files $out/$1-$run.json"
        fixed="$fixed $out/$1-fixed-$run.json"
    done
    # shellcheck disable=SC2086 # names without blanks
    {
        same=$(jq -r '.runs[0].cuts_hash' $fixed | sort -u | wc -l)
        misses=$(all_of '.misses.count' $files)
        use=$(all_of '.use_of_budget * 100 | round' $files)
        mean=$(all_of '.frame_ms.mean | . * 10 | round / 10' $files)
        triangles=$(all_of '.triangles.mean / 1e4 | round / 100' $files)
        unfit=$(all_of '.infeasible_frames' $files)
        least=$(all_of 'if .least_budget_ms then .least_budget_ms | round else "-" end' $files)
        fixed_misses=$(all_of '.misses.count' $fixed)
    }
    said=$(grep -l 'budget .* would do' "$out/$1"-[0-9]*.err | wc -l)
    echo "| $1 | $misses | $use | $mean | $triangles | $unfit | $least | $said of $runs |" \
        "$fixed_misses | $([ "$same" = 1 ] && echo yes || echo "NO: $same") |"
}

[ -f "$out/dragons.gltf" ] || write_scene
[ -f "$out/dragons.prom" ] ||
    "$program" build "$out/dragons.gltf" -o "$out/dragons.prom" --drop-work --quiet
[ -f "$out/profile.json" ] ||
    "$program" calibrate --resolution 960,540 -o "$out/profile.json" --quiet > /dev/null
{
    echo "| budget ms | misses of 40 | use of budget % | mean ms | million triangles |" \
        "infeasible frames | least budget ms | said so | misses with a profile | same cuts |"
    echo "| ---: | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    for budget in $budgets; do
        for run in $(seq "$runs"); do
            bench "$budget-$run" "$budget"
            bench "$budget-fixed-$run" "$budget" --profile "$out/profile.json"
        done
        row "$budget"
    done
} | tee "$out/dragons.md"

#!/bin/sh
# tests/bench/run.sh PROGRAM FOLDER: builds the bench scenes and prints both tables: how they were
# built (build.md) and how they walk (table.md). Everything stays in FOLDER.
#
# Environment:
#   SCENES       names to take, of: sponza candela_city black_forest forza candela_city_5x5
#                black_forest_5x5 furniture city (all); one that is not there is skipped
#   PROM_SHARED  folder whose scenes/ holds those that are not part of the project (../shared)
#   OPTIONS      options for table.sh, such as "-f 300 -F 60"
set -eu
here=$(dirname "$0")
program=$1
out=$2
shared=${PROM_SHARED:-../shared}/scenes
all="sponza candela_city black_forest forza candela_city_5x5 black_forest_5x5 furniture city"
mkdir -p "$out/models"

# is_there NAME: whether the scene is there or can be made; says so if not.
is_there() {
    case $1 in
    city) return 0 ;;
    sponza) needed=$shared/sponza/sponza.obj ;;
    furniture) needed=$shared/furniture-cc0 ;;
    *) needed=$shared/${1%_5x5}/${1%_5x5}.gltf ;;
    esac
    [ -e "$needed" ] && return 0
    echo "skipped $1: there is no $needed" >&2
    return 1
}

# The file of a scene by name; made when it is a generated or repeated one.
source_of() {
    case $1 in
    sponza) echo "$shared/sponza/sponza.obj" ;;
    *_5x5)
        base=${1%_5x5}
        [ -f "$out/models/$1.glb" ] || "$program" scene tile "$shared/$base/$base.gltf" \
            --grid 5x5 -o "$out/models/$1.glb" >&2
        echo "$out/models/$1.glb" ;;
    city)
        [ -f "$out/models/city.glb" ] || "$program" scene city -o "$out/models/city.glb" \
            --path "$out/models/city.path" >&2
        echo "$out/models/city.glb" ;;
    *) echo "$shared/$1/$1.gltf" ;;
    esac
}

paths_of() {
    case $1 in
    city) echo "$out/models/city.path" ;;
    forza) echo auto ;;
    sponza) echo "$shared/paths/sponza_court.path $shared/paths/sponza_high.path" ;;
    *)
        base=${1%_5x5}
        echo "$shared/paths/${base}_walk.path $shared/paths/${base}_aerial.path" ;;
    esac
}

# build NAME FILE: NAME.prom, its report and its facts.
build() {
    [ -f "$out/models/$1.prom" ] && [ -f "$out/$1.build.txt" ] && return
    echo "building $1" >&2
    "$program" build "$2" -o "$out/models/$1.prom" --force --drop-work > "$out/$1.build.txt.part"
    mv "$out/$1.build.txt.part" "$out/$1.build.txt"
}

build_row() {
    "$program" info "$out/models/$1.prom" --json > "$out/$1.info.json"
    peak=$(awk '/^peak memory/ { print $3 }' "$out/$1.build.txt")
    objects=$(awk '/^objects/ { print $2 }' "$out/$1.build.txt")
    jq -r --arg name "$1" --arg peak "$peak" --arg objects "$objects" '
        def mb: . / 1048576 * 10 | round / 10;
        "| \($name) | \(.triangles) | \($objects) | \(.tables.prototype.rows) | " +
        "\(.tables.node.rows) | \(.nodes.most_children) | \(.tables.representation.rows) | " +
        "\([.stages[].ms] | add / 1000 | . * 10 | round / 10) | " +
        "\([.stages[] | "\(.name) \(.ms / 1000 * 10 | round / 10)"] | join(", ")) | " +
        "\(.file_bytes | mb) | \($peak | tonumber | round) |"' "$out/$1.info.json"
}

pairs=""
{
    echo "| scene | triangles | objects | prototypes | nodes | most children | representations |" \
        "build s | by stage | file MiB | peak MiB |"
    echo "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: |"
} > "$out/build.md"
for name in ${SCENES:-$all}; do
    is_there "$name" || continue
    if [ "$name" = furniture ]; then
        find "$shared/furniture-cc0" -name '*.obj' | sort > "$out/furniture.txt"
        while read -r file; do
            prop=furniture-$(basename "$file" .obj)
            build "$prop" "$file"
            build_row "$prop" >> "$out/build.md"
        done < "$out/furniture.txt"
        continue
    fi
    build "$name" "$(source_of "$name")"
    build_row "$name" >> "$out/build.md"
    for path in $(paths_of "$name"); do pairs="$pairs $out/models/$name.prom:$path"; done
done
cat "$out/build.md"
# shellcheck disable=SC2086 # lists of words
[ -z "$pairs" ] || "$here/table.sh" ${OPTIONS:-} "$program" "$out" $pairs

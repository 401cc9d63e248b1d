// promenade scene: makes scenes, a generated city or gallery, or a repeated scene.
#include "app/command.h"
#include "app/options.h"
#include "app/output.h"

#include "scenes/city.h"
#include "scenes/gallery.h"
#include "scenes/tile.h"

#include <inttypes.h>
#include <stdio.h>
#include <sys/stat.h>

static const struct argp_child children[] = {{&prom_argp_log, 0, NULL, -1}, {0}};

enum {
    KEY_SEED = 0x1000,
    KEY_SIZE,
    KEY_DETAIL,
    KEY_STYLES,
    KEY_PATH,
    KEY_GRID,
    KEY_SPACING,
    KEY_ROOMS,
    KEY_ROOFLESS,
    KEY_FLIGHT,
};

// ---- what a generated scene takes

typedef struct generated {
    const char *output, *path;
    uint64_t seed;
} generated;

static error_t parse_generated(generated *o, int key, char *text, struct argp_state *state)
{
    switch (key) {
    case 'o':
        o->output = text;
        break;
    case KEY_PATH:
        o->path = text;
        break;
    case KEY_SEED:
        o->seed = prom_option_whole(state, "--seed", text, 0, UINT64_MAX);
        break;
    case ARGP_KEY_ARG:
        argp_error(state, "`%s` is one argument too many", text);
        break;
    case ARGP_KEY_END:
        prom_option_require(state, "--output", o->output);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

// ---- city

typedef struct city_options {
    generated common;
    prom_city_options city;
} city_options;

static const struct argp_option city_table[] = {
    {"output", 'o', "FILE", 0, "The scene to write (X.glb)", 0},
    {"path", KEY_PATH, "FILE", 0,
     "Also write a walk of 600 frames: a street, the bridge, the quay, the square", 0},
    {"flight", KEY_FLIGHT, "FILE", 0, "Also write a flight of 600 frames above the roofs", 0},
    {"seed", KEY_SEED, "N", 0, "Another number gives another city (1)", 0},
    {"size", KEY_SIZE, "N", 0, "Blocks along each side (4)", 0},
    {"detail", KEY_DETAIL, "1..4", 0, "From plain to rich (2)", 0},
    {"styles", KEY_STYLES, "N", 0, "Different houses (12 per step of detail)", 0},
    {0},
};

static error_t parse_city(int key, char *text, struct argp_state *state)
{
    city_options *o = state->input;
    switch (key) {
    case KEY_FLIGHT:
        o->city.flight_file = text;
        break;
    case KEY_SIZE:
        o->city.blocks = (uint32_t)prom_option_whole(state, "--size", text, 1, 256);
        break;
    case KEY_DETAIL:
        o->city.detail = (uint32_t)prom_option_whole(state, "--detail", text, 1, 4);
        break;
    case KEY_STYLES:
        o->city.styles = (uint32_t)prom_option_whole(state, "--styles", text, 1, 10000);
        break;
    default:
        return parse_generated(&o->common, key, text, state);
    }
    return 0;
}

static const struct argp city_argp = {
    .options = city_table,
    .parser = parse_city,
    .doc = "Generate a city on a river: houses, bridges, streets, trees, hills around.\v"
           "The same seed, size and detail give the same city.",
    .children = children,
};

static prom_status run_city(int argc, char **argv, prom_error *error)
{
    city_options o = {.common = {.seed = 1}};
    argp_parse(&city_argp, argc, argv, 0, NULL, &o);
    o.city.seed = o.common.seed;
    prom_command_files files = {
        .outputs = {&o.common.output, &o.common.path, &o.city.flight_file}};
    prom_status status = prom_outputs_check(&files, error);
    uint64_t triangles = 0;
    if (!status)
        status = prom_city_write(o.common.output, o.common.path, &o.city, &triangles, error);
    if (status) return status;
    printf("%s: %" PRIu64 " triangles\n", o.common.output, triangles);
    if (o.common.path) printf("%s: a walk through it\n", o.common.path);
    if (o.city.flight_file) printf("%s: a flight above it\n", o.city.flight_file);
    return PROM_OK;
}

// ---- gallery

typedef struct gallery_options {
    generated common;
    prom_gallery_options gallery;
} gallery_options;

static const struct argp_option gallery_table[] = {
    {"output", 'o', "FILE", 0, "The scene to write (X.glb)", 0},
    {"path", KEY_PATH, "FILE", 0, "Also write a walk through its rooms, up and down its stairs",
     0},
    {"seed", KEY_SEED, "N", 0, "Another number gives another gallery (1)", 0},
    {"rooms", KEY_ROOMS, "N", 0, "At least so many rooms, 17 to 2000 (24)", 0},
    {"detail", KEY_DETAIL, "1..4", 0,
     "From plain to rich; each step has about four times the triangles (2)", 0},
    {"roofless", KEY_ROOFLESS, NULL, 0, "Leave out ceilings and roofs, to look in from above",
     0},
    {0},
};

static error_t parse_gallery(int key, char *text, struct argp_state *state)
{
    gallery_options *o = state->input;
    switch (key) {
    case KEY_ROOMS:
        o->gallery.rooms = (uint32_t)prom_option_whole(
            state, "--rooms", text, PROM_GALLERY_ROOMS_MIN, PROM_GALLERY_ROOMS_MAX);
        break;
    case KEY_DETAIL:
        o->gallery.detail =
            (uint32_t)prom_option_whole(state, "--detail", text, 1, PROM_GALLERY_DETAIL_MAX);
        break;
    case KEY_ROOFLESS:
        o->gallery.roofless = true;
        break;
    default:
        return parse_generated(&o->common, key, text, state);
    }
    return 0;
}

static const struct argp gallery_argp = {
    .options = gallery_table,
    .parser = parse_gallery,
    .doc =
        "Generate a gallery: rooms with pictures, sculptures, vitrines and furniture around a "
        "hall and a rotunda, on two storeys.\v"
        "The same seed, rooms and detail give the same gallery.",
    .children = children,
};

static prom_status run_gallery(int argc, char **argv, prom_error *error)
{
    gallery_options o = {.common = {.seed = 1}};
    argp_parse(&gallery_argp, argc, argv, 0, NULL, &o);
    o.gallery.seed = o.common.seed;
    prom_command_files files = {.outputs = {&o.common.output, &o.common.path}};
    prom_status status = prom_outputs_check(&files, error);
    prom_gallery_facts facts = {0};
    if (!status)
        status = prom_gallery_write(o.common.output, o.common.path, &o.gallery, &facts, error);
    if (status) return status;
    printf("%s: %" PRIu64 " triangles in %u rooms\n", o.common.output, facts.triangles,
           facts.rooms);
    if (o.common.path)
        printf("%s: a walk of %u frames through it\n", o.common.path, facts.walk_keys);
    return PROM_OK;
}

// ---- tile

typedef struct tile_options {
    prom_tile_options tile;
    const char *scene, *output;
} tile_options;

static const struct argp_option tile_table[] = {
    {"output", 'o', "FILE", 0, "The scene to write (X.glb)", 0},
    {"grid", KEY_GRID, "NxM", 0, "Tiles along x and z", 0},
    {"spacing", KEY_SPACING, "X,Z", 0,
     "Distance from tile to tile (the layout without its backdrop)", 0},
    {0},
};

static void parse_grid(prom_tile_options *tile, const char *text,
                       const struct argp_state *state)
{
    double n[2] = {1, 1};
    prom_option_numbers(state, "--grid", text, 'x', 1, 256, 2, n);
    tile->columns = (uint32_t)n[0];
    tile->rows = (uint32_t)n[1];
    if (n[0] != tile->columns || n[1] != tile->rows)
        argp_error(state, "--grid: `%s` is not in whole tiles", text);
}

static error_t parse_tile(int key, char *text, struct argp_state *state)
{
    tile_options *o = state->input;
    switch (key) {
    case 'o':
        o->output = text;
        break;
    case KEY_GRID:
        parse_grid(&o->tile, text, state);
        break;
    case KEY_SPACING:
        prom_option_numbers(state, "--spacing", text, ',', 1e-6, 1e9, 2, o->tile.spacing);
        break;
    case ARGP_KEY_ARG:
        prom_option_argument(state, text, &o->scene);
        break;
    case ARGP_KEY_END:
        prom_option_require(state, "the scene's file", o->scene);
        prom_option_require(state, "--output", o->output);
        prom_option_require(state, "--grid", o->tile.columns ? "given" : NULL);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp tile_argp = {
    .options = tile_table,
    .parser = parse_tile,
    .args_doc = "SCENE",
    .doc = "Repeat a glTF scene as instances on a grid.\v"
           "The original stays in place as the centre tile; a backdrop stands once.",
    .children = children,
};

static prom_status run_tile(int argc, char **argv, prom_error *error)
{
    tile_options o = {0};
    argp_parse(&tile_argp, argc, argv, 0, NULL, &o);
    prom_command_files files = {{o.scene}, {&o.output}};
    prom_status status = prom_outputs_check(&files, error);
    if (!status) status = prom_tile_write(o.scene, o.output, &o.tile, error);
    if (status) return status;
    struct stat st = {0};
    stat(o.output, &st);
    printf("%s: %ux%u tiles, %.1f MiB\n", o.output, o.tile.columns, o.tile.rows,
           (double)st.st_size / (1 << 20));
    return PROM_OK;
}

prom_status prom_command_scene(int argc, char **argv, prom_error *error)
{
    static const prom_command commands[] = {
        {"city", "-o X.glb", "generate a city", run_city},
        {"gallery", "-o X.glb", "generate a gallery", run_gallery},
        {"tile", "SCENE -o X.glb", "repeat a scene on a grid", run_tile},
    };
    return prom_command_dispatch("promenade scene", commands, 3, argc, argv, error);
}

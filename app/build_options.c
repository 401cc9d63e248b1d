#include "app/build_options.h"

#include "app/options.h"

#include "benefit/metric.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum {
    KEY_TEXTURE_MB = 0x1000,
    KEY_OCTREE,
    KEY_DIVISIONS,
    KEY_GROUP_RADIUS,
    KEY_MAX_CHILDREN,
    KEY_MAX_OBJECT,
    KEY_MIN_OBJECT,
    KEY_CHUNK_SIZE,
    KEY_MAX_TEXTURE,
    KEY_IMPORT_MEMORY,
    KEY_IMPORT_TIME,
    KEY_UP_AXIS,
    KEY_UNIT,
    KEY_PROFILE,
    KEY_WEIGHT,
    KEY_METRIC,
    KEY_PPD,
    KEY_MEMORY,
    KEY_FORCE,
    KEY_FROM,
    KEY_DROP_WORK,
    KEY_KEEP_VIEWS,
    KEY_VETO,
    KEY_VIEW_CELLS,
    KEY_VIEW_CELL_SIZE,
    KEY_VIEW_CELL_PX,
};

static const struct argp_option options[] = {
    {"output", 'o', "FILE", 0, "The model to write (X.prom)", 0},
    {0, 0, 0, 0, "Import:", 1},
    {"max-texture-px", KEY_MAX_TEXTURE, "PX", 0, "Reduce pictures to this side (1024)", 1},
    {"import-memory-mb", KEY_IMPORT_MEMORY, "MB", 0,
     "Memory that reading the scene may take (8192)", 1},
    {"import-time-s", KEY_IMPORT_TIME, "S", 0,
     "Processor time that reading the scene may take (300)", 1},
    {"up-axis", KEY_UP_AXIS, "y|z", 0, "The scene's upward axis (what the file says)", 1},
    {"unit-m", KEY_UNIT, "M", 0, "Metres of a unit of the scene (what the file says, or 1)", 1},
    {0, 0, 0, 0, "Objects:", 2},
    {"max-object-triangles", KEY_MAX_OBJECT, "N", 0, "Split larger objects (4096)", 2},
    {"min-object-triangles", KEY_MIN_OBJECT, "N", 0, "Gather smaller neighbours (256)", 2},
    {"chunk-size", KEY_CHUNK_SIZE, "UNITS", 0,
     "Edge of the chunks of large surfaces, in scene units (from the layout)", 2},
    {0, 0, 0, 0, "Tree:", 3},
    {"octree", KEY_OCTREE, "loose|strict", 0, "Kind of tree (loose)", 3},
    {"divisions", KEY_DIVISIONS, "NX,NY,NZ", 0, "strict: cells of the finest level (16,1,16)",
     3},
    {"group-radius", KEY_GROUP_RADIUS, "UNITS", 0,
     "strict: take objects within it as one group first (0: none)", 3},
    {"max-children", KEY_MAX_CHILDREN, "N", 0, "loose: children of a node, at most (16)", 3},
    {0, 0, 0, 0, "Impostors and cost:", 4},
    {"texture-mb", KEY_TEXTURE_MB, "MB", 0, "Memory for impostor pictures (256)", 4},
    {"profile", KEY_PROFILE, "FILE", 0, "Cost profile that the model is built for", 4},
    {"metric", KEY_METRIC, "NAME", 0,
     "How pictures are compared: flip, ssim, rmse, sobel or edge-blur; constant compares "
     "nothing and takes every representation for half right (" PROM_MEASURE_METRIC ")",
     4},
    {"ppd", KEY_PPD, "X", 0,
     "Pixels per degree of the viewer's angle that they are compared for (22.34: 1280 pixels "
     "on a screen 0.7 m wide, 0.7 m away)",
     4},
    {0, 0, 0, 0, "Weights:", 5},
    {"weight", KEY_WEIGHT, "PATTERN=X", 0,
     "A visible pixel of the objects of these names, and of all below a node of the scene that "
     "is named so, is worth X instead of 1, 'statue*=4' for one; may be given more than once, "
     "the last that matches a name counts",
     5},
    {0, 0, 0, 0, "Visibility:", 6},
    {"view-cells", KEY_VIEW_CELLS, "WHERE", 0,
     "Find out what can be seen from where the viewer may be: along camera paths "
     "(FILE[,FILE...]), the automatic walk (auto), or over the floors in a box "
     "(X0,Y0,Z0:X1,Y1,Z1)",
     6},
    {"view-cell-size", KEY_VIEW_CELL_SIZE, "M", 0,
     "Side of the cells that this is kept for (2, or more where that would make more than 400)",
     6},
    {"view-cell-px", KEY_VIEW_CELL_PX, "PX", 0,
     "Side of the six pictures around an eye, for what shows there (512)", 6},
    {0, 0, 0, 0, "Work:", 7},
    {"jobs", 'j', "N", 0, "Cores to use (all)", 7},
    {"memory-mb", KEY_MEMORY, "MB", 0,
     "Memory to stay within: fewer things are under way at a time (any)", 7},
    {"from", KEY_FROM, "STAGE", 0,
     "Take nothing from earlier builds from this stage on: levels, leaves, clusters or "
     "view-cells",
     7},
    {"force", KEY_FORCE, NULL, 0, "Take nothing from earlier builds", 7},
    {"veto", KEY_VETO, NULL, 0,
     "Refuse a representation from where a part of the object is missing, however small the "
     "mean "
     "error: it is then only drawn where nothing dearer can be paid for",
     3},
    {"keep-views", KEY_KEEP_VIEWS, NULL, 0,
     "Keep the pictures that are drawn in X.prom.work too: a build with another --metric or "
     "--ppd need not draw them",
     7},
    {"drop-work", KEY_DROP_WORK, NULL, 0,
     "Delete X.prom.work, which serves later builds, at the end", 7},
    {0},
};

static error_t parse_import(prom_build_command *o, int key, char *text,
                            struct argp_state *state)
{
    prom_import_options *import = &o->build.import;
    switch (key) {
    case KEY_MAX_TEXTURE:
        import->max_texture_px =
            (uint32_t)prom_option_whole(state, "--max-texture-px", text, 1, PROM_TEXTURE_MAX);
        break;
    case KEY_IMPORT_MEMORY:
        import->memory_bytes = prom_option_whole(state, "--import-memory-mb", text, 16, 1 << 24)
                               << 20;
        break;
    case KEY_IMPORT_TIME:
        import->time_s =
            (uint32_t)prom_option_whole(state, "--import-time-s", text, 1, 1000000);
        break;
    case KEY_UP_AXIS:
        if (strcmp(text, "y") && strcmp(text, "z"))
            argp_error(state, "--up-axis: `%s` is neither y nor z", text);
        import->up = *text == 'y' ? PROM_UP_Y : PROM_UP_Z;
        break;
    case KEY_UNIT:
        import->unit_m = prom_option_number(state, "--unit-m", text, 1e-9, 1e9);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static void parse_from(prom_build_options *build, const char *text,
                       const struct argp_state *state)
{
    static const struct {
        const char *stage;
        prom_build_from from;
    } stages[] = {
        {"import", PROM_BUILD_FROM_START},      {"objects", PROM_BUILD_FROM_START},
        {"tree", PROM_BUILD_FROM_START},        {"textures", PROM_BUILD_FROM_START},
        {"levels", PROM_BUILD_FROM_START},      {"leaves", PROM_BUILD_FROM_LEAVES},
        {"clusters", PROM_BUILD_FROM_CLUSTERS}, {"view-cells", PROM_BUILD_FROM_VIEW_CELLS}};
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++)
        if (!strcmp(text, stages[i].stage)) {
            build->from = stages[i].from;
            return;
        }
    argp_error(state, "--from: `%s` is no stage; give levels, leaves, clusters or view-cells",
               text);
}

static error_t parse_work(prom_build_command *o, int key, char *text, struct argp_state *state)
{
    switch (key) {
    case 'j':
        o->jobs = (unsigned)prom_option_whole(state, "--jobs", text, 1, 64);
        break;
    case KEY_MEMORY:
        o->build.memory_mb =
            (uint32_t)prom_option_whole(state, "--memory-mb", text, 64, 1 << 24);
        break;
    case KEY_FORCE:
        o->build.from = PROM_BUILD_FROM_START;
        break;
    case KEY_FROM:
        parse_from(&o->build, text, state);
        break;
    case KEY_VETO:
        o->build.measure.veto = true;
        break;
    case KEY_KEEP_VIEWS:
        o->build.keep_views = true;
        break;
    case KEY_DROP_WORK:
        o->build.drop_work = true;
        break;
    default:
        return parse_import(o, key, text, state);
    }
    return 0;
}

static error_t parse_objects(prom_build_command *o, int key, char *text,
                             struct argp_state *state)
{
    prom_object_options *objects = &o->build.objects;
    switch (key) {
    case KEY_MAX_OBJECT:
        objects->max_triangles =
            (uint32_t)prom_option_whole(state, "--max-object-triangles", text, 16, 100000000);
        break;
    case KEY_MIN_OBJECT:
        objects->min_triangles =
            (uint32_t)prom_option_whole(state, "--min-object-triangles", text, 1, 100000000);
        break;
    case KEY_CHUNK_SIZE:
        objects->chunk_size = prom_option_number(state, "--chunk-size", text, 1e-6, 1e9);
        break;
    default:
        return parse_work(o, key, text, state);
    }
    return 0;
}

static void parse_divisions(prom_tree_options *tree, const char *text,
                            const struct argp_state *state)
{
    double n[3] = {1, 1, 1};
    prom_option_numbers(state, "--divisions", text, ',', 1, 1024, 3, n);
    for (int i = 0; i < 3; i++) {
        if (n[i] != (uint32_t)n[i])
            argp_error(state, "--divisions: `%s` is not in whole cells", text);
        tree->divisions[i] = (uint32_t)n[i];
    }
}

static error_t parse_tree(prom_build_command *o, int key, char *text, struct argp_state *state)
{
    prom_tree_options *tree = &o->build.tree;
    switch (key) {
    case KEY_OCTREE:
        if (!strcmp(text, "loose"))
            tree->octree = PROM_OCTREE_LOOSE;
        else if (!strcmp(text, "strict"))
            tree->octree = PROM_OCTREE_STRICT;
        else
            argp_error(state, "--octree: `%s` is neither loose nor strict", text);
        break;
    case KEY_DIVISIONS:
        parse_divisions(tree, text, state);
        break;
    case KEY_GROUP_RADIUS:
        tree->group_radius = prom_option_number(state, "--group-radius", text, 0, 1e9);
        break;
    case KEY_MAX_CHILDREN:
        tree->max_children =
            (uint32_t)prom_option_whole(state, "--max-children", text, 2, 1024);
        break;
    default:
        return parse_objects(o, key, text, state);
    }
    return 0;
}

// The strict tree's options mean nothing to the loose one and the other way round.
static void check_tree(const prom_tree_options *tree, const struct argp_state *state)
{
    bool strict = tree->octree == PROM_OCTREE_STRICT;
    if (!strict && (tree->divisions[0] || tree->group_radius > 0))
        argp_error(state, "--divisions and --group-radius are for --octree strict");
    if (strict && tree->max_children) argp_error(state, "--max-children is for --octree loose");
}

static void check_objects(const prom_object_options *objects, const struct argp_state *state)
{
    uint32_t most = objects->max_triangles, least = objects->min_triangles;
    if (most && least > most)
        argp_error(state,
                   "--min-object-triangles %" PRIu32 " is more than --max-object-triangles "
                   "%" PRIu32,
                   least, most);
}

static const char *known_metric(const struct argp_state *state, const char *name)
{
    if (!strcmp(name, PROM_METRIC_CONSTANT) || prom_metric_named(name)) return name;
    char names[256] = "";
    for (size_t i = 0, n = 0; i < prom_metric_count() && n < sizeof names; i++)
        n += (size_t)snprintf(names + n, sizeof names - n, "%s, ", prom_metric_at(i)->name);
    argp_error(state, "--metric: there is no `%s`; give %sor " PROM_METRIC_CONSTANT, name,
               names);
    return NULL;
}

static error_t parse_measure(prom_build_command *o, int key, char *text,
                             struct argp_state *state)
{
    prom_measure_options *measure = &o->build.measure;
    switch (key) {
    case KEY_METRIC:
        measure->metric = known_metric(state, text);
        break;
    case KEY_PPD:
        measure->ppd =
            (float)prom_option_number(state, "--ppd", text, PROM_PPD_MIN, PROM_PPD_MAX);
        break;
    default:
        return parse_tree(o, key, text, state);
    }
    return 0;
}

static error_t parse_view_cells(prom_build_command *o, int key, char *text,
                                struct argp_state *state)
{
    switch (key) {
    case KEY_VIEW_CELLS:
        prom_where_parse(&o->where, text, state);
        break;
    case KEY_VIEW_CELL_SIZE:
        o->cells.cell_size = prom_option_number(state, "--view-cell-size", text, 1e-3, 1e6);
        break;
    case KEY_VIEW_CELL_PX:
        o->cells.face_px = (uint32_t)prom_option_whole(state, "--view-cell-px", text, 64, 2048);
        break;
    default:
        return parse_measure(o, key, text, state);
    }
    return 0;
}

static void check_view_cells(const prom_build_command *o, const struct argp_state *state)
{
    if (!o->where.kind && (o->cells.cell_size > 0 || o->cells.face_px))
        argp_error(state, "--view-cell-size and --view-cell-px are for --view-cells");
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    prom_build_command *o = state->input;
    switch (key) {
    case 'o':
        o->output = text;
        break;
    case KEY_TEXTURE_MB:
        o->build.texture_mb =
            (uint32_t)prom_option_whole(state, "--texture-mb", text, 1, 1 << 20);
        break;
    case KEY_PROFILE:
        o->build.profile = text;
        break;
    case KEY_WEIGHT:
        prom_option_weight(state, text, &o->build.weights);
        break;
    case ARGP_KEY_ARG:
        prom_option_argument(state, text, &o->scene);
        break;
    case ARGP_KEY_END:
        prom_option_require(state, "the scene's file", o->scene);
        prom_option_require(state, "--output", o->output);
        check_tree(&o->build.tree, state);
        check_objects(&o->build.objects, state);
        check_view_cells(o, state);
        break;
    default:
        return parse_view_cells(o, key, text, state);
    }
    return 0;
}

static const struct argp_child children[] = {{&prom_argp_log, 0, NULL, -1}, {0}};

const struct argp prom_argp_build = {
    .options = options,
    .parser = parse,
    .args_doc = "SCENE",
    .doc =
        "Build a model from a scene: glTF, GLB, OBJ, PLY, FBX, DAE, 3DS, STL, AC and what else "
        "assimp reads.\v"
        "The model appears when the build has succeeded, or not at all; its view cells are put "
        "into it then, and without them it is as good. A build that was cut "
        "off goes on where it stopped when it is started again, and one with other options "
        "or a changed scene redoes only what depends on them: X.prom.work beside the model "
        "holds what was done. It may be deleted at any time.",
    .children = children,
};

#include "scenes/gallery_parts.h"

#include <unistd.h>

#define ROOMS_DEFAULT 24u
#define PAINTINGS_MAX 320u

static prom_status check(const prom_gallery_options *o, prom_error *error)
{
    if (o->rooms && (o->rooms < PROM_GALLERY_ROOMS_MIN || o->rooms > PROM_GALLERY_ROOMS_MAX))
        return prom_fail(error, PROM_ERR_USAGE,
                         "a gallery of %u rooms; it may have from %u to %u", o->rooms,
                         PROM_GALLERY_ROOMS_MIN, PROM_GALLERY_ROOMS_MAX);
    if (o->detail > PROM_GALLERY_DETAIL_MAX)
        return prom_fail(error, PROM_ERR_USAGE, "gallery detail %u; it goes from 1 to %u",
                         o->detail, PROM_GALLERY_DETAIL_MAX);
    return PROM_OK;
}

static uint32_t add_group(prom_gallery *g, const char *name, uint32_t parent)
{
    return prom_glb_add_node(
        g->glb,
        &(prom_glb_node){.name = name, .parent = parent, .mesh = PROM_GLB_NONE, .scale = 1});
}

static void init(prom_gallery *g, const prom_gallery_options *options, const char *glb_path)
{
    *g = (prom_gallery){.options = *options, .glb = prom_glb_create(glb_path)};
    if (!g->options.rooms) g->options.rooms = ROOMS_DEFAULT;
    if (!g->options.detail) g->options.detail = 2;
    for (int i = 0; i < PROM_GALLERY_TEXTURE_COUNT; i++) g->images[i] = PROM_GLB_NONE;
    for (int i = 0; i < PROM_GALLERY_THING_COUNT; i++)
        for (uint32_t k = 0; k < PROM_GALLERY_VARIANTS_MAX; k++)
            g->meshes[i][k] = PROM_GLB_NONE;
    prom_gallery_plan_init(&g->plan, &g->options);
    // Each painting has a picture of its own; a large gallery shows some of them twice, far
    // apart.
    uint32_t paintings = (2 + g->options.detail) * g->plan.room_count;
    g->painting_limit = paintings < PAINTINGS_MAX ? paintings : PAINTINGS_MAX;
    g->root = add_group(g, "gallery", PROM_GLB_NONE);
}

static void finish(prom_gallery *g)
{
    prom_glb_destroy(g->glb);
    prom_gallery_plan_finish(&g->plan);
    prom_array_finish(&g->paints);
    prom_array_finish(&g->paintings);
    prom_array_finish(&g->sights);
}

static const char *const kind_names[PROM_GALLERY_KIND_COUNT] = {
    [PROM_GALLERY_CABINET] = "cabinet",   [PROM_GALLERY_SCULPTURES] = "sculptures",
    [PROM_GALLERY_VITRINES] = "vitrines", [PROM_GALLERY_LIBRARY] = "library",
    [PROM_GALLERY_SALON] = "salon",       [PROM_GALLERY_MODERN] = "modern",
    [PROM_GALLERY_CORRIDOR] = "corridor", [PROM_GALLERY_HALL] = "hall",
    [PROM_GALLERY_ROTUNDA] = "rotunda",   [PROM_GALLERY_STAIRS] = "stairs",
    [PROM_GALLERY_COURT] = "court"};

static void build_room(prom_gallery *g, uint32_t id)
{
    const prom_gallery_room *r = &g->plan.rooms.data[id];
    char *name = prom_format("%s_%u", kind_names[r->kind], id);
    uint32_t group = add_group(g, name, g->root);
    prom_free(name);
    prom_gallery_build_shell(g, id, group);
    if (!g->options.roofless) prom_gallery_build_ceiling(g, id, group);
    if (r->kind == PROM_GALLERY_HALL) prom_gallery_build_hall(g, id, group);
    if (r->kind == PROM_GALLERY_ROTUNDA) prom_gallery_build_rotunda(g, id, group);
    if (r->kind == PROM_GALLERY_STAIRS) prom_gallery_build_stairs(g, id, group);
    prom_gallery_furnish(g, id, group);
}

static prom_status write_walk(const char *file, const prom_gallery *g, uint32_t *keys,
                              prom_error *error)
{
    prom_path path = {0};
    prom_gallery_walk(g, &path);
    *keys = (uint32_t)path.keys.count;
    prom_status status =
        prom_path_save(file, &path, "generated gallery, through its rooms", error);
    prom_path_finish(&path);
    return status;
}

prom_status prom_gallery_write(const char *glb_path, const char *path_file,
                               const prom_gallery_options *options, prom_gallery_facts *facts,
                               prom_error *error)
{
    prom_status status = check(options, error);
    if (status) return status;
    prom_gallery g;
    prom_gallery_facts made = {0};
    init(&g, options, glb_path);
    for (uint32_t i = 0; i < g.plan.rooms.count && !prom_glb_failed(g.glb); i++)
        build_room(&g, i);
    prom_gallery_build_outside(&g, add_group(&g, "outside", g.root));
    if (g.error.status)
        status = prom_fail(error, g.error.status, "%s", g.error.text);
    else
        status = prom_glb_finish(g.glb, "promenade gallery", error);
    if (!status && path_file) {
        status = write_walk(path_file, &g, &made.walk_keys, error);
        if (status) unlink(glb_path); // both or none
    }
    made.triangles = prom_glb_triangles(g.glb);
    made.rooms = g.plan.room_count;
    if (!status && facts) *facts = made;
    finish(&g);
    return status;
}

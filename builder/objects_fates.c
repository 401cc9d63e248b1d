// Fates: what becomes of each part of a scope.
//
// An instance stays as it is. Another part stays whole unless it is too large, sprawls over the
// scene, or has pieces that belong to another layer. Broken up, its pieces are backdrop, go to
// the surfaces, are halved when large, stand for themselves, or are gathered when small. Whole
// parts that are small are gathered too.
#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"

// A part whose pieces are small against it sprawls when it is wider than this share of the
// layout (a choice, the same as for surfaces).
#define SPRAWL_SHARE (1.0 / 8)

// What the parts of one scope, opaque or blended, put together.
typedef struct pool {
    prom_finder *finder;
    bool blended;
    PROM_ARRAY(prom_face) surface;
    PROM_ARRAY(uint32_t) small; // items
} pool;

static prom_layer layer_or_blended(const pool *p, prom_layer layer)
{
    return p->blended ? PROM_LAYER_BLENDED : layer;
}

static prom_face *item_faces(const prom_finder *finder, const prom_item *item)
{
    return finder->faces.data + item->first_face;
}

static void put_surface(pool *p, const prom_item *item)
{
    memcpy(prom_array_extend(&p->surface, item->face_count), item_faces(p->finder, item),
           item->face_count * sizeof(prom_face));
}

static void make_halves(pool *p, const prom_item *item)
{
    prom_spans pieces = {0};
    prom_cut_halves(p->finder, item_faces(p->finder, item), item->face_count, &pieces);
    double step = prom_snap_step(&pieces);
    for (size_t i = 0; i < pieces.count; i++)
        prom_make_shape(p->finder, pieces.data[i], layer_or_blended(p, PROM_LAYER_OBJECT), true,
                        step);
    prom_array_finish(&pieces);
}

static void put_item(pool *p, const prom_part *part, uint32_t index)
{
    prom_finder *finder = p->finder;
    const prom_item *item = &finder->items.data[index];
    if (item->backdrop) return; // made for the whole part
    if (item->surface)
        put_surface(p, item);
    else if (item->face_count < finder->options.min_triangles)
        prom_array_push(&p->small, index);
    else if (part->item_count == 1)
        prom_make_part(finder, part, false);
    else if (item->face_count > finder->options.max_triangles)
        make_halves(p, item);
    else
        prom_make_shape(finder,
                        (prom_span){item_faces(finder, item), item->face_count, item->bounds},
                        layer_or_blended(p, PROM_LAYER_OBJECT), false, 0);
}

// All backdrop pieces of a part are one object: they are always drawn.
static void make_backdrop(prom_finder *finder, const prom_part *part)
{
    PROM_ARRAY(prom_face) faces = {0};
    for (uint32_t i = 0; i < part->item_count; i++) {
        const prom_item *item = &finder->items.data[part->first_item + i];
        if (!item->backdrop) continue;
        memcpy(prom_array_extend(&faces, item->face_count), item_faces(finder, item),
               item->face_count * sizeof(prom_face));
    }
    if (faces.count) {
        prom_span span = {faces.data, faces.count,
                          prom_faces_bounds(finder, faces.data, faces.count)};
        prom_make_shape(finder, span, PROM_LAYER_BACKDROP, false, 0);
    }
    prom_array_finish(&faces);
}

static bool breaks_up(const prom_finder *finder, const prom_part *part)
{
    uint32_t most = finder->options.max_triangles;
    bool heavy = part->triangles / PROM_ALONE_FACTOR > most;
    if (finder->scope->one_thing) return heavy;
    if (part->item_count == 1) return heavy || finder->items.data[part->first_item].surface;
    if (part->triangles > most) return true;
    double widest = 0, diagonal = prom_wbox_diagonal(&part->bounds);
    for (uint32_t i = 0; i < part->item_count; i++) {
        const prom_item *item = &finder->items.data[part->first_item + i];
        if (item->surface || item->backdrop) return true;
        widest = fmax(widest, prom_wbox_diagonal(&item->bounds));
    }
    return diagonal > SPRAWL_SHARE * finder->scope->layout.diagonal && widest < diagonal / 2;
}

// One item for all of a part that stays whole; its pieces' faces stand together already.
static void merge_items(prom_finder *finder, prom_part *part)
{
    prom_item *first = &finder->items.data[part->first_item];
    first->face_count = part->triangles;
    first->bounds = part->bounds;
    part->item_count = 1;
}

// The only part of the whole scene, when it is mostly one connected piece and levels of detail
// alone cannot serve it, is treated like a surface.
static bool is_heavy_alone(const prom_finder *finder, const prom_part *part)
{
    if (finder->parts.count > 1 || !breaks_up(finder, part)) return false;
    uint32_t most = 0;
    for (uint32_t i = 0; i < part->item_count; i++) {
        uint32_t triangles = finder->items.data[part->first_item + i].face_count;
        most = triangles > most ? triangles : most;
    }
    return most > part->triangles / 2;
}

static void put_heavy_alone(pool *p, const prom_part *part)
{
    p->finder->split++;
    for (uint32_t i = 0; i < part->item_count; i++)
        put_surface(p, &p->finder->items.data[part->first_item + i]);
}

static void put_part(pool *p, prom_part *part)
{
    prom_finder *finder = p->finder;
    bool single = part->item_count == 1;
    if (!part->unique) {
        prom_make_part(finder, part, prom_is_backdrop(finder, &part->bounds, part->triangles));
    } else if (is_heavy_alone(finder, part)) {
        put_heavy_alone(p, part);
    } else if (single && finder->items.data[part->first_item].backdrop) {
        prom_make_part(finder, part, true);
    } else if (!breaks_up(finder, part)) {
        merge_items(finder, part);
        put_item(p, part, part->first_item);
    } else {
        finder->split++;
        make_backdrop(finder, part);
        if (single && !finder->items.data[part->first_item].surface)
            make_halves(p, &finder->items.data[part->first_item]);
        else
            for (uint32_t i = 0; i < part->item_count; i++)
                put_item(p, part, part->first_item + i);
    }
}

static void make_surface(pool *p)
{
    prom_spans chunks = {0};
    prom_cut_chunks(p->finder, p->surface.data, p->surface.count, &chunks);
    double step = prom_snap_step(&chunks);
    for (size_t i = 0; i < chunks.count; i++)
        prom_make_shape(p->finder, chunks.data[i], layer_or_blended(p, PROM_LAYER_SURFACE),
                        true, step);
    prom_array_finish(&chunks);
}

static void make_gathered(pool *p)
{
    prom_finder *finder = p->finder;
    size_t triangles = 0;
    for (size_t i = 0; i < p->small.count; i++)
        triangles += finder->items.data[p->small.data[i]].face_count;
    prom_face *faces = prom_alloc(triangles, sizeof *faces);
    prom_spans objects = {0};
    prom_gather(finder, p->small.data, p->small.count, faces, &objects);
    for (size_t i = 0; i < objects.count; i++)
        prom_make_shape(finder, objects.data[i], layer_or_blended(p, PROM_LAYER_OBJECT), false,
                        0);
    finder->gathered += (uint32_t)objects.count;
    prom_array_finish(&objects);
    prom_free(faces);
}

void prom_make_scope(prom_finder *finder, const prom_scope *scope)
{
    finder->scope = scope;
    finder->split = finder->gathered = 0;
    for (int blended = 0; blended < 2; blended++) {
        pool p = {.finder = finder, .blended = blended};
        for (uint32_t i = 0; i < scope->part_count; i++) {
            prom_part *part = &finder->parts.data[scope->first_part + i];
            if (part->blended == p.blended) put_part(&p, part);
        }
        make_surface(&p);
        make_gathered(&p);
        prom_array_finish(&p.surface);
        prom_array_finish(&p.small);
    }
}

// Shapes: geometry copied out of the source, submeshes by material.
#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"

#include <stdlib.h>

uint32_t prom_face_material(const prom_finder *finder, prom_face face)
{
    return finder->source->meshes.data[finder->uses.data[face.use].mesh].submeshes[0].material;
}

// A node without a name goes by its nearest ancestor's.
uint32_t prom_node_name(prom_finder *finder, uint32_t node)
{
    if (finder->node_name[node] != PROM_NONE) return finder->node_name[node];
    const prom_source_node *nodes = finder->source->nodes.data;
    uint32_t n = node;
    while (n != PROM_NONE && !(nodes[n].name && nodes[n].name[0])) n = nodes[n].parent;
    uint32_t offset = 0;
    if (n != PROM_NONE && n != node) {
        offset = prom_node_name(finder, n);
    } else if (n != PROM_NONE) {
        size_t bytes = strlen(nodes[n].name) + 1;
        offset = (uint32_t)finder->out->names.count;
        memcpy(prom_array_extend(&finder->out->names, bytes), nodes[n].name, bytes);
    }
    return finder->node_name[node] = offset;
}

double prom_snap_step(const prom_spans *pieces)
{
    double widest = 0;
    for (size_t i = 0; i < pieces->count; i++)
        for (int k = 0; k < 3; k++)
            widest =
                fmax(widest, pieces->data[i].bounds.max[k] - pieces->data[i].bounds.min[k]);
    // Half of the extent is below 2^exponent; a float holds 2^24 steps exactly, twice as many
    // as are used here, which leaves room for centres that are off by a step.
    int exponent;
    (void)frexp(widest / 2, &exponent);
    return widest > 0 ? ldexp(1, exponent - 23) : 0;
}

typedef struct face_key {
    uint32_t material;
    prom_face face;
} face_key;

static int by_material(const void *pa, const void *pb)
{
    const face_key *a = pa, *b = pb;
    if (a->material != b->material) return a->material < b->material ? -1 : 1;
    if (a->face.use != b->face.use) return a->face.use < b->face.use ? -1 : 1;
    return a->face.triangle < b->face.triangle ? -1 : a->face.triangle > b->face.triangle;
}

// Sorts the faces by material and returns the number of materials.
static uint32_t sort_faces(const prom_finder *finder, prom_span span)
{
    face_key *keys = prom_alloc(span.count, sizeof *keys);
    for (size_t i = 0; i < span.count; i++)
        keys[i] = (face_key){prom_face_material(finder, span.faces[i]), span.faces[i]};
    qsort(keys, span.count, sizeof *keys, by_material);
    uint32_t materials = 0;
    for (size_t i = 0; i < span.count; i++) {
        span.faces[i] = keys[i].face;
        materials += !i || keys[i].material != keys[i - 1].material;
    }
    prom_free(keys);
    return materials;
}

// Numbers the vertices that the faces use.
static uint32_t number_vertices(prom_finder *finder, prom_span span)
{
    uint32_t stamp = ++finder->stamp, count = 0;
    for (size_t i = 0; i < span.count; i++) {
        prom_use *use = &finder->uses.data[span.faces[i].use];
        const uint32_t *t =
            finder->source->meshes.data[use->mesh].indices + 3 * (size_t)span.faces[i].triangle;
        for (int k = 0; k < 3; k++) {
            if (use->stamp[t[k]] == stamp) continue;
            use->stamp[t[k]] = stamp;
            use->copy[t[k]] = count++;
        }
    }
    return count;
}

static double snap(double value, double step)
{
    return step > 0 ? rint(value / step) * step : value;
}

static void copy_vertex(const prom_finder *finder, const prom_use *use, uint32_t vertex,
                        const double center[3], double step, prom_vertex *out)
{
    const prom_vertex *in = &finder->source->meshes.data[use->mesh].vertices[vertex];
    *out = *in;
    for (int k = 0; k < 3; k++)
        out->position[k] = (float)(snap(use->world[vertex][k], step) - center[k]);
    prom_turn_normal(use->normal, in->normal, out->normal);
}

static void fill_mesh(const prom_finder *finder, prom_span span, const double center[3],
                      double step, prom_mesh *mesh)
{
    prom_submesh *sub = mesh->submeshes;
    for (size_t i = 0; i < span.count; i++) {
        const prom_use *use = &finder->uses.data[span.faces[i].use];
        const uint32_t *t =
            finder->source->meshes.data[use->mesh].indices + 3 * (size_t)span.faces[i].triangle;
        uint32_t material = prom_face_material(finder, span.faces[i]);
        if (i && material != sub->material) sub++;
        if (!sub->index_count) {
            sub->first_index = (uint32_t)(3 * i);
            sub->material = material;
        }
        sub->index_count += 3;
        for (int k = 0; k < 3; k++) {
            uint32_t v = t[use->mirrored && k ? 3 - k : k];
            mesh->indices[3 * i + (size_t)k] = use->copy[v];
            copy_vertex(finder, use, v, center, step, &mesh->vertices[use->copy[v]]);
        }
    }
}

// The node that most of the faces come from.
static uint32_t commonest_node(prom_finder *finder, prom_span span)
{
    uint32_t best = PROM_NONE, most = 0;
    for (size_t i = 0; i < span.count; i++) {
        uint32_t node = finder->uses.data[span.faces[i].use].node;
        uint32_t weight = ++finder->node_weight[node];
        if (weight > most || (weight == most && node < best)) {
            most = weight;
            best = node;
        }
    }
    for (size_t i = 0; i < span.count; i++)
        finder->node_weight[finder->uses.data[span.faces[i].use].node] = 0;
    return best;
}

static void add_object(prom_finder *finder, uint32_t shape, uint32_t node,
                       const prom_placement *placement)
{
    finder->out->shapes.data[shape].instances++;
    prom_array_push(&finder->out->objects, (prom_object){.shape = shape,
                                                         .name = prom_node_name(finder, node),
                                                         .node = node,
                                                         .group = PROM_NONE,
                                                         .placement = *placement});
}

void prom_make_shape(prom_finder *finder, prom_span span, prom_layer layer, bool lock_border,
                     double step)
{
    prom_placement at = prom_placement_identity;
    prom_wbox_center(&span.bounds, at.origin);
    for (int k = 0; k < 3; k++) at.origin[k] = snap(at.origin[k], step);
    uint32_t materials = sort_faces(finder, span);
    uint32_t vertices = number_vertices(finder, span);
    prom_shape shape = {.layer = layer, .lock_border = lock_border, .until = INFINITY};
    prom_mesh_init(&shape.mesh, vertices, (uint32_t)(3 * span.count), materials);
    fill_mesh(finder, span, at.origin, step, &shape.mesh);
    shape.bounds = prom_mesh_bounds(&shape.mesh);
    prom_array_push(&finder->out->shapes, shape);
    add_object(finder, (uint32_t)finder->out->shapes.count - 1, commonest_node(finder, span),
               &at);
}

// ---- whole parts, in their own frame

typedef struct mesh_key {
    uint32_t material, mesh, order;
} mesh_key;

static int by_mesh_material(const void *pa, const void *pb)
{
    const mesh_key *a = pa, *b = pb;
    if (a->material != b->material) return a->material < b->material ? -1 : 1;
    return a->order < b->order ? -1 : 1;
}

static void append_mesh(const prom_mesh *in, uint32_t material, const float stretch[3],
                        prom_mesh *out, uint32_t *vertices, uint32_t *indices,
                        uint32_t *submeshes)
{
    float normal[9] = {stretch[1] * stretch[2], 0, 0, 0, stretch[0] * stretch[2], 0, 0, 0,
                       stretch[0] * stretch[1]};
    bool stretched = stretch[0] != 1 || stretch[1] != 1 || stretch[2] != 1;
    for (uint32_t v = 0; v < in->vertex_count; v++) {
        prom_vertex *o = &out->vertices[*vertices + v];
        *o = in->vertices[v];
        if (!stretched) continue;
        for (int k = 0; k < 3; k++) o->position[k] *= stretch[k];
        prom_turn_normal(normal, in->vertices[v].normal, o->normal);
    }
    for (uint32_t i = 0; i < in->index_count; i++)
        out->indices[*indices + i] = *vertices + in->indices[i];
    prom_submesh *sub = *submeshes ? &out->submeshes[*submeshes - 1] : NULL;
    if (!sub || sub->material != material) {
        sub = &out->submeshes[(*submeshes)++];
        *sub = (prom_submesh){.first_index = *indices, .material = material};
    }
    sub->index_count += in->index_count;
    *vertices += in->vertex_count;
    *indices += in->index_count;
}

// `count` of the part's meshes, or of a level's, from `first` on.
static void copy_meshes(const prom_finder *finder, const prom_part *part, uint32_t first,
                        uint32_t count, prom_mesh *out)
{
    const prom_mesh *meshes = finder->source->meshes.data;
    mesh_key *keys = prom_alloc(count, sizeof *keys);
    uint32_t vertices = 0, indices = 0, submeshes = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t mesh = finder->part_meshes.data[first + i];
        keys[i] = (mesh_key){meshes[mesh].submeshes[0].material, mesh, i};
        vertices += meshes[mesh].vertex_count;
        indices += meshes[mesh].index_count;
    }
    qsort(keys, count, sizeof *keys, by_mesh_material);
    for (uint32_t i = 0; i < count; i++)
        submeshes += !i || keys[i].material != keys[i - 1].material;
    prom_mesh_init(out, vertices, indices, submeshes);
    float stretch[3];
    for (int k = 0; k < 3; k++) stretch[k] = prom_part_stretch(part, k);
    vertices = indices = submeshes = 0;
    for (uint32_t i = 0; i < count; i++)
        append_mesh(&meshes[keys[i].mesh], keys[i].material, stretch, out, &vertices, &indices,
                    &submeshes);
    prom_free(keys);
}

// A billboard in place of a tree may be wider than the tree.
static void add_bounds(prom_box *box, const prom_mesh *mesh)
{
    prom_box more = prom_mesh_bounds(mesh);
    for (int k = 0; k < 3; k++) {
        box->min[k] = fminf(box->min[k], more.min[k]);
        box->max[k] = fmaxf(box->max[k], more.max[k]);
    }
}

static void copy_levels(const prom_finder *finder, const prom_part *part, prom_shape *shape)
{
    shape->until = part->level_count ? part->until : INFINITY;
    shape->level_count = part->level_count;
    if (!part->level_count) return;
    shape->levels = prom_calloc(part->level_count, sizeof *shape->levels);
    for (uint32_t i = 0; i < part->level_count; i++) {
        const prom_part_level *from = &finder->part_levels.data[part->first_level + i];
        shape->levels[i].until = from->until;
        copy_meshes(finder, part, from->first_mesh, from->mesh_count, &shape->levels[i].mesh);
    }
}

void prom_make_part(prom_finder *finder, const prom_part *part, bool backdrop)
{
    uint32_t *shape = &finder->kind_shape[2 * (size_t)part->kind + backdrop];
    if (*shape == PROM_NONE) {
        prom_shape s = {.layer = backdrop        ? PROM_LAYER_BACKDROP
                                 : part->blended ? PROM_LAYER_BLENDED
                                                 : PROM_LAYER_OBJECT};
        copy_meshes(finder, part, part->first_mesh, part->mesh_count, &s.mesh);
        copy_levels(finder, part, &s);
        s.bounds = prom_mesh_bounds(&s.mesh);
        for (uint32_t i = 0; i < s.level_count; i++) add_bounds(&s.bounds, &s.levels[i].mesh);
        *shape = (uint32_t)finder->out->shapes.count;
        prom_array_push(&finder->out->shapes, s);
    }
    add_object(finder, *shape, part->node, &part->placement);
}

// Items: the connected pieces of parts. Vertices at equal positions are one for this purpose;
// meshes (that is: materials) are looked at one by one, so that a road does not hold on to the
// houses that touch it.
#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"

static uint32_t hash_position(const float p[3])
{
    uint32_t h = 2166136261u;
    for (int k = 0; k < 3; k++) {
        float f = p[k] + 0.0f; // no negative zero
        uint32_t bits;
        memcpy(&bits, &f, sizeof bits);
        h = (h ^ bits) * 0x9e3779b1u;
        h ^= h >> 15;
    }
    return h;
}

// root[v]: the first vertex at v's position.
static void weld(const prom_mesh *mesh, uint32_t *root)
{
    size_t slots = 16;
    while (slots < 2 * (size_t)mesh->vertex_count) slots *= 2;
    uint32_t *table = prom_alloc(slots, sizeof *table);
    memset(table, 0xff, slots * sizeof *table);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *p = mesh->vertices[v].position;
        size_t s = hash_position(p) & (slots - 1);
        while (table[s] != PROM_NONE) {
            const float *q = mesh->vertices[table[s]].position;
            if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) break;
            s = (s + 1) & (slots - 1);
        }
        if (table[s] == PROM_NONE) table[s] = v;
        root[v] = table[s];
    }
    prom_free(table);
}

static uint32_t find(uint32_t *root, uint32_t v)
{
    while (root[v] != v) {
        root[v] = root[root[v]];
        v = root[v];
    }
    return v;
}

static void join(uint32_t *root, uint32_t a, uint32_t b)
{
    a = find(root, a);
    b = find(root, b);
    if (a < b)
        root[b] = a;
    else
        root[a] = b;
}

static void place_vertices(prom_use *use, const prom_mesh *mesh, const double w[16])
{
    use->world = prom_alloc(mesh->vertex_count, sizeof *use->world);
    use->copy = prom_alloc(mesh->vertex_count, sizeof *use->copy);
    use->stamp = prom_calloc(mesh->vertex_count, sizeof *use->stamp);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *p = mesh->vertices[v].position;
        for (int r = 0; r < 3; r++)
            use->world[v][r] = w[r] * p[0] + w[4 + r] * p[1] + w[8 + r] * p[2] + w[12 + r];
        prom_wbox_add_point(&use->bounds, use->world[v]);
    }
}

// Appends the use's faces, component after component in the order of their first triangles.
static void split_use(prom_finder *finder, uint32_t use, uint32_t part)
{
    const prom_mesh *mesh = &finder->source->meshes.data[finder->uses.data[use].mesh];
    uint32_t triangles = mesh->index_count / 3;
    uint32_t *root = prom_alloc(mesh->vertex_count, sizeof *root);
    weld(mesh, root);
    for (uint32_t t = 0; t < triangles; t++) {
        const uint32_t *i = mesh->indices + 3 * (size_t)t;
        join(root, i[0], i[1]);
        join(root, i[0], i[2]);
    }
    uint32_t *item_of = prom_alloc(mesh->vertex_count, sizeof *item_of);
    memset(item_of, 0xff, mesh->vertex_count * sizeof *item_of);
    for (uint32_t t = 0; t < triangles; t++) {
        uint32_t r = find(root, mesh->indices[3 * (size_t)t]);
        if (item_of[r] == PROM_NONE) {
            item_of[r] = (uint32_t)finder->items.count;
            prom_array_push(&finder->items, (prom_item){.part = part});
        }
        finder->items.data[item_of[r]].face_count++;
    }
    uint32_t first = (uint32_t)finder->faces.count;
    (void)prom_array_extend(&finder->faces, triangles);
    for (uint32_t i = item_of[find(root, mesh->indices[0])]; i < finder->items.count; i++) {
        prom_item *item = &finder->items.data[i];
        item->first_face = first;
        first += item->face_count;
        item->face_count = 0;
    }
    for (uint32_t t = 0; t < triangles; t++) {
        prom_item *item =
            &finder->items.data[item_of[find(root, mesh->indices[3 * (size_t)t])]];
        finder->faces.data[item->first_face + item->face_count++] = (prom_face){use, t};
    }
    prom_free(item_of);
    prom_free(root);
}

static void split_part(prom_finder *finder, uint32_t part)
{
    prom_part *p = &finder->parts.data[part];
    p->first_item = (uint32_t)finder->items.count;
    for (uint32_t i = 0; i < p->mesh_count; i++) {
        uint32_t mesh = finder->part_meshes.data[p->first_mesh + i];
        prom_use use = {.node = p->node, .mesh = mesh, .bounds = PROM_WBOX_EMPTY};
        const double *world = finder->source->nodes.data[p->node].world;
        use.mirrored = prom_normal_matrix(world, use.normal);
        place_vertices(&use, &finder->source->meshes.data[mesh], world);
        prom_array_push(&finder->uses, use);
        split_use(finder, (uint32_t)finder->uses.count - 1, part);
    }
    p->item_count = (uint32_t)finder->items.count - p->first_item;
    p->bounds = PROM_WBOX_EMPTY;
    for (uint32_t i = 0; i < p->item_count; i++) {
        prom_item *item = &finder->items.data[p->first_item + i];
        item->bounds =
            prom_faces_bounds(finder, finder->faces.data + item->first_face, item->face_count);
        prom_wbox_add(&p->bounds, &item->bounds);
    }
}

void prom_find_items(prom_finder *finder)
{
    for (uint32_t i = 0; i < finder->parts.count; i++)
        if (finder->parts.data[i].unique) split_part(finder, i);
}

prom_wbox prom_faces_bounds(const prom_finder *finder, const prom_face *faces, size_t count)
{
    prom_wbox box = PROM_WBOX_EMPTY;
    for (size_t i = 0; i < count; i++) {
        const prom_use *use = &finder->uses.data[faces[i].use];
        const uint32_t *t =
            finder->source->meshes.data[use->mesh].indices + 3 * (size_t)faces[i].triangle;
        for (int k = 0; k < 3; k++) prom_wbox_add_point(&box, use->world[t[k]]);
    }
    return box;
}

void prom_face_centroid(const prom_finder *finder, prom_face face, double out[3])
{
    const prom_use *use = &finder->uses.data[face.use];
    const uint32_t *t =
        finder->source->meshes.data[use->mesh].indices + 3 * (size_t)face.triangle;
    for (int k = 0; k < 3; k++)
        out[k] = (use->world[t[0]][k] + use->world[t[1]][k] + use->world[t[2]][k]) / 3;
}

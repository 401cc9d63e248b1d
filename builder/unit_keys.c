// Keys of units of work: hashes of all that a unit's results depend on, so that equal keys mean
// equal results.
#include "builder/build.h"

#include "metaobj/base/hash.h"

#include <stdio.h>

// Another program may compute otherwise: its own bytes are part of every key.
static uint64_t hash_of_program(void)
{
    enum { BLOCK = 1 << 16 };
    uint64_t h = 0;
    FILE *f = fopen("/proc/self/exe", "rb");
    uint8_t *block = prom_alloc(BLOCK, 1);
    for (size_t n; f && (n = fread(block, 1, BLOCK, f)) > 0;) h = prom_hash(block, n, h);
    prom_free(block);
    if (f) fclose(f);
    return h;
}

void prom_keys_of_program(prom_build_state *b)
{
    b->program_key = hash_of_program();
}

void prom_keys_of_device(prom_build_state *b)
{
    const char *renderer = prom_context_renderer(b->context);
    b->device_key = prom_hash(renderer, strlen(renderer), b->program_key);
}

void prom_keys_of_materials(prom_build_state *b)
{
    b->material_keys = prom_calloc(b->source.materials.count, sizeof *b->material_keys);
    uint64_t *pictures = prom_calloc(b->source.images.count, sizeof *pictures);
    for (size_t i = 0; i < b->source.images.count; i++)
        pictures[i] = prom_texture_hash(&b->textures[i], 0);
    for (size_t i = 0; i < b->source.materials.count; i++) {
        prom_material m = b->source.materials.data[i];
        uint64_t picture = m.texture == PROM_NONE ? 0 : pictures[m.texture];
        m.texture = 0; // its number does not count
        b->material_keys[i] = prom_hash(&m, sizeof m, picture);
    }
    prom_free(pictures);
}

static uint64_t hash_mesh(const prom_build_state *b, const prom_mesh *mesh, uint64_t h)
{
    h = prom_mesh_hash(mesh, h);
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        uint32_t m = mesh->submeshes[s].material;
        if (m != PROM_NONE) h = prom_hash(&b->material_keys[m], sizeof *b->material_keys, h);
    }
    return h;
}

uint64_t prom_key_of_levels(const prom_build_state *b, uint32_t shape)
{
    const prom_shape *s = &b->objects.shapes.data[shape];
    uint32_t marks[3] = {s->layer, s->lock_border, s->level_count};
    uint64_t h = prom_hash(marks, sizeof marks, b->program_key);
    h = prom_hash(&s->until, sizeof s->until, h);
    h = hash_mesh(b, &s->mesh, h);
    for (uint32_t l = 0; l < s->level_count; l++) {
        h = prom_hash(&s->levels[l].until, sizeof s->levels[l].until, h);
        h = hash_mesh(b, &s->levels[l].mesh, h);
    }
    return h;
}

// What every measurement depends on.
static uint64_t measured(const prom_build_state *b, uint32_t prototype)
{
    uint32_t boxed = b->boxed[prototype];
    uint64_t h = prom_hash(&b->mean_luminance, sizeof b->mean_luminance, b->device_key);
    return prom_hash(&boxed, sizeof boxed, h);
}

uint64_t prom_key_of_leaf(const prom_build_state *b, uint32_t shape)
{
    const uint64_t levels = b->shapes[shape].levels_key;
    return prom_hash(&levels, sizeof levels, measured(b, shape));
}

typedef uint64_t (*child_key)(const prom_build_state *b, const prom_tree_node *child);

static uint64_t merge_key_of_child(const prom_build_state *b, const prom_tree_node *child)
{
    return child->object != PROM_NONE
               ? b->shapes[b->objects.objects.data[child->object].shape].levels_key
               : b->clusters[child->cluster].merge_key;
}

static uint64_t cluster_key_of_child(const prom_build_state *b, const prom_tree_node *child)
{
    return child->object != PROM_NONE
               ? b->shapes[b->objects.objects.data[child->object].shape].leaf_key
               : b->clusters[child->cluster].cluster_key;
}

// The children and where they stand in the cluster's frame.
static uint64_t hash_children(const prom_build_state *b, uint32_t node, child_key key_of,
                              uint64_t h)
{
    const prom_tree_node *n = &b->tree.nodes.data[node];
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++) {
        const prom_tree_node *child = &b->tree.nodes.data[c];
        uint64_t key = key_of(b, child);
        prom_placement at = prom_placement_identity;
        memcpy(at.origin, child->origin, sizeof at.origin);
        if (child->object != PROM_NONE) at = b->objects.objects.data[child->object].placement;
        for (int a = 0; a < 3; a++) at.origin[a] -= n->origin[a];
        h = prom_hash(&key, sizeof key, h);
        h = prom_hash(at.origin, sizeof at.origin, h);
        h = prom_hash(at.basis, sizeof at.basis, h);
    }
    return h;
}

static uint64_t hash_cluster(const prom_tree_cluster *c, uint64_t h)
{
    uint32_t marks[3] = {c->child_count, c->layer, c->mixed};
    return prom_hash(marks, sizeof marks, h);
}

uint64_t prom_key_of_merge(const prom_build_state *b, uint32_t cluster)
{
    const prom_tree_cluster *c = &b->tree.clusters.data[cluster];
    return hash_children(b, c->node, merge_key_of_child, hash_cluster(c, b->program_key));
}

// The bounds are part of it: they depend on places in the world, by rounding.
uint64_t prom_key_of_cluster(const prom_build_state *b, uint32_t cluster)
{
    const prom_tree_cluster *c = &b->tree.clusters.data[cluster];
    uint32_t p = (uint32_t)b->objects.shapes.count + cluster;
    const prom_prototype *proto = &b->prototypes[p];
    uint64_t h = hash_cluster(c, measured(b, p));
    h = prom_hash(proto->center, sizeof proto->center, h);
    h = prom_hash(proto->half, sizeof proto->half, h);
    h = prom_hash(&proto->radius, sizeof proto->radius, h);
    return hash_children(b, c->node, cluster_key_of_child, h);
}

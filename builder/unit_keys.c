// Keys of units of work: hashes of all that a unit's results depend on, so that equal keys mean
// equal results.
#include "builder/build.h"

#include "metaobj/base/hash.h"

#include <link.h>
#include <stdio.h>
#include <time.h>

// The program's own bytes. One that cannot be read is equal to no other.
static uint64_t hash_of_program(void)
{
    enum { BLOCK = 1 << 16 };
    uint64_t h = 0;
    FILE *f = fopen("/proc/self/exe", "rb");
    uint8_t *block = prom_alloc(BLOCK, 1);
    for (size_t n; f && (n = fread(block, 1, BLOCK, f)) > 0;) h = prom_hash(block, n, h);
    if (!f || ferror(f)) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        const int64_t moment[2] = {now.tv_sec, now.tv_nsec};
        h = prom_hash(moment, sizeof moment, h);
    }
    prom_free(block);
    if (f) fclose(f);
    return h;
}

// The notes of a library hold the id of its build.
static int add_library(struct dl_phdr_info *library, size_t size, void *user)
{
    (void)size;
    uint64_t *h = user;
    if (!strncmp(library->dlpi_name, "linux-vdso", 10)) return 0; // the kernel's: no results
    for (int i = 0; i < library->dlpi_phnum; i++) {
        const ElfW(Phdr) *part = &library->dlpi_phdr[i];
        const void *notes = (const void *)(library->dlpi_addr + part->p_vaddr);
        if (part->p_type == PT_NOTE) *h = prom_hash(notes, part->p_memsz, *h);
    }
    return 0;
}

// Another program may compute otherwise, and so may this one with other libraries.
uint64_t prom_key_of_program(void)
{
    uint64_t h = hash_of_program();
    dl_iterate_phdr(add_library, &h);
    return h;
}

uint64_t prom_key_of_device(const prom_context *context, uint64_t program_key)
{
    const char *device = prom_context_renderer(context);
    const char *driver = prom_context_version(context);
    return prom_hash(driver, strlen(driver), prom_hash(device, strlen(device), program_key));
}

// The renderer draws in the order of the sizes in which pictures come first; where faces of
// different pictures lie at equal depth, what is seen depends on it.
static uint64_t hash_of_size_order(const prom_build_state *b, uint64_t h)
{
    uint64_t seen = 0; // sides are powers of two
    for (size_t i = 0; i < b->source.images.count; i++) {
        uint32_t side = b->textures[i].width;
        if (!(seen & side)) h = prom_hash(&side, sizeof side, h);
        seen |= side;
    }
    return h;
}

void prom_keys_of_materials(prom_build_state *b)
{
    b->device_key = hash_of_size_order(b, b->device_key);
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

// prom_mesh_hash takes turned triangles for equal, but what is made of them need not be.
static uint64_t hash_mesh(const prom_build_state *b, const prom_mesh *mesh, uint64_t h)
{
    h = prom_mesh_hash(mesh, h);
    h = prom_hash(mesh->indices, mesh->index_count * sizeof *mesh->indices, h);
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

// What every picture depends on.
static uint64_t drawn(const prom_build_state *b, uint32_t prototype)
{
    uint32_t pictures[2] = {b->boxed[prototype], b->atlased[prototype]};
    return prom_hash(pictures, sizeof pictures, b->device_key);
}

uint64_t prom_key_of_leaf_views(const prom_build_state *b, uint32_t shape)
{
    const uint64_t levels = b->shapes[shape].levels_key;
    return prom_hash(&levels, sizeof levels, drawn(b, shape));
}

uint64_t prom_key_of_measured(const prom_build_state *b, uint64_t views_key)
{
    const uint64_t how = prom_measure_key(b->measure);
    return prom_hash(&how, sizeof how, views_key);
}

void prom_key_add_placed(uint64_t *key, uint64_t part, const double origin[3],
                         const float basis[9])
{
    uint64_t h = prom_hash(&part, sizeof part, *key);
    h = prom_hash(origin, 3 * sizeof *origin, h);
    *key = prom_hash(basis, 9 * sizeof *basis, h);
}

static uint64_t hash_cluster(const prom_tree_cluster *c, uint64_t h)
{
    uint32_t marks[3] = {c->child_count, c->layer, c->mixed};
    return prom_hash(marks, sizeof marks, h);
}

uint64_t prom_key_of_merge(const prom_build_state *b, uint32_t cluster)
{
    return hash_cluster(&b->tree.clusters.data[cluster], b->program_key);
}

uint64_t prom_key_of_cluster_views(const prom_build_state *b, uint32_t cluster)
{
    uint32_t p = (uint32_t)b->objects.shapes.count + cluster;
    const prom_prototype *proto = &b->prototypes[p];
    const uint64_t merge = b->clusters[cluster].merge_key;
    uint64_t h = hash_cluster(&b->tree.clusters.data[cluster], drawn(b, p));
    h = prom_hash(proto->center, sizeof proto->center, h);
    h = prom_hash(proto->half, sizeof proto->half, h);
    h = prom_hash(&proto->radius, sizeof proto->radius, h);
    return prom_hash(&merge, sizeof merge, h);
}

// Repeated assemblies: equal subtrees of the source's hierarchy.
//
// Two subtrees are equal when their nodes name the same meshes and levels, the matrices below
// their heads are equal to the bit, and the heads themselves are turned and scaled alike in the
// world; only where the heads stand may differ. Larger subtrees are taken before smaller ones,
// so that a repeated house inside a repeated street is no group of its own.
#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/hash.h"

#include <stdlib.h>

// Fewer objects than this are not worth a group (a choice).
enum { LEAST_OBJECTS = 8 };

typedef struct subtree {
    uint64_t hash;
    uint32_t objects, nodes; // in the subtree
    uint32_t node;
} subtree;

static int by_size_then_hash(const void *pa, const void *pb)
{
    const subtree *a = pa, *b = pb;
    if (a->objects != b->objects) return a->objects < b->objects ? 1 : -1;
    if (a->nodes != b->nodes) return a->nodes < b->nodes ? 1 : -1;
    if (a->hash != b->hash) return a->hash < b->hash ? -1 : 1;
    return a->node < b->node ? -1 : 1;
}

static bool matrix_finite(const double m[16])
{
    for (int k = 0; k < 16; k++)
        if (!isfinite(m[k])) return false;
    return true;
}

static uint64_t hash_meshes(const prom_source *source, uint32_t first, uint32_t count,
                            uint64_t h)
{
    return prom_hash(source->mesh_refs.data + first, count * sizeof(uint32_t), h);
}

// Hashes from the leaves up, children after their parent in the array of nodes.
static void hash_subtrees(const prom_source *source, subtree *trees)
{
    for (uint32_t i = 0; i < source->nodes.count; i++) trees[i] = (subtree){.node = i};
    for (size_t i = source->nodes.count; i-- > 0;) {
        const prom_source_node *n = &source->nodes.data[i];
        subtree *t = &trees[i];
        t->nodes++;
        if (n->mesh_count) {
            t->objects++;
            t->hash = hash_meshes(source, n->first_mesh, n->mesh_count, t->hash);
        }
        for (uint32_t k = 0; k < n->level_count; k++) {
            const prom_source_level *l = &source->levels.data[n->first_level + k];
            const float until[2] = {n->until, l->until};
            t->hash = prom_hash(until, sizeof until, t->hash);
            t->hash = hash_meshes(source, l->first_mesh, l->mesh_count, t->hash);
        }
        if (n->parent == PROM_NONE) continue;
        subtree *up = &trees[n->parent];
        up->objects += t->objects;
        up->nodes += t->nodes;
        up->hash = prom_hash(n->local, sizeof n->local, up->hash);
        up->hash = prom_hash(&t->hash, sizeof t->hash, up->hash);
    }
}

// The children of every node: first[i]..first[i + 1] in `list`.
static void list_children(const prom_source *source, uint32_t *first, uint32_t *list)
{
    size_t n = source->nodes.count;
    memset(first, 0, (n + 1) * sizeof *first);
    for (size_t i = 0; i < n; i++) {
        uint32_t parent = source->nodes.data[i].parent;
        if (parent != PROM_NONE) first[parent + 1]++;
    }
    for (size_t i = 0; i < n; i++) first[i + 1] += first[i];
    // Filled from behind, which leaves every first[i + 1] at the start of its own run.
    for (size_t i = n; i-- > 0;) {
        uint32_t parent = source->nodes.data[i].parent;
        if (parent != PROM_NONE) list[--first[parent + 1]] = (uint32_t)i;
    }
    for (size_t i = 0; i < n; i++) first[i] = first[i + 1];
    uint32_t children = 0;
    for (size_t i = 0; i < n; i++) children += source->nodes.data[i].parent != PROM_NONE;
    first[n] = children;
}

typedef struct marker {
    uint32_t *first, *list, *stack;
    bool *taken;
} marker;

static void mark_subtree(prom_finder *finder, const marker *m, uint32_t root, uint32_t scope)
{
    size_t depth = 0;
    m->stack[depth++] = root;
    while (depth) {
        uint32_t n = m->stack[--depth];
        finder->node_scope[n] = scope;
        m->taken[n] = true;
        for (uint32_t c = m->first[n]; c < m->first[n + 1]; c++) m->stack[depth++] = m->list[c];
    }
}

// A run of equal subtrees, less those that stand inside a group already.
static void take_run(prom_finder *finder, const marker *m, const subtree *run, size_t count)
{
    size_t open = 0;
    for (size_t i = 0; i < count; i++) open += !m->taken[run[i].node];
    if (open < 2) return;
    uint32_t scope = (uint32_t)finder->scopes.count;
    prom_array_push(&finder->scopes, (prom_scope){.group_kind = scope - 1});
    prom_scope *s = &finder->scopes.data[scope];
    for (size_t i = 0; i < count; i++) {
        if (m->taken[run[i].node]) continue;
        mark_subtree(finder, m, run[i].node, s->roots.count ? PROM_NONE : scope);
        prom_array_push(&s->roots, run[i].node);
    }
}

void prom_find_groups(prom_finder *finder)
{
    const prom_source *source = finder->source;
    size_t n = source->nodes.count;
    finder->node_scope = prom_calloc(n, sizeof *finder->node_scope);
    prom_array_push(&finder->scopes, (prom_scope){.group_kind = PROM_NONE});

    subtree *trees = prom_alloc(n, sizeof *trees);
    hash_subtrees(source, trees);
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        const double *w = source->nodes.data[i].world;
        if (trees[i].objects < LEAST_OBJECTS || !matrix_finite(w)) continue;
        for (int column = 0; column < 3; column++)
            trees[i].hash = prom_hash(w + 4 * column, 3 * sizeof *w, trees[i].hash);
        trees[kept++] = trees[i];
    }
    qsort(trees, kept, sizeof *trees, by_size_then_hash);

    marker m = {.first = prom_alloc(n + 1, sizeof(uint32_t)),
                .list = prom_alloc(n, sizeof(uint32_t)),
                .stack = prom_alloc(n, sizeof(uint32_t)),
                .taken = prom_calloc(n, sizeof(bool))};
    list_children(source, m.first, m.list);
    for (size_t i = 0, end; i < kept; i = end) {
        for (end = i + 1; end < kept && trees[end].hash == trees[i].hash &&
                          trees[end].nodes == trees[i].nodes;)
            end++;
        take_run(finder, &m, trees + i, end - i);
    }
    prom_free(m.first);
    prom_free(m.list);
    prom_free(m.stack);
    prom_free(m.taken);
    prom_free(trees);
}

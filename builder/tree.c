#include "builder/tree.h"

#include "builder/tree_private.h"

#include <assert.h>
#include <stdlib.h>

enum { MAX_CHILDREN = 16, DIVISIONS = 8, MOST_DIVISIONS = 65536 };

prom_bud prom_bud_make(prom_twig twig, const prom_wbox *bounds)
{
    prom_bud bud = {.twig = twig, .bounds = *bounds};
    prom_wbox_center(bounds, bud.center);
    bud.radius = prom_wbox_diagonal(bounds) / 2;
    return bud;
}

prom_bud prom_bud_bind(prom_grower *grower, const prom_bud *buds, size_t count,
                       prom_layer layer, bool mixed)
{
    prom_branch branch = {.first_twig = (uint32_t)grower->twigs.count,
                          .twig_count = (uint32_t)count,
                          .home = grower->home,
                          .layer = layer,
                          .mixed = mixed,
                          .height = 1};
    prom_wbox bounds = PROM_WBOX_EMPTY;
    for (size_t i = 0; i < count; i++) {
        const prom_twig *t = &buds[i].twig;
        prom_wbox_add(&bounds, &buds[i].bounds);
        prom_array_push(&grower->twigs, *t);
        if (t->branch == PROM_NONE) continue;
        uint32_t below = grower->branches.data[t->branch].height;
        if (branch.height <= below) branch.height = below + 1;
    }
    prom_wbox_center(&bounds, branch.center);
    prom_array_push(&grower->branches, branch);
    prom_twig twig = {PROM_NONE, (uint32_t)grower->branches.count - 1, PROM_NONE};
    return prom_bud_make(twig, &bounds);
}

static prom_bud bud_of_object(const prom_objects *objects, uint32_t index)
{
    const prom_object *o = &objects->objects.data[index];
    prom_wbox bounds =
        prom_wbox_of_placed(&objects->shapes.data[o->shape].bounds, &o->placement);
    return prom_bud_make((prom_twig){index, PROM_NONE, PROM_NONE}, &bounds);
}

static prom_layer layer_of(const prom_objects *objects, uint32_t object)
{
    return objects->shapes.data[objects->objects.data[object].shape].layer;
}

static void grow(prom_grower *grower, prom_buds *buds, prom_layer layer,
                 const prom_wbox *bounds, prom_buds *out)
{
    for (size_t i = 0; i < buds->count; i++) buds->data[i].order = (uint32_t)i;
    if (grower->options.octree == PROM_OCTREE_STRICT)
        prom_grow_strict(grower, buds->data, buds->count, layer, bounds, out);
    else
        prom_grow_loose(grower, buds->data, buds->count, layer, out);
}

// ---- groups

static void add_member(const prom_objects *objects, const prom_bud *head,
                       const prom_group *home, uint32_t group, prom_buds *outer)
{
    const prom_group *g = &objects->groups.data[group];
    prom_bud bud = *head;
    if (g != home) {
        double by[3];
        for (int k = 0; k < 3; k++) by[k] = g->origin[k] - home->origin[k];
        prom_wbox_move(&bud.bounds, by);
        bud = prom_bud_make(bud.twig, &bud.bounds);
        if (bud.twig.object != PROM_NONE)
            bud.twig.object = g->first_object + (bud.twig.object - home->first_object);
    }
    if (bud.twig.branch != PROM_NONE) bud.twig.group = group;
    prom_array_push(outer, bud);
}

// Grows the tree of the group's kind and hangs it up for every group of the kind.
static void add_kind(prom_grower *grower, uint32_t first, prom_buds outer[])
{
    const prom_objects *objects = grower->objects;
    const prom_group *home = &objects->groups.data[first];
    grower->home = first;
    for (int layer = 0; layer < PROM_LAYER_BACKDROP; layer++) {
        prom_buds buds = {0}, top = {0};
        for (uint32_t i = 0; i < home->object_count; i++)
            if (layer_of(objects, home->first_object + i) == (prom_layer)layer)
                prom_array_push(&buds, bud_of_object(objects, home->first_object + i));
        if (buds.count) {
            grow(grower, &buds, (prom_layer)layer, NULL, &top);
            prom_bud head = top.count == 1 ? top.data[0]
                                           : prom_bud_bind(grower, top.data, top.count,
                                                           (prom_layer)layer, false);
            for (uint32_t g = first; g < objects->groups.count; g++)
                if (objects->groups.data[g].kind == home->kind)
                    add_member(objects, &head, home, g, &outer[layer]);
        }
        prom_array_finish(&buds);
        prom_array_finish(&top);
    }
    grower->home = PROM_NONE;
}

// ---- the whole

// Buds by layer. The strict octree knows no groups.
static void collect(prom_grower *grower, prom_buds layers[])
{
    const prom_objects *objects = grower->objects;
    bool groups = grower->options.octree == PROM_OCTREE_LOOSE;
    for (uint32_t i = 0; i < objects->objects.count; i++) {
        prom_layer layer = layer_of(objects, i);
        if (layer == PROM_LAYER_BACKDROP) continue;
        if (groups && objects->objects.data[i].group != PROM_NONE) continue;
        prom_array_push(&layers[layer], bud_of_object(objects, i));
    }
    if (!groups) return;
    uint32_t kinds = 0;
    for (size_t g = 0; g < objects->groups.count; g++)
        if (objects->groups.data[g].kind >= kinds) kinds = objects->groups.data[g].kind + 1;
    bool *done = prom_calloc(kinds, sizeof *done);
    for (uint32_t g = 0; g < objects->groups.count; g++) {
        uint32_t kind = objects->groups.data[g].kind;
        if (!done[kind]) add_kind(grower, g, layers);
        done[kind] = true;
    }
    prom_free(done);
}

// The root branch. A scene of one layer has that layer's branch as its root; of several, the
// root holds one branch (or single object) for each.
static uint32_t grow_root(prom_grower *grower)
{
    prom_buds layers[PROM_LAYER_BACKDROP] = {0}, roots = {0};
    collect(grower, layers);
    prom_wbox bounds = PROM_WBOX_EMPTY;
    int used = 0;
    for (int layer = 0; layer < PROM_LAYER_BACKDROP; layer++) {
        used += layers[layer].count > 0;
        for (size_t i = 0; i < layers[layer].count; i++)
            prom_wbox_add(&bounds, &layers[layer].data[i].bounds);
    }
    assert(used > 0); // a scene of backdrops alone is refused before
    for (int layer = 0; layer < PROM_LAYER_BACKDROP; layer++) {
        if (!layers[layer].count) continue;
        prom_buds top = {0};
        grow(grower, &layers[layer], (prom_layer)layer, &bounds, &top);
        bool whole = top.count == 1 && (used > 1 || (top.data[0].twig.branch != PROM_NONE &&
                                                     top.data[0].twig.group == PROM_NONE));
        prom_array_push(&roots, whole ? top.data[0]
                                      : prom_bud_bind(grower, top.data, top.count,
                                                      (prom_layer)layer, false));
        prom_array_finish(&top);
        prom_array_finish(&layers[layer]);
    }
    prom_bud root =
        used > 1 ? prom_bud_bind(grower, roots.data, roots.count, PROM_LAYER_OBJECT, true)
                 : roots.data[0];
    prom_array_finish(&roots);
    return root.twig.branch;
}

// ---- numbering

// Where a node's branch stands: for which group it is used, PROM_NONE outside all groups.
static void place_node(const prom_grower *grower, const prom_branch *branch, uint32_t group,
                       double origin[3])
{
    const prom_group *groups = grower->objects->groups.data;
    for (int k = 0; k < 3; k++) {
        origin[k] = branch->center[k];
        if (branch->home != PROM_NONE && group != branch->home)
            origin[k] += groups[group].origin[k] - groups[branch->home].origin[k];
    }
}

static uint32_t object_in_group(const prom_objects *objects, uint32_t object, uint32_t group)
{
    uint32_t home = objects->objects.data[object].group;
    if (group == PROM_NONE || home == group) return object;
    const prom_group *groups = objects->groups.data;
    return groups[group].first_object + (object - groups[home].first_object);
}

static void push_node(const prom_grower *grower, prom_tree *tree, uint32_t parent,
                      const prom_twig *twig, uint32_t group)
{
    prom_tree_node node = {
        .parent = parent, .first_child = PROM_NONE, .object = PROM_NONE, .cluster = PROM_NONE};
    if (twig->object != PROM_NONE) {
        node.object = object_in_group(grower->objects, twig->object, group);
        node.layer = layer_of(grower->objects, node.object);
    } else {
        const prom_branch *branch = &grower->branches.data[twig->branch];
        node.cluster = twig->branch; // renumbered at the end
        node.layer = branch->layer;
        node.mixed = branch->mixed;
        place_node(grower, branch, group, node.origin);
    }
    prom_array_push(&tree->nodes, node);
}

static void number_nodes(const prom_grower *grower, uint32_t root, prom_tree *tree)
{
    PROM_ARRAY(uint32_t) groups = {0}; // of each node
    push_node(grower, tree, PROM_NONE, &(prom_twig){PROM_NONE, root, PROM_NONE}, PROM_NONE);
    prom_array_push(&groups, PROM_NONE);
    for (uint32_t i = 0; i < tree->nodes.count; i++) {
        if (tree->nodes.data[i].cluster == PROM_NONE) continue;
        const prom_branch *branch = &grower->branches.data[tree->nodes.data[i].cluster];
        tree->nodes.data[i].first_child = (uint32_t)tree->nodes.count;
        tree->nodes.data[i].child_count = branch->twig_count;
        for (uint32_t c = 0; c < branch->twig_count; c++) {
            const prom_twig *twig = &grower->twigs.data[branch->first_twig + c];
            uint32_t group = twig->group != PROM_NONE ? twig->group : groups.data[i];
            push_node(grower, tree, i, twig, group);
            prom_array_push(&groups, group);
        }
    }
    prom_array_finish(&groups);
}

static int by_height(const void *pa, const void *pb)
{
    const prom_tree_cluster *a = pa, *b = pb;
    if (a->height != b->height) return a->height < b->height ? -1 : 1;
    return a->node < b->node ? -1 : 1;
}

static void number_clusters(const prom_grower *grower, prom_tree *tree)
{
    size_t n = grower->branches.count;
    prom_tree_cluster *clusters = prom_array_extend(&tree->clusters, n);
    for (uint32_t i = 0; i < n; i++) {
        const prom_branch *b = &grower->branches.data[i];
        clusters[i] = (prom_tree_cluster){.node = PROM_NONE,
                                          .child_count = b->twig_count,
                                          .height = b->height,
                                          .layer = b->layer,
                                          .mixed = b->mixed};
    }
    for (uint32_t i = 0; i < tree->nodes.count; i++) {
        uint32_t branch = tree->nodes.data[i].cluster;
        if (branch == PROM_NONE) continue;
        if (!clusters[branch].instances++) clusters[branch].node = i;
    }
    qsort(clusters, n, sizeof *clusters, by_height);
    // The first places still tell the branches, which turns the order into a renumbering.
    uint32_t *cluster_of = prom_alloc(n, sizeof *cluster_of);
    for (uint32_t i = 0; i < n; i++) cluster_of[tree->nodes.data[clusters[i].node].cluster] = i;
    for (uint32_t i = 0; i < tree->nodes.count; i++) {
        uint32_t *c = &tree->nodes.data[i].cluster;
        if (*c != PROM_NONE) *c = cluster_of[*c];
    }
    prom_free(cluster_of);
}

void prom_tree_build(const prom_objects *objects, const prom_tree_options *options,
                     prom_tree *tree)
{
    memset(tree, 0, sizeof *tree);
    prom_grower grower = {.objects = objects, .home = PROM_NONE};
    if (options) grower.options = *options;
    if (!grower.options.max_children) grower.options.max_children = MAX_CHILDREN;
    if (grower.options.max_children < 2) grower.options.max_children = 2;
    for (int k = 0; k < 3; k++) {
        uint32_t *d = &grower.options.divisions[k];
        if (!*d) *d = DIVISIONS;
        if (*d > MOST_DIVISIONS) *d = MOST_DIVISIONS; // cell numbers stay exact
    }

    uint32_t root = grow_root(&grower);
    number_nodes(&grower, root, tree);
    number_clusters(&grower, tree);
    tree->backdrop_first = (uint32_t)tree->nodes.count;
    for (uint32_t i = 0; i < objects->objects.count; i++)
        if (layer_of(objects, i) == PROM_LAYER_BACKDROP)
            prom_array_push(&tree->backdrop_objects, i);
    prom_array_finish(&grower.branches);
    prom_array_finish(&grower.twigs);
}

void prom_tree_finish(prom_tree *tree)
{
    prom_array_finish(&tree->nodes);
    prom_array_finish(&tree->clusters);
    prom_array_finish(&tree->backdrop_objects);
}

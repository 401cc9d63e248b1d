// LINK: prom_builder prom_metaobj
// The tree over objects made in memory: every object once, breadth first, shared where
// repeated.
#include "builder/tree.h"
#include "metaobj/base/alloc.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

// ---- objects: boxes, whose meshes the tree does not look at

static uint32_t add_shape(prom_objects *o, prom_layer layer, float half)
{
    prom_array_push(
        &o->shapes,
        (prom_shape){.layer = layer, .bounds = {{-half, -half, -half}, {half, half, half}}});
    return (uint32_t)o->shapes.count - 1;
}

static void add_object(prom_objects *o, uint32_t shape, double x, double y, double z)
{
    prom_object object = {
        .shape = shape, .group = PROM_NONE, .placement = prom_placement_identity};
    object.placement.origin[0] = x;
    object.placement.origin[1] = y;
    object.placement.origin[2] = z;
    o->shapes.data[shape].instances++;
    prom_array_push(&o->objects, object);
}

static double random_unit(void)
{
    return rand() / (RAND_MAX + 1.0);
}

// Things of many sizes, thick in places, in all layers.
static void fill_random(prom_objects *o, size_t count, unsigned seed)
{
    memset(o, 0, sizeof *o);
    srand(seed);
    for (int i = 0; i < 20; i++)
        add_shape(o,
                  i % 10 == 9  ? PROM_LAYER_BLENDED
                  : i % 5 == 4 ? PROM_LAYER_SURFACE
                               : PROM_LAYER_OBJECT,
                  (float)pow(10, 3 * random_unit() - 1));
    double center[3] = {0};
    for (size_t i = 0; i < count; i++) {
        if (i % 37 == 0)
            for (int k = 0; k < 3; k++) center[k] = 2000 * random_unit() * (k == 1 ? 0.1 : 1);
        double p[3];
        for (int k = 0; k < 3; k++) p[k] = center[k] + 50 * random_unit() * random_unit();
        bool again = i && i % 11 == 0; // one in the other's place
        const double *q = again ? o->objects.data[i - 1].placement.origin : p;
        double r[3] = {q[0], q[1], q[2]};
        add_object(o, (uint32_t)rand() % 20, r[0], r[1], r[2]);
    }
}

static void finish(prom_objects *o)
{
    prom_array_finish(&o->shapes);
    prom_array_finish(&o->objects);
    prom_array_finish(&o->groups);
}

// ---- properties of every tree

static prom_layer layer_of(const prom_objects *o, uint32_t object)
{
    return o->shapes.data[o->objects.data[object].shape].layer;
}

static void check_nodes(const prom_objects *o, const prom_tree *t)
{
    uint8_t *seen = prom_calloc(o->objects.count, 1);
    uint32_t next = 1;
    assert_int_equal(t->nodes.data[0].parent, PROM_NONE);
    assert_int_not_equal(t->nodes.data[0].cluster, PROM_NONE);
    for (uint32_t i = 0; i < t->nodes.count; i++) {
        const prom_tree_node *n = &t->nodes.data[i];
        if (n->object != PROM_NONE) {
            assert_int_equal(n->cluster, PROM_NONE);
            assert_int_equal(n->child_count, 0);
            assert_int_equal(n->layer, layer_of(o, n->object));
            assert_int_equal(seen[n->object]++, 0);
            continue;
        }
        // Breadth first, children together: the next unnumbered nodes are this one's children.
        assert_int_equal(n->first_child, next);
        assert_true(n->child_count > 0);
        next += n->child_count;
        if (n->child_count == 1) assert_int_equal(i, 0);
        for (uint32_t c = n->first_child; c < next; c++) {
            assert_int_equal(t->nodes.data[c].parent, i);
            if (!n->mixed) assert_int_equal(t->nodes.data[c].layer, n->layer);
            assert_false(t->nodes.data[c].mixed);
        }
    }
    assert_int_equal(next, t->nodes.count);
    for (size_t i = 0; i < t->backdrop_objects.count; i++) {
        assert_int_equal(layer_of(o, t->backdrop_objects.data[i]), PROM_LAYER_BACKDROP);
        seen[t->backdrop_objects.data[i]]++;
    }
    assert_int_equal(t->backdrop_first, t->nodes.count);
    for (size_t i = 0; i < o->objects.count; i++) assert_int_equal(seen[i], 1);
    prom_free(seen);
}

static void child_place(const prom_objects *o, const prom_tree *t, const prom_tree_node *parent,
                        uint32_t child, double out[3])
{
    const prom_tree_node *n = &t->nodes.data[child];
    const double *at =
        n->object != PROM_NONE ? o->objects.data[n->object].placement.origin : n->origin;
    for (int k = 0; k < 3; k++) out[k] = at[k] - parent->origin[k];
}

// A cluster has the same children at the same places relative to it wherever it stands.
static void check_same(const prom_objects *o, const prom_tree *t, const prom_tree_node *a,
                       const prom_tree_node *b)
{
    assert_int_equal(a->child_count, b->child_count);
    for (uint32_t c = 0; c < a->child_count; c++) {
        const prom_tree_node *p = &t->nodes.data[a->first_child + c];
        const prom_tree_node *q = &t->nodes.data[b->first_child + c];
        assert_int_equal(p->cluster, q->cluster);
        assert_int_equal(p->object == PROM_NONE, q->object == PROM_NONE);
        if (p->object != PROM_NONE)
            assert_int_equal(o->objects.data[p->object].shape,
                             o->objects.data[q->object].shape);
        double x[3], y[3];
        child_place(o, t, a, a->first_child + c, x);
        child_place(o, t, b, b->first_child + c, y);
        for (int k = 0; k < 3; k++) assert_true(fabs(x[k] - y[k]) < 1e-9);
    }
}

static void check_clusters(const prom_objects *o, const prom_tree *t)
{
    uint32_t *instances = prom_calloc(t->clusters.count, sizeof *instances);
    for (uint32_t i = 0; i < t->nodes.count; i++) {
        const prom_tree_node *n = &t->nodes.data[i];
        if (n->cluster == PROM_NONE) continue;
        assert_in_range(n->cluster, 0, t->clusters.count - 1);
        const prom_tree_cluster *c = &t->clusters.data[n->cluster];
        if (!instances[n->cluster]++) assert_int_equal(c->node, i);
        check_same(o, t, &t->nodes.data[c->node], n);
        assert_int_equal(c->child_count, n->child_count);
        assert_int_equal(c->layer, n->layer);
        assert_int_equal(c->mixed, n->mixed);
        uint32_t height = 1;
        for (uint32_t k = 0; k < n->child_count; k++) {
            uint32_t below = t->nodes.data[n->first_child + k].cluster;
            if (below == PROM_NONE) continue;
            assert_true(below < n->cluster);
            if (t->clusters.data[below].height >= height)
                height = t->clusters.data[below].height + 1;
        }
        assert_int_equal(c->height, height);
    }
    for (uint32_t i = 0; i < t->clusters.count; i++) {
        assert_int_equal(t->clusters.data[i].instances, instances[i]);
        if (i) assert_true(t->clusters.data[i].height >= t->clusters.data[i - 1].height);
    }
    prom_free(instances);
}

static uint32_t most_children(const prom_tree *t)
{
    uint32_t most = 0;
    for (size_t i = 0; i < t->nodes.count; i++)
        if (t->nodes.data[i].child_count > most) most = t->nodes.data[i].child_count;
    return most;
}

static void check(const prom_objects *o, const prom_tree *t)
{
    check_nodes(o, t);
    check_clusters(o, t);
}

// ---- the loose octree

static void random_scenes_hold_together(void **state)
{
    (void)state;
    const size_t counts[] = {1, 2, 3, 9, 17, 100, 1000, 5000};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
        for (uint32_t most = 0; most <= 4; most += 2) {
            prom_objects o;
            prom_tree t;
            fill_random(&o, counts[c], (unsigned)c + 7);
            prom_tree_build(&o, &(prom_tree_options){.max_children = most}, &t);
            check(&o, &t);
            // The mixed root has as many as there are layers.
            assert_true(most_children(&t) <= (most == 2 ? 3u : most ? most : 16u));
            if (!most && counts[c] >= 1000) {
                double inner = (double)(t.nodes.count - o.objects.count);
                double mean = (double)(t.nodes.count - 1) / inner;
                assert_true(mean >= 4 && mean <= 12);
            }
            prom_tree_finish(&t);
            prom_tree_build(&o, &(prom_tree_options){.octree = PROM_OCTREE_STRICT}, &t);
            check(&o, &t);
            prom_tree_finish(&t);
            finish(&o);
        }
}

static void layers_are_apart(void **state)
{
    (void)state;
    prom_objects o = {0};
    prom_tree t;
    for (int layer = 0; layer < PROM_LAYER_COUNT; layer++) {
        uint32_t shape = add_shape(&o, (prom_layer)layer, 1);
        for (int i = 0; i < 3; i++) add_object(&o, shape, 3 * i, layer, 0);
    }
    prom_tree_build(&o, NULL, &t);
    check(&o, &t);
    assert_true(t.nodes.data[0].mixed);
    assert_int_equal(t.nodes.data[0].child_count, 3);
    for (uint32_t c = 1; c <= 3; c++) assert_int_equal(t.nodes.data[c].child_count, 3);
    assert_int_equal(t.backdrop_objects.count, 3);
    prom_tree_finish(&t);
    finish(&o);

    // One layer alone is the root itself; one object alone hangs on a root.
    memset(&o, 0, sizeof o);
    uint32_t shape = add_shape(&o, PROM_LAYER_SURFACE, 1);
    add_object(&o, shape, 1, 2, 3);
    for (int round = 0; round < 2; round++) {
        prom_tree_build(&o, NULL, &t);
        check(&o, &t);
        assert_false(t.nodes.data[0].mixed);
        assert_int_equal(t.nodes.data[0].layer, PROM_LAYER_SURFACE);
        assert_int_equal(t.nodes.data[0].child_count, round + 1);
        assert_true(t.nodes.data[0].origin[0] == (round ? 2.0 : 1.0));
        prom_tree_finish(&t);
        add_object(&o, shape, 3, 2, 3);
    }
    finish(&o);
}

static uint32_t depth_of(const prom_tree *t, uint32_t object)
{
    for (uint32_t i = 0; i < t->nodes.count; i++) {
        if (t->nodes.data[i].object != object) continue;
        uint32_t depth = 0;
        for (uint32_t n = i; n; n = t->nodes.data[n].parent) depth++;
        return depth;
    }
    return 0;
}

static void large_things_wait_higher_up(void **state)
{
    (void)state;
    prom_objects o = {0};
    prom_tree t;
    uint32_t small = add_shape(&o, PROM_LAYER_OBJECT, 0.1f);
    uint32_t large = add_shape(&o, PROM_LAYER_OBJECT, 40);
    for (int i = 0; i < 32; i++)
        for (int k = 0; k < 32; k++) add_object(&o, small, 3 * i, 0, 3 * k);
    add_object(&o, large, 20, 0, 20);
    prom_tree_build(&o, NULL, &t);
    check(&o, &t);
    assert_int_equal(depth_of(&t, (uint32_t)o.objects.count - 1), 1);
    assert_true(depth_of(&t, 0) > 2);
    prom_tree_finish(&t);
    finish(&o);
}

static void equal_places_end(void **state)
{
    (void)state;
    prom_objects o = {0};
    prom_tree t;
    uint32_t shape = add_shape(&o, PROM_LAYER_OBJECT, 1e-6f);
    for (int i = 0; i < 1000; i++) add_object(&o, shape, 1e6, 5, i < 999 ? 5 : -1e6);
    prom_tree_build(&o, NULL, &t);
    check(&o, &t);
    assert_true(most_children(&t) <= 16);
    prom_tree_finish(&t);
    finish(&o);
}

// ---- groups

static void groups_are_instanced(void **state)
{
    (void)state;
    enum { TILES = 25, EACH = 60 };
    prom_objects o, single;
    prom_tree t;
    fill_random(&o, EACH, 3);
    fill_random(&single, EACH, 3);
    uint32_t sky = add_shape(&o, PROM_LAYER_BACKDROP, 1e5f);
    o.objects.data[5].shape = sky; // one of the group's is a backdrop
    single.objects.data[5].shape = add_shape(&single, PROM_LAYER_BACKDROP, 1e5f);
    for (uint32_t g = 0; g < TILES; g++) {
        double at[3] = {2100.0 * (g % 5), 0.25, 2100.0 * (g / 5)};
        prom_array_push(&o.groups, (prom_group){.kind = 0,
                                                .origin = {at[0], at[1], at[2]},
                                                .first_object = EACH * g,
                                                .object_count = EACH});
        for (uint32_t i = 0; i < EACH; i++) {
            prom_object object = o.objects.data[i];
            object.group = g;
            for (int k = 0; k < 3; k++)
                object.placement.origin[k] += at[k] - o.groups.data[0].origin[k];
            if (g)
                prom_array_push(&o.objects, object);
            else
                o.objects.data[i].group = 0;
        }
    }
    add_object(&o, 0, 50, 50, 50); // something outside
    prom_tree_build(&o, NULL, &t);
    check(&o, &t);
    assert_true(most_children(&t) <= 16);
    assert_int_equal(t.backdrop_objects.count, TILES);
    prom_tree alone;
    prom_tree_build(&single, NULL, &alone);
    uint32_t shared = 0;
    for (size_t i = 0; i < t.clusters.count; i++) {
        if (t.clusters.data[i].instances == 1) continue;
        assert_int_equal(t.clusters.data[i].instances, TILES);
        shared++;
    }
    // All of a tile's clusters but the mixed root, which tiles do not have.
    assert_int_equal(shared, alone.clusters.count - 1);
    prom_tree_finish(&alone);
    prom_tree_finish(&t);
    finish(&single);
    finish(&o);
}

// ---- the strict octree

static uint32_t node_of_object(const prom_tree *t, uint32_t object)
{
    for (uint32_t i = 0; i < t->nodes.count; i++)
        if (t->nodes.data[i].object == object) return i;
    return PROM_NONE;
}

static uint32_t parent_of(const prom_tree *t, uint32_t object)
{
    return t->nodes.data[node_of_object(t, object)].parent;
}

// By hand, on a line of 8 cells over [0, 8], things of half 0.2 and a wide one:
//   0 and 1 in cell 0, 2 and 3 in cell 3, 4 across the border of cells 1 and 2, 5 alone in cell
//   5, 6 over [3, 6], 7 alone in cell 7.
// 8 cells: {0 1} = a, {2 3} = b. 4 cells: nothing meets. 2 cells: a, b and 4 in [0, 4] = c; 5
// and 7 in [4, 8] = d; 6 lies across. The root takes c, d and 6.
static void strict_small_case(void **state)
{
    (void)state;
    prom_objects o = {0};
    prom_tree t;
    uint32_t shape = add_shape(&o, PROM_LAYER_OBJECT, 0.2f);
    uint32_t wide = add_shape(&o, PROM_LAYER_OBJECT, 1.5f);
    const double x[6] = {0.2, 0.7, 3.2, 3.7, 2.0, 5.5};
    for (int i = 0; i < 6; i++) add_object(&o, shape, x[i], 0, 0);
    add_object(&o, wide, 4.5, 0, 0);  // 6: [3, 6] across the middle
    add_object(&o, shape, 7.8, 0, 0); // 7: ends the bounds at 8
    prom_tree_options options = {.octree = PROM_OCTREE_STRICT, .divisions = {8, 1, 1}};
    prom_tree_build(&o, &options, &t);
    check(&o, &t);
    uint32_t a = parent_of(&t, 0), b = parent_of(&t, 2), c = parent_of(&t, 4);
    assert_int_equal(parent_of(&t, 1), a);
    assert_int_equal(parent_of(&t, 3), b);
    assert_true(a != b && a != c && b != c);
    assert_int_equal(t.nodes.data[a].parent, c);
    assert_int_equal(t.nodes.data[b].parent, c);
    assert_int_equal(t.nodes.data[c].child_count, 3);
    assert_int_equal(t.nodes.data[c].parent, 0);
    assert_int_equal(parent_of(&t, 6), 0);
    uint32_t d = parent_of(&t, 5);
    assert_int_equal(parent_of(&t, 7), d);
    assert_int_equal(t.nodes.data[d].parent, 0);
    assert_int_equal(t.nodes.data[0].child_count, 3);
    assert_int_equal(t.nodes.count, 8 + 5);
    prom_tree_finish(&t);

    // With a radius, neighbours come first: 4 is within 1.3 of 1 and of 2, and 1 is asked first
    // by 0, whose neighbours are 0 and 1 alone.
    options.group_radius = 1.3;
    prom_tree_build(&o, &options, &t);
    check(&o, &t);
    assert_int_equal(parent_of(&t, 0), parent_of(&t, 1));
    assert_int_equal(parent_of(&t, 2), parent_of(&t, 3));
    assert_int_equal(parent_of(&t, 2), parent_of(&t, 4));
    assert_int_equal(parent_of(&t, 2), parent_of(&t, 6));
    prom_tree_finish(&t);
    finish(&o);
}

static void same_objects_same_tree(void **state)
{
    (void)state;
    prom_objects o;
    prom_tree a, b;
    fill_random(&o, 3000, 5);
    prom_tree_build(&o, NULL, &a);
    prom_tree_build(&o, NULL, &b);
    assert_int_equal(a.nodes.count, b.nodes.count);
    for (size_t i = 0; i < a.nodes.count; i++) {
        assert_int_equal(a.nodes.data[i].object, b.nodes.data[i].object);
        assert_int_equal(a.nodes.data[i].cluster, b.nodes.data[i].cluster);
        assert_int_equal(a.nodes.data[i].first_child, b.nodes.data[i].first_child);
    }
    prom_tree_finish(&a);
    prom_tree_finish(&b);
    finish(&o);
}

static void many_objects(void **state)
{
    (void)state;
    prom_objects o;
    prom_tree t;
    fill_random(&o, 100000, 9);
    prom_tree_build(&o, NULL, &t);
    check(&o, &t);
    assert_true(most_children(&t) <= 16);
    prom_tree_finish(&t);
    finish(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_scenes_hold_together), cmocka_unit_test(layers_are_apart),
        cmocka_unit_test(large_things_wait_higher_up), cmocka_unit_test(equal_places_end),
        cmocka_unit_test(groups_are_instanced),        cmocka_unit_test(strict_small_case),
        cmocka_unit_test(same_objects_same_tree),      cmocka_unit_test(many_objects),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// LINK: prom_traverse prom_benefit prom_metaobj
// The visibility store, and cuts selected with it, on random trees and cameras.
#include "selector_fixture.h"
#include "traverse/evaluate.h"
#include "traverse/footprint.h"

#include <stdlib.h>

typedef PROM_ARRAY(prom_visible_count) count_array;

// Counts of a cut: each entry shows share_of(its number) of its footprint.
static void count_cut(const prom_cut *cut, float (*share_of)(uint64_t *seed), uint64_t *seed,
                      count_array *counts)
{
    counts->count = 0;
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        prom_array_push(counts, (prom_visible_count){*e, e->footprint_px * share_of(seed)});
    }
}

static float all_shows(uint64_t *seed)
{
    (void)seed;
    return 1.0f;
}

static float nothing_shows(uint64_t *seed)
{
    (void)seed;
    return 0.0f;
}

static float most_is_hidden(uint64_t *seed)
{
    return random_unit(seed) < 0.7f ? 0.0f : random_unit(seed);
}

// Selects, counts and feeds a few frames of one view, as a walk at rest does.
static void rest(bench *b, prom_visibility *v, const char *name, double budget,
                 float (*share_of)(uint64_t *seed), uint64_t *seed)
{
    count_array counts = {0};
    for (int frame = 0; frame < 12; frame++) {
        prom_visibility_begin(v, &b->camera);
        b->selection.visibility = v;
        count_cut(bench_run(b, name, budget), share_of, seed, &counts);
        prom_visibility_feed(v, &b->camera, counts.data, counts.count);
    }
    prom_array_finish(&counts);
}

static double budget_between(bench *b, float t)
{
    double low = bench_run(b, "coarsest", 0)->predicted_ms;
    return low + t * (bench_run(b, "full", 0)->predicted_ms - low);
}

// ---- cuts

static int by_node(const void *a, const void *b)
{
    const prom_cut_entry *x = a, *y = b;
    return x->node < y->node ? -1 : x->node > y->node;
}

// Of some clusters the box is in view but nothing in it. Such a one shows its footprint as long
// as it is drawn, and nothing once it is opened: its counts contradict each other.
static bool has_empty_clusters(bench *b)
{
    const prom_model *m = &b->model;
    bool *shows = prom_calloc(m->tree_count, sizeof *shows);
    bool empty = false;
    for (uint32_t n = m->tree_count; n-- > 0;) {
        bool in_view = prom_view_cull(&b->view, m->center[n], m->half[n]) != PROM_OUTSIDE;
        if (!m->child_count[n]) shows[n] = in_view;
        if (shows[n] && n) shows[m->parent[n]] = true;
        empty = empty || (in_view && !shows[n]);
    }
    prom_free(shows);
    return empty;
}

static void counts_like_the_footprints_change_nothing(void **state)
{
    (void)state;
    uint64_t seed = 70;
    int rounds = 0;
    for (int tries = 0; rounds < 40 && tries < 400; tries++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        bench_look(&b, &seed);
        if (has_empty_clusters(&b)) {
            bench_finish(&b);
            continue;
        }
        rounds++;
        double budget = budget_between(&b, random_unit(&seed));
        for (size_t i = 0; i < prom_selector_count(); i++) {
            const char *name = prom_selector_at(i)->name;
            prom_visibility *v = prom_visibility_create(&b.model, NULL);
            b.selection.visibility = NULL;
            prom_cut *cut = NULL; // those that go on from their last cut come to rest
            for (int frame = 0; frame < 12; frame++) cut = bench_run(&b, name, budget);
            size_t count = cut->entries.count;
            prom_cut_entry *plain = prom_alloc(count, sizeof *plain);
            if (count) memcpy(plain, cut->entries.data, count * sizeof *plain);
            rest(&b, v, name, budget, all_shows, &seed);
            cut = bench_run(&b, name, budget);
            assert_int_equal(cut->entries.count, count);
            qsort(plain, count, sizeof *plain, by_node);
            if (count) qsort(cut->entries.data, count, sizeof *plain, by_node);
            for (size_t k = 0; k < count; k++) {
                assert_int_equal(plain[k].node, cut->entries.data[k].node);
                assert_int_equal(plain[k].rep, cut->entries.data[k].rep);
            }
            prom_free(plain);
            prom_visibility_destroy(v);
        }
        bench_finish(&b);
    }
    assert_int_equal(rounds, 40);
}

static void cuts_cover_each_leaf_once_whatever_was_seen(void **state)
{
    (void)state;
    uint64_t seed = 71;
    for (int round = 0; round < 40; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        prom_visibility *v = prom_visibility_create(&b.model, NULL);
        for (int look = 0; look < 5; look++) {
            bench_look(&b, &seed);
            double budget = budget_between(&b, random_between(&seed, -0.2f, 1.2f));
            for (size_t i = 0; i < prom_selector_count(); i++) {
                const char *name = prom_selector_at(i)->name;
                rest(&b, v, name, budget, look % 2 ? most_is_hidden : nothing_shows, &seed);
                prom_cut *cut = bench_run(&b, name, budget);
                const char *fault = prom_cut_check(&b.model, &b.view, cut);
                if (fault) fail_msg("%s: %s", name, fault);
            }
        }
        prom_visibility_destroy(v);
        bench_finish(&b);
    }
}

// Where nothing shows, little more is spent than on the cheapest cut.
static void nothing_is_spent_on_what_is_hidden(void **state)
{
    (void)state;
    uint64_t seed = 72;
    double before = 0.0, after = 0.0;
    for (int round = 0; round < 20; round++) {
        bench b;
        bench_init(&b, random_u64(&seed),
                   &(random_model_options){.leaves = 150, .max_children = 8, .extent = 60});
        prom_visibility *v = prom_visibility_create(&b.model, NULL);
        bench_look(&b, &seed);
        double least = budget_between(&b, 0.0f), budget = budget_between(&b, 0.5f);
        before += bench_run(&b, "greedy", budget)->predicted_ms - least;
        rest(&b, v, "greedy", budget, nothing_shows, &seed);
        after += fmax(bench_run(&b, "greedy", budget)->predicted_ms - least, 0.0);
        prom_visibility_destroy(v);
        bench_finish(&b);
    }
    assert_true(before > 0.0);
    assert_true(after < 0.1 * before);
}

// ---- the store

static void sums_go_up_the_tree(void **state)
{
    (void)state;
    uint64_t seed = 73;
    bench b;
    bench_init(&b, 74, &(random_model_options){.leaves = 80, .max_children = 6, .extent = 30});
    prom_visibility *v = prom_visibility_create(&b.model, NULL);
    do bench_look(&b, &seed);
    while (bench_run(&b, "full", 0)->entries.count < 20);
    prom_cut *cut = bench_run(&b, "full", 0);
    count_array counts = {0};
    count_cut(cut, most_is_hidden, &seed, &counts);
    for (size_t i = 0; i < counts.count; i++) // so many that they are believed at once
        counts.data[i].px = counts.data[i].px > 0.0f ? 64.0f + counts.data[i].px : 0.0f;
    prom_visibility_begin(v, &b.camera);
    prom_visibility_feed(v, &b.camera, counts.data, counts.count);
    double *px = prom_calloc(b.model.tree_count, sizeof *px);
    bool *drawn = prom_calloc(b.model.tree_count, sizeof *drawn);
    for (size_t i = 0; i < counts.count; i++)
        for (uint32_t n = counts.data[i].entry.node; n != PROM_NONE; n = b.model.parent[n]) {
            px[n] += (double)counts.data[i].px;
            drawn[n] = true;
        }
    for (uint32_t n = 0; n < b.model.tree_count; n++) {
        float own_px = prom_own_px(&b.view, &b.model, n), known;
        bool is_known = prom_visibility_px(v, n, own_px, &known);
        assert_true(!is_known || drawn[n]);
        if (own_px < 1.0f || px[n] < 1.0) continue; // footprints of nothing teach nothing
        assert_true(is_known == drawn[n]);
        double least = (double)(PROM_VISIBILITY_LEAST * own_px);
        if (drawn[n])
            assert_float_equal(known, (float)fmax(px[n], least),
                               1e-4f * (float)(px[n] + least));
    }
    prom_free(px);
    prom_free(drawn);
    prom_array_finish(&counts);
    prom_visibility_destroy(v);
    bench_finish(&b);
}

// What is visible of a node is what is visible of its children, whatever is known of them.
static void pixels_flow_down_without_loss(void **state)
{
    (void)state;
    uint64_t seed = 75;
    for (int round = 0; round < 40; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        prom_visibility *v = prom_visibility_create(&b.model, NULL);
        bench_look(&b, &seed);
        rest(&b, v, "full", 0, most_is_hidden, &seed);
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        prom_eval_run(&eval, &b.selection, NULL, NULL);
        for (uint32_t i = 0; i < eval.visited_count; i++) {
            uint32_t node = eval.visited[i];
            const prom_eval_node *n = &eval.nodes[node];
            assert_true(n->px >= 0.0f);
            if (!n->expanded || !n->in_flow || n->culled || n->hidden) continue;
            double px = 0.0, footprint = 0.0;
            for (uint32_t c = 0; c < b.model.child_count[node]; c++) {
                px += (double)eval.nodes[b.model.first_child[node] + c].px;
                footprint += (double)eval.nodes[b.model.first_child[node] + c].footprint_px;
            }
            // What shows of a child by less than a pixel is left out.
            double hidden = 1.0 * b.model.child_count[node];
            assert_true(px <= (double)n->px * 1.001 + 1e-6);
            assert_true(px >= (double)n->px * 0.999 - hidden);
            double own = (double)n->footprint_px;
            assert_true(fabs(footprint - own) <= 1e-3 * own + 1e-6);
        }
        prom_eval_finish(&eval);
        prom_visibility_destroy(v);
        bench_finish(&b);
    }
}

// Two hidden nodes: one was wholly in view, of the other a part.
static void moving_forgets_and_turning_only_what_was_partly_outside(void **state)
{
    (void)state;
    uint64_t seed = 76;
    bench b;
    bench_init(&b, 77, &(random_model_options){.leaves = 80, .max_children = 6, .extent = 30});
    prom_visibility *v = prom_visibility_create(&b.model, NULL);
    do bench_look(&b, &seed);
    while (bench_run(&b, "full", 0)->entries.count < 20);
    count_array counts = {0};
    count_cut(bench_run(&b, "full", 0), nothing_shows, &seed, &counts);
    counts.data[0].px = counts.data[0].entry.footprint_px = 1000.0f;
    // What is seen is 10 away.
    counts.data[0].entry.depth = 10.0f - 0.5f * b.model.radius[counts.data[0].entry.node];
    uint32_t whole = counts.data[1].entry.node, part = counts.data[2].entry.node;
    for (int i = 1; i <= 2; i++) {
        counts.data[i].entry.footprint_px = 1000.0f;
        counts.data[i].entry.whole = i == 1;
    }
    prom_visibility_begin(v, &b.camera);
    prom_visibility_feed(v, &b.camera, counts.data, counts.count);
    const float least = PROM_VISIBILITY_LEAST;
    assert_float_equal(prom_visibility_share(v, whole), least, 0.0f);
    assert_float_equal(prom_visibility_share(v, part), least, 0.0f);

    prom_camera camera = b.camera;
    camera.eye[0] += 1.0;
    prom_visibility_begin(v, &camera);
    assert_float_equal(prom_visibility_share(v, whole), least, 0.0f);
    for (int k = 0; k < 4; k++) camera.orientation[k] = k == 1 ? 1.0f : 0.0f; // far round
    prom_visibility_begin(v, &camera);
    assert_float_equal(prom_visibility_share(v, whole), least, 0.0f);
    assert_true(prom_visibility_share(v, part) > 0.1f);

    float last = least;
    for (int step = 0; step < 5; step++) {
        camera.eye[0] += step < 4 ? 1.0 : 1000.0;
        prom_visibility_begin(v, &camera);
        float share = prom_visibility_share(v, whole);
        assert_true(share > last);
        last = share;
    }
    assert_float_equal(last, 1.0f, 1e-3);
    prom_array_finish(&counts);
    prom_visibility_destroy(v);
    bench_finish(&b);
}

// However far the camera has come before: small steps add up.
static void steps_count_after_a_jump(void **state)
{
    (void)state;
    uint64_t seed = 78;
    bench b;
    bench_init(&b, 79, &(random_model_options){.leaves = 80, .max_children = 6, .extent = 30});
    prom_visibility *v = prom_visibility_create(&b.model, NULL);
    do bench_look(&b, &seed);
    while (!bench_run(&b, "full", 0)->entries.count);
    prom_visible_count seen = {.entry = bench_run(&b, "full", 0)->entries.data[0]};
    seen.px = seen.entry.footprint_px = 1000.0f;
    seen.entry.whole = true;
    prom_visibility_begin(v, &b.camera);
    prom_visibility_feed(v, &b.camera, &seen, 1);
    prom_camera camera = b.camera;
    const double jump = 1e9;
    camera.eye[0] += jump;
    prom_visibility_begin(v, &camera);
    double sight = jump / prom_visibility_way(v);
    seen.px = 0.0f;
    for (int i = 0; i < 20; i++) prom_visibility_feed(v, &b.camera, &seen, 1);
    assert_true(prom_visibility_share(v, seen.entry.node) < 0.01f);
    for (int step = 0; step < 200; step++) {
        camera.eye[0] += 0.01 * sight;
        prom_visibility_begin(v, &camera);
    }
    assert_true(prom_visibility_share(v, seen.entry.node) > 0.99f);
    prom_visibility_destroy(v);
    bench_finish(&b);
}

// What was not counted keeps its share; a node above is what most of it is.
static float visible_px(const bench *b, const prom_visibility *v, uint32_t node)
{
    float px;
    assert_true(prom_visibility_px(v, node, prom_own_px(&b->view, &b->model, node), &px));
    return px;
}

static void what_is_not_counted_keeps_its_share(void **state)
{
    (void)state;
    uint64_t seed = 80;
    bench b;
    bench_init(&b, 81, &(random_model_options){.leaves = 80, .max_children = 6, .extent = 30});
    prom_visibility *v = prom_visibility_create(&b.model, NULL);
    do bench_look(&b, &seed);
    while (bench_run(&b, "full", 0)->entries.count < 20);
    count_array counts = {0};
    prom_cut *cut = bench_run(&b, "full", 0);
    count_cut(cut, nothing_shows, &seed, &counts);
    for (size_t i = 0; i < counts.count; i++) {
        counts.data[i].entry.footprint_px = counts.data[i].entry.visible_px = 100.0f;
        counts.data[i].px = 90.0f;
    }
    uint32_t last = counts.data[counts.count - 1].entry.node;
    prom_visibility_begin(v, &b.camera);
    prom_visibility_feed(v, &b.camera, counts.data, counts.count);
    assert_float_equal(visible_px(&b, v, last), 90.0f, 1e-2f);
    for (size_t i = 0; i < counts.count; i++) counts.data[i].px = i ? 120.0f : -1.0f;
    counts.data[counts.count - 1].px = -1.0f;
    prom_visibility_feed(v, &b.camera, counts.data, counts.count);
    assert_float_equal(visible_px(&b, v, last), 90.0f, 1e-2f);
    // What was not counted is taken to show what was expected.
    float sum = 120.0f * (float)(counts.count - 2) + 200.0f;
    assert_float_equal(visible_px(&b, v, 0), sum, 1e-3f * sum);
    for (size_t i = 0; i < counts.count; i++) counts.data[i].px = -1.0f;
    counts.data[0].px = 0.0f;
    prom_visibility_feed(v, &b.camera, counts.data, counts.count);
    assert_float_equal(visible_px(&b, v, 0), sum, 1e-3f * sum);
    prom_array_finish(&counts);
    prom_visibility_destroy(v);
    bench_finish(&b);
}

// ---- cells

static void cells_are_what_is_known_at_first(void **state)
{
    (void)state;
    uint64_t seed = 78;
    bench b;
    bench_init(&b, 79, &(random_model_options){.leaves = 60, .max_children = 5, .extent = 30});
    do bench_look(&b, &seed);
    while (bench_run(&b, "full", 0)->entries.count < 10);
    uint32_t leaf = bench_run(&b, "full", 0)->entries.data[3].node;
    prom_view_cell cell = {.first = 0, .count = 1};
    uint8_t code = prom_view_share_encode(0.25);
    prom_view_cells cells = {.size = 4.0,
                             .cell_count = 1,
                             .cells = &cell,
                             .entry_count = 1,
                             .leaves = &leaf,
                             .shares = &code};
    for (int k = 0; k < 3; k++) cells.origin[k] = b.camera.eye[k] - 2.0;
    prom_visibility *v = prom_visibility_create(&b.model, &cells);
    prom_visibility_begin(v, &b.camera);
    assert_float_equal(prom_visibility_share(v, leaf), 0.25f, 0.02f);
    for (uint32_t n = 0; n < b.model.tree_count; n++) {
        float share = prom_visibility_share(v, n);
        assert_true(share >= PROM_VISIBILITY_LEAST && share <= 1.0f);
        bool above = false;
        for (uint32_t up = leaf; up != PROM_NONE; up = b.model.parent[up]) above |= up == n;
        if (!above) assert_float_equal(share, PROM_VISIBILITY_LEAST, 0.0f);
    }
    for (size_t i = 0; i < prom_selector_count(); i++) {
        b.selection.visibility = v;
        prom_cut *cut = bench_run(&b, prom_selector_at(i)->name, 5.0);
        assert_null(prom_cut_check(&b.model, &b.view, cut));
    }
    prom_camera outside = b.camera;
    outside.eye[0] += 100.0;
    prom_visibility_begin(v, &outside);
    for (uint32_t n = 0; n < b.model.tree_count; n++)
        assert_float_equal(prom_visibility_share(v, n), 1.0f, 0.0f);
    prom_visibility_destroy(v);
    bench_finish(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_like_the_footprints_change_nothing),
        cmocka_unit_test(cuts_cover_each_leaf_once_whatever_was_seen),
        cmocka_unit_test(nothing_is_spent_on_what_is_hidden),
        cmocka_unit_test(sums_go_up_the_tree),
        cmocka_unit_test(pixels_flow_down_without_loss),
        cmocka_unit_test(moving_forgets_and_turning_only_what_was_partly_outside),
        cmocka_unit_test(steps_count_after_a_jump),
        cmocka_unit_test(what_is_not_counted_keeps_its_share),
        cmocka_unit_test(cells_are_what_is_known_at_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

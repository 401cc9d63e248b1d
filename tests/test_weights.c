// LINK: prom_traverse prom_benefit prom_metaobj
// Weights, orders and priors, and staying with the last cut.
#include "selector_fixture.h"
#include "traverse/evaluate.h"

#include <stdlib.h>

static float *leaf_weights(prom_model *m, uint64_t *seed)
{
    for (uint32_t n = 0; n < m->tree_count; n++)
        if (!m->child_count[n])
            m->weight[n] = random_below(seed, 6) ? random_between(seed, 0, 5) : 0.0f;
    float *semantics = prom_alloc(m->tree_count, sizeof *semantics);
    assert_true(prom_weights_gather(m, semantics) || m->tree_count == 1);
    return semantics;
}

static prom_view earlier_view(const bench *b, uint64_t *seed)
{
    prom_camera camera = b->camera;
    prom_view before;
    for (int k = 0; k < 3; k++)
        camera.eye[k] += random_between(seed, -1, 1) * 0.05 * (double)b->model.radius[0];
    prom_view_init(&before, &camera);
    return before;
}

// Whether the cuts are equal, and all their weights 1.
static bool same_cuts(const prom_cut *a, const prom_cut *b)
{
    if (a->entries.count != b->entries.count || a->predicted_ms != b->predicted_ms ||
        a->benefit != b->benefit || a->loss != b->loss)
        return false;
    for (size_t i = 0; i < a->entries.count; i++) {
        const prom_cut_entry *x = &a->entries.data[i], *y = &b->entries.data[i];
        if (x->node != y->node || x->rep != y->rep || x->accuracy != y->accuracy ||
            x->visible_px != y->visible_px || x->weight != 1.0f || y->weight != 1.0f)
            return false;
    }
    return true;
}

static void copy_cut(const prom_cut *from, prom_cut *to)
{
    prom_array_reserve(&to->entries, from->entries.count);
    memcpy(to->entries.data, from->entries.data,
           from->entries.count * sizeof *from->entries.data);
    to->entries.count = from->entries.count;
    to->predicted_ms = from->predicted_ms;
    to->benefit = from->benefit;
    to->loss = from->loss;
}

// ---- the curves

static void curves_fall_from_one_to_nothing(void **state)
{
    (void)state;
    assert_true(prom_weight_focus(0) == 1.0f && prom_weight_motion(0) == 1.0f);
    assert_float_equal(prom_weight_focus(PROM_FOCUS_HALF_DEG), 0.5f, 1e-6f);
    assert_float_equal(prom_weight_motion(PROM_MOTION_HALF_DEG_S), 0.5f, 1e-6f);
    for (int i = 1; i < 100; i++) {
        assert_true(prom_weight_focus((float)i) < prom_weight_focus((float)i - 1));
        assert_true(prom_weight_motion((float)i) < prom_weight_motion((float)i - 1));
    }
    assert_true(prom_weight_motion(1e9f) < 1e-6f);
}

// A model of one leaf of radius 1 at a place.
static void lone_leaf(prom_model *m, const double center[3])
{
    random_model(m, 3, &(random_model_options){.leaves = 1, .max_children = 2, .extent = 1});
    for (int k = 0; k < 3; k++) m->center[0][k] = center[k];
    m->radius[0] = 1.0f;
}

static prom_view view_from(double x, double z, double to_x, double to_z)
{
    prom_camera camera = {
        .eye = {x, 0, z}, .fov_y = 1, .z_near = 0.1f, .width = 640, .height = 360};
    const double target[3] = {to_x, 0, to_z};
    prom_view view;
    prom_camera_look_at(&camera, target);
    prom_view_init(&view, &camera);
    return view;
}

static void focus_falls_with_the_angle(void **state)
{
    (void)state;
    prom_model m;
    lone_leaf(&m, (double[3]){0, 0, -100});
    const prom_weighting focus = {.use = PROM_WEIGHT_FOCUS};
    assert_true(prom_weighting_is_on(&focus));
    prom_view ahead = view_from(0, 0, 0, -1), edge = view_from(0, 0, 0.009, -1);
    prom_view aside = view_from(0, 0, 1, -1), within = view_from(0, -100.5, 1, -100.5);
    assert_true(prom_weight_in_view(&focus, &ahead, &m, 0) == 1.0f);
    assert_true(prom_weight_in_view(&focus, &edge, &m, 0) == 1.0f); // half a degree wide
    assert_float_equal(prom_weight_in_view(&focus, &aside, &m, 0),
                       prom_weight_focus(45 - 0.573f), 1e-3f);
    assert_float_equal(prom_weight_in_view(&focus, &within, &m, 0), 1.0f, 1e-6f);
    prom_model_finish(&m);
}

static void motion_falls_with_the_apparent_speed(void **state)
{
    (void)state;
    prom_model m;
    lone_leaf(&m, (double[3]){0, 0, -100});
    prom_view now = view_from(0, 0, 0, -1), aside = view_from(-10, 0, -10, -1);
    prom_view turned = view_from(0, 0, 1, -1), behind = view_from(0, 50, 0, -1);
    prom_weighting motion = {.use = PROM_WEIGHT_MOTION, .before = &aside, .dt_s = 0.5};
    // Ten to the side at a distance of 100 in half a second.
    float degrees = (float)(atan(0.1) * 180 / M_PI);
    assert_float_equal(prom_weight_in_view(&motion, &now, &m, 0),
                       prom_weight_motion(degrees / 0.5f), 1e-4f);
    motion.before = &turned;
    assert_float_equal(prom_weight_in_view(&motion, &now, &m, 0), prom_weight_motion(90),
                       1e-4f);
    motion.before = &behind; // straight ahead: it grows, but stays where it is
    assert_float_equal(prom_weight_in_view(&motion, &now, &m, 0), 1.0f, 1e-4f);
    assert_true(prom_weighting_is_on(&motion));
    motion.dt_s = 0;
    assert_false(prom_weighting_is_on(&motion));
    assert_true(prom_weight_in_view(&motion, &now, &m, 0) == 1.0f);
    prom_model_finish(&m);
}

// ---- semantics

static void the_last_rule_that_matches_counts(void **state)
{
    (void)state;
    prom_weight_rules rules = {
        .list = {{"statue*", 4, false}, {"*_small", 0.5f, false}, {"tree", 2, false}},
        .count = 3};
    assert_true(prom_weight_of_name(&rules, "statue_3", 1) == 4);
    assert_true(prom_weight_of_name(&rules, "statue_small", 1) == 0.5f);
    assert_true(prom_weight_of_name(&rules, "a statue", 7) == 7);
    assert_true(rules.list[0].matched && rules.list[1].matched && !rules.list[2].matched);
}

// A cluster of a cluster of two leaves, and a leaf.
static void small_tree(prom_model *m)
{
    static const uint32_t parents[] = {PROM_NONE, 0, 0, 1, 1};
    static char names[] = "\0house\0tree\0house door";
    static const uint32_t names_at[] = {0, 1, 7, 0, 12};
    random_allocate(m, 5, 3);
    uint64_t seed = 8;
    random_prototype(m, &seed, 0);
    random_reps(m, &seed, false, false);
    random_prototype(m, &seed, 2);
    m->node_count = m->tree_count = 5;
    m->names = names;
    m->names_bytes = sizeof names;
    for (uint32_t n = 0; n < 5; n++) {
        m->parent[n] = parents[n];
        m->name[n] = names_at[n];
        m->child_count[n] = n < 2 ? 2 : 0;
        m->first_child[n] = n < 2 ? 1 + 2 * n : PROM_NONE;
        m->prototype[n] = n < 2;
        m->radius[n] = n == 3 ? 2.0f : 1.0f;
    }
}

static void names_weigh_what_is_below_them(void **state)
{
    (void)state;
    prom_model m = {0};
    small_tree(&m);
    prom_weight_rules rules = {.list = {{"house", 4, false}, {"*door", 2, false}}, .count = 2};
    prom_weights_apply(&rules, &m);
    assert_true(m.weight[1] == 4 && m.weight[3] == 4 && m.weight[4] == 2 && m.weight[2] == 1);
    float weights[5];
    assert_true(prom_weights_gather(&m, weights));
    assert_true(weights[2] == 1 && weights[3] == 4 && weights[4] == 2);
    // By area: the larger leaf counts four times.
    assert_float_equal(weights[1], (4 * 4 + 2) / 5.0f, 1e-5f);
    assert_float_equal(weights[0], (4 * 4 + 2 + 1) / 6.0f, 1e-5f);
    prom_model_finish(&m);
}

static void weights_of_one_are_none(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int round = 0; round < 20; round++) {
        prom_model m;
        random_model_options o = options_of(&seed);
        random_model(&m, random_u64(&seed), &o);
        float *weights = prom_alloc(m.tree_count, sizeof *weights);
        assert_false(prom_weights_gather(&m, weights));
        for (uint32_t n = 0; n < m.tree_count; n++) assert_true(weights[n] == 1.0f);
        prom_free(weights);
        prom_model_finish(&m);
    }
}

// ---- the flow

// What a node's pixels are worth is what its children's are, wherever they flow.
static double check_flow(const prom_eval *eval)
{
    const prom_model *m = eval->model;
    double spread = 0;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        uint32_t node = eval->visited[i];
        const prom_eval_node *n = &eval->nodes[node];
        if (!n->expanded || !n->in_flow || n->culled) continue;
        double worth = 0, px = 0;
        for (uint32_t c = 0; c < m->child_count[node]; c++) {
            const prom_eval_node *child = &eval->nodes[m->first_child[node] + c];
            worth += (double)child->px * (double)child->weight;
            px += (double)child->px;
            if (child->px > 0)
                spread = fmax(spread, fabs((double)child->weight - (double)n->weight));
        }
        if (!(px > 0)) continue; // no child in view
        assert_true(fabs(px - (double)n->px) <= 1e-4 * px + 1e-6);
        assert_true(fabs(worth - (double)(n->px * n->weight)) <= 1e-4 * worth + 1e-6);
    }
    return spread;
}

static void a_node_is_worth_what_its_children_are(void **state)
{
    (void)state;
    uint64_t seed = 70;
    double spread = 0;
    for (int round = 0; round < 60; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        float *semantics = leaf_weights(&b.model, &seed);
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        for (int look = 0; look < 4; look++) {
            bench_look(&b, &seed);
            prom_view before = earlier_view(&b, &seed);
            b.selection.weighting = (prom_weighting){
                .use = 1 + random_below(&seed, 7), .semantics = semantics, .before = &before};
            b.selection.weighting.dt_s = 0.1;
            prom_eval_run(&eval, &b.selection, NULL, NULL);
            if (!eval.nodes[0].culled) spread = fmax(spread, check_flow(&eval));
            // A perfect cut of weighted pixels has no loss, whatever they are worth.
            const prom_cut *full = bench_run(&b, "full", 0);
            assert_true(fabs(full->loss) <= 1e-4 * full->benefit + 1e-6);
        }
        prom_eval_finish(&eval);
        prom_free(semantics);
        bench_finish(&b);
    }
    assert_true(spread > 1.0); // the weights did tell nodes apart
}

static void benefit_is_pixels_times_weight_times_accuracy(void **state)
{
    (void)state;
    uint64_t seed = 71;
    uint32_t weighted = 0;
    for (int round = 0; round < 30; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        float *semantics = leaf_weights(&b.model, &seed);
        bench_look(&b, &seed);
        b.selection.weighting = (prom_weighting){
            .use = PROM_WEIGHT_FOCUS | PROM_WEIGHT_SEMANTICS, .semantics = semantics};
        for (size_t i = 0; i < prom_selector_count(); i++) {
            const prom_cut *cut = bench_run(&b, prom_selector_at(i)->name, 5);
            double benefit = 0, worth = 0;
            for (size_t k = 0; k < cut->entries.count; k++) {
                const prom_cut_entry *e = &cut->entries.data[k];
                double px = (double)(e->visible_px * e->weight);
                benefit += px * (double)e->accuracy;
                worth += px;
                weighted += e->weight != 1.0f;
            }
            assert_null(prom_cut_check(&b.model, &b.view, cut));
            assert_true(fabs(benefit - cut->benefit) <= 1e-4 * worth + 1e-6);
            assert_true(fabs(worth - benefit - cut->loss) <= 1e-4 * worth + 1e-6);
        }
        prom_free(semantics);
        bench_finish(&b);
    }
    assert_true(weighted > 100);
}

// The same sums in the same order, and so the same bits.
static void weights_of_one_change_nothing(void **state)
{
    (void)state;
    uint64_t seed = 72;
    prom_cut other = {0};
    for (int round = 0; round < 40; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        float *ones = prom_alloc(b.model.tree_count, sizeof *ones);
        for (uint32_t n = 0; n < b.model.tree_count; n++) ones[n] = 1.0f;
        prom_selector *plain[sizeof b.selectors / sizeof *b.selectors];
        for (size_t i = 0; i < prom_selector_count(); i++)
            plain[i] = prom_selector_create(prom_selector_at(i)->name, &b.model, NULL);
        for (int look = 0; look < 4; look++) {
            bench_look(&b, &seed);
            double budget = random_between(&seed, 0, 20);
            for (size_t i = 0; i < prom_selector_count(); i++) {
                b.selection.weighting =
                    (prom_weighting){.use = PROM_WEIGHT_SEMANTICS, .semantics = ones};
                assert_true(prom_weighting_is_on(&b.selection.weighting));
                const prom_cut *cut = bench_run(&b, prom_selector_at(i)->name, budget);
                b.selection.weighting = (prom_weighting){0};
                prom_selector_run(plain[i], &b.selection, &other);
                assert_true(same_cuts(cut, &other));
            }
        }
        for (size_t i = 0; i < prom_selector_count(); i++) prom_selector_destroy(plain[i]);
        prom_free(ones);
        bench_finish(&b);
    }
    prom_cut_finish(&other);
}

// Of what stands for a leaf in a cut; -1: nothing does.
static double accuracy_of_leaf(const prom_model *m, const prom_cut *cut, uint32_t leaf)
{
    for (uint32_t n = leaf; n != PROM_NONE; n = m->parent[n])
        for (size_t i = 0; i < cut->entries.count; i++)
            if (cut->entries.data[i].node == n) return (double)cut->entries.data[i].accuracy;
    return -1;
}

static void what_is_worth_more_is_shown_better(void **state)
{
    (void)state;
    uint64_t seed = 73;
    double before = 0, after = 0;
    uint32_t count = 0;
    for (int round = 0; round < 60; round++) {
        bench b;
        bench_init(&b, random_u64(&seed),
                   &(random_model_options){.leaves = 100, .max_children = 8, .extent = 100});
        float *semantics = prom_alloc(b.model.tree_count, sizeof *semantics);
        bench_look(&b, &seed);
        double low = bench_run(&b, "coarsest", 0)->predicted_ms;
        double high = bench_run(&b, "full", 0)->predicted_ms;
        uint32_t leaf = random_below(&seed, b.model.tree_count);
        while (b.model.child_count[leaf]) leaf = b.model.first_child[leaf];
        b.model.weight[leaf] = 50;
        prom_weights_gather(&b.model, semantics);
        for (int i = 1; i < 5; i++) {
            double budget = low + (high - low) * i / 8;
            b.selection.weighting = (prom_weighting){0};
            double plain = accuracy_of_leaf(&b.model, bench_run(&b, "greedy", budget), leaf);
            b.selection.weighting =
                (prom_weighting){.use = PROM_WEIGHT_SEMANTICS, .semantics = semantics};
            double prized = accuracy_of_leaf(&b.model, bench_run(&b, "greedy", budget), leaf);
            if (plain < 0 || prized < 0) continue; // not in view
            before += plain, after += prized, count++;
        }
        prom_free(semantics);
        bench_finish(&b);
    }
    print_message("accuracy of an object: %.3f, worth 50 times as much %.3f\n", before / count,
                  after / count);
    assert_true(count > 50);
    assert_true(after > before + 0.02 * count);
}

// ---- hysteresis

// Switches along a walk through a random model in small steps.
static uint32_t switches_of_walk(bench *b, const char *name, float hysteresis, uint64_t seed)
{
    prom_last_cut last;
    prom_last_cut_init(&last, &b->model);
    uint32_t switches = 0;
    bench_look(b, &seed);
    const prom_camera start = b->camera;
    double step = 0.004 * (double)b->model.radius[0];
    double budget = 0.5 * bench_run(b, "coarsest", 0)->predicted_ms;
    budget += 0.5 * bench_run(b, "full", 0)->predicted_ms;
    b->selection.last = &last;
    b->selection.hysteresis = hysteresis;
    for (int i = 0; i < 40; i++) {
        b->camera = start;
        for (int k = 0; k < 3; k++) b->camera.eye[k] += step * sin(i * 0.3 + k);
        prom_view_init(&b->view, &b->camera);
        const prom_cut *cut = bench_run(b, name, budget);
        assert_null(prom_cut_check(&b->model, &b->view, cut));
        uint32_t count = prom_last_cut_note(&last, cut).count;
        switches += i ? count : 0;
    }
    prom_last_cut_finish(&last);
    b->selection.last = NULL;
    b->selection.hysteresis = 0;
    return switches;
}

static void hysteresis_keeps_what_is_shown(void **state)
{
    (void)state;
    uint64_t seed = 80;
    for (int s = 0; s < 2; s++) {
        const char *name = s ? "meta" : "greedy";
        uint32_t with = 0, without = 0;
        for (int round = 0; round < 20; round++) {
            bench b;
            bench_init(
                &b, random_u64(&seed),
                &(random_model_options){.leaves = 150, .max_children = 8, .extent = 100});
            uint64_t walk = random_u64(&seed);
            without += switches_of_walk(&b, name, 0, walk);
            with += switches_of_walk(&b, name, 0.2f, walk);
            bench_finish(&b);
        }
        print_message("%s switches %u times, with hysteresis %u\n", name, without, with);
        assert_true(without > 100);
        assert_true(with < 0.85 * without);
    }
}

// It orders, but is no part of what a cut is scored by.
static void hysteresis_is_no_benefit(void **state)
{
    (void)state;
    uint64_t seed = 81;
    for (int round = 0; round < 30; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        bench_look(&b, &seed);
        prom_last_cut last;
        prom_last_cut_init(&last, &b.model);
        prom_last_cut_note(&last, bench_run(&b, "greedy", 3));
        b.selection.last = &last;
        b.selection.hysteresis = 0.5f;
        const prom_cut *cut = bench_run(&b, "greedy", 6);
        double benefit = 0, worth = 0;
        for (size_t i = 0; i < cut->entries.count; i++) {
            const prom_cut_entry *e = &cut->entries.data[i];
            worth += (double)e->visible_px;
            benefit += (double)(e->visible_px * e->accuracy);
        }
        assert_true(fabs(benefit - cut->benefit) <= 1e-4 * worth + 1e-6);
        assert_true(fabs(worth - benefit - cut->loss) <= 1e-4 * worth + 1e-6);
        prom_last_cut_finish(&last);
        bench_finish(&b);
    }
}

static void switches_are_what_is_shown_otherwise(void **state)
{
    (void)state;
    prom_model m = {0};
    small_tree(&m);
    prom_last_cut last;
    prom_last_cut_init(&last, &m);
    prom_cut_entry rest = {.node = 2, .rep = 0, .visible_px = 7};
    prom_cut_entry whole = {.node = 1, .rep = 3, .visible_px = 10};
    prom_cut_entry parts[] = {{.node = 3, .rep = 0, .visible_px = 6},
                              {.node = 4, .rep = 1, .visible_px = 0}};
    prom_cut cut = {0};
    prom_array_push(&cut.entries, rest);
    assert_int_equal(prom_last_cut_note(&last, &cut).count, 0); // nothing was before
    prom_array_push(&cut.entries, whole);
    assert_int_equal(prom_last_cut_note(&last, &cut).count, 0); // came into view
    cut.entries.data[1].rep = 4;
    assert_int_equal(prom_last_cut_note(&last, &cut).count, 1);
    assert_int_equal(prom_last_cut_note(&last, &cut).count, 0);
    cut.entries.data[1] = parts[0];
    prom_array_push(&cut.entries, parts[1]);
    prom_switches opened = prom_last_cut_note(&last, &cut); // what is hidden does not count
    assert_true(opened.count == 1 && opened.px == 6);
    cut.entries.count = 2;
    cut.entries.data[1] = whole;
    prom_switches closed = prom_last_cut_note(&last, &cut);
    assert_true(closed.count == 1 && closed.px == 10);
    prom_last_cut_finish(&last);
    prom_cut_finish(&cut);
    prom_model_finish(&m);
}

// ---- the classic rules

static void other_orders_keep_the_rules(void **state)
{
    (void)state;
    uint64_t seed = 90;
    uint32_t different = 0;
    prom_cut plain = {0};
    for (int round = 0; round < 60; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        bench_look(&b, &seed);
        double low = bench_run(&b, "coarsest", 0)->predicted_ms;
        double high = bench_run(&b, "full", 0)->predicted_ms;
        double budget = low + 0.4 * (high - low);
        for (int s = 0; s < 2; s++) {
            const char *name = s ? "meta" : "greedy";
            copy_cut(bench_run(&b, name, budget), &plain);
            b.selection.order = PROM_ORDER_SUM;
            const prom_cut *sum = bench_run(&b, name, budget);
            b.selection.order = PROM_ORDER_PIXELS;
            assert_null(prom_cut_check(&b.model, &b.view, sum));
            assert_true(s || sum->feasible || low > budget * (1 - 1e-8));
            different += !same_cuts(&plain, sum);
        }
        bench_finish(&b);
    }
    prom_cut_finish(&plain);
    assert_true(different > 20);
}

// With the sum, a cluster stands in the list of `meta` before each of its children, and before
// another cluster whose best child is better but whose sum is less.
static void sums_add_up(void **state)
{
    (void)state;
    uint64_t seed = 91;
    for (int round = 0; round < 30; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        bench_look(&b, &seed);
        b.selection.order = PROM_ORDER_SUM;
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        prom_eval_run(&eval, &b.selection, NULL, NULL);
        for (uint32_t i = 0; i < eval.visited_count; i++) {
            uint32_t node = eval.visited[i], first = b.model.first_child[node];
            const prom_eval_node *n = &eval.nodes[node];
            if (!n->expanded || n->culled) continue;
            double sum = 0;
            for (uint32_t c = 0; c < b.model.child_count[node]; c++)
                if (!eval.nodes[first + c].culled)
                    sum += (double)eval.nodes[first + c].value_px;
            assert_true(fabs(sum - (double)n->value_px) <= 1e-4 * sum);
            for (uint32_t k = 0; k < n->option_count; k++) {
                const prom_option *option = &eval.options[n->first_option + k];
                assert_true(option->value == n->value_px * option->accuracy);
            }
        }
        prom_eval_finish(&eval);
        bench_finish(&b);
    }
}

static bool has_average_box(const prom_model *m, uint32_t node, float size_px)
{
    const prom_prototype *p = &m->prototypes[m->prototype[node]];
    for (uint32_t r = p->first_rep; r < p->first_rep + p->rep_count; r++)
        if (m->reps[r].kind == PROM_REP_AVERAGE_BOX && size_px <= m->reps[r].max_size_px)
            return true;
    return false;
}

static void priors_choose_for_the_small_and_the_large(void **state)
{
    (void)state;
    uint64_t seed = 92;
    uint32_t small = 0, large = 0;
    for (int round = 0; round < 150; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        bench_look(&b, &seed);
        b.selection.priors = PROM_PRIOR_FEW_PIXELS | PROM_PRIOR_FULL_DETAIL;
        float screen = (float)b.camera.width * (float)b.camera.height;
        double budget = bench_run(&b, "full", 0)->predicted_ms * random_unit(&seed);
        for (int s = 0; s < 2; s++) {
            const prom_cut *cut = bench_run(&b, s ? "meta" : "greedy", budget);
            assert_null(prom_cut_check(&b.model, &b.view, cut));
            for (size_t i = 0; i < cut->entries.count; i++) {
                const prom_cut_entry *e = &cut->entries.data[i];
                const prom_prototype *p = &b.model.prototypes[b.model.prototype[e->node]];
                prom_appearance a;
                prom_view_appearance(&b.view, &b.model, e->node, &a);
                bool leaf = !b.model.child_count[e->node];
                if (leaf && e->footprint_px >= PROM_PRIOR_LARGE_SHARE * screen) {
                    assert_int_equal(e->rep, p->first_rep);
                    large++;
                } else if (a.size_px < PROM_SIZE_MIN_PX && !a.near_case &&
                           has_average_box(&b.model, e->node, a.size_px)) {
                    assert_int_equal(b.model.reps[e->rep].kind, PROM_REP_AVERAGE_BOX);
                    small++;
                }
            }
        }
        // The others do not heed them.
        const prom_cut *full = bench_run(&b, "full", 0);
        for (size_t i = 0; i < full->entries.count; i++) {
            uint32_t prototype = b.model.prototype[full->entries.data[i].node];
            assert_int_equal(full->entries.data[i].rep,
                             b.model.prototypes[prototype].first_rep);
        }
        bench_finish(&b);
    }
    print_message("%u small and %u large\n", small, large);
    assert_true(small > 50 && large > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curves_fall_from_one_to_nothing),
        cmocka_unit_test(focus_falls_with_the_angle),
        cmocka_unit_test(motion_falls_with_the_apparent_speed),
        cmocka_unit_test(the_last_rule_that_matches_counts),
        cmocka_unit_test(names_weigh_what_is_below_them),
        cmocka_unit_test(weights_of_one_are_none),
        cmocka_unit_test(a_node_is_worth_what_its_children_are),
        cmocka_unit_test(benefit_is_pixels_times_weight_times_accuracy),
        cmocka_unit_test(weights_of_one_change_nothing),
        cmocka_unit_test(what_is_worth_more_is_shown_better),
        cmocka_unit_test(hysteresis_keeps_what_is_shown),
        cmocka_unit_test(hysteresis_is_no_benefit),
        cmocka_unit_test(switches_are_what_is_shown_otherwise),
        cmocka_unit_test(other_orders_keep_the_rules),
        cmocka_unit_test(sums_add_up),
        cmocka_unit_test(priors_choose_for_the_small_and_the_large),
    };
    return cmocka_run_group_tests_name("weights", tests, NULL, NULL);
}

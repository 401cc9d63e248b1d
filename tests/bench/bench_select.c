// LINK: prom_traverse prom_benefit prom_metaobj
// Times the selectors on towns of any number of objects, of which the view always sees as many:
// the camera flies over the middle of the town and looks down. Says how far their cuts are from
// their bounds. CSV on stdout: one row per town and selector.
// Usage: bench_select [-b] [FRAMES [OBJECTS...]]
//   -b: without bounds, for the time that they take; FRAMES: 100; OBJECTS: 10000 100000 1000000
#include "../random_model.h"
#include "metaobj/base/clock.h"
#include "traverse/bound.h"
#include "traverse/selector.h"

#include <stdio.h>
#include <stdlib.h>

#define SPACING 10.0f // between objects
#define HEIGHT 150.0  // of the camera
#define SPEED 0.5     // per frame
#define BUDGET 0.2    // between the cheapest cut and full detail

enum { LEAF_PROTOTYPES = 8, MOST_LEVELS = 16, MOST_FRAMES = 100000 };

// ---- the town: a square of squares of 2 x 2, down to objects

typedef struct town {
    prom_model model;
    uint32_t objects;
    uint32_t root_side, levels; // of squares of 2 x 2 below the root's children
} town;

static void make_leaf_prototypes(prom_model *m, uint64_t *seed)
{
    for (int i = 0; i < LEAF_PROTOTYPES; i++) {
        random_prototype(m, seed, 0);
        prom_prototype *p = &m->prototypes[i];
        for (int k = 0; k < 3; k++) p->center[k] = 0.0f, p->half[k] = 0.4f * SPACING;
        p->radius = sqrtf(3.0f) * p->half[0];
        random_correlated_reps(m, seed, false);
    }
}

static void make_cluster_prototype(prom_model *m, uint64_t *seed, uint32_t children)
{
    random_prototype(m, seed, children);
    const prom_prototype *p = &m->prototypes[m->prototype_count - 1];
    for (uint32_t c = 0; c < children; c++)
        for (uint32_t d = 0; d < PROM_DIRS; d++)
            m->shares[p->first_share + c][d] = (uint16_t)(65535 / children);
    random_correlated_reps(m, seed, true);
}

// Nodes of one level: a square grid, in the order of their parents' children.
static void place_level(prom_model *m, uint32_t first, uint32_t count, uint32_t parents,
                        uint32_t side, float size)
{
    uint32_t per = side * side;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t node = first + i, parent = parents + i / per, c = i % per;
        m->parent[node] = parent;
        m->placement[node] = prom_placement_identity;
        const double *at = m->placement[parent].origin;
        float middle = 0.5f * (float)(side - 1);
        m->placement[node].origin[0] = at[0] + (double)(((float)(c % side) - middle) * size);
        m->placement[node].origin[2] = at[2] + (double)(((float)(c / side) - middle) * size);
    }
}

static void make_town(town *t, uint32_t objects)
{
    prom_model *m = &t->model;
    uint64_t seed = 1;
    *t = (town){0};
    double left = objects;
    while (left > 12.0) left /= 4.0, t->levels++;
    t->root_side = (uint32_t)lround(sqrt(left));
    uint32_t count = t->root_side * t->root_side, nodes = 1;
    for (uint32_t l = 0; l <= t->levels; l++) nodes += count << 2 * l;
    random_allocate(m, nodes, LEAF_PROTOTYPES + MOST_LEVELS);
    t->objects = count << 2 * t->levels;
    make_leaf_prototypes(m, &seed);
    m->parent[0] = PROM_NONE;
    m->placement[0] = prom_placement_identity;
    uint32_t first = 0, size = 1, side = t->root_side;
    float edge = SPACING * (float)(1u << t->levels);
    for (uint32_t l = 0; l <= t->levels + 1; l++) {
        bool leaves = l == t->levels + 1;
        if (!leaves) make_cluster_prototype(m, &seed, side * side);
        for (uint32_t i = 0; i < size; i++) {
            uint32_t n = first + i;
            m->prototype[n] =
                leaves ? random_below(&seed, LEAF_PROTOTYPES) : m->prototype_count - 1;
            m->child_count[n] = leaves ? 0 : side * side;
            m->first_child[n] = leaves ? PROM_NONE : first + size + i * side * side;
        }
        if (leaves) break;
        place_level(m, first + size, size * side * side, first, side, edge);
        first += size;
        size *= side * side;
        side = 2;
        edge *= 0.5f;
    }
    m->node_count = m->tree_count = nodes;
    m->mesh_count = m->rep_count;
    prom_model_update_bounds(m);
    for (uint32_t n = 0; n < nodes && m->child_count[n]; n++)
        m->prototypes[m->prototype[n]].radius = m->radius[n];
}

// ---- the flight

static void pose(uint32_t frame, prom_camera *camera)
{
    *camera = (prom_camera){.fov_y = 1.0471976f, .z_near = 0.1f, .width = 1280, .height = 720};
    // In a circle, so that the town need not be larger than what is seen.
    double angle = frame * SPEED / 100.0;
    camera->eye[0] = 100.0 * cos(angle);
    camera->eye[1] = HEIGHT;
    camera->eye[2] = 100.0 * sin(angle);
    const double target[3] = {0.3 * camera->eye[0], 0.0, 0.3 * camera->eye[2]};
    prom_camera_look_at(camera, target);
}

static double mean_ms(const prom_model *m, const char *name, const prom_cost_model *cost,
                      uint32_t frames)
{
    prom_selector *selector = prom_selector_create(name, m, NULL);
    prom_cut cut = {0};
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t f = 0; f < frames; f += 10, count++) {
        prom_camera camera;
        prom_view view;
        pose(f, &camera);
        prom_view_init(&view, &camera);
        prom_selection selection = {.view = &view, .cost = cost};
        prom_selector_run(selector, &selection, &cut);
        sum += cut.predicted_ms;
    }
    prom_cut_finish(&cut);
    prom_selector_destroy(selector);
    return sum / count;
}

static int by_size(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return *x < *y ? -1 : *x > *y;
}

static double mean_of(const double *values, uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) sum += values[i];
    return count ? sum / count : NAN;
}

static double p99_of(double *values, uint32_t count)
{
    qsort(values, count, sizeof *values, by_size);
    return count ? values[(uint32_t)(0.99 * (count - 1))] : NAN;
}

static void fly(const town *t, const prom_selector_class *class, const prom_cost_model *cost,
                double budget_ms, uint32_t frames, bool certify)
{
    const prom_model *m = &t->model;
    prom_selector *selector = prom_selector_create(class->name, m, NULL);
    prom_last_cut last;
    prom_cut cut = {0};
    prom_last_cut_init(&last, m);
    double *ms = prom_alloc(frames, sizeof *ms), *gaps = prom_alloc(frames, sizeof *gaps);
    double visited = 0.0, entries = 0.0, switches = 0.0, use = 0.0, loss = 0.0;
    uint32_t gap_count = 0, warm = frames > 10 ? 5 : 0; // frames that are not counted
    for (uint32_t f = 0; f < frames + warm; f++) {
        prom_camera camera;
        prom_view view;
        pose(f, &camera);
        double start = prom_clock_ms();
        prom_view_init(&view, &camera);
        prom_selection selection = {.view = &view,
                                    .cost = cost,
                                    .budget_ms = budget_ms,
                                    .certify = certify,
                                    .last = &last};
        prom_selector_run(selector, &selection, &cut);
        double taken = prom_clock_ms() - start;
        prom_switches s = prom_last_cut_note(&last, &cut);
        if (f < warm) continue;
        ms[f - warm] = taken;
        switches += s.count;
        visited += cut.nodes_visited;
        entries += (double)cut.entries.count;
        use += cut.predicted_ms / budget_ms;
        loss += cut.loss / (cut.benefit + cut.loss);
        double gap = prom_cut_gap(&cut);
        if (isfinite(gap)) gaps[gap_count++] = gap;
    }
    double mean = mean_of(ms, frames), gap = mean_of(gaps, gap_count);
    printf("%u,%u,%s,%.3f,%.0f,%.0f,%.4f,%.4f,%.2f,%.4f,%.5f,", t->objects, m->tree_count,
           class->name, budget_ms, visited / frames, entries / frames, mean, p99_of(ms, frames),
           switches / frames, use / frames, loss / frames);
    if (gap_count) printf("%.5f,%.5f", gap, p99_of(gaps, gap_count));
    if (!gap_count) printf(",");
    printf("\n");
    fflush(stdout);
    prom_free(ms);
    prom_free(gaps);
    prom_cut_finish(&cut);
    prom_last_cut_finish(&last);
    prom_selector_destroy(selector);
}

static void time_town(uint32_t objects, uint32_t frames, bool certify)
{
    town t;
    make_town(&t, objects);
    prom_cost_model cost = {
        .fixed_ms = 1, .draw_ms = 5e-4, .triangle_ms = 1.2e-4, .hidden_pixel_ms = 5e-7};
    for (int k = 0; k < PROM_COST_KINDS; k++) cost.pixel_ms[k] = 4e-6;
    double low = mean_ms(&t.model, "coarsest", &cost, frames);
    double high = mean_ms(&t.model, "full", &cost, frames);
    for (size_t s = 0; s < prom_selector_count(); s++)
        // Far too slow for so many.
        if (strcmp(prom_selector_at(s)->name, "optimal"))
            fly(&t, prom_selector_at(s), &cost, low + BUDGET * (high - low), frames, certify);
    prom_model_finish(&t.model);
}

int main(int argc, char **argv)
{
    bool certify = !(argc > 1 && !strcmp(argv[1], "-b"));
    argc -= !certify, argv += !certify;
    long frames = argc > 1 ? strtol(argv[1], NULL, 10) : 100;
    static const char *const usual[] = {"10000", "100000", "1000000"};
    int count = argc > 2 ? argc - 2 : 3;
    printf("objects,nodes,selector,budget_ms,visited,entries,ms,ms_p99,"
           "switches,use,loss,gap_mean,gap_p99\n");
    for (int i = 0; i < count; i++) {
        long objects = strtol(argc > 2 ? argv[i + 2] : usual[i], NULL, 10);
        if (frames < 1 || frames > MOST_FRAMES || objects < 100 || objects > 20000000) {
            fprintf(stderr,
                    "error: usage: bench_select [-b] [FRAMES 1..%d [OBJECTS "
                    "100..20000000]...]\n",
                    MOST_FRAMES);
            return 1;
        }
        time_town((uint32_t)objects, (uint32_t)frames, certify);
    }
    return 0;
}

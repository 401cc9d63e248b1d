#include "builder/simplify/engine_step.h"

#include "metaobj/base/clock.h"

#include <assert.h>
#include <float.h>
#include <math.h>

// A candidate that a guard turned away comes again when the others cost twice as much, so many
// times its own cost at the most: its surroundings have changed by then.
#define COME_AGAIN 2.0f
#define LAST_TIME 64.0f
// Other places for it may cost so many times more before they wait for their turn.
#define OTHER_PLACE 2.0f
// After all candidates are gone they are gathered anew as long as a round removes this part.
#define ROUND_PART 0.01f

// ---- candidates

static bool stale(const void *user, const prom_candidate *e)
{
    const prom_collapser *c = user;
    return c->points[e->from].stamp + c->points[e->to].stamp != e->stamp;
}

// Dropping what is stale pays if much of it is.
static void make_room(prom_collapser *c)
{
    if (c->queue.count < c->room) return;
    prom_queue_filter(&c->queue, stale, c);
    if (c->queue.count > c->room / 8 * 7) c->room += c->room / 4;
}

// The cheaper way to merge two points.
static bool find_candidate(prom_collapser *c, uint32_t a, uint32_t b, prom_candidate *out)
{
    const bool locked[2] = {c->points[a].flags & PROM_POINT_LOCKED,
                            c->points[b].flags & PROM_POINT_LOCKED};
    bool found = false;
    if (locked[0] && locked[1]) c->stats.rejected_lock++;
    for (int turned = 0; turned < 2; turned++) {
        const uint32_t from = turned ? a : b, to = turned ? b : a;
        if (locked[!turned]) continue;
        if (found && !c->options.half_edge) break; // the place is free: it is the same
        prom_step step;
        if (!prom_step_evaluate(c, from, to, false, &step)) {
            c->left_out = true;
            continue;
        }
        if (found && !(step.result.cost < out->key)) continue;
        *out = (prom_candidate){step.result.cost, from, to,
                                c->points[a].stamp + c->points[b].stamp};
        found = true;
    }
    return found;
}

static void push_candidate(prom_collapser *c, uint32_t a, uint32_t b)
{
    prom_candidate e;
    if (!find_candidate(c, a, b, &e)) return;
    make_room(c);
    prom_queue_push(&c->queue, &e);
}

// Calls for every edge and virtual edge around a point, once each; only those with lower points
// if `lower`. Returns whether the point is on an open border.
static bool for_each_edge(prom_collapser *c, uint32_t point, bool lower,
                          void (*each)(prom_collapser *c, uint32_t point, uint32_t other))
{
    const prom_collapse_mesh *mesh = c->mesh;
    const uint32_t epoch = prom_marks_begin(&c->marks);
    uint32_t *mark = c->marks.mark;
    int once = 0; // edges seen once so far: with one triangle
    mark[point] = epoch + 1;
    for (uint32_t i = mesh->first_corner[point]; i != PROM_NONE; i = mesh->next_corner[i])
        for (int k = 0; k < 2; k++) {
            const uint32_t corner = k ? prom_corner_before(i) : prom_corner_after(i);
            const uint32_t other = prom_corner_point(mesh, corner);
            if (mark[other] < epoch) {
                mark[other] = epoch;
                once++;
                if (each && (!lower || other < point)) each(c, point, other);
            } else if (mark[other] == epoch) {
                mark[other] = epoch + 1;
                once--;
            }
        }
    if (!each || !prom_pairs_any(&c->pairs) || mesh->first_corner[point] == PROM_NONE)
        return once > 0; // a point without triangles is gone, pairs or not
    for (uint32_t i = c->pairs.first[point]; i != PROM_NONE; i = c->pairs.links.data[i].next) {
        const uint32_t other = prom_pairs_find(&c->pairs, c->pairs.links.data[i].other);
        if (mark[other] >= epoch || mesh->first_corner[other] == PROM_NONE) continue;
        mark[other] = epoch;
        if (!lower || other < point) each(c, point, other);
    }
    return once > 0;
}

static void gather_candidates(prom_collapser *c)
{
    prom_queue_clear(&c->queue);
    c->left_out = false;
    c->room = SIZE_MAX;
    for (uint32_t p = 0; p < c->mesh->points; p++)
        if (c->mesh->first_corner[p] != PROM_NONE) for_each_edge(c, p, true, push_candidate);
}

// ---- beginning and end

static bool has_vertices(const prom_collapse_mesh *mesh, uint32_t point)
{
    const uint32_t first = mesh->first_corner[point];
    for (uint32_t i = first; i != PROM_NONE; i = mesh->next_corner[i])
        if (mesh->corners[i] != mesh->corners[first]) return true;
    return false;
}

static void find_flags(prom_collapser *c, const uint8_t *locked)
{
    const prom_collapse_mesh *mesh = c->mesh;
    for (uint32_t p = 0; p < mesh->points; p++) {
        if (mesh->first_corner[p] == PROM_NONE) continue;
        if (for_each_edge(c, p, false, NULL)) c->points[p].flags |= PROM_POINT_BORDER;
        if (has_vertices(mesh, p)) c->points[p].flags |= PROM_POINT_MULTIPLE;
        if (c->options.lock_border && (c->points[p].flags & PROM_POINT_BORDER))
            c->points[p].flags |= PROM_POINT_LOCKED;
    }
    for (uint32_t i = 0; i < mesh->base_vertices && locked; i++)
        if (locked[i]) c->points[mesh->point.data[i]].flags |= PROM_POINT_LOCKED;
}

static size_t bytes_now(const prom_collapser *c)
{
    const size_t per_point = sizeof *c->points + sizeof *c->marks.mark;
    return prom_collapse_mesh_bytes(c->mesh) + c->options.metric->bytes(c->metric) +
           prom_queue_bytes(&c->queue) + prom_pairs_bytes(&c->pairs, c->mesh) +
           c->mesh->points * per_point;
}

static void note_bytes(prom_collapser *c)
{
    const size_t bytes = bytes_now(c);
    if (bytes > c->stats.peak_bytes) c->stats.peak_bytes = bytes;
}

prom_collapser *prom_collapser_create(prom_collapse_mesh *mesh,
                                      const prom_collapse_options *options)
{
    assert(!(options->loose && options->records));
    const double start = prom_clock_ms();
    prom_collapser *c = prom_calloc(1, sizeof *c);
    c->mesh = mesh;
    c->options = *options;
    c->options.locked = NULL;
    if (!c->options.metric) c->options.metric = prom_collapse_metric_at(0);
    c->points = prom_calloc(mesh->points, sizeof *c->points);
    prom_marks_init(&c->marks, mesh->points);
    prom_queue_init(&c->queue);
    c->metric = c->options.metric->create(mesh, &c->options.weights);
    prom_pairs_init(&c->pairs, mesh, options->pair_distance);
    find_flags(c, options->locked);
    gather_candidates(c);
    note_bytes(c);
    c->stats.init_ms = prom_clock_ms() - start;
    return c;
}

void prom_collapser_destroy(prom_collapser *c)
{
    if (!c) return;
    c->options.metric->destroy(c->metric);
    prom_queue_finish(&c->queue);
    prom_pairs_finish(&c->pairs);
    prom_marks_finish(&c->marks);
    prom_slots_finish(&c->slots);
    prom_array_finish(&c->made);
    prom_array_finish(&c->survivors);
    prom_free(c->points);
    prom_free(c);
}

void prom_collapser_stats(const prom_collapser *c, prom_collapse_stats *stats)
{
    *stats = c->stats;
    stats->triangles = c->mesh->triangles;
}

// ---- running

static void count_rejected(prom_collapser *c, prom_verdict verdict)
{
    c->stats.rejected_link += verdict == PROM_VERDICT_LINK;
    c->stats.rejected_flip += verdict == PROM_VERDICT_FLIP;
    c->stats.rejected_degenerate += verdict == PROM_VERDICT_DEGENERATE;
}

// After a collapse: candidates around the merged point are made anew.
static void renew(prom_collapser *c, uint32_t point)
{
    const bool border = for_each_edge(c, point, false, push_candidate);
    c->points[point].flags &= ~(uint32_t)PROM_POINT_BORDER;
    c->points[point].flags |= border ? PROM_POINT_BORDER : 0;
}

typedef enum outcome { DONE, TOO_MUCH, REFUSED, AGAINST_LINK } outcome;

// Does a step if it may be done for so much.
static outcome attempt(prom_collapser *c, uint32_t from, uint32_t to, bool fixed,
                       float most_cost, float limit)
{
    prom_step step;
    if (c->points[from].flags & PROM_POINT_LOCKED) return REFUSED;
    if (!prom_step_evaluate(c, from, to, fixed, &step) || step.result.cost > most_cost)
        return REFUSED;
    if (step.result.error > limit) return TOO_MUCH;
    const prom_verdict verdict = prom_step_judge(c, &step, limit);
    count_rejected(c, verdict);
    if (verdict) return verdict == PROM_VERDICT_LINK ? AGAINST_LINK : REFUSED;
    prom_step_apply(c, &step);
    renew(c, to);
    return DONE;
}

// Where a face would flip, other places may do.
static outcome attempt_all(prom_collapser *c, const prom_candidate *e, float limit)
{
    outcome result = attempt(c, e->from, e->to, false, INFINITY, limit);
    if (result != REFUSED) return result;
    const float most = OTHER_PLACE * e->key;
    if (!c->options.half_edge) {
        result = attempt(c, e->from, e->to, true, most, limit);
        if (result != REFUSED) return result;
    }
    return attempt(c, e->to, e->from, true, most, limit);
}

static void come_again(prom_collapser *c, prom_candidate e)
{
    prom_step step;
    c->left_out = true;
    if (!prom_step_evaluate(c, e.from, e.to, false, &step)) return;
    e.key *= COME_AGAIN;
    if (e.key > 0 && e.key <= fminf(LAST_TIME * step.result.cost, FLT_MAX))
        prom_queue_push(&c->queue, &e);
}

// Until the target is reached or no candidate is left.
static void run_round(prom_collapser *c, uint32_t target, float limit)
{
    prom_candidate e;
    while (c->mesh->triangles > target && prom_queue_pop(&c->queue, &e)) {
        if (stale(c, &e)) continue;
        const outcome result = attempt_all(c, &e, limit);
        if (result == TOO_MUCH) c->left_out = true;
        if (result == REFUSED || result == AGAINST_LINK) come_again(c, e);
    }
}

float prom_collapser_run(prom_collapser *c, uint32_t target_triangles, float max_error)
{
    const double start = prom_clock_ms();
    const float limit = max_error * max_error;
    uint32_t before = UINT32_MAX;
    run_round(c, target_triangles, limit);
    while (c->mesh->triangles > target_triangles && c->left_out &&
           (float)(before - c->mesh->triangles) > ROUND_PART * (float)c->mesh->triangles) {
        before = c->mesh->triangles;
        gather_candidates(c);
        run_round(c, target_triangles, limit);
    }
    note_bytes(c);
    c->stats.run_ms += prom_clock_ms() - start;
    return sqrtf(c->greatest_error);
}

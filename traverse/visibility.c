#include "traverse/visibility.h"

#include "benefit/accuracy.h"
#include "traverse/footprint.h"
#include "traverse/view_private.h"

#include <math.h>

// What was counted holds for some way: a part of the distance to what is seen, or for what was
// partly outside the view, of the angle of view. From there on it fades, to half in HALF_WAY
// more: by then other things are hidden. By taste.
#define SURE_WAY 0.15f
#define HALF_WAY 0.35f
// Pixels of a footprint in which a counting that found nothing is believed at once: fewer are
// seldom met by the samples.
#define SURE_PX 64.0f
// What shows more than this of itself is known to show; how much more, few samples do not tell.
#define SEEN 0.05f
// And how much is believed of one that found less than before, and of one that found nothing:
// samples of a narrow view of something large come and go.
#define FALL 0.5f
#define FALL_TO_NOTHING 0.75f
// What was partly outside the view and has grown by more than this factor has come into it as
// far as it is more: of that nothing is known yet.
#define GROWTH 1.1f
// A footprint of fewer pixels says nothing.
#define LEAST_PX 1e-3f

typedef struct node_state {
    double moved, turned; // the odometers when it was counted last
    float share;          // as counted then
    float own_px;         // and what it would have had by itself
    float prior;          // by the cell
    uint32_t cell;        // the number of the cell's visit for which that holds
    bool counted;         // moved, turned, share, whole are valid
    bool whole;           // it was wholly in view
} node_state;

// Sums over the entries below a node; valid for one feed.
typedef struct node_sum {
    float px, footprint_px;
    float counted_px;  // of the footprint
    float expected_px; // to be visible, when the cut was chosen
    uint32_t feed;
} node_sum;

struct prom_visibility {
    const prom_model *model;
    const prom_view_cells *cells;
    node_state *nodes;
    node_sum *sums;
    uint32_t *touched; // of one feed, or one cell
    uint32_t touched_count, feeds;
    // The camera's way: moved in units of the distance to what was seen, turned in units of the
    // angle of view. Doubles: a step counts after any jump too.
    double moved, turned;
    float sight; // that distance
    prom_camera camera;
    bool has_camera;
    const prom_view_cell *cell;
    uint32_t cell_visit; // 0: in none
};

prom_visibility *prom_visibility_create(const prom_model *model, const prom_view_cells *cells)
{
    prom_visibility *v = prom_calloc(1, sizeof *v);
    v->model = model;
    v->cells = cells && cells->size > 0.0 ? cells : NULL;
    v->nodes = prom_calloc(model->tree_count, sizeof *v->nodes);
    v->sums = prom_calloc(model->tree_count, sizeof *v->sums);
    v->touched = prom_alloc(model->tree_count, sizeof *v->touched);
    return v;
}

void prom_visibility_destroy(prom_visibility *visibility)
{
    if (!visibility) return;
    prom_free(visibility->nodes);
    prom_free(visibility->sums);
    prom_free(visibility->touched);
    prom_free(visibility);
}

// Adds to the sums of a node and of all above it, up to the root.
static void add_upwards(prom_visibility *v, uint32_t node, node_sum more)
{
    for (; node != PROM_NONE; node = v->model->parent[node]) {
        node_sum *s = &v->sums[node];
        if (s->feed != v->feeds) {
            *s = (node_sum){.feed = v->feeds};
            v->touched[v->touched_count++] = node;
        }
        s->px += more.px;
        s->footprint_px += more.footprint_px;
        s->counted_px += more.counted_px;
        s->expected_px += more.expected_px;
    }
}

static void begin_sums(prom_visibility *v)
{
    v->touched_count = 0;
    v->feeds++;
}

static float clamp_share(float share)
{
    return fminf(fmaxf(share, PROM_VISIBILITY_LEAST), PROM_VISIBILITY_MOST);
}

// ---- cells

// What a node covers seen from the eye, for a focal length of 1 px.
static float footprint_around(const prom_view *view, const prom_model *model, uint32_t node)
{
    prom_appearance a;
    prom_view_appearance_culled(view, model, node, PROM_INSIDE, &a);
    if (a.nearest < PROM_EXTREME_NEAREST * a.distance) return 0.0f; // all around
    return prom_footprint_px(model, model->prototype[node], a.dir, a.size_px) /
           (view->f_px * view->f_px);
}

static void enter_cell(prom_visibility *v, const prom_camera *camera)
{
    const prom_view_cell *cell = v->cell;
    prom_view view;
    prom_view_init(&view, camera);
    begin_sums(v);
    for (uint32_t i = cell->first; i < cell->first + cell->count; i++) {
        uint32_t leaf = v->cells->leaves[i];
        float share = prom_view_share_decode(v->cells->shares[i]);
        float footprint = footprint_around(&view, v->model, leaf);
        add_upwards(v, leaf, (node_sum){.px = share * (footprint > 0.0f ? footprint : 1.0f)});
        v->nodes[leaf].prior = share;
        v->nodes[leaf].cell = v->cell_visit;
    }
    for (uint32_t i = 0; i < v->touched_count; i++) {
        uint32_t node = v->touched[i];
        if (!v->model->child_count[node]) continue;
        float footprint = footprint_around(&view, v->model, node);
        v->nodes[node].prior = footprint > 0.0f ? v->sums[node].px / footprint : 1.0f;
        v->nodes[node].cell = v->cell_visit;
    }
}

static void look_up_cell(prom_visibility *v, const prom_camera *camera)
{
    if (!v->cells) return;
    const prom_view_cell *cell = prom_view_cells_at(v->cells, camera->eye);
    if (cell == v->cell) return;
    v->cell = cell;
    if (!cell) return;
    v->cell_visit++;
    enter_cell(v, camera);
}

// What is known of a node without counting.
static float prior_of(const prom_visibility *v, uint32_t node)
{
    if (!v->cell) return 1.0f;
    const node_state *n = &v->nodes[node];
    return n->cell == v->cell_visit ? fminf(n->prior, 1.0f) : PROM_VISIBILITY_LEAST;
}

// ---- counts

static double moved_by(const prom_camera *from, const prom_camera *to)
{
    double square = 0.0;
    for (int k = 0; k < 3; k++) {
        double d = to->eye[k] - from->eye[k];
        square += d * d;
    }
    return sqrt(square);
}

// The angle between two orientations: q and -q are the same one.
static float turned_by(const prom_camera *from, const prom_camera *to)
{
    float minus = 0.0f, plus = 0.0f;
    for (int k = 0; k < 4; k++) {
        float a = from->orientation[k], b = to->orientation[k];
        minus += (a - b) * (a - b);
        plus += (a + b) * (a + b);
    }
    return 4.0f * asinf(fminf(0.5f * sqrtf(fminf(minus, plus)), 1.0f));
}

void prom_visibility_begin(prom_visibility *visibility, const prom_camera *camera)
{
    prom_visibility *v = visibility;
    if (v->has_camera) {
        if (v->sight > 0.0f) v->moved += moved_by(&v->camera, camera) / (double)v->sight;
        v->turned += (double)(turned_by(&v->camera, camera) / camera->fov_y);
    }
    v->camera = *camera;
    v->has_camera = true;
    look_up_cell(v, camera);
}

float prom_visibility_share(const prom_visibility *visibility, uint32_t node)
{
    const prom_visibility *v = visibility;
    const node_state *n = &v->nodes[node];
    float prior = prior_of(v, node);
    if (!n->counted) return prior;
    float way = (float)(v->moved - n->moved + (n->whole ? 0.0 : v->turned - n->turned));
    if (way <= SURE_WAY) return n->share;
    float beyond = (way - SURE_WAY) / HALF_WAY;
    return prior + (n->share - prior) * exp2f(-beyond * beyond);
}

double prom_visibility_way(const prom_visibility *visibility)
{
    return visibility->moved + visibility->turned;
}

bool prom_visibility_px(const prom_visibility *visibility, uint32_t node, float own_px,
                        float *px)
{
    const node_state *n = &visibility->nodes[node];
    if (!n->counted && !visibility->cell) return false;
    float come = n->counted && !n->whole ? fmaxf(own_px - GROWTH * n->own_px, 0.0f) : 0.0f;
    float share = prom_visibility_share(visibility, node);
    *px = share * (own_px - come) + fmaxf(share, prior_of(visibility, node)) * come;
    return true;
}

// Of a node most of whose footprint has been counted.
static void settle(prom_visibility *v, uint32_t node, const prom_view *view)
{
    const node_sum *sum = &v->sums[node];
    node_state *n = &v->nodes[node];
    if (!(sum->footprint_px > LEAST_PX) || sum->counted_px < 0.5f * sum->footprint_px) return;
    float own_px = prom_own_px(view, v->model, node);
    if (!(own_px > LEAST_PX)) return;
    float now = clamp_share(sum->px / own_px);
    float before = n->counted ? n->share : clamp_share(sum->expected_px / own_px);
    float sure = fminf(fmaxf(own_px, sum->px) / SURE_PX, 1.0f);
    if (now < before) {
        float most = !n->counted ? 1.0f : sum->px > 0.0f ? FALL : FALL_TO_NOTHING;
        now = before + fminf(sure, most) * (now - before);
    } else if (before > SEEN) {
        now = before + sure * (now - before);
    } else if (sure < 1.0f) {
        now = fminf(now, 1.0f);
    }
    *n = (node_state){.moved = v->moved,
                      .turned = v->turned,
                      .share = now,
                      .own_px = own_px,
                      .prior = n->prior,
                      .cell = n->cell,
                      .counted = true};
}

// The distance to what is seen, about: that of the middle between the nearest point of each
// entry and its centre, weighted by their pixels.
static float sight_of(const prom_visibility *v, const prom_visible_count *counts, size_t count)
{
    double sum = 0.0, weight = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (!(counts[i].px > 0.0f)) continue;
        const prom_cut_entry *e = &counts[i].entry;
        sum += (double)counts[i].px * (double)(e->depth + 0.5f * v->model->radius[e->node]);
        weight += (double)counts[i].px;
    }
    return weight > 0.0 ? (float)(sum / weight) : 0.0f;
}

void prom_visibility_feed(prom_visibility *visibility, const prom_camera *camera,
                          const prom_visible_count *counts, size_t count)
{
    prom_visibility *v = visibility;
    prom_view view;
    prom_view_init(&view, camera);
    begin_sums(v);
    for (size_t i = 0; i < count; i++) {
        const prom_cut_entry *e = &counts[i].entry;
        bool counted = counts[i].px >= 0.0f;
        add_upwards(v, e->node,
                    (node_sum){.px = counted ? counts[i].px : e->visible_px,
                               .footprint_px = e->footprint_px,
                               .counted_px = counted ? e->footprint_px : 0.0f,
                               .expected_px = e->visible_px});
    }
    // What is above the entries is partly outside as a rule.
    for (uint32_t i = 0; i < v->touched_count; i++) settle(v, v->touched[i], &view);
    for (size_t i = 0; i < count; i++)
        if (counts[i].px >= 0.0f) v->nodes[counts[i].entry.node].whole = counts[i].entry.whole;
    float sight = sight_of(v, counts, count);
    if (sight > 0.0f) v->sight = sight;
}

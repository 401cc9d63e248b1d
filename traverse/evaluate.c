#include "traverse/evaluate.h"

#include "benefit/accuracy.h"
#include "traverse/evaluate_private.h"
#include "traverse/footprint.h"
#include "traverse/view_private.h"

#include <assert.h>
#include <math.h>

// A node is not opened if its own best picture is wrong by less than this many pixels in all.
// By taste; 2000 such nodes, more than a walk shows, are a thousandth of a frame.
#define MOST_NEARNESS 16.0f // nearer, the distance to the centre says little
#define SMALL_LOSS_PX 0.5f
// Or if it is this small, so that it has no more than TINY_LOSS_PX to lose: what is below it
// has less than a pixel each.
#define TINY_SIZE_PX 2.0f
#define TINY_LOSS_PX 3.2f

// A node is taken as hidden if less than this shows of it, in pixels and of its footprint: it
// is covered in the cheapest way.
#define HIDDEN_PX 1.0f
#define HIDDEN_SHARE 0.01f

void prom_eval_init(prom_eval *eval, const prom_model *model)
{
    *eval = (prom_eval){.model = model, .tolerance = 1.0f};
    size_t options = 0;
    for (uint32_t n = 0; n < model->tree_count; n++) {
        options += model->prototypes[model->prototype[n]].rep_count;
        if (model->child_count[n] > eval->max_children)
            eval->max_children = model->child_count[n];
    }
    eval->nodes = prom_calloc(model->tree_count, sizeof *eval->nodes);
    eval->visited = prom_alloc(model->tree_count, sizeof *eval->visited);
    eval->options = prom_alloc(options, sizeof *eval->options);
    eval->in_view = prom_alloc(eval->max_children, sizeof *eval->in_view);
    eval->px = prom_alloc(eval->max_children, sizeof *eval->px);
}

void prom_eval_finish(prom_eval *eval)
{
    prom_free(eval->nodes);
    prom_free(eval->visited);
    prom_free(eval->options);
    prom_free(eval->in_view);
    prom_free(eval->px);
    *eval = (prom_eval){0};
}

// ---- top down: culling, appearance, pixels, options

// Whether anything is known of what shows of a node, and how many pixels.
static bool is_known(const prom_eval *eval, uint32_t node, float *px)
{
    const prom_visibility *visibility = eval->selection->visibility;
    return visibility && prom_visibility_px(visibility, node, eval->nodes[node].own_px, px);
}

static float known_px(const prom_eval *eval, uint32_t node, float footprint_px)
{
    float px;
    return is_known(eval, node, &px) ? px : footprint_px;
}

// Culls a node and notes how it appears, with the pixels that it would have by itself; returns
// the part of it that is in view, 0 when culled.
static float look_at(prom_eval *eval, uint32_t node, bool parent_inside)
{
    const prom_model *m = eval->model;
    const prom_view *view = eval->selection->view;
    prom_eval_node *n = &eval->nodes[node];
    prom_cull cull =
        parent_inside ? PROM_INSIDE : prom_view_cull(view, m->center[node], m->half[node]);
    n->culled = cull == PROM_OUTSIDE;
    n->expanded = false;
    n->option_count = 0;
    n->px = n->value_px = n->footprint_px = 0.0f;
    n->weight = 1.0f;
    n->cmin = n->cmin_benefit = 0.0;
    n->cmin_option = PROM_NONE;
    if (n->culled) return 0.0f;
    prom_appearance a;
    prom_view_appearance_culled(view, m, node, cull, &a);
    n->inside = cull == PROM_INSIDE;
    n->distance = a.distance;
    n->nearest = a.nearest;
    n->size_px = a.size_px;
    n->uv[0] = a.uv[0];
    n->uv[1] = a.uv[1];
    n->dir = (uint8_t)a.dir;
    n->near_case = a.near_case;
    float in_view;
    n->own_px = n->footprint_px = prom_footprint_in_view(view, m, node, &a, &in_view);
    if (eval->weighted)
        n->weight = prom_weight_in_view(&eval->selection->weighting, view, m, node);
    if (eval->selection->order == PROM_ORDER_SUM)
        n->value_px = known_px(eval, node, n->footprint_px) * n->weight;
    return in_view;
}

// The size that sets the accuracy. Beyond the measured sizes the projected error counts, and
// that is largest at the nearest point.
static float accuracy_size(const prom_eval *eval, uint32_t node)
{
    const prom_eval_node *n = &eval->nodes[node];
    if (n->size_px <= PROM_SIZE_MAX_PX) return n->size_px;
    const prom_view *view = eval->selection->view;
    float nearest = fmaxf(n->nearest, view->camera.z_near);
    return fmaxf(n->size_px, 2.0f * eval->model->radius[node] * view->f_px / nearest);
}

static void add_options(prom_eval *eval, uint32_t node)
{
    const prom_model *m = eval->model;
    prom_eval_node *n = &eval->nodes[node];
    const prom_prototype *p = &m->prototypes[m->prototype[node]];
    n->first_option = eval->option_count;
    n->option_count = 0;
    if (eval->selection->order == PROM_ORDER_PIXELS) n->value_px = n->px * n->weight;
    if (n->near_case && m->child_count[node]) return;
    float size = accuracy_size(eval, node), table_px = eval->selection->table_px;
    prom_accuracy_place place;
    prom_accuracy_place_init(&place, n->uv, table_px > 0.0f ? size * table_px : size);
    for (uint32_t i = 0; i < p->rep_count; i++) {
        uint32_t rep = p->first_rep + i;
        const prom_representation *r = &m->reps[rep];
        bool is_mesh = r->kind == PROM_REP_MESH;
        if (!is_mesh && n->near_case) continue;
        bool too_large = !((is_mesh ? size : n->size_px) <= r->max_size_px);
        bool any_size = (eval->any_size && eval->any_size[rep]) ||
                        (is_mesh && n->hidden && eval->any_mesh_hides);
        if (too_large && !any_size) continue;
        float accuracy = prom_accuracy(m, rep, &place, p->radius);
        float benefit = n->px * n->weight * accuracy;
        eval->options[eval->option_count++] = (prom_option){
            .rep = rep, .accuracy = accuracy, .benefit = benefit, .value = benefit};
    }
    n->option_count = eval->option_count - n->first_option;
    if (eval->heeds_priors && eval->selection->priors) prom_eval_heed_priors(eval, node);
}

// What shows of a node, or nothing where that is too little.
static void set_visible(prom_eval *eval, uint32_t node, float px)
{
    prom_eval_node *n = &eval->nodes[node];
    n->hidden =
        eval->selection->visibility && px < HIDDEN_PX && px < HIDDEN_SHARE * n->footprint_px;
    n->px = n->hidden ? 0.0f : px;
}

// A node under none with pixels of its own keeps those that look_at gave it; a cluster that
// holds the eye has none, and its children start for themselves.
static void start_flow(prom_eval *eval, uint32_t node)
{
    prom_eval_node *n = &eval->nodes[node];
    n->in_flow = !(n->near_case && eval->model->child_count[node]);
    if (!n->in_flow) n->footprint_px = 0.0f;
    set_visible(eval, node, n->in_flow ? known_px(eval, node, n->footprint_px) : 0.0f);
}

// Scales the children's weights so that their pixels (eval->px) are worth together what the
// node's are.
static void flow_weight(prom_eval *eval, uint32_t node)
{
    const prom_model *m = eval->model;
    prom_eval_node *children = &eval->nodes[m->first_child[node]];
    double px = 0.0, worth = 0.0;
    for (uint32_t c = 0; c < m->child_count[node]; c++) {
        px += (double)eval->px[c];
        worth += (double)eval->px[c] * (double)children[c].weight;
    }
    if (!(px > 0.0)) return;
    double mean = worth / px, weight = (double)eval->nodes[node].weight;
    for (uint32_t c = 0; c < m->child_count[node]; c++)
        children[c].weight =
            (float)(mean > 0.0 ? (double)children[c].weight * (weight / mean) : weight);
}

// How much larger a child shows than it would from afar, beside its siblings: shares are baked
// without perspective.
static float nearness(const prom_eval_node *parent, const prom_eval_node *child)
{
    float ratio = parent->distance / fmaxf(child->distance, 1e-6f);
    return fminf(fmaxf(ratio * ratio, 1.0f / MOST_NEARNESS), MOST_NEARNESS);
}

// Splits what is visible of a node among its children: what is known of them first, the rest by
// their footprints. (Of siblings that are known, one that is not was out of view.)
static void split_visible(prom_eval *eval, uint32_t node)
{
    uint32_t first = eval->model->first_child[node], count = eval->model->child_count[node];
    const prom_eval_node *children = &eval->nodes[first];
    double px = (double)eval->nodes[node].px, known = 0.0, unknown = 0.0;
    for (uint32_t c = 0; c < count; c++) {
        if (children[c].culled) continue;
        float *child = &eval->px[c];
        bool sure = is_known(eval, first + c, child);
        *(sure ? &known : &unknown) += (double)*child;
        eval->in_view[c] = sure ? 1.0f : 0.0f;
    }
    double rest = unknown > 0.0 ? fmax(px - known, 0.0) : 0.0;
    double known_factor = known > 0.0 ? (px - rest) / known : 0.0;
    double rest_factor = unknown > 0.0 ? rest / unknown : 0.0;
    for (uint32_t c = 0; c < count; c++)
        eval->px[c] *= (float)(eval->in_view[c] > 0.0f ? known_factor : rest_factor);
}

// Splits a node's footprint among its children by their baked shares, and what is visible of
// it.
static void flow_down(prom_eval *eval, uint32_t node)
{
    const prom_model *m = eval->model;
    const prom_eval_node *n = &eval->nodes[node];
    uint32_t first = m->first_child[node], count = m->child_count[node];
    prom_eval_node *children = &eval->nodes[first];
    for (uint32_t c = 0; c < count; c++) eval->in_view[c] *= nearness(n, &children[c]);
    prom_split_pixels(m, m->prototype[node], n->dir, n->footprint_px, eval->in_view, eval->px);
    for (uint32_t c = 0; c < count; c++) {
        if (children[c].culled) continue;
        children[c].in_flow = true;
        children[c].footprint_px = eval->px[c];
    }
    split_visible(eval, node);
    for (uint32_t c = 0; c < count; c++)
        if (!children[c].culled) set_visible(eval, first + c, eval->px[c]);
    if (eval->weighted) flow_weight(eval, node);
}

static void expand(prom_eval *eval, uint32_t node)
{
    const prom_model *m = eval->model;
    prom_eval_node *n = &eval->nodes[node];
    uint32_t first = m->first_child[node], count = m->child_count[node];
    n->expanded = true;
    for (uint32_t c = 0; c < count; c++) eval->in_view[c] = look_at(eval, first + c, n->inside);
    if (n->in_flow) flow_down(eval, node);
    for (uint32_t c = 0; c < count; c++) {
        if (eval->nodes[first + c].culled) continue;
        if (!n->in_flow) start_flow(eval, first + c);
        eval->visited[eval->visited_count++] = first + c;
    }
}

static void walk_down(prom_eval *eval, prom_eval_open *open, void *user)
{
    eval->visited_count = eval->option_count = 0;
    look_at(eval, 0, false);
    if (eval->nodes[0].culled) return;
    start_flow(eval, 0);
    eval->visited[eval->visited_count++] = 0;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        uint32_t node = eval->visited[i];
        add_options(eval, node);
        if (!eval->model->child_count[node]) continue;
        if (!eval->nodes[node].option_count || !open || open(user, node)) expand(eval, node);
    }
}

bool prom_eval_open_visible(void *user, uint32_t node)
{
    const prom_eval *eval = user;
    const prom_eval_node *n = &eval->nodes[node];
    if (n->hidden) return false;
    float best = -INFINITY;
    for (uint32_t i = 0; i < n->option_count; i++)
        best = fmaxf(best, eval->options[n->first_option + i].benefit);
    float loss = n->size_px < TINY_SIZE_PX ? TINY_LOSS_PX : SMALL_LOSS_PX;
    return n->px * n->weight - best >= loss * eval->tolerance;
}

void prom_eval_run(prom_eval *eval, const prom_selection *selection, prom_eval_open *open,
                   void *user)
{
    eval->selection = selection;
    eval->weighted = prom_weighting_is_on(&selection->weighting);
    walk_down(eval, open, user);
    prom_eval_find_costs(eval);
    prom_eval_find_values(eval);
}

// ---- cuts

double prom_eval_budget(const prom_eval *eval)
{
    return eval->selection->budget_ms * (1.0 - 1e-9);
}

void prom_eval_begin_cut(const prom_eval *eval, prom_cut *cut)
{
    cut->entries.count = 0;
    cut->predicted_ms = eval->fixed_ms;
    memset(cut->terms_ms, 0, sizeof cut->terms_ms);
    cut->terms_ms[PROM_TERM_FIXED] = eval->fixed_ms;
    cut->cmin_ms = eval->fixed_ms + eval->nodes[0].cmin;
    cut->cmin_benefit = eval->nodes[0].cmin_benefit;
    cut->benefit = cut->loss = 0.0;
    cut->bound = INFINITY;
    cut->nodes_visited = eval->visited_count;
    cut->feasible = cut->limited = false;
}

void prom_eval_emit(const prom_eval *eval, uint32_t node, uint32_t option, prom_cut *cut)
{
    const prom_eval_node *n = &eval->nodes[node];
    const prom_option *o = &eval->options[option];
    assert(option >= n->first_option && option - n->first_option < n->option_count);
    prom_array_push(&cut->entries, (prom_cut_entry){
                                       .node = node,
                                       .rep = o->rep,
                                       .fade_from = PROM_NONE,
                                       .fade = 1.0f,
                                       .depth = n->nearest,
                                       .footprint_px = n->footprint_px,
                                       .visible_px = n->px,
                                       .weight = n->weight,
                                       .accuracy = o->accuracy,
                                       .cost_ms = (float)o->cost,
                                       .whole = n->inside,
                                   });
    cut->predicted_ms += o->cost;
    prom_eval_add_terms(eval, node, o->rep, cut->terms_ms);
    cut->benefit += o->benefit;
    cut->loss += (double)(n->px * n->weight) - o->benefit;
}

void prom_eval_emit_cmin(prom_eval *eval, prom_cut *cut)
{
    // `expanded` is spent here as the mark of nodes that the cut passes through.
    const prom_model *m = eval->model;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        uint32_t node = eval->visited[i], parent = m->parent[node];
        prom_eval_node *n = &eval->nodes[node];
        bool reached = parent == PROM_NONE || eval->nodes[parent].expanded;
        if (reached && !n->culled && n->cmin_option != PROM_NONE)
            prom_eval_emit(eval, node, n->cmin_option, cut);
        n->expanded = reached && n->cmin_option == PROM_NONE && n->expanded;
    }
}

void prom_eval_end_cut(const prom_eval *eval, prom_cut *cut)
{
    cut->feasible = cut->predicted_ms <= eval->selection->budget_ms;
}

// What everything costs in a view, and the cheapest way to cover it (cmin): bottom up.
#include "traverse/evaluate_private.h"
#include "traverse/footprint.h"
#include "traverse/view_private.h"

#include <math.h>

// Sum of the pixels of all nodes that stand for themselves: more than the screen where they
// hide each other.
static double sum_px(const prom_eval *eval)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        uint32_t node = eval->visited[i];
        uint32_t parent = eval->model->parent[node];
        bool topmost = parent == PROM_NONE || !eval->nodes[parent].in_flow;
        if (topmost && eval->nodes[node].in_flow) sum += eval->nodes[node].px;
    }
    return sum;
}

// Part of the pixels that are shaded: no more than there are on the screen.
static double shaded_share(double sum, double screen)
{
    return sum > screen ? screen / sum : 1.0;
}

// The background layer is drawn whole, by its finest meshes, behind everything: where the tree
// leaves the screen free, its pixels are shaded, each once.
static double background_cost(const prom_eval *eval, double sum, double screen)
{
    const prom_model *m = eval->model;
    const prom_view *view = eval->selection->view;
    double hidden = fmin(sum, screen);
    double ms = 0.0, pixel_ms = 0.0;
    uint32_t seen = 0;
    for (uint32_t node = m->tree_count; node < m->node_count; node++) {
        const prom_prototype *p = &m->prototypes[m->prototype[node]];
        if (!p->rep_count) continue;
        const prom_representation *rep = &m->reps[p->first_rep];
        double geometry = prom_cost_of_rep(eval->selection->cost, rep, 0.0, 0.0);
        ms += geometry;
        if (prom_view_cull(view, m->center[node], m->half[node]) == PROM_OUTSIDE) continue;
        pixel_ms +=
            prom_cost_of_rep(eval->selection->cost, rep, screen - hidden, hidden) - geometry;
        seen++;
    }
    return seen ? ms + pixel_ms / seen : ms;
}

// Pixels that are shaded for each that shows, where `layers` lie behind each other in any
// order. Of opaque ones, those are shaded that are nearer than all before: of n, 1 + 1/2 + ...
// + 1/n. Where a texture decides what is there, all may be.
static double shaded_layers(const prom_representation *rep)
{
    bool opaque = rep->shading == PROM_SHADE_PLAIN || rep->shading == PROM_SHADE_TEXTURED;
    double layers = (double)rep->layers;
    return opaque ? fmin(1.0 + log(layers), layers) : layers;
}

// A node's pixels, from which follow those that its representations fill.
typedef struct node_pixels {
    double shown, footprint;
    double
        box; // of a box that stands for it, per pixel of the footprint; below 0: not yet known
} node_pixels;

static node_pixels pixels_of(const prom_eval *eval, uint32_t node)
{
    const prom_eval_node *n = &eval->nodes[node];
    double shown = eval->shaded_share * n->px;
    return (node_pixels){shown, fmax(n->footprint_px, shown), -1.0};
}

// Pixels that a representation shades, and that it draws behind others.
static void fill_of(const prom_eval *eval, uint32_t node, const prom_representation *rep,
                    node_pixels *px, double *shaded, double *hidden)
{
    double filled_layers = (double)rep->layers, shaded_part = shaded_layers(rep);
    if (rep->kind != PROM_REP_MESH && px->footprint > 0.0) { // a box is filled all over
        if (px->box < 0.0)
            px->box = prom_box_px(eval->selection->view, eval->model, node,
                                  eval->nodes[node].dir, (float)px->footprint) /
                      px->footprint;
        filled_layers *= px->box;
        shaded_part *= px->box;
    }
    *shaded = shaded_part * px->shown;
    *hidden = filled_layers * px->footprint - *shaded;
}

static void set_costs(prom_eval *eval, uint32_t node)
{
    const prom_eval_node *n = &eval->nodes[node];
    node_pixels px = pixels_of(eval, node);
    for (uint32_t i = 0; i < n->option_count; i++) {
        prom_option *o = &eval->options[n->first_option + i];
        const prom_representation *rep = &eval->model->reps[o->rep];
        double shaded, hidden;
        fill_of(eval, node, rep, &px, &shaded, &hidden);
        o->cost = prom_cost_of_rep(eval->selection->cost, rep, shaded, hidden);
    }
}

void prom_eval_add_terms(const prom_eval *eval, uint32_t node, uint32_t rep,
                         double terms[PROM_TERMS])
{
    const prom_representation *r = &eval->model->reps[rep];
    node_pixels px = pixels_of(eval, node);
    double shaded, hidden;
    fill_of(eval, node, r, &px, &shaded, &hidden);
    prom_cost_add_terms(eval->selection->cost, r, shaded, hidden, terms);
}

static void take_cheapest(prom_eval *eval, uint32_t node)
{
    prom_eval_node *n = &eval->nodes[node];
    for (uint32_t i = 0; i < n->option_count; i++) {
        const prom_option *o = &eval->options[n->first_option + i];
        bool better = n->cmin_option == PROM_NONE || o->cost < n->cmin ||
                      (o->cost == n->cmin && o->benefit > n->cmin_benefit);
        if (!better) continue;
        n->cmin = o->cost;
        n->cmin_benefit = o->benefit;
        n->cmin_option = n->first_option + i;
    }
}

// Compares with opening. A node that turns out to have nothing in the frustum is culled.
static void take_opening(prom_eval *eval, uint32_t node)
{
    prom_eval_node *n = &eval->nodes[node];
    uint32_t first = eval->model->first_child[node];
    uint32_t end = first + eval->model->child_count[node];
    double cost = 0.0, benefit = 0.0;
    bool any = false;
    for (uint32_t c = first; c < end; c++) {
        const prom_eval_node *child = &eval->nodes[c];
        if (child->culled) continue;
        any = true;
        cost += child->cmin;
        benefit += child->cmin_benefit;
    }
    if (!any) {
        n->culled = true;
        n->option_count = 0;
        n->cmin = n->cmin_benefit = 0.0;
        n->cmin_option = PROM_NONE;
    } else if (n->cmin_option == PROM_NONE || cost < n->cmin ||
               (cost == n->cmin && benefit > n->cmin_benefit)) {
        n->cmin = cost;
        n->cmin_benefit = benefit;
        n->cmin_option = PROM_NONE;
    }
}

void prom_eval_find_costs(prom_eval *eval)
{
    const prom_cost_model *cost = eval->selection->cost;
    double sum = sum_px(eval), screen = prom_view_screen_px(eval->selection->view);
    eval->shaded_share = shaded_share(sum, screen);
    eval->fixed_ms = cost->fixed_ms + background_cost(eval, sum, screen);
    for (uint32_t i = eval->visited_count; i-- > 0;) {
        uint32_t node = eval->visited[i];
        set_costs(eval, node);
        take_cheapest(eval, node);
        if (eval->nodes[node].expanded) take_opening(eval, node);
    }
}

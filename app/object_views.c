#include "app/object_views.h"

// What stands for a leaf in the true look of a cluster errs at most this, as in the builder.
#define TRUTH_ERROR_PX 0.5f

prom_status prom_object_views_init(prom_object_views *v, prom_container *container,
                                   const prom_model *model, prom_error *error)
{
    *v = (prom_object_views){.model = model};
    prom_status status = PROM_OK;
    v->context = prom_context_create_headless(error);
    if (v->context) v->renderer = prom_renderer_create(v->context, error);
    if (v->renderer) v->baker = prom_baker_create(v->renderer, error);
    if (!v->baker) status = error->status;
    if (!status) status = prom_renderer_load(v->renderer, container, model, error);
    if (status) prom_object_views_finish(v);
    return status;
}

void prom_object_views_finish(prom_object_views *v)
{
    prom_baker_destroy(v->baker);
    if (v->renderer) prom_renderer_destroy(v->renderer);
    prom_context_destroy(v->context);
    *v = (prom_object_views){0};
}

static prom_draw_item item_of(const prom_representation *rep, const double origin[3],
                              const float basis[9])
{
    prom_draw_item item = {.mesh = rep->mesh, .texture = rep->texture, .flags = rep->flags};
    for (int a = 0; a < 3; a++) item.origin[a] = (float)origin[a];
    memcpy(item.basis, basis, sizeof item.basis);
    return item;
}

static prom_draw_item item_in_prototype(const prom_model *m, uint32_t prototype, uint32_t rep)
{
    const float *center = m->prototypes[prototype].center;
    const double origin[3] = {-(double)center[0], -(double)center[1], -(double)center[2]};
    return item_of(&m->reps[rep], origin, prom_placement_identity.basis);
}

// The coarsest mesh that is as good as the object, where the view has px_per_unit.
static uint32_t true_enough(const prom_model *m, uint32_t leaf, float px_per_unit)
{
    const prom_prototype *proto = &m->prototypes[m->prototype[leaf]];
    float scale = prom_basis_scale(m->placement[leaf].basis) * px_per_unit;
    uint32_t best = proto->first_rep;
    for (uint32_t r = best; r < proto->first_rep + proto->rep_count; r++) {
        const prom_representation *rep = &m->reps[r];
        if (rep->kind == PROM_REP_MESH && !(rep->flags & PROM_REP_ARTIST) &&
            2.0f * proto->radius * scale <= rep->max_size_px &&
            rep->error * scale <= TRUTH_ERROR_PX)
            best = r;
    }
    return best;
}

typedef PROM_ARRAY(prom_draw_item) item_list;

// Clusters are not turned (builder/stage_model.c): their frames are the world's, moved.
static void collect_leaves(const prom_model *m, uint32_t node, const double center[3],
                           float px_per_unit, item_list *items)
{
    bool *below = prom_calloc(m->tree_count, sizeof *below);
    below[node] = true;
    for (uint32_t n = node + 1; n < m->tree_count; n++) {
        below[n] = below[m->parent[n]];
        if (!below[n] || m->child_count[n]) continue;
        const prom_placement *at = &m->placement[n];
        double origin[3];
        for (int a = 0; a < 3; a++) origin[a] = at->origin[a] - center[a];
        const prom_representation *rep = &m->reps[true_enough(m, n, px_per_unit)];
        prom_array_push(items, item_of(rep, origin, at->basis));
    }
    prom_free(below);
}

void prom_object_views_take_truth(prom_object_views *v, uint32_t node, bool large,
                                  prom_views *out)
{
    const prom_model *m = v->model;
    const prom_prototype *proto = &m->prototypes[m->prototype[node]];
    item_list items = {0};
    if (m->child_count[node]) {
        double center[3];
        prom_placement_apply(&m->placement[node], proto->center, center);
        float px_per_unit =
            (large ? PROM_VIEW_LARGE_PX : PROM_VIEW_PX) / (2.0f * proto->radius);
        collect_leaves(m, node, center, px_per_unit, &items);
    } else {
        prom_array_push(&items, item_in_prototype(m, m->prototype[node], proto->first_rep));
    }
    prom_baker_set_subject(v->baker, items.data, items.count);
    prom_baker_take_views(v->baker, proto->radius, large, out);
    prom_array_finish(&items);
}

void prom_object_views_take(prom_object_views *v, uint32_t prototype, uint32_t rep, bool large,
                            prom_views *out)
{
    prom_draw_item item = item_in_prototype(v->model, prototype, rep);
    prom_baker_set_subject(v->baker, &item, 1);
    prom_baker_take_views(v->baker, v->model->prototypes[prototype].radius, large, out);
}

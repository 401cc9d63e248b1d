#include "metaobj/model.h"

const char *prom_rep_kind_name(uint32_t kind)
{
    static const char *const names[PROM_REP_KIND_COUNT] = {"mesh", "average-box",
                                                           "textured-box"};
    return kind < PROM_REP_KIND_COUNT ? names[kind] : "?";
}

void prom_model_finish(prom_model *model)
{
    prom_arena_finish(&model->arena);
    *model = (prom_model){0};
}

// Rounded upwards: a parent's box must hold its children's.
static float round_up(double value)
{
    float f = (float)value;
    return (double)f < value ? nextafterf(f, INFINITY) : f;
}

static void bound_leaf(prom_model *m, uint32_t node)
{
    const prom_prototype *p = &m->prototypes[m->prototype[node]];
    const prom_placement *placement = &m->placement[node];
    prom_placement_apply(placement, p->center, m->center[node]);
    prom_basis_apply_half(placement->basis, p->half, m->half[node]);
    m->radius[node] = prom_basis_scale(placement->basis) * p->radius;
}

static void bound_inner(prom_model *m, uint32_t node)
{
    uint32_t first = m->first_child[node], end = first + m->child_count[node];
    double diagonal = 0;
    for (int a = 0; a < 3; a++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t c = first; c < end; c++) {
            low = fmin(low, m->center[c][a] - m->half[c][a]);
            high = fmax(high, m->center[c][a] + m->half[c][a]);
        }
        m->center[node][a] = (low + high) / 2;
        m->half[node][a] = round_up((high - low) / 2);
        diagonal += (double)m->half[node][a] * m->half[node][a];
    }
    // Not the tightest sphere: impostors fill the box, and it is what their views hold.
    m->radius[node] = round_up(sqrt(diagonal));
}

void prom_model_update_bounds(prom_model *model)
{
    for (uint32_t n = model->node_count; n-- > 0;) {
        if (model->child_count[n])
            bound_inner(model, n);
        else
            bound_leaf(model, n);
    }
}

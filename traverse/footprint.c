#include "traverse/footprint.h"

#include "benefit/accuracy.h"
#include "traverse/view_private.h"

#include <math.h>

// Part of a screen rectangle that the outline of a box fills; between 1/2 and 1.
#define OUTLINE_IN_RECTANGLE 0.7f
#define LEAST_PX 1e-3f

// Area of the outline of a box seen from afar along a vector of any length.
static float outline_area(const float half[3], const float along[3])
{
    float area = 0.0f, length2 = 0.0f;
    for (int k = 0; k < 3; k++) {
        area += 4.0f * half[(k + 1) % 3] * half[(k + 2) % 3] * fabsf(along[k]);
        length2 += along[k] * along[k];
    }
    return length2 > 0.0f ? area / sqrtf(length2) : 0.0f;
}

static void node_to_eye(const prom_view *view, const prom_model *model, uint32_t node,
                        float out[3])
{
    for (int k = 0; k < 3; k++) out[k] = (float)(view->camera.eye[k] - model->center[node][k]);
}

// What a node covers of an outline that holds it. The areas are those seen from afar, in one
// frame; prom_footprint_px of a length gives such an area.
static float filled_share(float covered, float outline)
{
    return covered < outline ? covered / outline : 1.0f;
}

// The footprint is that of the distance to the centre; of a wall beside the eye, or the ground
// below it, that says little. There the node covers as much of what its rectangle covers of the
// viewport as it covers of its box from afar.
float prom_footprint_in_view(const prom_view *view, const prom_model *model, uint32_t node,
                             const prom_appearance *appearance, float *in_view)
{
    const prom_appearance *a = appearance;
    uint32_t prototype = model->prototype[node];
    float screen = prom_view_screen_px(view);
    float footprint = prom_footprint_px(model, prototype, a->dir, a->size_px);
    float px = footprint * a->in_view;
    *in_view = a->in_view;
    if (a->extreme > 0.0f) {
        float to_eye[3];
        node_to_eye(view, model, node, to_eye);
        float covered = prom_footprint_px(model, prototype, a->dir, 2.0f * model->radius[node]);
        float filled = filled_share(covered, outline_area(model->half[node], to_eye));
        float seen = OUTLINE_IN_RECTANGLE * filled * a->overlap_px;
        if (seen > px) px *= powf(seen / fmaxf(px, LEAST_PX), a->extreme);
        *in_view = px < footprint ? fmaxf(*in_view, px / footprint) : 1.0f;
    }
    return fminf(px, screen);
}

float prom_own_px(const prom_view *view, const prom_model *model, uint32_t node)
{
    prom_cull cull = prom_view_cull(view, model->center[node], model->half[node]);
    if (cull == PROM_OUTSIDE) return 0.0f;
    prom_appearance a;
    float in_view;
    prom_view_appearance_culled(view, model, node, cull, &a);
    return prom_footprint_in_view(view, model, node, &a, &in_view);
}

float prom_box_px(const prom_view *view, const prom_model *model, uint32_t node, uint32_t dir,
                  float px)
{
    const prom_prototype *p = &model->prototypes[model->prototype[node]];
    float to_eye[3], local[3];
    node_to_eye(view, model, node, to_eye);
    prom_basis_apply_transposed(model->placement[node].basis, to_eye, local);
    float covered = prom_footprint_px(model, model->prototype[node], dir, 2.0f * p->radius);
    float filled = filled_share(covered, outline_area(p->half, local));
    return filled > 0.0f ? fminf(px / filled, prom_view_screen_px(view)) : px;
}

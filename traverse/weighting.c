#include "traverse/weighting.h"

#include <math.h>

#define DEGREES 57.29577951f

static bool has_motion(const prom_weighting *w)
{
    return w->use & PROM_WEIGHT_MOTION && w->before && w->dt_s > 0.0;
}

bool prom_weighting_is_on(const prom_weighting *w)
{
    return w->use & PROM_WEIGHT_FOCUS || has_motion(w) ||
           (w->use & PROM_WEIGHT_SEMANTICS && w->semantics);
}

// From the eye to a point, in the camera's axes: it looks along -z.
static void in_camera(const prom_view *view, const double point[3], float out[3])
{
    float relative[3];
    for (int k = 0; k < 3; k++) relative[k] = (float)(point[k] - view->camera.eye[k]);
    prom_basis_apply(view->axes, relative, out);
}

static float angle_between(const float a[3], const float b[3])
{
    const float cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                            a[0] * b[1] - a[1] * b[0]};
    float sine = sqrtf(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
    return DEGREES * atan2f(sine, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

// Where a node is, for its angles: the centre of its sphere, or the sphere's surface straight
// ahead if the eye is in it. Returns the angle that the sphere's radius takes.
static float place_of(const prom_view *view, const prom_model *model, uint32_t node,
                      double place[3])
{
    float to[3], radius = model->radius[node];
    for (int k = 0; k < 3; k++) {
        place[k] = model->center[node][k];
        to[k] = (float)(place[k] - view->camera.eye[k]);
    }
    float distance = sqrtf(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    if (distance > radius) return DEGREES * asinf(radius / distance);
    const float ahead[3] = {0.0f, 0.0f, -fmaxf(radius, view->camera.z_near)};
    prom_basis_apply_transposed(view->axes, ahead, to);
    for (int k = 0; k < 3; k++) place[k] = view->camera.eye[k] + (double)to[k];
    return 0.0f;
}

float prom_weight_in_view(const prom_weighting *w, const prom_view *view,
                          const prom_model *model, uint32_t node)
{
    bool said = w->use & PROM_WEIGHT_SEMANTICS && w->semantics, moves = has_motion(w);
    float weight = said ? w->semantics[node] : 1.0f;
    if (!(w->use & PROM_WEIGHT_FOCUS) && !moves) return weight;
    double place[3];
    float radius_deg = place_of(view, model, node, place), now[3];
    in_camera(view, place, now);
    if (w->use & PROM_WEIGHT_FOCUS) {
        const float sight[3] = {0.0f, 0.0f, -1.0f};
        weight *= prom_weight_focus(fmaxf(angle_between(sight, now) - radius_deg, 0.0f));
    }
    if (moves) {
        float then[3];
        in_camera(w->before, place, then);
        weight *= prom_weight_motion(angle_between(then, now) / (float)w->dt_s);
    }
    return weight;
}

// What a panorama says of each leaf.
#include "builder/panorama.h"

#include "benefit/accuracy.h"
#include "traverse/view.h"

#include <math.h>

// Leaves of fewer pixels fall between them (by taste, as those of about a pixel's width).
#define LEAST_PX 2.0

float *prom_panorama_angles(uint32_t size_px)
{
    float *angles = prom_alloc((size_t)size_px * size_px, sizeof *angles);
    double step = 2.0 / size_px;
    for (uint32_t y = 0; y < size_px; y++)
        for (uint32_t x = 0; x < size_px; x++) {
            double u = (x + 0.5) * step - 1, v = (y + 0.5) * step - 1;
            // A square seen askance, from sqrt(1 + u^2 + v^2).
            angles[(size_t)y * size_px + x] =
                (float)(step * step / pow(1 + u * u + v * v, 1.5));
        }
    return angles;
}

// Adds the pixels of a face that are not the same in `known` (NULL: all).
static void count_face(const uint32_t *ids, const uint32_t *known, const float *angles,
                       size_t pixels, uint32_t tree_count, double *solid)
{
    for (size_t i = 0; i < pixels;) {
        uint32_t id = ids[i];
        double sum = 0;
        for (; i < pixels && ids[i] == id; i++)
            if (!known || known[i] != id) sum += (double)angles[i];
        if (id < tree_count) solid[id] += sum;
    }
}

static void count(const prom_panorama *p, const float *angles, uint32_t tree_count,
                  double *solid)
{
    size_t pixels = (size_t)p->size_px * p->size_px;
    for (int f = 0; f < PROM_PANORAMA_FACES; f++) {
        const uint32_t *opaque = p->opaque + (size_t)f * pixels;
        const uint32_t *blended = p->blended + (size_t)f * pixels;
        count_face(opaque, NULL, angles, pixels, tree_count, solid);
        if (p->has_blended[f]) count_face(blended, opaque, angles, pixels, tree_count, solid);
    }
}

// A leaf's own outline, from the eye; *near: the eye is about inside of it.
static double footprint_of(const prom_model *model, uint32_t node, const prom_view *view,
                           bool *near)
{
    prom_appearance a;
    prom_view_appearance(view, model, node, &a);
    *near = a.distance <= model->radius[node];
    return fmin(
        (double)prom_footprint_px(model, model->prototype[node], a.dir, a.size_px / view->f_px),
        4 * M_PI);
}

static float share_of(double solid, double footprint)
{
    return solid < footprint ? (float)(solid / footprint) : solid > 0 ? 1.0f : 0.0f;
}

// Children stand behind their parents.
static void add_to_parents(const prom_model *model, double *value)
{
    for (uint32_t n = model->tree_count; n-- > 1;) value[model->parent[n]] += value[n];
}

void prom_panorama_shares(const prom_panorama *panorama, const prom_model *model,
                          const float *angles, double *solid, double *footprint, float *shares)
{
    const double *eye = panorama->eye;
    prom_view view;
    prom_view_init(&view, &(prom_camera){.eye = {eye[0], eye[1], eye[2]},
                                         .orientation = {0, 0, 0, 1},
                                         .fov_y = (float)(M_PI / 2),
                                         .z_near = 1e-6f * model->radius[0],
                                         .width = panorama->size_px,
                                         .height = panorama->size_px});
    memset(solid, 0, model->tree_count * sizeof *solid);
    memset(footprint, 0, model->tree_count * sizeof *footprint);
    count(panorama, angles, model->tree_count, solid);
    for (uint32_t n = 0; n < model->tree_count; n++) {
        bool near;
        if (model->child_count[n]) continue;
        footprint[n] = footprint_of(model, n, &view, &near);
        if (near && solid[n] > 0) solid[n] = footprint[n] = fmax(solid[n], footprint[n]);
    }
    add_to_parents(model, solid);
    add_to_parents(model, footprint);
    const double least = LEAST_PX * 4 / ((double)panorama->size_px * panorama->size_px);
    for (uint32_t n = 0; n < model->tree_count; n++) {
        shares[n] = share_of(solid[n], footprint[n]);
        if (n && footprint[n] < least) shares[n] = fmaxf(shares[n], shares[model->parent[n]]);
    }
}

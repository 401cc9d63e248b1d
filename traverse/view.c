#include "traverse/view.h"

#include "traverse/view_private.h"

#include <assert.h>
#include <math.h>

// Rounding of positions relative to the eye, as a part of their length: a plane test closer
// than this is undecided, and undecided counts as visible.
#define CULL_SLACK 1e-5f
// No visible node counts for less of itself than this.
#define IN_VIEW_MIN 1e-3f
// A corner with less depth than this part of the distance: its place in the picture runs away.
#define EXTREME_DEPTH 0.25f
#define EXTREME_FADE 0.2f // sizes must not jump as the eye passes

static void rotation_of(const float q[4], float r[9])
{
    const float x = q[0], y = q[1], z = q[2], w = q[3];
    // Row-major world from camera, which is column-major camera from world.
    r[0] = 1 - 2 * (y * y + z * z), r[1] = 2 * (x * y - z * w), r[2] = 2 * (x * z + y * w);
    r[3] = 2 * (x * y + z * w), r[4] = 1 - 2 * (x * x + z * z), r[5] = 2 * (y * z - x * w);
    r[6] = 2 * (x * z - y * w), r[7] = 2 * (y * z + x * w), r[8] = 1 - 2 * (x * x + y * y);
}

// The plane through the eye, or `distance` in front of it, with the given normal in camera
// space.
static void set_plane(prom_view *view, int i, float x, float y, float z, float offset)
{
    const float normal[3] = {x, y, z};
    float length = sqrtf(x * x + y * y + z * z), world[3];
    prom_basis_apply_transposed(view->axes, normal, world);
    for (int k = 0; k < 3; k++) view->planes[i][k] = world[k] / length;
    view->planes[i][3] = offset;
}

void prom_view_init(prom_view *view, const prom_camera *camera)
{
    assert(camera->width > 0 && camera->height > 0 && camera->fov_y > 0.0f);
    view->camera = *camera;
    rotation_of(camera->orientation, view->axes);
    view->f_px = (float)camera->height / (2.0f * tanf(0.5f * camera->fov_y));
    float half_w = 0.5f * (float)camera->width / view->f_px;
    float half_h = 0.5f * (float)camera->height / view->f_px;
    set_plane(view, 0, 0, 0, -1, -camera->z_near);
    set_plane(view, 1, 1, 0, -half_w, 0);
    set_plane(view, 2, -1, 0, -half_w, 0);
    set_plane(view, 3, 0, 1, -half_h, 0);
    set_plane(view, 4, 0, -1, -half_h, 0);
}

float prom_view_screen_px(const prom_view *view)
{
    return (float)view->camera.width * (float)view->camera.height;
}

static void relative_to_eye(const prom_view *view, const double center[3], float out[3])
{
    for (int k = 0; k < 3; k++) out[k] = (float)(center[k] - view->camera.eye[k]);
}

prom_cull prom_view_cull(const prom_view *view, const double center[3], const float half[3])
{
    float c[3];
    relative_to_eye(view, center, c);
    float slack =
        CULL_SLACK * (fabsf(c[0]) + fabsf(c[1]) + fabsf(c[2]) + half[0] + half[1] + half[2]);
    prom_cull result = PROM_INSIDE;
    for (int i = 0; i < 5; i++) {
        const float *p = view->planes[i];
        float distance = p[0] * c[0] + p[1] * c[1] + p[2] * c[2] + p[3];
        float reach = fabsf(p[0]) * half[0] + fabsf(p[1]) * half[1] + fabsf(p[2]) * half[2];
        if (distance + reach < -slack) return PROM_OUTSIDE;
        if (distance - reach < slack) result = PROM_CROSSING;
    }
    return result;
}

// ---- the part of a box's screen rectangle that is inside the viewport

typedef struct rectangle {
    float min[2], max[2]; // in units of half the viewport: it spans -1 to 1
} rectangle;

static void add_point(rectangle *r, const float p[3], float half_w, float half_h)
{
    const float at[2] = {p[0] / (-p[2] * half_w), p[1] / (-p[2] * half_h)};
    for (int k = 0; k < 2; k++) {
        r->min[k] = fminf(r->min[k], at[k]);
        r->max[k] = fmaxf(r->max[k], at[k]);
    }
}

// Adds the part of the edge from a to b that lies in front of the near plane.
static void add_edge(rectangle *r, const float a[3], const float b[3], float near, float half_w,
                     float half_h)
{
    bool a_front = -a[2] >= near, b_front = -b[2] >= near;
    if (a_front) add_point(r, a, half_w, half_h);
    if (b_front) add_point(r, b, half_w, half_h);
    if (a_front == b_front) return;
    float t = (-near - a[2]) / (b[2] - a[2]);
    const float p[3] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), -near};
    add_point(r, p, half_w, half_h);
}

// The eight corners in camera space: bit k of the index says which side along axis k.
static void box_corners(const prom_view *view, const float center[3], const float half[3],
                        float corners[8][3])
{
    float c[3];
    prom_basis_apply(view->axes, center, c);
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) {
            corners[i][k] = c[k];
            for (int a = 0; a < 3; a++)
                corners[i][k] += (i >> a & 1 ? half[a] : -half[a]) * view->axes[3 * a + k];
        }
    }
}

// 1 where `near` is at most this part of the distance, 0 from a little more on.
static float extremity(float near, float distance, float part)
{
    if (!(distance > 0.0f)) return 1.0f;
    return fminf(fmaxf((part - near / distance) / EXTREME_FADE + 1.0f, 0.0f), 1.0f);
}

static void look_at_rectangle(const prom_view *view, const float center[3], const float half[3],
                              prom_appearance *appearance)
{
    float half_w = 0.5f * (float)view->camera.width / view->f_px;
    float half_h = 0.5f * (float)view->camera.height / view->f_px;
    float corners[8][3];
    box_corners(view, center, half, corners);
    float depth = INFINITY;
    for (int i = 0; i < 8; i++) depth = fminf(depth, -corners[i][2]);
    appearance->extreme =
        fmaxf(appearance->extreme, extremity(depth, appearance->distance, EXTREME_DEPTH));
    rectangle r = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (int i = 0; i < 8; i++)
        for (int axis = 0; axis < 3; axis++)
            if (!(i >> axis & 1))
                add_edge(&r, corners[i], corners[i | 1 << axis], view->camera.z_near, half_w,
                         half_h);
    float share = 1.0f, area = 1.0f;
    for (int k = 0; k < 2; k++) {
        float extent = r.max[k] - r.min[k];
        float overlap = fminf(r.max[k], 1.0f) - fmaxf(r.min[k], -1.0f);
        if (!(overlap > 0.0f)) overlap = 0.0f;
        if (extent > 1e-9f) share *= overlap / extent;
        area *= 0.5f * overlap;
    }
    appearance->in_view = share > IN_VIEW_MIN ? fminf(share, 1.0f) : IN_VIEW_MIN;
    appearance->overlap_px = area * prom_view_screen_px(view);
}

// ---- appearance

// Distance from the eye to the corners of the near rectangle: a box farther than this cannot
// touch it.
static float near_reach(const prom_view *view)
{
    float w = 0.5f * (float)view->camera.width / view->f_px;
    float h = 0.5f * (float)view->camera.height / view->f_px;
    return view->camera.z_near * sqrtf(1.0f + w * w + h * h);
}

static void place_direction(const prom_model *model, uint32_t node, const float center[3],
                            prom_appearance *appearance)
{
    const float to_eye[3] = {-center[0], -center[1], -center[2]};
    float local[3];
    prom_basis_apply_transposed(model->placement[node].basis, to_eye, local);
    if (!(fabsf(local[0]) + fabsf(local[1]) + fabsf(local[2]) > 0.0f)) local[1] = 1.0f;
    prom_octahedral_encode(local, appearance->uv);
    appearance->dir = prom_bin_of_place(appearance->uv);
}

void prom_view_appearance_culled(const prom_view *view, const prom_model *model, uint32_t node,
                                 prom_cull cull, prom_appearance *appearance)
{
    const float *half = model->half[node];
    float center[3], outside2 = 0.0f, distance2 = 0.0f;
    relative_to_eye(view, model->center[node], center);
    for (int k = 0; k < 3; k++) {
        float d = fmaxf(fabsf(center[k]) - half[k], 0.0f);
        outside2 += d * d;
        distance2 += center[k] * center[k];
    }
    appearance->distance = sqrtf(distance2);
    appearance->nearest = sqrtf(outside2);
    appearance->near_case = appearance->nearest <= near_reach(view);
    appearance->size_px = 2.0f * model->radius[node] * view->f_px /
                          fmaxf(appearance->distance, view->camera.z_near);
    place_direction(model, node, center, appearance);
    appearance->in_view = 1.0f;
    appearance->overlap_px = prom_view_screen_px(view);
    appearance->extreme =
        extremity(appearance->nearest, appearance->distance, PROM_EXTREME_NEAREST);
    if (cull != PROM_INSIDE || appearance->extreme > 0.0f)
        look_at_rectangle(view, center, half, appearance);
}

void prom_view_appearance(const prom_view *view, const prom_model *model, uint32_t node,
                          prom_appearance *appearance)
{
    prom_view_appearance_culled(view, model, node, PROM_CROSSING, appearance);
}

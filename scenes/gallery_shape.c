#include "scenes/gallery_parts.h"

#include <cglm/cglm.h>
#include <math.h>
#include <stdlib.h>

#define PI 3.14159265f

// Towards the light of every scene (render/shaders/lighting.glsl).
static const float to_light[3] = {0.4243f, 0.7576f, 0.4960f};

int prom_gallery_steps(const prom_gallery *g, int most)
{
    // A step of detail has about five times the triangles of the one before.
    static const int percent[PROM_GALLERY_DETAIL_MAX] = {7, 20, 45, 100};
    int n = most * percent[g->options.detail - 1] / 100;
    return n > 2 ? n : 2;
}

int prom_gallery_sides(const prom_gallery *g, int most)
{
    int n = prom_gallery_steps(g, most);
    return n < 6 ? 6 : n < 8 ? n : n / 4 * 4;
}

// ---- surfaces

typedef struct sheet {
    int nu, nv;
    float (*points)[3], (*normals)[3];
} sheet;

static size_t at(const sheet *t, int i, int j)
{
    return (size_t)j * (size_t)(t->nu + 1) + (size_t)i;
}

static void add_to(float sum[3], const float v[3])
{
    for (int k = 0; k < 3; k++) sum[k] += v[k];
}

static bool add_face(sheet *t, size_t a, size_t b, size_t c)
{
    vec3 ab, ac, n;
    glm_vec3_sub(t->points[b], t->points[a], ab);
    glm_vec3_sub(t->points[c], t->points[a], ac);
    glm_vec3_cross(ab, ac, n);
    add_to(t->normals[a], n);
    add_to(t->normals[b], n);
    add_to(t->normals[c], n);
    return glm_vec3_norm(n) > 1e-10f;
}

// Sums normals across a closed seam.
static void join(sheet *t, size_t a, size_t b)
{
    add_to(t->normals[a], t->normals[b]);
    glm_vec3_copy(t->normals[a], t->normals[b]);
}

// A row of points in one place shares its normal.
static void join_pole(sheet *t, int j)
{
    float *first = t->points[at(t, 0, j)];
    vec3 sum = {0};
    for (int i = 0; i <= t->nu; i++) {
        if (glm_vec3_distance2(first, t->points[at(t, i, j)]) > 1e-12f) return;
        add_to(sum, t->normals[at(t, i, j)]);
    }
    for (int i = 0; i <= t->nu; i++) glm_vec3_copy(sum, t->normals[at(t, i, j)]);
}

static void find_normals(sheet *t, int flags)
{
    for (int j = 0; j < t->nv; j++) {
        for (int i = 0; i < t->nu; i++) {
            add_face(t, at(t, i, j), at(t, i + 1, j), at(t, i + 1, j + 1));
            add_face(t, at(t, i, j), at(t, i + 1, j + 1), at(t, i, j + 1));
        }
    }
    for (int j = 0; flags & PROM_GALLERY_CLOSED_U && j <= t->nv; j++)
        join(t, at(t, 0, j), at(t, t->nu, j));
    for (int i = 0; flags & PROM_GALLERY_CLOSED_V && i <= t->nu; i++)
        join(t, at(t, i, 0), at(t, i, t->nv));
    join_pole(t, 0);
    join_pole(t, t->nv);
    size_t n = (size_t)(t->nu + 1) * (size_t)(t->nv + 1);
    for (size_t i = 0; i < n; i++) {
        if (glm_vec3_norm(t->normals[i]) > 1e-12f)
            glm_vec3_normalize(t->normals[i]);
        else
            glm_vec3_copy((vec3){0, 1, 0}, t->normals[i]);
        if (flags & PROM_GALLERY_LIT) glm_vec3_copy((float *)to_light, t->normals[i]);
    }
}

static void emit(prom_solid *s, const sheet *t, uint32_t first, size_t a, size_t b, size_t c)
{
    vec3 ab, ac, n;
    glm_vec3_sub(t->points[b], t->points[a], ab);
    glm_vec3_sub(t->points[c], t->points[a], ac);
    glm_vec3_cross(ab, ac, n);
    if (glm_vec3_norm(n) < 1e-9f) return;
    prom_solid_triangle(s, first + (uint32_t)a, first + (uint32_t)b, first + (uint32_t)c);
}

void prom_gallery_surface(prom_solid *s, prom_gallery_point point, const void *context, int nu,
                          int nv, float repeat_u, float repeat_v, int flags)
{
    size_t n = (size_t)(nu + 1) * (size_t)(nv + 1);
    sheet t = {nu, nv, prom_calloc(n, sizeof *t.points), prom_calloc(n, sizeof *t.normals)};
    for (int j = 0; j <= nv; j++)
        for (int i = 0; i <= nu; i++) {
            int iu = flags & PROM_GALLERY_CLOSED_U ? i % nu : i;
            int iv = flags & PROM_GALLERY_CLOSED_V ? j % nv : j;
            point(context, (float)iu / (float)nu, (float)iv / (float)nv,
                  t.points[at(&t, i, j)]);
        }
    find_normals(&t, flags);
    uint32_t first = 0;
    for (int j = 0; j <= nv; j++)
        for (int i = 0; i <= nu; i++) {
            size_t k = at(&t, i, j);
            uint32_t id =
                prom_solid_vertex(s, t.points[k], t.normals[k], repeat_u * (float)i / (float)nu,
                                  repeat_v * (1 - (float)j / (float)nv));
            if (!k) first = id;
        }
    for (int j = 0; j < nv; j++)
        for (int i = 0; i < nu; i++) {
            emit(s, &t, first, at(&t, i, j), at(&t, i + 1, j), at(&t, i + 1, j + 1));
            emit(s, &t, first, at(&t, i, j), at(&t, i + 1, j + 1), at(&t, i, j + 1));
        }
    prom_free(t.points);
    prom_free(t.normals);
}

static void ball_point(const void *context, float u, float v, float p[3])
{
    const float *b = context;
    float a = 2 * PI * u, e = PI * (v - 0.5f), r = v <= 0 || v >= 1 ? 0 : cosf(e);
    p[0] = b[0] + b[3] * r * cosf(a);
    p[1] = b[1] + b[4] * sinf(e);
    p[2] = b[2] - b[5] * r * sinf(a);
}

void prom_gallery_ball(prom_solid *s, float x, float y, float z, float rx, float ry, float rz,
                       int sides, int flags)
{
    const float ball[6] = {x, y, z, rx, ry, rz};
    int rings = sides / 2 > 3 ? sides / 2 : 3;
    prom_gallery_surface(s, ball_point, ball, sides, rings, 2, 1,
                         flags | PROM_GALLERY_CLOSED_U);
}

// ---- walls with holes

#define CUTS_MAX 128

static int compare(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static int add_cut(float *cuts, int count, float value, float low, float high)
{
    if (value > low && value < high && count < CUTS_MAX) cuts[count++] = value;
    return count;
}

static int sort_cuts(float *cuts, int count)
{
    int n = 0;
    qsort(cuts, (size_t)count, sizeof *cuts, compare);
    for (int i = 0; i < count; i++)
        if (!n || cuts[i] > cuts[n - 1] + 1e-4f) cuts[n++] = cuts[i];
    return n;
}

typedef struct cuts {
    float u[CUTS_MAX], v[CUTS_MAX];
    int nu, nv;
} cuts;

static void find_cuts(cuts *c, const float box[4], const prom_gallery_hole *holes,
                      int hole_count, const float *bands, int band_count)
{
    *c = (cuts){.u = {box[0], box[2]}, .v = {box[1], box[3]}, .nu = 2, .nv = 2};
    for (int i = 0; i < hole_count; i++) {
        c->nu = add_cut(c->u, c->nu, holes[i].u0, box[0], box[2]);
        c->nu = add_cut(c->u, c->nu, holes[i].u1, box[0], box[2]);
        c->nv = add_cut(c->v, c->nv, holes[i].v0, box[1], box[3]);
        c->nv = add_cut(c->v, c->nv, holes[i].v1, box[1], box[3]);
    }
    for (int i = 0; i < band_count; i++) c->nv = add_cut(c->v, c->nv, bands[i], box[1], box[3]);
    c->nu = sort_cuts(c->u, c->nu);
    c->nv = sort_cuts(c->v, c->nv);
}

static bool in_hole(const prom_gallery_hole *holes, int count, float u, float v)
{
    for (int i = 0; i < count; i++)
        if (u > holes[i].u0 && u < holes[i].u1 && v > holes[i].v0 && v < holes[i].v1)
            return true;
    return false;
}

void prom_gallery_wall(prom_solid *s, float length, float y0, float y1,
                       const prom_gallery_hole *holes, int hole_count, const float *bands,
                       int band_count, const prom_paint *paints)
{
    cuts c;
    find_cuts(&c, (float[]){0, y0, length, y1}, holes, hole_count, bands, band_count);
    for (int j = 0; j + 1 < c.nv; j++) {
        float v = 0.5f * (c.v[j] + c.v[j + 1]);
        int band = 0;
        while (band < band_count && v > bands[band]) band++;
        prom_solid_use(s, paints[band]);
        for (int i = 0; i + 1 < c.nu; i++) {
            if (in_hole(holes, hole_count, 0.5f * (c.u[i] + c.u[i + 1]), v)) continue;
            prom_solid_quad(s, (float[]){c.u[i], c.v[j], 0}, (float[]){c.u[i + 1], c.v[j], 0},
                            (float[]){c.u[i + 1], c.v[j + 1], 0},
                            (float[]){c.u[i], c.v[j + 1], 0});
        }
    }
}

void prom_gallery_slab(prom_solid *s, float x0, float z0, float x1, float z1, float y,
                       const prom_gallery_hole *holes, int hole_count, bool up)
{
    cuts c;
    find_cuts(&c, (float[]){x0, z0, x1, z1}, holes, hole_count, NULL, 0);
    for (int j = 0; j + 1 < c.nv; j++)
        for (int i = 0; i + 1 < c.nu; i++) {
            if (in_hole(holes, hole_count, 0.5f * (c.u[i] + c.u[i + 1]),
                        0.5f * (c.v[j] + c.v[j + 1])))
                continue;
            float near = up ? c.v[j + 1] : c.v[j], far = up ? c.v[j] : c.v[j + 1];
            prom_solid_quad(s, (float[]){c.u[i], y, near}, (float[]){c.u[i + 1], y, near},
                            (float[]){c.u[i + 1], y, far}, (float[]){c.u[i], y, far});
        }
}

void prom_gallery_add(prom_gallery *g, uint32_t parent, const char *name, prom_solid *s)
{
    if (prom_solid_triangles(s)) {
        uint32_t mesh = prom_solid_write(s, g->glb, name);
        prom_glb_add_node(
            g->glb, &(prom_glb_node){.name = name, .parent = parent, .mesh = mesh, .scale = 1});
    }
    prom_solid_finish(s);
}

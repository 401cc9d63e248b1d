#include "scenes/solid.h"

#include <assert.h>
#include <cglm/cglm.h>
#include <math.h>

#define PI 3.14159265f

void prom_solid_init(prom_solid *shape)
{
    *shape = (prom_solid){.repeat = 1, .frame = {.c = 1}};
}

void prom_solid_finish(prom_solid *shape)
{
    for (size_t i = 0; i < shape->parts.count; i++) {
        prom_array_finish(&shape->parts.data[i].vertices);
        prom_array_finish(&shape->parts.data[i].indices);
    }
    prom_array_finish(&shape->parts);
}

uint32_t prom_solid_triangles(const prom_solid *shape)
{
    size_t n = 0;
    for (size_t i = 0; i < shape->parts.count; i++) n += shape->parts.data[i].indices.count / 3;
    return (uint32_t)n;
}

uint32_t prom_solid_write(const prom_solid *shape, prom_glb *glb, const char *name)
{
    prom_glb_part *parts = prom_calloc(shape->parts.count, sizeof *parts);
    size_t n = 0;
    for (size_t i = 0; i < shape->parts.count; i++) {
        const prom_solid_part *p = &shape->parts.data[i];
        if (!p->indices.count) continue;
        parts[n++] = (prom_glb_part){.material = p->material,
                                     .vertices = p->vertices.data,
                                     .indices = p->indices.data,
                                     .vertex_count = (uint32_t)p->vertices.count,
                                     .index_count = (uint32_t)p->indices.count};
    }
    uint32_t mesh = prom_glb_add_mesh(glb, name, parts, n);
    prom_free(parts);
    return mesh;
}

void prom_solid_use(prom_solid *shape, prom_paint paint)
{
    shape->repeat = paint.repeat;
    for (shape->part = 0; shape->part < shape->parts.count; shape->part++)
        if (shape->parts.data[shape->part].material == paint.material) return;
    prom_array_push(&shape->parts, (prom_solid_part){.material = paint.material});
}

prom_solid_frame prom_solid_enter(prom_solid *shape, float x, float y, float z, float yaw)
{
    prom_solid_frame old = shape->frame;
    float c = cosf(yaw), s = sinf(yaw);
    shape->frame = (prom_solid_frame){
        .origin = {old.origin[0] + old.c * x + old.s * z, old.origin[1] + y,
                   old.origin[2] - old.s * x + old.c * z},
        .c = old.c * c - old.s * s,
        .s = old.s * c + old.c * s,
    };
    return old;
}

void prom_solid_leave(prom_solid *shape, prom_solid_frame frame)
{
    shape->frame = frame;
}

uint32_t prom_solid_vertex(prom_solid *shape, const float p[3], const float n[3], float u,
                           float v)
{
    assert(shape->parts.count);
    prom_solid_part *part = &shape->parts.data[shape->part];
    const prom_solid_frame *f = &shape->frame;
    prom_glb_vertex vertex = {
        .position = {f->origin[0] + f->c * p[0] + f->s * p[2], f->origin[1] + p[1],
                     f->origin[2] - f->s * p[0] + f->c * p[2]},
        .normal = {f->c * n[0] + f->s * n[2], n[1], -f->s * n[0] + f->c * n[2]},
        .uv = {u, v},
    };
    prom_array_push(&part->vertices, vertex);
    return (uint32_t)part->vertices.count - 1;
}

void prom_solid_triangle(prom_solid *shape, uint32_t a, uint32_t b, uint32_t c)
{
    prom_solid_part *part = &shape->parts.data[shape->part];
    prom_array_push(&part->indices, a);
    prom_array_push(&part->indices, b);
    prom_array_push(&part->indices, c);
}

// Normal and the in-plane axes of a face: u along its first edge, v down.
static void face_axes(const float a[3], const float b[3], const float c[3], vec3 n, vec3 u,
                      vec3 v)
{
    vec3 ab, ac;
    glm_vec3_sub((float *)b, (float *)a, ab);
    glm_vec3_sub((float *)c, (float *)a, ac);
    glm_vec3_cross(ab, ac, n);
    glm_vec3_normalize(n);
    glm_vec3_normalize_to(ab, u);
    glm_vec3_cross(u, n, v);
}

static void face(prom_solid *shape, const float *const corners[], int count)
{
    vec3 n, u, v;
    uint32_t first = 0;
    face_axes(corners[0], corners[1], corners[2], n, u, v);
    for (int i = 0; i < count; i++) {
        float *p = (float *)corners[i];
        uint32_t id = prom_solid_vertex(shape, p, n, glm_vec3_dot(p, u) / shape->repeat,
                                        glm_vec3_dot(p, v) / shape->repeat);
        if (!i) first = id;
    }
    for (uint32_t i = 2; i < (uint32_t)count; i++)
        prom_solid_triangle(shape, first, first + i - 1, first + i);
}

void prom_solid_quad(prom_solid *shape, const float a[3], const float b[3], const float c[3],
                     const float d[3])
{
    face(shape, (const float *const[]){a, b, c, d}, 4);
}

void prom_solid_flat_triangle(prom_solid *shape, const float a[3], const float b[3],
                              const float c[3])
{
    face(shape, (const float *const[]){a, b, c}, 3);
}

void prom_solid_picture_part(prom_solid *shape, const float a[3], const float b[3],
                             const float c[3], const float d[3], const float uv[4])
{
    vec3 n, u, v;
    face_axes(a, b, c, n, u, v);
    uint32_t i = prom_solid_vertex(shape, a, n, uv[0], uv[3]);
    prom_solid_vertex(shape, b, n, uv[2], uv[3]);
    prom_solid_vertex(shape, c, n, uv[2], uv[1]);
    prom_solid_vertex(shape, d, n, uv[0], uv[1]);
    prom_solid_triangle(shape, i, i + 1, i + 2);
    prom_solid_triangle(shape, i, i + 2, i + 3);
}

void prom_solid_picture(prom_solid *shape, const float a[3], const float b[3], const float c[3],
                        const float d[3])
{
    prom_solid_picture_part(shape, a, b, c, d, (const float[4]){0, 0, 1, 1});
}

static void flat_outline(prom_solid *shape, const float (*outline)[2], int points, float z,
                         bool front)
{
    const float n[3] = {0, 0, front ? 1.0f : -1.0f};
    uint32_t first = 0;
    for (int i = 0; i < points; i++) {
        float x = outline[i][0], y = outline[i][1];
        uint32_t id = prom_solid_vertex(shape, (float[]){x, y, z}, n, x / shape->repeat,
                                        -y / shape->repeat);
        if (!i) first = id;
    }
    for (uint32_t i = 2; i < (uint32_t)points; i++)
        prom_solid_triangle(shape, first, first + (front ? i - 1 : i),
                            first + (front ? i : i - 1));
}

void prom_solid_extrude(prom_solid *shape, const float (*outline)[2], int points, float z0,
                        float z1, int faces)
{
    if (faces & PROM_FACE_FRONT) flat_outline(shape, outline, points, z1, true);
    if (faces & PROM_FACE_BACK) flat_outline(shape, outline, points, z0, false);
    for (int i = 0; i < points && faces & ~(PROM_FACE_FRONT | PROM_FACE_BACK); i++) {
        const float *a = outline[i], *b = outline[(i + 1) % points];
        prom_solid_quad(shape, (float[]){a[0], a[1], z1}, (float[]){a[0], a[1], z0},
                        (float[]){b[0], b[1], z0}, (float[]){b[0], b[1], z1});
    }
}

void prom_solid_box(prom_solid *shape, float x0, float y0, float z0, float x1, float y1,
                    float z1, int faces)
{
    // Corner i: bit 0 x, bit 1 y, bit 2 z.
    float p[8][3];
    for (int i = 0; i < 8; i++) {
        p[i][0] = i & 1 ? x1 : x0;
        p[i][1] = i & 2 ? y1 : y0;
        p[i][2] = i & 4 ? z1 : z0;
    }
    static const int corners[6][4] = {{5, 1, 3, 7}, {0, 4, 6, 2}, {6, 7, 3, 2},
                                      {0, 1, 5, 4}, {4, 5, 7, 6}, {1, 0, 2, 3}};
    for (int f = 0; f < 6; f++)
        if (faces >> f & 1)
            prom_solid_quad(shape, p[corners[f][0]], p[corners[f][1]], p[corners[f][2]],
                            p[corners[f][3]]);
}

void prom_solid_moulding(prom_solid *shape, const float (*profile)[2], int points, float x0,
                         float x1)
{
    for (int i = 0; i + 1 < points; i++) {
        const float *a = profile[i], *b = profile[i + 1];
        prom_solid_quad(shape, (float[]){x0, a[0], a[1]}, (float[]){x1, a[0], a[1]},
                        (float[]){x1, b[0], b[1]}, (float[]){x0, b[0], b[1]});
    }
    for (int i = 1; i + 1 < points; i++) {
        const float *a = profile[0], *b = profile[i], *c = profile[i + 1];
        prom_solid_flat_triangle(shape, (float[]){x1, a[0], a[1]}, (float[]){x1, c[0], c[1]},
                                 (float[]){x1, b[0], b[1]});
        prom_solid_flat_triangle(shape, (float[]){x0, a[0], a[1]}, (float[]){x0, b[0], b[1]},
                                 (float[]){x0, c[0], c[1]});
    }
}

// One ring of a lathe at a profile point with the normal (outward, up).
static uint32_t lathe_ring(prom_solid *shape, const float point[2], const float normal[2],
                           int sides, float v)
{
    uint32_t first = 0;
    float around = fmaxf(1.0f, roundf(2 * PI * point[0] / shape->repeat));
    for (int i = 0; i <= sides; i++) {
        float angle = 2 * PI * (float)(i % sides) / (float)sides, c = cosf(angle),
              s = sinf(angle);
        uint32_t id = prom_solid_vertex(shape, (float[]){c * point[0], point[1], -s * point[0]},
                                        (float[]){c * normal[0], normal[1], -s * normal[0]},
                                        around * (float)i / (float)sides, v);
        if (!i) first = id;
    }
    return first;
}

// The normal of a profile segment, pointing away from the axis when the profile goes up.
static void segment_normal(const float a[2], const float b[2], float normal[2])
{
    float dr = b[0] - a[0], dy = b[1] - a[1], length = hypotf(dr, dy);
    normal[0] = dy / length;
    normal[1] = -dr / length;
}

static void point_normal(const float (*profile)[2], int points, int i, float normal[2])
{
    float before[2] = {0}, after[2] = {0};
    if (i > 0) segment_normal(profile[i - 1], profile[i], before);
    if (i + 1 < points) segment_normal(profile[i], profile[i + 1], after);
    float x = before[0] + after[0], y = before[1] + after[1], length = hypotf(x, y);
    normal[0] = length > 1e-6f ? x / length : 1;
    normal[1] = length > 1e-6f ? y / length : 0;
}

void prom_solid_lathe(prom_solid *shape, const float (*profile)[2], int points, int sides,
                      bool smooth)
{
    float v = 0;
    for (int i = 0; i + 1 < points; i++) {
        const float *a = profile[i], *b = profile[i + 1];
        float na[2], nb[2], next = v - hypotf(b[0] - a[0], b[1] - a[1]) / shape->repeat;
        segment_normal(a, b, na);
        segment_normal(a, b, nb);
        if (smooth) {
            point_normal(profile, points, i, na);
            point_normal(profile, points, i + 1, nb);
        }
        uint32_t low = lathe_ring(shape, a, na, sides, v);
        uint32_t high = lathe_ring(shape, b, nb, sides, next);
        for (uint32_t k = 0; k < (uint32_t)sides; k++) {
            if (a[0] > 0) prom_solid_triangle(shape, low + k, low + k + 1, high + k);
            if (b[0] > 0) prom_solid_triangle(shape, low + k + 1, high + k + 1, high + k);
        }
        v = next;
    }
}

void prom_solid_tube(prom_solid *shape, const float (*points)[3], const float *radii, int count,
                     int sides)
{
    // One reference direction, turned as little as possible from ring to ring, so that the tube
    // does not twist.
    vec3 side = {0};
    uint32_t before = 0;
    float v = 0;
    for (int i = 0; i < count; i++) {
        vec3 along, across, reference = {0, 0, 1};
        int a = i > 0 ? i - 1 : 0, b = i + 1 < count ? i + 1 : count - 1;
        glm_vec3_sub((float *)points[b], (float *)points[a], along);
        glm_vec3_normalize(along);
        if (!i && fabsf(along[2]) > 0.9f) reference[0] = 1, reference[2] = 0;
        glm_vec3_copy(i ? side : reference, side);
        glm_vec3_muladds(along, -glm_vec3_dot(side, along), side);
        glm_vec3_normalize(side);
        glm_vec3_cross(along, side, across);
        if (i)
            v -= glm_vec3_distance((float *)points[i], (float *)points[i - 1]) / shape->repeat;
        uint32_t first = 0;
        for (int k = 0; k <= sides; k++) {
            float angle = 2 * PI * (float)(k % sides) / (float)sides;
            vec3 n, p;
            glm_vec3_scale(side, cosf(angle), n);
            glm_vec3_muladds(across, sinf(angle), n);
            glm_vec3_copy((float *)points[i], p);
            glm_vec3_muladds(n, radii[i], p);
            uint32_t id = prom_solid_vertex(shape, p, n, (float)k / (float)sides, v);
            if (!k) first = id;
        }
        for (uint32_t k = 0; i && k < (uint32_t)sides; k++) {
            prom_solid_triangle(shape, before + k, before + k + 1, first + k);
            prom_solid_triangle(shape, before + k + 1, first + k + 1, first + k);
        }
        before = first;
    }
}

void prom_solid_floor(prom_solid *shape, float x0, float z0, float x1, float z1, float y,
                      float cell)
{
    uint32_t nx = (uint32_t)fmaxf(1, roundf((x1 - x0) / cell));
    uint32_t nz = (uint32_t)fmaxf(1, roundf((z1 - z0) / cell)), first = 0;
    static const float up[3] = {0, 1, 0};
    for (uint32_t j = 0; j <= nz; j++) {
        for (uint32_t i = 0; i <= nx; i++) {
            float x = x0 + (x1 - x0) * (float)i / (float)nx;
            float z = z0 + (z1 - z0) * (float)j / (float)nz;
            uint32_t id = prom_solid_vertex(shape, (float[]){x, y, z}, up, x / shape->repeat,
                                            z / shape->repeat);
            if (!i && !j) first = id;
        }
    }
    for (uint32_t j = 0; j < nz; j++) {
        for (uint32_t i = 0; i < nx; i++) {
            uint32_t a = first + j * (nx + 1) + i, b = a + nx + 1;
            prom_solid_triangle(shape, a, b, b + 1);
            prom_solid_triangle(shape, a, b + 1, a + 1);
        }
    }
}

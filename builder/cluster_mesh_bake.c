// Materials become vertex colours.
#include "builder/cluster_mesh.h"

#include "builder/cluster_mesh_sample.h"
#include "builder/simplify/simplify.h"
#include "builder/simplify/cards.h"
#include "builder/simplify/work.h"

#include <math.h>

// Masked components of up to this many triangles shrink as a whole; in larger ones triangles
// that are mostly see-through shrink one by one (both by taste).
enum { CARD_TRIANGLES = 8 };
// Points of a triangle whose colours are averaged, and how much finer than the triangle they
// look.
enum { COLOR_POINTS = 24, FINER_LEVELS = 2 };
#define SEE_THROUGH 0.9f
// Less cover than this is not worth a triangle.
#define LEAST_COVERAGE 0.01f

typedef struct baker {
    prom_work work;
    prom_sampler *samplers;          // per submesh
    const prom_material **materials; // per submesh, NULL: none
} baker;

static const float *position(const baker *b, uint32_t vertex)
{
    return b->work.vertices.data[vertex].position;
}

static float area_of(const baker *b, const uint32_t *t)
{
    float cross[3];
    prom_triangle_cross(position(b, t[0]), position(b, t[1]), position(b, t[2]), cross);
    return glm_vec3_norm(cross) / 2;
}

static void baker_init(baker *b, const prom_mesh *mesh, const prom_material *materials,
                       const prom_texture *textures)
{
    prom_work_init(&b->work, mesh);
    uint32_t count = b->work.submesh_count;
    b->samplers = prom_alloc(count, sizeof *b->samplers);
    b->materials = prom_alloc(count, sizeof *b->materials);
    for (uint32_t s = 0; s < count; s++) {
        uint32_t m = b->work.materials[s];
        b->materials[s] = m == PROM_NONE ? NULL : &materials[m];
        b->samplers[s] = prom_sampler_init(b->materials[s], textures);
    }
}

static void drop_blended(baker *b)
{
    size_t n = 0;
    prom_index_array *faces = &b->work.indices;
    for (size_t i = 0; i < faces->count; i += 3) {
        uint32_t t[3];
        memcpy(t, faces->data + i, sizeof t);
        const prom_material *m = b->materials[prom_owner_submesh(b->work.owners.data[t[0]])];
        if (m && m->alpha_mode == PROM_ALPHA_BLEND) continue;
        memcpy(faces->data + n, t, sizeof t);
        n += 3;
    }
    faces->count = n;
}

// Adds the colours of a triangle to its corners: points all over it, each weighted with its
// barycentric coordinates. The level is finer than the triangle, so that in an atlas the
// neighbours' pictures stay out.
static void add_triangle(const baker *b, const uint32_t *t, float (*sums)[4])
{
    const prom_vertex *v = b->work.vertices.data;
    const prom_sampler *s = &b->samplers[prom_owner_submesh(b->work.owners.data[t[0]])];
    const float *uv[3] = {v[t[0]].uv, v[t[1]].uv, v[t[2]].uv};
    uint32_t level = prom_sampler_level(s, uv);
    level = level > FINER_LEVELS ? level - FINER_LEVELS : 0;
    float area = area_of(b, t);
    int points = s->texture ? COLOR_POINTS : 1;
    for (int i = 0; i < points; i++) {
        // The sequence of prom_sampler_coverage, folded into the triangle.
        float w[3] = {0, 1 / 3.0f, 1 / 3.0f}, at[2], rgb[3];
        if (points > 1) {
            w[1] = 0.5f + 0.7548776662f * (float)i, w[2] = 0.5f + 0.5698402910f * (float)i;
            w[1] -= floorf(w[1]), w[2] -= floorf(w[2]);
            if (w[1] + w[2] > 1) w[1] = 1 - w[1], w[2] = 1 - w[2];
        }
        w[0] = 1 - w[1] - w[2];
        for (int a = 0; a < 2; a++) at[a] = w[0] * uv[0][a] + w[1] * uv[1][a] + w[2] * uv[2][a];
        prom_sampler_color(s, level, at, rgb);
        for (int k = 0; k < 3; k++) {
            for (int c = 0; c < 3; c++) sums[t[k]][c] += rgb[c] * area * w[k];
            sums[t[k]][3] += area * w[k];
        }
    }
}

// Every vertex gets the mean of its triangles' colours around it.
static void color_vertices(baker *b)
{
    prom_vertex *v = b->work.vertices.data;
    const prom_index_array *faces = &b->work.indices;
    float(*sums)[4] = prom_calloc(b->work.vertices.count, sizeof *sums);
    for (size_t i = 0; i < faces->count; i += 3) add_triangle(b, faces->data + i, sums);
    for (size_t i = 0; i < b->work.vertices.count; i++) {
        if (sums[i][3] <= 0) continue;
        for (int c = 0; c < 3; c++)
            v[i].color[c] = prom_linear_to_srgb8(sums[i][c] / sums[i][3] *
                                                 prom_srgb8_to_linear(v[i].color[c]));
    }
    prom_free(sums);
}

static float coverage_of(const baker *b, const uint32_t *t)
{
    const prom_vertex *v = b->work.vertices.data;
    const prom_sampler *s = &b->samplers[prom_owner_submesh(b->work.owners.data[t[0]])];
    if (!s->masked) return 1;
    const float *uv[3] = {v[t[0]].uv, v[t[1]].uv, v[t[2]].uv};
    float alpha = (float)(v[t[0]].color[3] + v[t[1]].color[3] + v[t[2]].color[3]) / 765;
    return prom_sampler_coverage(s, uv, alpha);
}

static void shrink(float position[3], const float center[3], float factor)
{
    for (int a = 0; a < 3; a++) position[a] = center[a] + (position[a] - center[a]) * factor;
}

// Cuts a triangle off and shrinks it about its own middle.
static void shrink_alone(baker *b, uint32_t *t, float coverage)
{
    float center[3] = {0};
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) center[a] += position(b, t[k])[a] / 3;
    for (int k = 0; k < 3; k++) {
        prom_vertex copy = b->work.vertices.data[t[k]];
        uint32_t owner = b->work.owners.data[t[k]], id = (uint32_t)b->work.vertices.count;
        shrink(copy.position, center, sqrtf(coverage));
        prom_array_push(&b->work.vertices, copy);
        prom_array_push(&b->work.owners, owner);
        prom_array_push(&b->work.place, id);
        t[k] = id;
    }
}

typedef struct coverage_table {
    float *triangle;  // per triangle
    float *component; // per component, area-weighted
    uint32_t *of;
    prom_component *components;
    uint32_t count;
} coverage_table;

static coverage_table measure_coverage(const baker *b)
{
    const prom_index_array *faces = &b->work.indices;
    coverage_table c = {.triangle = prom_alloc(faces->count / 3, sizeof *c.triangle),
                        .of = prom_alloc(faces->count / 3, sizeof *c.of)};
    c.count = prom_work_components(&b->work, faces, c.of, &c.components);
    c.component = prom_calloc(c.count, sizeof *c.component);
    for (size_t t = 0; t < faces->count / 3; t++) {
        c.triangle[t] = coverage_of(b, faces->data + t * 3);
        float area = c.components[c.of[t]].area;
        if (area > 0)
            c.component[c.of[t]] += c.triangle[t] * area_of(b, faces->data + t * 3) / area;
    }
    return c;
}

static void shrink_masked(baker *b)
{
    prom_index_array *faces = &b->work.indices;
    coverage_table c = measure_coverage(b);
    uint8_t *moved = prom_calloc(b->work.vertices.count, 1);
    size_t n = 0;
    for (size_t t = 0; t < faces->count / 3; t++) {
        uint32_t corner[3];
        memcpy(corner, faces->data + t * 3, sizeof corner);
        const prom_component *part = &c.components[c.of[t]];
        bool whole = part->triangles <= CARD_TRIANGLES;
        float coverage = whole ? c.component[c.of[t]] : c.triangle[t];
        if (coverage < LEAST_COVERAGE) continue;
        for (int k = 0; whole && k < 3; k++) {
            if (moved[corner[k]]) continue;
            moved[corner[k]] = 1;
            shrink(b->work.vertices.data[corner[k]].position, part->center,
                   sqrtf(fminf(coverage, 1)));
        }
        if (!whole && coverage < SEE_THROUGH) shrink_alone(b, corner, coverage);
        memcpy(faces->data + n, corner, sizeof corner);
        n += 3;
    }
    faces->count = n;
    prom_free(moved);
    prom_free(c.triangle);
    prom_free(c.component);
    prom_free(c.components);
    prom_free(c.of);
}

// One submesh without material; double-sided materials leave back sides behind.
static void forget_materials(baker *b)
{
    for (size_t i = 0; i < b->work.vertices.count; i++) {
        const prom_material *m = b->materials[prom_owner_submesh(b->work.owners.data[i])];
        uint32_t *owner = &b->work.owners.data[i];
        *owner &= PROM_OWNERS - 1;
        if (m && m->double_sided) *owner |= PROM_OWNER_BACK;
        prom_vertex *v = &b->work.vertices.data[i];
        v->uv[0] = v->uv[1] = 0;
        v->color[3] = 255;
    }
    if (b->work.submesh_count > 1) b->work.submesh_count = 1;
    if (b->work.submesh_count) b->work.materials[0] = PROM_NONE;
}

void prom_mesh_bake_colors(const prom_mesh *mesh, const prom_material *materials,
                           const prom_texture *textures, prom_mesh *out)
{
    baker b;
    baker_init(&b, mesh, materials, textures);
    drop_blended(&b);
    color_vertices(&b);
    shrink_masked(&b);
    forget_materials(&b);
    prom_work_emit(&b.work, &b.work.indices, out);
    prom_free(b.samplers);
    prom_free(b.materials);
    prom_work_finish(&b.work);
    // Vertices that differed by texture coordinates or material only are one now.
    prom_mesh_weld(out, 0);
}

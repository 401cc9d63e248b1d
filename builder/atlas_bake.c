// Filling an atlas: each chart gets a picture of what stands there, from straight ahead.
#include "builder/atlas_bake.h"

#include "metaobj/base/alloc.h"

#include <math.h>

// A texel is the mean of so many pixels squared.
#define PIXELS_PER_TEXEL 4u
// Coverages of texels.
enum { COVERED = 254, UNKNOWN = 255, CUT = 128 };
_Static_assert(PROM_ATLAS_SIDE_MAX *PIXELS_PER_TEXEL <= PROM_PATCHES_PX, "room for an atlas");
// How far before a chart its picture begins, in parts of the mesh's error (by taste); where
// that shows nothing, all of it counts. Things farther away would cast themselves on the chart.
#define NEAR_SHARE 0.25f
// Exactly at the chart would be too tight for numbers: of the subject's extent.
#define LEAST_DEPTH 1e-4f
// Texels that no picture has are filled from so far away.
enum { DILATE_RINGS = 16 };

typedef PROM_ARRAY(prom_draw_item) item_array;

// The rectangle of a chart's place, gutter included.
static prom_patch patch_of(const prom_atlas *atlas, const prom_chart *chart,
                           const prom_atlas_subject *subject)
{
    const float texel = 1 / atlas->texels_per_unit;
    const float left = chart->min[0] - PROM_ATLAS_GUTTER * texel;
    const float top = chart->max[1] + PROM_ATLAS_GUTTER * texel;
    const float least = LEAST_DEPTH * texel * (float)atlas->side;
    prom_patch p = {.half_width = (float)chart->width * texel / 2,
                    .half_height = (float)chart->height * texel / 2,
                    .x = chart->x * PIXELS_PER_TEXEL,
                    .y = chart->y * PIXELS_PER_TEXEL,
                    .width = chart->width * PIXELS_PER_TEXEL,
                    .height = chart->height * PIXELS_PER_TEXEL};
    memcpy(p.right, chart->right, sizeof p.right);
    memcpy(p.up, chart->up, sizeof p.up);
    memcpy(p.out, chart->out, sizeof p.out);
    glm_vec3_negate_to((float *)subject->center, p.center);
    glm_vec3_muladds(p.right, left + p.half_width, p.center);
    glm_vec3_muladds(p.up, top - p.half_height, p.center);
    p.front = chart->max[2] + fmaxf(subject->error, least);
    p.back = chart->min[2] - fmaxf(subject->error, least);
    return p;
}

static bool reaches(const prom_sphere *sphere, const prom_patch *p)
{
    vec3 to;
    glm_vec3_sub((float *)sphere->center, (float *)p->center, to);
    const float r = sphere->radius, depth = glm_vec3_dot(to, (float *)p->out);
    return fabsf(glm_vec3_dot(to, (float *)p->right)) <= p->half_width + r &&
           fabsf(glm_vec3_dot(to, (float *)p->up)) <= p->half_height + r &&
           depth <= p->front + r && depth >= p->back - r;
}

// Draws what stands at each chart.
static void take_patches(prom_baker *baker, const prom_atlas *atlas,
                         const prom_atlas_subject *subject, uint8_t *rgba)
{
    item_array items = {0};
    prom_baker_begin_patches(baker);
    for (uint32_t c = 0; c < atlas->chart_count; c++) {
        prom_patch patch = patch_of(atlas, &atlas->charts[c], subject);
        items.count = 0;
        for (size_t i = 0; i < subject->count; i++)
            if (reaches(&subject->spheres[i], &patch))
                prom_array_push(&items, subject->items[i]);
        prom_baker_set_subject(baker, items.data, items.count);
        prom_baker_draw_patch(baker, &patch);
    }
    prom_baker_read_patches(baker, atlas->side * PIXELS_PER_TEXEL, rgba);
    prom_array_finish(&items);
}

// ---- from pixels to texels

static float edge(const float a[2], const float b[2], float x, float y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

// Marks the pixels whose middles a triangle has.
static void mark_triangle(const float at[3][2], uint32_t side, uint8_t *inside)
{
    float area = edge(at[0], at[1], at[2][0], at[2][1]), limit = (float)side;
    float low[2], high[2];
    for (int a = 0; a < 2; a++) {
        low[a] = fmaxf(floorf(fminf(at[0][a], fminf(at[1][a], at[2][a]))), 0);
        high[a] = fminf(ceilf(fmaxf(at[0][a], fmaxf(at[1][a], at[2][a]))), limit);
    }
    for (uint32_t y = (uint32_t)low[1]; (float)y < high[1]; y++)
        for (uint32_t x = (uint32_t)low[0]; (float)x < high[0]; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f;
            if (edge(at[0], at[1], px, py) * area >= 0 &&
                edge(at[1], at[2], px, py) * area >= 0 &&
                edge(at[2], at[0], px, py) * area >= 0)
                inside[(size_t)y * side + x] = 1;
        }
}

static uint8_t *mark_faces(const prom_mesh *unwrapped, uint32_t side)
{
    uint8_t *inside = prom_calloc((size_t)side * side, 1);
    for (uint32_t i = 0; i < unwrapped->index_count; i += 3) {
        float at[3][2];
        for (int k = 0; k < 3; k++)
            for (int a = 0; a < 2; a++)
                at[k][a] = unwrapped->vertices[unwrapped->indices[i + k]].uv[a] * (float)side;
        mark_triangle((const float(*)[2])at, side, inside);
    }
    return inside;
}

// A texel: the mean colour of what its pixels show, with alpha 255, or nothing, with 0. Returns
// the share of its faces' pixels that show something, of COVERED, or UNKNOWN if it has none.
static uint8_t mean_of(const uint8_t *rgba, const uint8_t *inside, size_t side, uint8_t out[4])
{
    uint32_t shown = 0, faces = 0, covered = 0;
    float sum[3] = {0};
    for (size_t y = 0; y < PIXELS_PER_TEXEL; y++)
        for (size_t x = 0; x < PIXELS_PER_TEXEL; x++) {
            const uint8_t *p = rgba + (y * side + x) * 4;
            faces += inside[y * side + x];
            if (!p[3]) continue;
            shown++;
            covered += inside[y * side + x];
            for (int c = 0; c < 3; c++) sum[c] += prom_srgb8_to_linear(p[c]);
        }
    for (int c = 0; c < 3 && shown; c++) out[c] = prom_linear_to_srgb8(sum[c] / (float)shown);
    out[3] = shown ? 255 : 0;
    return (uint8_t)(faces ? covered * COVERED / faces : UNKNOWN);
}

// Texels without faces, which filtering blends in, go on as their neighbours do.
static void spread_coverage(uint8_t *coverage, uint32_t side)
{
    const size_t texels = (size_t)side * side;
    uint8_t *before = prom_alloc(texels, 1);
    memcpy(before, coverage, texels);
    for (uint32_t y = 0; y < side; y++)
        for (uint32_t x = 0; x < side; x++) {
            const size_t i = (size_t)y * side + x;
            if (before[i] != UNKNOWN) continue;
            uint32_t sum = 0, count = 0;
            for (uint32_t v = y ? y - 1 : 0; v <= y + 1 && v < side; v++)
                for (uint32_t u = x ? x - 1 : 0; u <= x + 1 && u < side; u++) {
                    uint8_t c = before[(size_t)v * side + u];
                    if (c == UNKNOWN) continue;
                    sum += c;
                    count++;
                }
            if (count) coverage[i] = (uint8_t)(sum / count);
        }
    prom_free(before);
}

// Level 0, its colours without an end, and the coverage beside it.
static uint8_t *take_texels(prom_baker *baker, const prom_atlas *atlas,
                            const prom_mesh *unwrapped, const prom_atlas_subject *subject,
                            prom_texture *out)
{
    const size_t side = (size_t)atlas->side * PIXELS_PER_TEXEL;
    uint8_t *rgba = prom_alloc(side * side, 4);
    uint8_t *inside = mark_faces(unwrapped, (uint32_t)side);
    uint8_t *coverage = prom_alloc((size_t)atlas->side * atlas->side, 1);
    take_patches(baker, atlas, subject, rgba);
    for (size_t i = 0; i < (size_t)atlas->side * atlas->side; i++) {
        size_t first = (i / atlas->side * side + i % atlas->side) * PIXELS_PER_TEXEL;
        coverage[i] = mean_of(rgba + first * 4, inside + first, side, out->pixels + i * 4);
    }
    prom_free(inside);
    prom_free(rgba);
    prom_texture_dilate(out, DILATE_RINGS);
    return coverage;
}

bool prom_atlas_bake(prom_baker *baker, const prom_atlas *atlas, const prom_mesh *unwrapped,
                     const prom_atlas_subject *subject, prom_texture *out)
{
    const size_t texels = (size_t)atlas->side * atlas->side;
    prom_texture_init(out, PROM_TEXTURE_COLOR, atlas->side, atlas->side);
    uint8_t *coverage = take_texels(baker, atlas, unwrapped, subject, out);
    for (uint32_t i = 0; i < PROM_ATLAS_GUTTER; i++) spread_coverage(coverage, atlas->side);
    bool cut = false;
    for (size_t i = 0; i < texels; i++) cut |= coverage[i] < CUT;
    for (size_t i = 0; i < texels; i++)
        out->pixels[i * 4 + 3] = !cut || coverage[i] == COVERED ? 255 : coverage[i];
    prom_free(coverage);
    prom_texture_make_mips(out, cut ? PROM_ATLAS_CUTOFF : 0);
    return cut;
}

// Packing charts: rectangles from high to low, each where it stands lowest on what is there
// already (the skyline, bottom-left: Jylanki 2010).
#include "builder/atlas.h"

#include "metaobj/base/alloc.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// The density is found to within this factor.
#define DENSITY_STEP 1.01f

typedef struct step {
    uint32_t x, y, width; // of the skyline: filled up to y
} step;

typedef struct skyline {
    step *steps;
    uint32_t count, side;
} skyline;

typedef struct ranked_chart {
    uint32_t width, height, chart;
} ranked_chart;

static int by_height(const void *a, const void *b)
{
    const ranked_chart *x = a, *y = b;
    if (x->height != y->height) return x->height > y->height ? -1 : 1;
    if (x->width != y->width) return x->width > y->width ? -1 : 1;
    return (x->chart > y->chart) - (x->chart < y->chart);
}

// Where a width fits at step i; UINT32_MAX: nowhere.
static uint32_t level_at(const skyline *s, uint32_t i, uint32_t width, uint32_t height)
{
    uint32_t y = 0, x = s->steps[i].x;
    if (x + width > s->side) return UINT32_MAX;
    for (; i < s->count && s->steps[i].x < x + width; i++)
        if (s->steps[i].y > y) y = s->steps[i].y;
    return y + height > s->side ? UINT32_MAX : y;
}

// Puts a rectangle on step i: the steps below it go.
static void raise(skyline *s, uint32_t i, uint32_t width, uint32_t top)
{
    uint32_t x = s->steps[i].x, end = i;
    while (end < s->count && s->steps[end].x + s->steps[end].width <= x + width) end++;
    if (end < s->count && s->steps[end].x < x + width) {
        uint32_t cut = x + width - s->steps[end].x;
        s->steps[end].x += cut;
        s->steps[end].width -= cut;
    }
    // One step takes the place of [i, end).
    memmove(s->steps + i + 1, s->steps + end, (s->count - end) * sizeof *s->steps);
    s->count = s->count - (end - i) + 1;
    s->steps[i] = (step){x, top, width};
}

static bool place(skyline *s, prom_chart *chart)
{
    uint32_t best = PROM_NONE, best_y = UINT32_MAX;
    for (uint32_t i = 0; i < s->count; i++) {
        uint32_t y = level_at(s, i, chart->width, chart->height);
        if (y >= best_y) continue;
        best = i;
        best_y = y;
    }
    if (best == PROM_NONE) return false;
    chart->x = s->steps[best].x;
    chart->y = best_y;
    raise(s, best, chart->width, best_y + chart->height);
    return true;
}

// Texels for a length, with the gutter; too many for any square stay so.
static uint32_t texels_for(float length, float texels_per_unit)
{
    float texels = ceilf(length * texels_per_unit);
    if (!(texels >= 1)) texels = 1;
    return (uint32_t)fminf(texels, 1 << 20) + 2 * PROM_ATLAS_GUTTER;
}

// Lies rather than stands: shelves of one height fill better.
static void lay_down(prom_chart *chart)
{
    vec3 right;
    if (chart->max[0] - chart->min[0] >= chart->max[1] - chart->min[1]) return;
    glm_vec3_copy(chart->right, right);
    glm_vec3_copy(chart->up, chart->right);
    glm_vec3_negate_to(right, chart->up);
    const float min[2] = {chart->min[1], -chart->max[0]};
    const float max[2] = {chart->max[1], -chart->min[0]};
    memcpy(chart->min, min, sizeof min);
    memcpy(chart->max, max, sizeof max);
}

bool prom_atlas_pack(prom_atlas *atlas, float texels_per_unit, uint32_t side)
{
    uint32_t count = atlas->chart_count;
    ranked_chart *order = prom_alloc(count, sizeof *order);
    for (uint32_t i = 0; i < count; i++) {
        prom_chart *c = &atlas->charts[i];
        lay_down(c);
        c->width = texels_for(c->max[0] - c->min[0], texels_per_unit);
        c->height = texels_for(c->max[1] - c->min[1], texels_per_unit);
        order[i] = (ranked_chart){c->width, c->height, i};
    }
    qsort(order, count, sizeof *order, by_height);
    // Each rectangle adds one step at most.
    skyline s = {prom_alloc((size_t)count + 1, sizeof *s.steps), 1, side};
    s.steps[0] = (step){0, 0, side};
    bool fits = true;
    for (uint32_t i = 0; i < count && fits; i++)
        fits = place(&s, &atlas->charts[order[i].chart]);
    prom_free(s.steps);
    prom_free(order);
    atlas->side = side;
    atlas->texels_per_unit = texels_per_unit;
    return fits;
}

// At which no chart takes more than a texel.
static float least_density(const prom_atlas *atlas)
{
    float longest = 0;
    for (uint32_t i = 0; i < atlas->chart_count; i++)
        for (int a = 0; a < 2; a++)
            longest = fmaxf(longest, atlas->charts[i].max[a] - atlas->charts[i].min[a]);
    return longest > 0 ? 1 / longest : INFINITY;
}

// The greatest density below the wanted one that fits; false if not even the least does.
static bool pack_thinner(prom_atlas *atlas, float wanted, uint32_t side)
{
    float fits = fminf(least_density(atlas), wanted), over = wanted;
    if (!prom_atlas_pack(atlas, fits, side)) return false;
    while (over > DENSITY_STEP * fits) {
        float middle = sqrtf(fits * over);
        if (prom_atlas_pack(atlas, middle, side))
            fits = middle;
        else
            over = middle;
    }
    return prom_atlas_pack(atlas, fits, side);
}

bool prom_atlas_init(prom_atlas *atlas, const prom_mesh *mesh, float texels_per_unit,
                     uint32_t min_side, uint32_t max_side)
{
    assert(texels_per_unit > 0);
    *atlas = (prom_atlas){0};
    if (mesh->index_count < 3) return false;
    prom_atlas_chart(atlas, mesh);
    for (uint32_t side = min_side; side <= max_side; side *= 2)
        if (prom_atlas_pack(atlas, texels_per_unit, side)) return true;
    if (pack_thinner(atlas, texels_per_unit, max_side)) return true;
    prom_atlas_finish(atlas);
    return false;
}

void prom_atlas_finish(prom_atlas *atlas)
{
    prom_free(atlas->charts);
    prom_free(atlas->faces);
    *atlas = (prom_atlas){0};
}

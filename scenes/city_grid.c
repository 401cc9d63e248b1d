#include "scenes/city_parts.h"

#include <math.h>

void prom_cut_to(prom_cuts *c, float from, float to, float cell)
{
    uint32_t n = (uint32_t)fmaxf(1, roundf((to - from) / cell));
    if (!c->count) c->at[c->count++] = from;
    for (uint32_t i = 1; i <= n && c->count < PROM_CUTS_MAX; i++)
        c->at[c->count++] = i == n ? to : from + (to - from) * (float)i / (float)n;
}

static float grid_height(const prom_grid *g, float x, float z)
{
    return g->height_of ? g->height_of(g->user, x, z) : g->y;
}

static uint32_t grid_vertex(prom_solid *shape, const prom_grid *g, float x, float z)
{
    const float e = 0.5f;
    float dx = (grid_height(g, x + e, z) - grid_height(g, x - e, z)) / (2 * e);
    float dz = (grid_height(g, x, z + e) - grid_height(g, x, z - e)) / (2 * e);
    float length = sqrtf(dx * dx + 1 + dz * dz);
    float normal[3] = {-dx / length, 1 / length, -dz / length};
    float at[3] = {x, grid_height(g, x, z), z};
    if (g->shift) g->shift(g->user, &at[0], &at[2]);
    return prom_solid_vertex(shape, at, normal, x / shape->repeat, z / shape->repeat);
}

void prom_grid_build(prom_solid *shape, const prom_grid *g, int paint)
{
    uint32_t nx = g->x->count, nz = g->z->count;
    uint32_t *ids = prom_alloc((size_t)nx * nz, sizeof *ids);
    memset(ids, 255, (size_t)nx * nz * sizeof *ids);
    for (uint32_t j = 0; j + 1 < nz; j++) {
        for (uint32_t i = 0; i + 1 < nx; i++) {
            float mx = (g->x->at[i] + g->x->at[i + 1]) / 2;
            float mz = (g->z->at[j] + g->z->at[j + 1]) / 2;
            if (g->paint_of(g->user, mx, mz) != paint) continue;
            uint32_t at[4] = {j * nx + i, (j + 1) * nx + i, (j + 1) * nx + i + 1,
                              j * nx + i + 1};
            for (int k = 0; k < 4; k++)
                if (ids[at[k]] == UINT32_MAX)
                    ids[at[k]] =
                        grid_vertex(shape, g, g->x->at[at[k] % nx], g->z->at[at[k] / nx]);
            prom_solid_triangle(shape, ids[at[0]], ids[at[1]], ids[at[2]]);
            prom_solid_triangle(shape, ids[at[0]], ids[at[2]], ids[at[3]]);
        }
    }
    prom_free(ids);
}

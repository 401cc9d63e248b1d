#include "builder/simplify/repair_edges.h"

#include "metaobj/mesh.h"

// Open addressing: `table` holds edges + 1.
static uint32_t find_edge(prom_edges *edges, uint32_t *table, uint32_t mask, uint32_t low,
                          uint32_t high)
{
    uint64_t h = (low * UINT64_C(0x9E3779B97F4A7C15)) ^ (high * UINT64_C(0xC2B2AE3D27D4EB4F));
    uint32_t slot = (uint32_t)(h >> 32) & mask;
    for (; table[slot]; slot = (slot + 1) & mask) {
        const prom_edge *e = &edges->edges.data[table[slot] - 1];
        if (e->low == low && e->high == high) return table[slot] - 1;
    }
    prom_array_push(&edges->edges, (prom_edge){low, high, 0, {PROM_NONE, PROM_NONE}});
    table[slot] = (uint32_t)edges->edges.count;
    return table[slot] - 1;
}

void prom_edges_init(prom_edges *edges, const uint32_t *points, const bool *skip,
                     uint32_t triangles)
{
    uint32_t corners = triangles * 3, size = 16;
    while (size < corners + corners / 2) size *= 2;
    uint32_t *table = prom_calloc(size, sizeof *table);
    *edges = (prom_edges){.of = prom_alloc(corners, sizeof *edges->of)};
    for (uint32_t c = 0; c < corners; c++) {
        edges->of[c] = PROM_NONE;
        if (skip[c / 3]) continue;
        uint32_t a = points[c], b = points[prom_next_corner(c)];
        uint32_t found = find_edge(edges, table, size - 1, a < b ? a : b, a < b ? b : a);
        prom_edge *e = &edges->edges.data[found];
        if (e->uses < 2) e->half[e->uses] = c;
        e->uses++;
        edges->of[c] = found;
    }
    prom_free(table);
}

void prom_edges_finish(prom_edges *edges)
{
    prom_array_finish(&edges->edges);
    prom_free(edges->of);
    *edges = (prom_edges){0};
}

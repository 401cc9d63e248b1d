#include "builder/simplify/mesh_volume.h"

#include "builder/simplify/weld.h"
#include "metaobj/base/alloc.h"

#include <stdlib.h>

#define WELD_SHARE 1e-5f // of the bounds' half diagonal

// Six times the volume of the tetrahedron between the origin and a triangle, and twice the
// triangle's area.
static double six_volumes(const prom_vertex *v, const uint32_t t[3], double *two_areas)
{
    double e[2][3], n[3], volume = 0, square = 0;
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 2; c++)
            e[c][k] = (double)v[t[c + 1]].position[k] - (double)v[t[0]].position[k];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = e[0][i] * e[1][j] - e[0][j] * e[1][i];
        square += n[k] * n[k];
        volume += n[k] * v[t[0]].position[k];
    }
    *two_areas = sqrt(square);
    return volume;
}

double prom_mesh_area(const prom_mesh *mesh)
{
    double sum = 0, two_areas;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        six_volumes(mesh->vertices, mesh->indices + i, &two_areas);
        sum += two_areas;
    }
    return sum / 2;
}

// ---- closedness

static int ascending(const void *pa, const void *pb)
{
    const uint64_t *a = pa, *b = pb;
    return (*a > *b) - (*a < *b);
}

// Edges as (low, high) vertex, the lowest bit saying which way: from low to high 0.
static size_t collect_edges(const prom_mesh *mesh, const uint32_t *first, uint64_t *edges)
{
    size_t count = 0;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3)
        for (uint32_t k = 0; k < 3; k++) {
            uint64_t a = first[mesh->indices[i + k]], b = first[mesh->indices[i + (k + 1) % 3]];
            if (a == b) continue; // the triangle is a line: its other two edges cancel out
            edges[count++] = a < b ? a << 33 | b << 1 : b << 33 | a << 1 | 1;
        }
    return count;
}

static bool edges_balance(const uint64_t *edges, size_t count)
{
    int64_t sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += edges[i] & 1 ? -1 : 1;
        bool last = i + 1 == count || edges[i] >> 1 != edges[i + 1] >> 1;
        if (last && sum) return false;
    }
    return true;
}

static bool is_closed(const prom_mesh *mesh)
{
    prom_box box = prom_mesh_bounds(mesh);
    float tolerance = WELD_SHARE / 2 * prom_box_diagonal(&box);
    if (!(tolerance > 0)) return false;
    uint32_t *first = prom_alloc(mesh->vertex_count, sizeof *first);
    uint64_t *edges = prom_alloc(mesh->index_count, sizeof *edges);
    prom_first_near(mesh->vertices, mesh->vertex_count, tolerance, false, first);
    size_t count = collect_edges(mesh, first, edges);
    qsort(edges, count, sizeof *edges, ascending);
    bool closed = count && edges_balance(edges, count);
    prom_free(first);
    prom_free(edges);
    return closed;
}

bool prom_mesh_volume(const prom_mesh *mesh, double *volume)
{
    if (!mesh->index_count || mesh->vertex_count > INT32_MAX || !is_closed(mesh)) return false;
    double sum = 0, two_areas;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3)
        sum += six_volumes(mesh->vertices, mesh->indices + i, &two_areas);
    *volume = sum / 6;
    return true;
}

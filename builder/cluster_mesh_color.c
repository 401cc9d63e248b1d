#include "builder/cluster_mesh_color.h"

#include "builder/simplify/distance.h"

#include <math.h>
#include <stdlib.h>

// Original triangles that are asked for their nearest point; of more, every k-th.
enum { MAX_SAMPLES = 8192 };

static int by_value(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return *x < *y ? -1 : *x > *y;
}

// Marks places on edges that no triangle uses the other way round.
static uint8_t *border_places(const prom_work *work, const prom_index_array *faces)
{
    uint8_t *border = prom_calloc(work->vertices.count, 1);
    uint64_t *edges = prom_alloc(faces->count, sizeof *edges);
    const uint32_t *place = work->place.data;
    for (size_t i = 0; i < faces->count; i++) {
        size_t next = i % 3 == 2 ? i - 2 : i + 1;
        edges[i] = (uint64_t)place[faces->data[i]] << 32 | place[faces->data[next]];
    }
    qsort(edges, faces->count, sizeof *edges, by_value);
    for (size_t i = 0; i < faces->count; i++) {
        uint64_t back = edges[i] >> 32 | edges[i] << 32;
        if (bsearch(&back, edges, faces->count, sizeof *edges, by_value)) continue;
        border[edges[i] >> 32] = border[edges[i] & UINT32_MAX] = 1;
    }
    prom_free(edges);
    return border;
}

static void gather(const prom_work *work, const prom_index_array *faces, float (*sums)[4])
{
    const prom_vertex *v = work->vertices.data;
    const prom_index_array *all = &work->indices;
    prom_surface surface;
    prom_surface_init(&surface, v, (uint32_t)work->vertices.count, faces->data, faces->count);
    uint32_t hint = PROM_NONE;
    size_t stride = all->count / 3 / MAX_SAMPLES + 1;
    for (size_t i = 0; i + 2 < all->count; i += stride * 3) {
        const uint32_t *t = all->data + i;
        float point[3] = {0}, rgb[3] = {0}, cross[3];
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++) {
                point[c] += v[t[k]].position[c] / 3;
                rgb[c] += prom_srgb8_to_linear(v[t[k]].color[c]) / 3;
            }
        prom_triangle_cross(v[t[0]].position, v[t[1]].position, v[t[2]].position, cross);
        float area = glm_vec3_norm(cross);
        prom_nearest near = prom_surface_nearest(&surface, point, 0, hint);
        hint = near.slot;
        for (int k = 0; k < 3; k++) {
            float *sum = sums[near.triangle[k]], weight = area * near.weights[k];
            for (int c = 0; c < 3; c++) sum[c] += rgb[c] * weight;
            sum[3] += weight;
        }
    }
    prom_surface_finish(&surface);
}

// Vertices at one place that no triangle was nearest to take what their neighbours have.
static void spread_to_empty(const prom_index_array *faces, float (*sums)[4], size_t count)
{
    float(*next)[4] = prom_alloc(count, sizeof *next);
    for (int pass = 0; pass < 3; pass++) {
        memcpy(next, sums, count * sizeof *next);
        for (size_t i = 0; i < faces->count; i++) {
            uint32_t v = faces->data[i];
            if (sums[v][3] > 0) continue;
            for (size_t k = i - i % 3; k < i - i % 3 + 3; k++)
                for (int c = 0; c < 4; c++) next[v][c] += sums[faces->data[k]][c];
        }
        memcpy(sums, next, count * sizeof *next);
    }
    prom_free(next);
}

void prom_work_recolor(prom_work *work, const prom_index_array *faces, bool keep_border)
{
    if (!faces->count) return;
    size_t count = work->vertices.count;
    float(*sums)[4] = prom_calloc(count, sizeof *sums);
    gather(work, faces, sums);
    spread_to_empty(faces, sums, count);
    uint8_t *border = keep_border ? border_places(work, faces) : NULL;
    for (size_t i = 0; i < faces->count; i++) {
        uint32_t id = faces->data[i];
        if (!(sums[id][3] > 0) || (border && border[work->place.data[id]])) continue;
        for (int c = 0; c < 3; c++)
            work->vertices.data[id].color[c] = prom_linear_to_srgb8(sums[id][c] / sums[id][3]);
    }
    prom_free(border);
    prom_free(sums);
}

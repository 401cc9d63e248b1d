#include "builder/simplify/corner.h"

#include <math.h>

// Candidates beyond these are not looked at: three corners make at most 8^3 combinations.
enum { MAX_CANDIDATES = 8 };

typedef struct reading_key {
    float position[3];
    uint32_t owner;
    uint8_t color[4];
    float uv[2];
} reading_key;

void prom_read_vertices(const prom_work *work, prom_reading reading, uint32_t *representative)
{
    uint32_t n = work->base_count;
    if (reading == PROM_READ_ALL) {
        for (uint32_t i = 0; i < n; i++) representative[i] = i;
        return;
    }
    reading_key *keys = prom_calloc(n, sizeof *keys);
    for (uint32_t i = 0; i < n; i++) {
        const prom_vertex *v = &work->vertices.data[i];
        memcpy(keys[i].position, v->position, sizeof keys[i].position);
        keys[i].owner = work->owners.data[i];
        if (reading == PROM_READ_POSITION) continue;
        memcpy(keys[i].color, v->color, sizeof keys[i].color);
        memcpy(keys[i].uv, v->uv, sizeof keys[i].uv);
    }
    prom_first_equal(keys, n, sizeof *keys, representative);
    prom_free(keys);
}

static uint32_t root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

// Charts: vertices joined by triangles, where vertices that differ by their normal only are
// one.
static uint32_t *find_charts(const prom_work *work, const prom_index_array *faces)
{
    uint32_t *parent = prom_alloc(work->base_count, sizeof *parent);
    prom_read_vertices(work, PROM_READ_NO_NORMAL, parent);
    for (size_t i = 0; i < faces->count; i += 3)
        for (int k = 1; k < 3; k++) {
            uint32_t a = root(parent, faces->data[i]), b = root(parent, faces->data[i + k]);
            if (a < b) parent[b] = a;
            if (b < a) parent[a] = b;
        }
    for (uint32_t i = 0; i < work->base_count; i++) parent[i] = root(parent, i);
    return parent;
}

// The vertices used by `faces`, grouped by representative.
typedef struct members {
    uint32_t *start; // per vertex, base_count + 1
    uint32_t *list;
} members;

static members group_members(const prom_work *work, const prom_index_array *faces,
                             const uint32_t *representative)
{
    uint32_t n = work->base_count;
    uint8_t *used = prom_calloc(n, 1);
    members m = {prom_calloc((size_t)n + 2, sizeof *m.start), prom_alloc(n, sizeof *m.list)};
    for (size_t i = 0; i < faces->count; i++) used[faces->data[i]] = 1;
    for (uint32_t i = 0; i < n; i++)
        if (used[i]) m.start[representative[i] + 2]++;
    for (uint32_t i = 2; i < n + 2; i++) m.start[i] += m.start[i - 1];
    for (uint32_t i = 0; i < n; i++)
        if (used[i]) m.list[m.start[representative[i] + 1]++] = i;
    prom_free(used);
    return m;
}

typedef struct chooser {
    const prom_work *work;
    const uint32_t *charts; // NULL: texture coordinates do not matter
    members groups;
} chooser;

static float chart_penalty(const chooser *c, const uint32_t v[3])
{
    if (!c->charts) return 0;
    uint32_t a = c->charts[v[0]], b = c->charts[v[1]], d = c->charts[v[2]];
    if (a == b && b == d) return 0;
    // A triangle across charts smears the texture; keep its extent there small.
    float extent = 0;
    for (int i = 0; i < 3; i++) {
        const float *p = c->work->vertices.data[v[i]].uv;
        const float *q = c->work->vertices.data[v[(i + 1) % 3]].uv;
        extent += hypotf(p[0] - q[0], p[1] - q[1]);
    }
    return 8.0f + extent;
}

static void choose(const chooser *c, uint32_t triangle[3])
{
    const uint32_t *list[3];
    uint32_t count[3];
    for (int k = 0; k < 3; k++) {
        list[k] = c->groups.list + c->groups.start[triangle[k]];
        count[k] = c->groups.start[triangle[k] + 1] - c->groups.start[triangle[k]];
        if (count[k] > MAX_CANDIDATES) count[k] = MAX_CANDIDATES;
    }
    if (count[0] * count[1] * count[2] == 1) {
        for (int k = 0; k < 3; k++) triangle[k] = list[k][0];
        return;
    }
    const prom_vertex *v = c->work->vertices.data;
    float normal[3], fit[3][MAX_CANDIDATES], best = INFINITY;
    prom_triangle_cross(v[triangle[0]].position, v[triangle[1]].position,
                        v[triangle[2]].position, normal);
    glm_vec3_normalize(normal);
    for (int k = 0; k < 3; k++)
        for (uint32_t i = 0; i < count[k]; i++) {
            const int8_t *n = v[list[k][i]].normal;
            fit[k][i] = (normal[0] * n[0] + normal[1] * n[1] + normal[2] * n[2]) / 127.0f;
        }
    for (uint32_t i = 0; i < count[0]; i++)
        for (uint32_t j = 0; j < count[1]; j++)
            for (uint32_t l = 0; l < count[2]; l++) {
                uint32_t pick[3] = {list[0][i], list[1][j], list[2][l]};
                float cost = chart_penalty(c, pick) - fit[0][i] - fit[1][j] - fit[2][l];
                if (cost >= best) continue;
                best = cost;
                memcpy(triangle, pick, sizeof pick);
            }
}

void prom_choose_corners(const prom_work *work, const prom_index_array *faces,
                         const uint32_t *representative, bool plain, prom_index_array *out)
{
    uint32_t *charts = plain ? NULL : find_charts(work, faces);
    chooser c = {work, charts, group_members(work, faces, representative)};
    for (size_t i = 0; i < out->count; i += 3) choose(&c, out->data + i);
    prom_free(c.groups.start);
    prom_free(c.groups.list);
    prom_free(charts);
}

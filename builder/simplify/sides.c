#include "builder/simplify/sides.h"

#include "builder/simplify/face_match.h"

// Drops repeated triangles; back[t]: the triangle whose back side t is, or PROM_NONE. A second
// back side is a repetition too.
static void match(const prom_work *work, uint8_t *marks, uint32_t *back)
{
    uint32_t triangles = (uint32_t)(work->indices.count / 3);
    uint32_t *places = prom_alloc(work->indices.count, sizeof *places);
    uint32_t *same = prom_alloc(triangles, sizeof *same);
    for (size_t i = 0; i < work->indices.count; i++)
        places[i] = work->place.data[work->indices.data[i]];
    prom_match_faces(places, NULL, triangles, same, back);
    for (uint32_t t = 0; t < triangles; t++) {
        if (same[t] != PROM_NONE) marks[t] = PROM_SIDE_DROP;
        if (back[t] > t) back[t] = PROM_NONE; // that is the front
    }
    prom_free(places);
    prom_free(same);
}

static uint32_t root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

// Whether a triangle and its back side have the same normals, on the whole.
static bool alike(const prom_work *work, uint32_t t, uint32_t u)
{
    int sums[2][3] = {{0}};
    for (uint32_t k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) {
            sums[0][a] += work->vertices.data[work->indices.data[t * 3 + k]].normal[a];
            sums[1][a] += work->vertices.data[work->indices.data[u * 3 + k]].normal[a];
        }
    return sums[0][0] * sums[1][0] + sums[0][1] * sums[1][1] + sums[0][2] * sums[1][2] > 0;
}

void prom_work_mark_sides(const prom_work *work, uint8_t *marks)
{
    uint32_t triangles = (uint32_t)(work->indices.count / 3);
    uint32_t places = (uint32_t)work->place.count;
    uint32_t *back = prom_alloc(triangles, sizeof *back);
    uint32_t *parent = prom_alloc(places, sizeof *parent);
    uint32_t *total = prom_calloc(places, sizeof *total);
    uint32_t *backs = prom_calloc(places, sizeof *backs);
    match(work, marks, back);
    for (uint32_t i = 0; i < places; i++) parent[i] = i;
    for (uint32_t i = 0; i < triangles * 3; i++) {
        uint32_t a = root(parent, work->place.data[work->indices.data[i - i % 3]]);
        uint32_t b = root(parent, work->place.data[work->indices.data[i]]);
        if (a < b) parent[b] = a;
        if (b < a) parent[a] = b;
    }
    for (uint32_t t = 0; t < triangles; t++) {
        uint32_t r = root(parent, work->place.data[work->indices.data[t * 3]]);
        total[r] += marks[t] != PROM_SIDE_DROP;
        backs[r] += back[t] != PROM_NONE;
    }
    for (uint32_t t = 0; t < triangles; t++) {
        if (back[t] == PROM_NONE) continue;
        uint32_t r = root(parent, work->place.data[work->indices.data[t * 3]]);
        // Nine fronts of ten; fronts and backs are both counted in the total.
        if (backs[r] * (uint64_t)19 < total[r] * (uint64_t)9) continue;
        marks[t] = PROM_SIDE_DROP;
        marks[back[t]] = alike(work, t, back[t]) ? PROM_SIDE_DOUBLE_LIKE : PROM_SIDE_DOUBLE;
    }
    prom_free(back);
    prom_free(parent);
    prom_free(total);
    prom_free(backs);
}

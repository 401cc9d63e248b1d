#include "builder/simplify/sides.h"

// A triangle's places, turned so that the smallest is first: equal triangles, equal triples.
static void triple_of(const prom_work *work, uint32_t triangle, uint32_t triple[3])
{
    const uint32_t *t = work->indices.data + (size_t)triangle * 3;
    uint32_t p[3];
    for (int k = 0; k < 3; k++) p[k] = work->place.data[t[k]];
    int low = p[0] < p[1] ? (p[0] < p[2] ? 0 : 2) : (p[1] < p[2] ? 1 : 2);
    for (int k = 0; k < 3; k++) triple[k] = p[(low + k) % 3];
}

static uint32_t triple_hash(const uint32_t triple[3])
{
    // The last two unordered: both windings must land in the same chain.
    uint64_t a = triple[1], b = triple[2];
    uint64_t h = triple[0] * 0x9E3779B97F4A7C15u ^ (a + b) * 0xC2B2AE3D27D4EB4Fu ^
                 (a ^ b) * 0x165667B19E3779F9u;
    return (uint32_t)(h >> 32) ^ (uint32_t)h;
}

// Drops repeated triangles; back[t]: the triangle whose back side t is, or PROM_NONE. A second
// back side is a repetition too.
static void match(const prom_work *work, uint8_t *marks, uint32_t *back)
{
    uint32_t triangles = (uint32_t)(work->indices.count / 3), size = 16;
    while (size < triangles * 2) size *= 2;
    uint32_t *table = prom_calloc(size, sizeof *table);
    for (uint32_t t = 0; t < triangles; t++) {
        uint32_t me[3], other[3];
        triple_of(work, t, me);
        uint32_t slot = triple_hash(me) & (size - 1), front = PROM_NONE;
        for (; table[slot]; slot = (slot + 1) & (size - 1)) {
            uint32_t o = table[slot] - 1;
            triple_of(work, o, other);
            if (me[0] != other[0]) continue;
            if (me[1] == other[1] && me[2] == other[2]) break;
            if (me[1] == other[2] && me[2] == other[1] && front == PROM_NONE) front = o;
        }
        if (table[slot]) {
            marks[t] = PROM_SIDE_DROP;
            continue;
        }
        table[slot] = t + 1;
        back[t] = front;
    }
    prom_free(table);
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
    memset(back, 0xff, triangles * sizeof *back);
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

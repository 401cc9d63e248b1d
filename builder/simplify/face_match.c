#include "builder/simplify/face_match.h"

#include "metaobj/base/alloc.h"
#include "metaobj/mesh.h"

#include <stdbool.h>

typedef struct matcher {
    const uint32_t *points, *groups;
    uint32_t *table; // heads of chains, triangle + 1
    uint32_t *next;
    uint32_t size;
    uint32_t *same, *opposite;
} matcher;

// A triangle's points, turned so that the smallest is first: equal triangles, equal triples.
static void triple_of(const matcher *m, uint32_t triangle, uint32_t triple[3])
{
    const uint32_t *p = m->points + (size_t)triangle * 3;
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

static bool same_group(const matcher *m, uint32_t a, uint32_t b)
{
    return !m->groups || m->groups[a] == m->groups[b];
}

static void match_one(matcher *m, uint32_t t)
{
    uint32_t me[3], other[3];
    triple_of(m, t, me);
    uint32_t *head = &m->table[triple_hash(me) & (m->size - 1)], front = PROM_NONE;
    for (uint32_t i = *head; i; i = m->next[i - 1]) {
        uint32_t o = i - 1;
        triple_of(m, o, other);
        if (me[0] != other[0]) continue;
        if (me[1] == other[1] && me[2] == other[2] && same_group(m, o, t)) {
            m->same[t] = o;
            return;
        }
        if (me[1] != other[2] || me[2] != other[1]) continue;
        front = o; // in the end the earliest: chains start with the latest
        // Never by a repetition: what it repeats has met o before.
        if (m->opposite[o] == PROM_NONE) m->opposite[o] = t;
    }
    m->opposite[t] = front;
    m->next[t] = *head;
    *head = t + 1;
}

void prom_match_faces(const uint32_t *points, const uint32_t *groups, uint32_t triangles,
                      uint32_t *same, uint32_t *opposite)
{
    matcher m = {points, groups, .size = 16, .same = same, .opposite = opposite};
    while (m.size < triangles) m.size *= 2;
    m.table = prom_calloc(m.size, sizeof *m.table);
    m.next = prom_alloc(triangles, sizeof *m.next);
    for (uint32_t t = 0; t < triangles; t++) same[t] = opposite[t] = PROM_NONE;
    for (uint32_t t = 0; t < triangles; t++) match_one(&m, t);
    prom_free(m.table);
    prom_free(m.next);
}

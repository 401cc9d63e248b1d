// What must hold of the records of any collapses: each returns NULL, or says what does not.
#ifndef PROM_TESTS_RECORD_PROPERTIES_H
#define PROM_TESTS_RECORD_PROPERTIES_H

#include "builder/simplify/records.h"
#include "tests/mesh_facts.h"
#include "tests/random_model.h"

// A mesh before and after recorded collapses.
typedef struct record_subject {
    const prom_records *records;
    const uint32_t *original, *last; // corners
    const uint32_t *point;           // per vertex; NULL: a vertex is its point
    const prom_vertex *vertices;     // NULL: positions are not looked at
    uint32_t vertex_count;           // with those made
    bool joined;                     // collapses of pairs without an edge join pieces
} record_subject;

static inline uint32_t record_count(const record_subject *s)
{
    return (uint32_t)s->records->records.count;
}

static inline mesh_facts record_facts(const record_subject *s, const uint32_t *corners)
{
    return mesh_facts_of(corners, s->records->triangle_slots, s->point, s->vertex_count);
}

// What the states are measured by.
static inline mesh_facts record_original(const record_subject *s)
{
    mesh_facts original = record_facts(s, s->original);
    if (s->joined) original.most_sharing = original.most_along = UINT32_MAX;
    return original;
}

static inline bool record_same(const record_subject *s, const uint32_t *a, const uint32_t *b)
{
    return !memcmp(a, b, 3 * (size_t)s->records->triangle_slots * sizeof *a);
}

// Vertices of one point that are in use stand at one place: nothing gapes.
static inline const char *record_gapes(const record_subject *s, const uint32_t *corners)
{
    if (!s->vertices || !s->point) return NULL;
    const char *wrong = NULL;
    uint32_t *first = prom_alloc(s->vertex_count, sizeof *first); // per point
    memset(first, 0xff, s->vertex_count * sizeof *first);
    for (size_t c = 0; c < 3 * (size_t)s->records->triangle_slots; c++) {
        if (corners[c] == PROM_NONE) continue;
        uint32_t *own = first + s->point[corners[c]];
        if (*own == PROM_NONE) *own = corners[c];
        const float *a = s->vertices[*own].position, *b = s->vertices[corners[c]].position;
        if (a[0] != b[0] || a[1] != b[1] || a[2] != b[2]) // -0 is 0
            wrong = "vertices of one point stand apart";
    }
    prom_free(first);
    return wrong;
}

static inline const char *record_state(const record_subject *s, const prom_replay *replay,
                                       const mesh_facts *original)
{
    const mesh_facts now = record_facts(s, replay->corners);
    const char *wrong = mesh_facts_spoiled(&now, original);
    if (!wrong && now.triangles != replay->triangles) wrong = "triangles are miscounted";
    return wrong ? wrong : record_gapes(s, replay->corners);
}

static inline const char *records_are_in_order(const record_subject *s)
{
    for (uint32_t i = 0; i < record_count(s); i++) {
        const prom_record_part part = prom_record_dependencies(s->records, i);
        if (part.first > part.end) return "a record's dependencies end before they begin";
        for (uint32_t k = part.first; k < part.end; k++) {
            const uint32_t *own = s->records->dependencies.data + k;
            if (*own >= i) return "a record depends on one that is not earlier";
            if (k > part.first && own[-1] >= *own) return "dependencies do not ascend";
        }
        const prom_record_part vertices = prom_record_vertices(s->records, i);
        if (vertices.first > vertices.end || vertices.end > s->vertex_count)
            return "a record made vertices that do not exist";
    }
    return NULL;
}

static inline const char *records_undone_give_the_original(const record_subject *s)
{
    prom_replay replay;
    const char *wrong = NULL;
    prom_replay_init(&replay, s->records, s->original);
    for (uint32_t i = 0; i < record_count(s) && !wrong; i++) {
        if (!prom_replay_can_apply(&replay, i))
            wrong = "a record cannot be applied in order";
        else
            prom_replay_apply(&replay, i);
    }
    if (!wrong && !record_same(s, replay.corners, s->last))
        wrong = "all records applied are not the mesh that the engine left";
    for (uint32_t i = record_count(s); i-- && !wrong;) {
        if (!prom_replay_can_undo(&replay, i))
            wrong = "a record cannot be undone in order";
        else
            prom_replay_undo(&replay, i);
    }
    if (!wrong && !record_same(s, replay.corners, s->original))
        wrong = "all records undone are not the original";
    prom_replay_finish(&replay);
    return wrong;
}

static inline const char *record_prefixes_are_meshes(const record_subject *s, uint32_t samples,
                                                     uint64_t seed)
{
    prom_replay replay;
    const char *wrong = NULL;
    const mesh_facts original = record_original(s);
    prom_replay_init(&replay, s->records, s->original);
    for (uint32_t i = 0; i < samples && !wrong; i++) {
        const uint32_t count = random_below(&seed, record_count(s) + 1);
        prom_replay_seek(&replay, count);
        wrong = record_state(s, &replay, &original);
        for (uint32_t k = 0; k < record_count(s) && !wrong; k++)
            if (replay.applied[k] != (k < count)) wrong = "seeking applied others";
    }
    if (!wrong) prom_replay_seek(&replay, record_count(s));
    if (!wrong && !record_same(s, replay.corners, s->last))
        wrong = "not where the engine ended";
    if (!wrong) prom_replay_seek(&replay, 0);
    if (!wrong && !record_same(s, replay.corners, s->original)) wrong = "not the original";
    prom_replay_finish(&replay);
    return wrong;
}

// Applies all that are left, in a random order that respects the dependencies.
static inline void record_apply_rest(prom_replay *replay, uint32_t count, uint64_t *seed)
{
    uint32_t *order = prom_alloc(count, sizeof *order), left = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!replay->applied[i]) order[left++] = i;
    while (left) {
        uint32_t kept = 0;
        for (uint32_t i = 0; i < left; i++) {
            const uint32_t k = i + random_below(seed, left - i), record = order[k];
            order[k] = order[i];
            if (prom_replay_can_apply(replay, record))
                prom_replay_apply(replay, record);
            else
                order[kept++] = record;
        }
        left = kept;
    }
    prom_free(order);
}

// Random steps, now mostly forward, now mostly back; after all of them everything is applied.
static inline const char *record_walks_are_meshes(const record_subject *s, uint32_t steps,
                                                  uint32_t samples, uint64_t seed)
{
    prom_replay replay;
    const char *wrong = NULL;
    const uint32_t count = record_count(s), every = steps / samples + 1;
    const mesh_facts original = record_original(s);
    prom_replay_init(&replay, s->records, s->original);
    for (uint32_t i = 0, forward = 8; i < steps && count && !wrong; i++) {
        if (!random_below(&seed, 2 * count)) forward = 1 + random_below(&seed, 9);
        const uint32_t record = random_below(&seed, count);
        const bool apply = random_below(&seed, 10) < forward;
        if (apply && prom_replay_can_apply(&replay, record)) prom_replay_apply(&replay, record);
        if (!apply && prom_replay_can_undo(&replay, record)) prom_replay_undo(&replay, record);
        if (i % every == 0) wrong = record_state(s, &replay, &original);
    }
    if (!wrong) record_apply_rest(&replay, count, &seed);
    if (!wrong && !record_same(s, replay.corners, s->last))
        wrong = "another order of all records ends elsewhere";
    prom_replay_finish(&replay);
    return wrong;
}

// The record and all that it rests on, ascending; returns how many. chosen: per record, zeroed
// before, and left so.
static inline uint32_t record_ancestors(const prom_records *records, uint32_t record,
                                        uint8_t *chosen, uint32_t *ancestors)
{
    uint32_t count = 0;
    chosen[record] = 1;
    for (uint32_t i = record + 1; i-- > 0;) {
        if (!chosen[i]) continue;
        chosen[i] = 0;
        ancestors[count++] = i;
        const prom_record_part part = prom_record_dependencies(records, i);
        for (uint32_t k = part.first; k < part.end; k++)
            chosen[records->dependencies.data[k]] = 1;
    }
    for (uint32_t i = 0; i < count / 2; i++) {
        const uint32_t other = ancestors[i];
        ancestors[i] = ancestors[count - 1 - i];
        ancestors[count - 1 - i] = other;
    }
    return count;
}

// A record with what it rests on, nothing else.
static inline const char *records_stand_alone(const record_subject *s, uint32_t samples,
                                              uint64_t seed)
{
    prom_replay replay;
    const char *wrong = NULL;
    const uint32_t all = record_count(s);
    const mesh_facts original = record_original(s);
    uint8_t *chosen = prom_calloc(all, 1);
    uint32_t *ancestors = prom_alloc(all, sizeof *ancestors);
    prom_replay_init(&replay, s->records, s->original);
    for (uint32_t i = 0; i < samples && all && !wrong; i++) {
        const uint32_t record = random_below(&seed, all);
        const uint32_t count = record_ancestors(s->records, record, chosen, ancestors);
        for (uint32_t k = 0; k < count; k++) prom_replay_apply(&replay, ancestors[k]);
        wrong = record_state(s, &replay, &original);
        for (uint32_t k = count; k-- > 0;) prom_replay_undo(&replay, ancestors[k]);
        if (!wrong && !record_same(s, replay.corners, s->original))
            wrong = "undoing a record and its ancestors left something";
    }
    prom_replay_finish(&replay);
    prom_free(ancestors);
    prom_free(chosen);
    return wrong;
}

static inline const char *records_hold(const record_subject *s, uint32_t samples, uint64_t seed)
{
    const char *wrong = records_are_in_order(s);
    if (!wrong) wrong = records_undone_give_the_original(s);
    if (!wrong) wrong = record_prefixes_are_meshes(s, samples, seed);
    if (!wrong) wrong = record_walks_are_meshes(s, 40 * record_count(s), 4 * samples, seed);
    if (!wrong) wrong = records_stand_alone(s, samples, seed);
    return wrong;
}

#endif

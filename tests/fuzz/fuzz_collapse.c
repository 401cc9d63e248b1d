// LINK: prom_simplify prom_metaobj
// MAX: 2048
// Edge collapse of any mesh: a byte of options, one of the number of vertices, then vertices of
// seven bytes, then indices. Positions are small whole numbers, so that points, edges and faces
// repeat, lie on each other and have no area; a few stand for what is no number and for
// extremes.
#include "fuzz.h"

#include "builder/simplify/engine.h"

#include <math.h>
#include <string.h>

const unsigned fuzz_spoilings = 400;

enum { VERTEX_BYTES = 7 };

static float coordinate(uint8_t byte)
{
    static const float odd[] = {NAN, INFINITY, -INFINITY, 1e30f, -1e-30f, 1e19f, -0.0f, 3e38f};
    return byte >= 248 ? odd[byte - 248] : (float)(byte % 8);
}

static prom_vertex vertex_of(const uint8_t *bytes)
{
    prom_vertex v = {0};
    for (int k = 0; k < 3; k++) v.position[k] = coordinate(bytes[k]);
    v.normal[bytes[3] % 3] = bytes[3] & 8 ? 127 : -127;
    v.uv[0] = coordinate(bytes[4]);
    v.uv[1] = (float)bytes[5] / 16;
    v.color[bytes[5] % 4] = bytes[5];
    return v;
}

static void check_mesh(const prom_collapse_mesh *mesh)
{
    uint32_t triangles = 0;
    for (uint32_t t = 0; t < mesh->triangle_slots; t++) {
        const uint32_t *c = mesh->corners + 3 * t;
        if (c[0] == PROM_NONE) continue;
        triangles++;
        for (int k = 0; k < 3; k++) {
            fuzz_check(c[k] < mesh->vertices.count);
            const uint32_t point = mesh->point.data[c[k]];
            fuzz_check(point != mesh->point.data[c[(k + 1) % 3]]);
            fuzz_check(mesh->group.data[c[k]] == mesh->group.data[c[0]]);
            for (int a = 0; a < 3; a++) {
                fuzz_check(isfinite(mesh->position[point][a]));
                fuzz_check(mesh->vertices.data[c[k]].position[a] == mesh->position[point][a]);
            }
        }
    }
    fuzz_check(triangles == mesh->triangles);
}

static void collapse(const prom_vertex *vertices, uint32_t count, const uint32_t *groups,
                     const uint32_t *indices, size_t index_count, uint8_t bits)
{
    prom_collapse_mesh mesh;
    prom_collapse_mesh_init(&mesh, vertices, count, groups, indices, index_count);
    check_mesh(&mesh);
    const uint32_t triangles = mesh.triangles;
    uint32_t *original = prom_alloc(3 * (size_t)mesh.triangle_slots, sizeof *original);
    memcpy(original, mesh.corners, 3 * (size_t)mesh.triangle_slots * sizeof *original);
    prom_records records;
    prom_records_init(&records, mesh.triangle_slots);
    const prom_collapse_options options = {.metric = prom_collapse_metric_at(bits % 3),
                                           .half_edge = bits & 4,
                                           .lock_border = bits & 8,
                                           .pair_distance = bits & 16 ? 1.5f : 0,
                                           .records = &records};
    prom_collapser *collapser = prom_collapser_create(&mesh, &options);
    prom_collapser_run(collapser, triangles / 2, bits & 32 ? 0.5f : INFINITY);
    check_mesh(&mesh);
    const float error = prom_collapser_run(collapser, 0, INFINITY);
    fuzz_check(error >= 0);
    check_mesh(&mesh);
    prom_collapser_destroy(collapser);
    prom_replay replay;
    prom_replay_init(&replay, &records, original);
    prom_replay_seek(&replay, (uint32_t)records.records.count);
    fuzz_check(replay.triangles == mesh.triangles);
    prom_replay_finish(&replay);
    prom_records_finish(&records);
    prom_free(original);
    prom_mesh out;
    prom_collapse_mesh_emit(&mesh, &out);
    fuzz_check(!prom_mesh_check(&out, UINT32_MAX));
    prom_mesh_finish(&out);
    prom_collapse_mesh_finish(&mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    if (count < 2) return 0;
    const uint8_t bits = bytes[0];
    const size_t fit = (count - 2) / VERTEX_BYTES;
    const uint32_t n = bytes[1] < fit ? bytes[1] : (uint32_t)fit;
    const uint8_t *rest = bytes + 2 + n * (size_t)VERTEX_BYTES;
    const size_t indices_left = n ? (size_t)(bytes + count - rest) / 3 * 3 : 0;
    prom_vertex vertices[256];
    uint32_t groups[256], indices[2048];
    fuzz_check(indices_left <= sizeof indices / sizeof *indices || count > 2048);
    if (count > 2048) return 0;
    for (uint32_t i = 0; i < n; i++) {
        vertices[i] = vertex_of(bytes + 2 + i * (size_t)VERTEX_BYTES);
        groups[i] = bytes[2 + i * (size_t)VERTEX_BYTES + 6] % 2;
    }
    size_t used = 0;
    for (size_t i = 0; i + 2 < indices_left; i += 3) {
        const uint32_t t[3] = {rest[i] % n, rest[i + 1] % n, rest[i + 2] % n};
        // A triangle is in one group.
        if (groups[t[0]] != groups[t[1]] || groups[t[0]] != groups[t[2]]) continue;
        memcpy(indices + used, t, sizeof t);
        used += 3;
    }
    collapse(vertices, n, groups, indices, used, bits);
    return 0;
}

// A grid of 6 x 6 points, in each way.
void fuzz_seeds(void (*each)(void *user, const char *name, const void *bytes, size_t count),
                void *user)
{
    enum { N = 6 };
    uint8_t bytes[2 + N * N * VERTEX_BYTES + (N - 1) * (N - 1) * 6] = {0, N * N};
    uint8_t *at = bytes + 2;
    for (uint8_t i = 0; i < N * N; i++) {
        const uint8_t vertex[VERTEX_BYTES] = {i % N, (uint8_t)(i * 7 % 3), i / N, 9, i % N, i,
                                              0};
        memcpy(at, vertex, sizeof vertex);
        at += sizeof vertex;
    }
    for (uint8_t i = 0; i < N * (N - 1); i++) {
        if (i % N == N - 1) continue;
        const uint8_t quad[6] = {i, i + N, i + 1, i + 1, i + N, i + N + 1};
        memcpy(at, quad, sizeof quad);
        at += sizeof quad;
    }
    for (uint8_t way = 0; way < 12; way++) {
        char name[16];
        bytes[0] = (uint8_t)(way * 5);
        snprintf(name, sizeof name, "%u", way);
        each(user, name, bytes, (size_t)(at - bytes));
    }
}

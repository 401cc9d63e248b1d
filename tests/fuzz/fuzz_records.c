// LINK: prom_simplify prom_metaobj
// MAX: 1024
// Any small mesh: collapsed under any options, its records must hold.
//
// Byte 0 says how, byte 1 how many vertices; these come as four bytes each
// (place, and one for the rest), then triangles as three bytes each.
#include "fuzz.h"

#include "builder/simplify/engine.h"
#include "tests/record_properties.h"

#include <math.h>

const unsigned fuzz_spoilings = 40;

enum { VERTEX_BYTES = 4, HALF_EDGE = 1, LOCK_BORDER = 2, LOCKS = 4, PAIRS = 8, ODD = 16 };

typedef struct input {
    PROM_ARRAY(prom_vertex) vertices;
    PROM_ARRAY(uint32_t) groups;
    PROM_ARRAY(uint8_t) locked;
    PROM_ARRAY(uint32_t) indices;
} input;

static float coordinate(uint8_t byte, bool odd)
{
    if (odd && byte == 255) return NAN;
    if (odd && byte == 254) return INFINITY;
    if (odd && byte == 253) return 1e30f;
    return (float)byte / 16.0f;
}

static void add_vertex(input *in, const uint8_t *bytes, bool odd)
{
    prom_vertex v = {.color = {bytes[3], 255, 255, 255}};
    for (int a = 0; a < 3; a++) v.position[a] = coordinate(bytes[a], odd);
    v.normal[bytes[3] % 3] = bytes[3] & 4 ? 127 : -127;
    v.uv[0] = (float)(bytes[3] >> 3 & 3);
    prom_array_push(&in->vertices, v);
    prom_array_push(&in->groups, bytes[3] >> 7);
    prom_array_push(&in->locked, bytes[3] >> 6 & 1);
}

// All of one group.
static void add_triangle(input *in, const uint8_t *bytes)
{
    uint32_t t[3];
    for (int k = 0; k < 3; k++) t[k] = bytes[k] % (uint32_t)in->vertices.count;
    const uint32_t *groups = in->groups.data;
    if (groups[t[0]] != groups[t[1]] || groups[t[0]] != groups[t[2]]) return;
    for (int k = 0; k < 3; k++) prom_array_push(&in->indices, t[k]);
}

static void read_input(input *in, const uint8_t *bytes, size_t count)
{
    const uint8_t *end = bytes + count, *at = bytes + 2;
    const uint32_t wanted = bytes[1];
    for (uint32_t i = 0; i < wanted && end - at >= VERTEX_BYTES; i++, at += VERTEX_BYTES)
        add_vertex(in, at, bytes[0] & ODD);
    const size_t vertices = in->vertices.count;
    for (; vertices && end - at >= 3; at += 3) add_triangle(in, at);
}

static void collapse_and_check(const input *in, uint8_t how, uint8_t metric)
{
    prom_collapse_mesh mesh;
    prom_records records;
    prom_collapse_mesh_init(&mesh, in->vertices.data, (uint32_t)in->vertices.count,
                            in->groups.data, in->indices.data, in->indices.count);
    uint32_t *original = prom_alloc(3 * (size_t)mesh.triangle_slots, sizeof *original);
    if (mesh.triangle_slots)
        memcpy(original, mesh.corners, 3 * (size_t)mesh.triangle_slots * sizeof *original);
    prom_records_init(&records, mesh.triangle_slots);
    const prom_collapse_options options = {
        .metric = prom_collapse_metric_at(metric % 3),
        .half_edge = how & HALF_EDGE,
        .lock_border = how & LOCK_BORDER,
        .locked = how & LOCKS ? in->locked.data : NULL,
        .pair_distance = how & PAIRS ? 1.0f : 0.0f,
        .records = &records,
    };
    prom_collapser *collapser = prom_collapser_create(&mesh, &options);
    prom_collapser_run(collapser, 0, INFINITY);
    prom_collapser_destroy(collapser);
    const record_subject subject = {.records = &records,
                                    .original = original,
                                    .last = mesh.corners,
                                    .point = mesh.point.data,
                                    .vertices = mesh.vertices.data,
                                    .vertex_count = (uint32_t)mesh.vertices.count,
                                    .joined = how & PAIRS};
    const char *wrong = records_hold(&subject, 8, 1);
    if (wrong) fprintf(stderr, "%s\n", wrong);
    fuzz_check(!wrong);
    prom_free(original);
    prom_records_finish(&records);
    prom_collapse_mesh_finish(&mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    if (count < 2) return 0;
    input in = {0};
    read_input(&in, bytes, count);
    collapse_and_check(&in, bytes[0], bytes[0] >> 5);
    prom_array_finish(&in.vertices);
    prom_array_finish(&in.groups);
    prom_array_finish(&in.locked);
    prom_array_finish(&in.indices);
    return 0;
}

// A bumpy sheet, 6 by 6 quads.
static size_t make_seed(uint8_t *out, uint8_t how)
{
    size_t count = 0;
    out[count++] = how;
    out[count++] = 49;
    for (uint32_t i = 0; i < 49; i++) {
        const uint32_t x = i % 7, y = i / 7;
        const uint8_t vertex[VERTEX_BYTES] = {(uint8_t)(16 * x), (uint8_t)(16 * y),
                                              (uint8_t)(x * x * y % 11),
                                              (uint8_t)(x > 3 ? 1 : 0)};
        memcpy(out + count, vertex, sizeof vertex);
        count += sizeof vertex;
    }
    for (uint32_t i = 0; i < 36; i++) {
        const uint8_t a = (uint8_t)(i / 6 * 7 + i % 6), b = a + 1, c = a + 7, d = a + 8;
        const uint8_t both[6] = {a, b, d, a, d, c};
        memcpy(out + count, both, sizeof both);
        count += sizeof both;
    }
    return count;
}

void fuzz_seeds(void (*each)(void *user, const char *name, const void *bytes, size_t count),
                void *user)
{
    for (uint32_t how = 0; how < 96; how++) { // each metric with each set of flags
        uint8_t seed[512];
        char name[16];
        snprintf(name, sizeof name, "%u", how);
        each(user, name, seed, make_seed(seed, (uint8_t)how));
    }
}

// LINK: prom_simplify prom_metaobj
// Records that the engine makes, with each metric, half and full edges, on surfaces with seams,
// creases, groups and borders, and on what is no surface.
#include "builder/simplify/engine.h"
#include "record_properties.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

typedef enum shape_kind { SHEET, TUBE, TORUS, BALL, RAG, SOUP, SHAPES } shape_kind;

static const char *const shape_names[SHAPES] = {"sheet", "tube", "torus",
                                                "ball",  "rag",  "soup"};

typedef struct shape {
    PROM_ARRAY(prom_vertex) vertices;
    PROM_ARRAY(uint32_t) groups;
    PROM_ARRAY(uint32_t) indices;
} shape;

typedef struct shape_options {
    shape_kind kind;
    bool faceted; // each triangle has vertices and a normal of its own
    bool grouped; // two submeshes
    uint32_t columns, rows;
} shape_options;

// ---- shapes

static void place(shape_kind kind, float u, float v, float out[3])
{
    const float a = 6.2831853f * u, b = (kind == BALL ? 3.1415927f : 6.2831853f) * v;
    const float r = kind == TORUS ? 2.0f + cosf(b) : kind == BALL ? 2.0f * sinf(b) : 1.0f;
    const float bumps = 1.0f + 0.1f * sinf(5.0f * a) * sinf(3.0f * b);
    if (kind == SHEET || kind == RAG) {
        out[0] = 4.0f * u, out[1] = bumps, out[2] = 4.0f * v;
        return;
    }
    out[0] = r * bumps * cosf(a), out[2] = r * bumps * sinf(a);
    out[1] = kind == TORUS ? sinf(b) : kind == BALL ? 2.0f * cosf(b) : 4.0f * v;
}

// Vertices at both ends of the wrap have the same place, to the bit, and other uvs: a seam.
static void add_vertices(shape *s, const shape_options *o)
{
    for (uint32_t y = 0; y <= o->rows; y++)
        for (uint32_t x = 0; x <= o->columns; x++) {
            const bool wraps = o->kind != SHEET && o->kind != RAG, closes = o->kind == TORUS;
            const bool pole = o->kind == BALL && (y == 0 || y == o->rows);
            const float u = (float)(wraps ? x % o->columns : x) / (float)o->columns;
            const float v = (float)(closes ? y % o->rows : y) / (float)o->rows;
            prom_vertex vertex = {.color = {255, 255, 255, 255}};
            place(o->kind, u, v, vertex.position);
            if (pole) vertex.position[0] = vertex.position[2] = 0.0f;
            prom_pack_normal(vertex.position, vertex.normal);
            vertex.uv[0] = (float)x / (float)o->columns;
            vertex.uv[1] = (float)y / (float)o->rows;
            prom_array_push(&s->vertices, vertex);
        }
}

static bool same_place(const shape *s, uint32_t a, uint32_t b)
{
    return !memcmp(s->vertices.data[a].position, s->vertices.data[b].position,
                   sizeof s->vertices.data->position);
}

static void add_triangle(shape *s, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    if (same_place(s, a, b) || same_place(s, b, c) || same_place(s, c, a)) return; // a pole
    for (int k = 0; k < 3; k++) prom_array_push(&s->indices, corners[k]);
}

static void add_surface(shape *s, const shape_options *o)
{
    add_vertices(s, o);
    for (uint32_t y = 0; y < o->rows; y++)
        for (uint32_t x = 0; x < o->columns; x++) {
            const uint32_t a = y * (o->columns + 1) + x, b = a + 1, c = b + o->columns + 1;
            add_triangle(s, a, c, b);
            add_triangle(s, a, c - 1, c);
        }
}

// Any triangles over a few points: edges of many triangles, pinched points, repeats.
static void add_soup(shape *s, const shape_options *o, uint64_t *seed)
{
    const uint32_t points = o->columns * 4;
    for (uint32_t i = 0; i < points; i++) {
        prom_vertex v = {.color = {255, 255, 255, 255}};
        for (int a = 0; a < 3; a++) v.position[a] = random_between(seed, -1, 1);
        prom_pack_normal(v.position, v.normal);
        prom_array_push(&s->vertices, v);
    }
    for (uint32_t i = 0; i < o->columns * o->rows; i++)
        add_triangle(s, random_below(seed, points), random_below(seed, points),
                     random_below(seed, points));
}

// A third of the triangles goes: sheets that meet in points only.
static void tear(shape *s, uint64_t *seed)
{
    size_t kept = 0;
    for (size_t i = 0; i < s->indices.count; i += 3) {
        if (!random_below(seed, 3)) continue;
        memmove(s->indices.data + kept, s->indices.data + i, 3 * sizeof *s->indices.data);
        kept += 3;
    }
    s->indices.count = kept;
}

// Every corner gets a vertex of its own.
static void make_faceted(shape *s)
{
    shape out = {0};
    for (uint32_t i = 0; i < s->indices.count; i++) {
        prom_vertex v = s->vertices.data[s->indices.data[i]];
        const uint32_t *t = s->indices.data + i / 3 * 3;
        const float *a = s->vertices.data[t[0]].position;
        vec3 normal, sides[2];
        for (int k = 0; k < 2; k++)
            for (int d = 0; d < 3; d++)
                sides[k][d] = s->vertices.data[t[k + 1]].position[d] - a[d];
        glm_vec3_crossn(sides[0], sides[1], normal);
        prom_pack_normal(normal, v.normal);
        prom_array_push(&out.vertices, v);
        prom_array_push(&out.indices, i);
    }
    prom_array_finish(&s->vertices);
    prom_array_finish(&s->indices);
    *s = out;
}

// The triangles of the second half stand on vertices of their own, of another group.
static void make_groups(shape *s, bool two)
{
    const uint32_t vertices = (uint32_t)s->vertices.count;
    for (uint32_t i = 0; i < vertices * (1 + two); i++) {
        prom_array_push(&s->groups, i / vertices);
        if (i >= vertices) {
            const prom_vertex copy = s->vertices.data[i - vertices];
            prom_array_push(&s->vertices, copy);
        }
    }
    for (size_t i = s->indices.count / 6 * 3; two && i < s->indices.count; i++)
        s->indices.data[i] += vertices;
}

static void shape_init(shape *s, const shape_options *o, uint64_t seed)
{
    *s = (shape){0};
    if (o->kind == SOUP)
        add_soup(s, o, &seed);
    else
        add_surface(s, o);
    if (o->kind == RAG) tear(s, &seed);
    if (o->faceted) make_faceted(s);
    make_groups(s, o->grouped);
}

static void shape_finish(shape *s)
{
    prom_array_finish(&s->vertices);
    prom_array_finish(&s->groups);
    prom_array_finish(&s->indices);
}

// ---- a recorded run

typedef struct run {
    prom_collapse_mesh mesh;
    prom_records records;
    uint32_t *original;
    uint8_t *locked;
} run;

static void run_init(run *r, const shape *s, prom_collapse_options options, bool locks)
{
    prom_collapse_mesh_init(&r->mesh, s->vertices.data, (uint32_t)s->vertices.count,
                            s->groups.data, s->indices.data, s->indices.count);
    const size_t corners = 3 * (size_t)r->mesh.triangle_slots;
    r->original = prom_alloc(corners, sizeof *r->original);
    if (corners) memcpy(r->original, r->mesh.corners, corners * sizeof *r->original);
    r->locked = prom_calloc(s->vertices.count, 1);
    for (uint32_t v = 0; v < s->vertices.count; v += 7) r->locked[v] = locks;
    prom_records_init(&r->records, r->mesh.triangle_slots);
    options.records = &r->records;
    options.locked = locks ? r->locked : NULL;
    prom_collapser *collapser = prom_collapser_create(&r->mesh, &options);
    prom_collapser_run(collapser, r->mesh.triangles / 2, INFINITY); // and on where it stopped
    prom_collapser_run(collapser, 0, INFINITY);
    prom_collapse_stats stats;
    prom_collapser_stats(collapser, &stats);
    assert_int_equal(stats.collapses, r->records.records.count);
    prom_collapser_destroy(collapser);
}

static void run_finish(run *r)
{
    prom_collapse_mesh_finish(&r->mesh);
    prom_records_finish(&r->records);
    prom_free(r->original);
    prom_free(r->locked);
}

static record_subject subject_of(const run *r)
{
    return (record_subject){.records = &r->records,
                            .original = r->original,
                            .last = r->mesh.corners,
                            .point = r->mesh.point.data,
                            .vertices = r->mesh.vertices.data,
                            .vertex_count = (uint32_t)r->mesh.vertices.count};
}

// ---- properties

static void check_run(const shape_options *o, const prom_collapse_options *options, bool locks,
                      uint64_t seed)
{
    shape s;
    run r;
    shape_init(&s, o, seed);
    run_init(&r, &s, *options, locks);
    record_subject subject = subject_of(&r);
    subject.joined = options->pair_distance > 0;
    const char *wrong = records_hold(&subject, 30, seed);
    if (!wrong && options->half_edge && r.mesh.vertices.count != s.vertices.count)
        wrong = "half edges made vertices";
    if (wrong)
        print_error("%s%s%s, %s, %s edges, pairs within %g%s, seed %u: %s\n",
                    shape_names[o->kind], o->faceted ? ", faceted" : "",
                    o->grouped ? ", grouped" : "", options->metric->name,
                    options->half_edge ? "half" : "full", (double)options->pair_distance,
                    locks ? ", locks" : "", (unsigned)seed, wrong);
    assert_null(wrong);
    if (o->kind < RAG && !locks && !o->faceted && !o->grouped)
        assert_true(r.records.records.count > 100); // there is something to replay
    run_finish(&r);
    shape_finish(&s);
}

static void check_shapes(const char *metric, bool half_edge)
{
    const prom_collapse_metric_class *class = prom_collapse_metric_find(metric);
    assert_non_null(class);
    for (uint32_t i = 0; i < SHAPES * 4; i++) {
        const shape_options o = {
            .kind = i / 4, .faceted = i & 1, .grouped = i & 2, .columns = 16, .rows = 14};
        for (uint32_t way = 0; way < 4; way++) {
            const prom_collapse_options options = {.metric = class,
                                                   .half_edge = half_edge,
                                                   .lock_border = way & 1,
                                                   .pair_distance = way == 2 ? 0.5f : 0.0f};
            check_run(&o, &options, way == 3, i + 1);
        }
    }
}

static void half_edges_by_qem(void **state)
{
    (void)state;
    check_shapes("qem", true);
}

static void full_edges_by_qem(void **state)
{
    (void)state;
    check_shapes("qem", false);
}

static void half_edges_by_attributes(void **state)
{
    (void)state;
    check_shapes("qem-attributes", true);
}

static void full_edges_by_attributes(void **state)
{
    (void)state;
    check_shapes("qem-attributes", false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_edges_by_qem),
        cmocka_unit_test(full_edges_by_qem),
        cmocka_unit_test(half_edges_by_attributes),
        cmocka_unit_test(full_edges_by_attributes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

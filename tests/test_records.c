// LINK: prom_simplify prom_metaobj
// Records of collapses that a naive collapser makes: any edge at random that keeps a surface
// one.
#include "record_properties.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

typedef PROM_ARRAY(uint32_t) number_array;

// ---- shapes: triangles over points

static void add_quad(number_array *corners, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    const uint32_t both[6] = {a, b, c, a, c, d};
    for (int k = 0; k < 6; k++) prom_array_push(corners, both[k]);
}

// Rows of quads, closed to a tube, a torus or not at all.
static uint32_t make_grid(number_array *corners, uint32_t columns, uint32_t rows, bool tube,
                          bool torus)
{
    const uint32_t across = columns + !tube, down = rows + !torus;
    for (uint32_t y = 0; y < rows; y++)
        for (uint32_t x = 0; x < columns; x++) {
            const uint32_t right = (x + 1) % across, below = (y + 1) % down;
            add_quad(corners, y * across + x, y * across + right, below * across + right,
                     below * across + x);
        }
    return across * down;
}

// A tube with a fan at each end: two points of many triangles.
static uint32_t make_sphere(number_array *corners, uint32_t columns, uint32_t rows)
{
    const uint32_t north = make_grid(corners, columns, rows, true, false), south = north + 1;
    for (uint32_t x = 0; x < columns; x++) {
        const uint32_t next = (x + 1) % columns, last = rows * columns;
        const uint32_t both[6] = {north, next, x, south, last + x, last + next};
        for (int k = 0; k < 6; k++) prom_array_push(corners, both[k]);
    }
    return south + 1;
}

// ---- the collapser

typedef struct naive {
    number_array corners;
    number_array point; // per vertex
    number_array star;  // triangles around both points
    uint8_t *linked;    // per point: bit 0: a neighbour of `from`, 1: of `to`
    uint32_t points;
    bool full; // each collapse makes a vertex; else `from` goes over into that of `to`
    prom_records records;
} naive;

static uint32_t *triangle_of(naive *n, uint32_t t)
{
    return n->corners.data + 3 * (size_t)t;
}

static int corner_at(naive *n, uint32_t t, uint32_t point)
{
    const uint32_t *c = triangle_of(n, t);
    for (int k = 0; k < 3 && c[k] != PROM_NONE; k++)
        if (n->point.data[c[k]] == point) return k;
    return -1;
}

static void find_star(naive *n, uint32_t from, uint32_t to)
{
    n->star.count = 0;
    for (uint32_t t = 0; t < n->corners.count / 3; t++)
        if (corner_at(n, t, from) >= 0 || corner_at(n, t, to) >= 0)
            prom_array_push(&n->star, t);
}

// The corner that is at neither; the star's triangles along the edge have one.
static uint32_t opposite(naive *n, uint32_t t, uint32_t from, uint32_t to)
{
    for (int k = 0; k < 3; k++) {
        const uint32_t p = n->point.data[triangle_of(n, t)[k]];
        if (p != from && p != to) return p;
    }
    return PROM_NONE;
}

static uint32_t triangles_along(naive *n, uint32_t a, uint32_t b)
{
    uint32_t count = 0;
    for (size_t i = 0; i < n->star.count; i++)
        count += corner_at(n, n->star.data[i], a) >= 0 && corner_at(n, n->star.data[i], b) >= 0;
    return count;
}

static bool is_open(naive *n, uint32_t point)
{
    for (size_t i = 0; i < n->star.count; i++) {
        if (corner_at(n, n->star.data[i], point) < 0) continue;
        for (int k = 0; k < 3; k++) {
            const uint32_t other = n->point.data[triangle_of(n, n->star.data[i])[k]];
            if (other != point && triangles_along(n, point, other) == 1) return true;
        }
    }
    return false;
}

static uint32_t count_shared_neighbours(naive *n, uint32_t from, uint32_t to)
{
    uint32_t count = 0;
    memset(n->linked, 0, n->points);
    for (size_t i = 0; i < n->star.count; i++) {
        const uint32_t t = n->star.data[i];
        const int at = (corner_at(n, t, from) >= 0) | (corner_at(n, t, to) >= 0) << 1;
        for (int k = 0; k < 3; k++)
            n->linked[n->point.data[triangle_of(n, t)[k]]] |= (uint8_t)at;
    }
    n->linked[from] = n->linked[to] = 0;
    for (uint32_t p = 0; p < n->points; p++) count += n->linked[p] == 3;
    return count;
}

// The link condition (Dey, Edelsbrunner, Guha and Nekhayev 1999) with an end of all borders.
static bool keeps_a_surface(naive *n, uint32_t from, uint32_t to)
{
    const uint32_t along = triangles_along(n, from, to);
    if (!along || count_shared_neighbours(n, from, to) != along) return false;
    if (along == 2 && is_open(n, from) && is_open(n, to)) return false;
    for (size_t i = 0; i < n->star.count; i++) { // an edge in both links: a tetrahedron
        const uint32_t t = n->star.data[i];
        if (corner_at(n, t, from) < 0 || corner_at(n, t, to) >= 0) continue;
        for (size_t j = 0; j < n->star.count; j++) {
            const uint32_t u = n->star.data[j];
            if (corner_at(n, u, to) < 0 || corner_at(n, u, from) >= 0) continue;
            int same = 0;
            for (int k = 0; k < 3; k++) {
                const uint32_t p = n->point.data[triangle_of(n, t)[k]];
                same += p != from && corner_at(n, u, p) >= 0;
            }
            if (same == 2) return false;
        }
    }
    for (size_t i = 0; i < n->star.count; i++) { // a triangle that hangs by one corner
        const uint32_t t = n->star.data[i];
        if (corner_at(n, t, from) < 0 || corner_at(n, t, to) < 0) continue;
        const uint32_t third = opposite(n, t, from, to);
        if (triangles_along(n, from, third) == 1 && triangles_along(n, to, third) == 1)
            return false;
    }
    return true;
}

static void rewire(naive *n, uint32_t at, uint32_t other, uint32_t vertex)
{
    for (size_t i = 0; i < n->star.count; i++) {
        const uint32_t t = n->star.data[i];
        const int k = corner_at(n, t, at);
        if (k < 0 || corner_at(n, t, other) >= 0) continue;
        uint32_t *corner = triangle_of(n, t) + k;
        if (*corner == vertex) continue;
        prom_records_change(&n->records, 3 * t + (uint32_t)k, *corner, vertex);
        *corner = vertex;
    }
}

static void collapse(naive *n, uint32_t from, uint32_t to)
{
    const uint32_t made = (uint32_t)n->point.count;
    prom_records_begin(&n->records, from, to, made);
    for (size_t i = 0; i < 2 * n->star.count; i++) // a triangle may be named twice
        prom_records_touch(&n->records, n->star.data[i / 2]);
    if (n->full) prom_array_push(&n->point, to);
    for (size_t i = 0; i < n->star.count; i++) {
        uint32_t *corners = triangle_of(n, n->star.data[i]);
        if (corner_at(n, n->star.data[i], from) < 0 || corner_at(n, n->star.data[i], to) < 0)
            continue;
        prom_records_remove(&n->records, n->star.data[i], corners);
        corners[0] = corners[1] = corners[2] = PROM_NONE;
    }
    if (n->full) rewire(n, to, from, made);
    rewire(n, from, PROM_NONE, n->full ? made : to);
    prom_records_end(&n->records, 0.0f, (uint32_t)n->point.count);
}

static void run(naive *n, uint32_t attempts, uint64_t seed)
{
    for (uint32_t i = 0; i < attempts; i++) {
        const uint32_t t = random_below(&seed, (uint32_t)n->corners.count / 3);
        const uint32_t *c = triangle_of(n, t), k = random_below(&seed, 3);
        if (c[0] == PROM_NONE) continue;
        const uint32_t from = n->point.data[c[k]], to = n->point.data[c[(k + 1) % 3]];
        find_star(n, from, to);
        if (keeps_a_surface(n, from, to)) collapse(n, from, to);
    }
}

static void naive_init(naive *n, uint32_t points, bool full)
{
    n->full = full;
    n->points = points;
    n->linked = prom_calloc(points, 1);
    for (uint32_t p = 0; p < points; p++) prom_array_push(&n->point, p);
    prom_records_init(&n->records, (uint32_t)n->corners.count / 3);
}

static void naive_finish(naive *n)
{
    prom_array_finish(&n->corners);
    prom_array_finish(&n->point);
    prom_array_finish(&n->star);
    prom_free(n->linked);
    prom_records_finish(&n->records);
}

// ---- properties

static void check_shape(uint32_t shape, bool full, uint64_t seed)
{
    naive n = {0};
    uint32_t points = 0;
    switch (shape) {
    case 0:
        points = make_grid(&n.corners, 14, 11, false, false);
        break;
    case 1:
        points = make_grid(&n.corners, 13, 9, true, false);
        break;
    case 2:
        points = make_grid(&n.corners, 16, 9, true, true);
        break;
    default:
        points = make_sphere(&n.corners, 12, 8);
    }
    number_array original = {0};
    for (size_t i = 0; i < n.corners.count; i++) prom_array_push(&original, n.corners.data[i]);
    naive_init(&n, points, full);
    run(&n, 6000, seed);
    const record_subject subject = {.records = &n.records,
                                    .original = original.data,
                                    .last = n.corners.data,
                                    .point = n.point.data,
                                    .vertex_count = (uint32_t)n.point.count};
    const mesh_facts before = record_facts(&subject, original.data);
    const mesh_facts after = record_facts(&subject, n.corners.data);
    assert_null(mesh_facts_spoiled(&after, &before)); // else the collapser is wrong
    assert_true(after.triangles < before.triangles / 4);
    const char *wrong = records_hold(&subject, 100, seed);
    if (wrong) print_error("shape %u, seed %u: %s\n", shape, (unsigned)seed, wrong);
    assert_null(wrong);
    prom_array_finish(&original);
    naive_finish(&n);
}

static void any_order_of_half_edges_is_a_mesh(void **state)
{
    (void)state;
    for (uint32_t shape = 0; shape < 4; shape++)
        for (uint64_t seed = 1; seed <= 8; seed++) check_shape(shape, false, seed);
}

static void any_order_of_full_edges_is_a_mesh(void **state)
{
    (void)state;
    for (uint32_t shape = 0; shape < 4; shape++)
        for (uint64_t seed = 1; seed <= 8; seed++) check_shape(shape, true, seed);
}

// A star of many triangles: each rests on a record, three and three on the same.
static void many_dependencies_ascend_without_repeats(void **state)
{
    (void)state;
    enum { TRIANGLES = 900 };
    prom_records records;
    uint64_t seed = 1;
    prom_records_init(&records, TRIANGLES);
    for (uint32_t i = 0; i < TRIANGLES / 3; i++) {
        prom_records_begin(&records, i, i + 1, 7);
        for (uint32_t k = 0; k < 3; k++) prom_records_touch(&records, i + k * (TRIANGLES / 3));
        prom_records_end(&records, 0.0f, 7);
        assert_int_equal(prom_record_dependencies(&records, i).end, 0);
    }
    prom_records_begin(&records, 0, 1, 7);
    for (uint32_t i = 0; i < 20 * TRIANGLES; i++)
        prom_records_touch(&records, random_below(&seed, TRIANGLES));
    prom_records_end(&records, 0.0f, 9);
    const prom_record_part part = prom_record_dependencies(&records, TRIANGLES / 3);
    assert_int_equal(part.end - part.first, TRIANGLES / 3);
    for (uint32_t i = part.first; i < part.end; i++)
        assert_int_equal(records.dependencies.data[i], i - part.first);
    const prom_record_part made = prom_record_vertices(&records, TRIANGLES / 3);
    assert_int_equal(made.first, 7);
    assert_int_equal(made.end, 9);
    prom_records_finish(&records);
}

// From any state: after steps out of order too.
static void seeking_goes_where_it_is_told(void **state)
{
    (void)state;
    enum { TRIANGLES = 40 };
    prom_records records;
    prom_replay replay;
    uint32_t corners[3 * TRIANGLES];
    uint64_t seed = 1;
    prom_records_init(&records, TRIANGLES);
    for (uint32_t t = 0; t < TRIANGLES; t++) { // each removes one triangle and rests on nothing
        for (uint32_t k = 0; k < 3; k++) corners[3 * t + k] = t + k;
        prom_records_begin(&records, t, t + 1, 0);
        prom_records_touch(&records, t);
        prom_records_remove(&records, t, corners + (size_t)3 * t);
        prom_records_end(&records, 0.0f, 0);
    }
    prom_replay_init(&replay, &records, corners);
    for (uint32_t round = 0; round < 500; round++) {
        const uint32_t count = random_below(&seed, TRIANGLES + 1);
        for (uint32_t k = random_below(&seed, 30); k; k--) {
            const uint32_t record = random_below(&seed, TRIANGLES);
            if (replay.applied[record])
                prom_replay_undo(&replay, record);
            else
                prom_replay_apply(&replay, record);
        }
        prom_replay_seek(&replay, count);
        assert_int_equal(replay.triangles, TRIANGLES - count);
        for (uint32_t t = 0; t < TRIANGLES; t++)
            assert_int_equal(replay.corners[3 * t], t < count ? PROM_NONE : t);
    }
    prom_replay_finish(&replay);
    prom_records_finish(&records);
}

static void no_records_are_no_steps(void **state)
{
    (void)state;
    const uint32_t triangle[3] = {0, 1, 2};
    for (uint32_t triangles = 0; triangles < 2; triangles++) {
        prom_records records;
        prom_replay replay;
        prom_records_init(&records, triangles);
        prom_replay_init(&replay, &records, triangles ? triangle : NULL);
        prom_replay_seek(&replay, 0);
        assert_int_equal(replay.triangles, triangles);
        assert_false(prom_replay_can_apply(&replay, 0));
        assert_false(prom_replay_can_undo(&replay, 0));
        prom_replay_finish(&replay);
        prom_records_finish(&records);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_order_of_half_edges_is_a_mesh),
        cmocka_unit_test(any_order_of_full_edges_is_a_mesh),
        cmocka_unit_test(many_dependencies_ascend_without_repeats),
        cmocka_unit_test(seeking_goes_where_it_is_told),
        cmocka_unit_test(no_records_are_no_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

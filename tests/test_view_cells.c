// LINK: prom_metaobj
// View cells: shares as codes, lookup, the check. For their way through the container see
// test_container_cells.
#include "container_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

// ---- shares

// Never below what was seen, and by less than a step of 2^(1/16) above.
static void assert_close_above(double share)
{
    uint8_t code = prom_view_share_encode(share);
    assert_true((double)prom_view_share_decode(code) >= share);
    if (code) assert_true((double)prom_view_share_decode((uint8_t)(code - 1)) < share);
}

static void shares_round_up(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int i = 0; i < 100000; i++)
        assert_close_above(exp2(-20.0 * fixture_random(&seed) / 16777216.0));
    for (int code = 0; code < 256; code++) {
        float share = prom_view_share_decode((uint8_t)code);
        assert_int_equal(prom_view_share_encode((double)share), code);
        assert_close_above(nextafter((double)share, 0.0));
        if (code < 255) assert_close_above(nextafter((double)share, 1.0));
    }
    assert_true(prom_view_share_decode(255) == 1.0f);
    assert_true(prom_view_share_decode(0) < 1.0f / 60000.0f);
    static const double least[] = {0.0, -0.0, -1.0, -INFINITY, 1e-320};
    for (size_t i = 0; i < sizeof least / sizeof *least; i++)
        assert_int_equal(prom_view_share_encode(least[i]), 0);
    static const double most[] = {1.0, 1.5, INFINITY, (double)NAN};
    for (size_t i = 0; i < sizeof most / sizeof *most; i++)
        assert_int_equal(prom_view_share_encode(most[i]), 255);
}

// ---- lookup

static const prom_view_cell *find_by_hand(const prom_view_cells *cells, const double p[3])
{
    for (uint32_t i = 0; i < cells->cell_count; i++) {
        bool inside = true;
        for (int a = 0; a < 3; a++) {
            double low = cells->origin[a] + cells->size * cells->cells[i].at[a];
            inside &= p[a] >= low && p[a] < low + cells->size;
        }
        if (inside) return &cells->cells[i];
    }
    return NULL;
}

static void every_point_has_its_cell(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 3, 4);
    const prom_view_cells *cells = &f.cells;
    uint32_t seed = 9, inside = 0;
    const double extent[3] = {8, 3, 12};
    for (int i = 0; i < 50000; i++) {
        double p[3];
        for (int a = 0; a < 3; a++)
            p[a] = cells->origin[a] + extent[a] * (fixture_random(&seed) / 8388608.0 - 1.0);
        const prom_view_cell *cell = prom_view_cells_at(cells, p);
        assert_ptr_equal(cell, find_by_hand(cells, p));
        inside += cell != NULL;
    }
    assert_true(inside > 1000 && inside < 49000);
    for (uint32_t i = 0; i < cells->cell_count; i++) { // corners belong to one cube only
        double p[3];
        for (int a = 0; a < 3; a++)
            p[a] = cells->origin[a] + cells->size * cells->cells[i].at[a];
        assert_ptr_equal(prom_view_cells_at(cells, p), &cells->cells[i]);
    }
    fixture_finish(&f);
}

static void points_that_are_nowhere(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 3, 4);
    static const double odd[] = {(double)NAN, INFINITY, -INFINITY, 1e300,
                                 -1e300,      6e9,      -6e9,      1e18};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
        for (int a = 0; a < 3; a++) {
            double p[3] = {-1e3, 1, 8};
            int32_t at[3];
            p[a] = odd[i];
            assert_null(prom_view_cells_at(&f.cells, p));
            assert_false(prom_view_cells_cube(&f.cells, p, at));
        }
    const prom_view_cells none = {0};
    assert_null(prom_view_cells_at(&none, (const double[3]){0, 0, 0}));
    // The outermost cubes that have a name.
    prom_view_cell ends[2] = {{{INT32_MIN, 0, 0}, 0, 0}, {{INT32_MAX, 0, 0}, 0, 0}};
    const prom_view_cells far = {.size = 1, .cell_count = 2, .cells = ends};
    assert_ptr_equal(prom_view_cells_at(&far, (const double[3]){INT32_MIN, 0.5, 0.5}), ends);
    assert_ptr_equal(prom_view_cells_at(&far, (const double[3]){INT32_MAX + 1.0, 0, 0}), NULL);
    assert_ptr_equal(prom_view_cells_at(&far, (const double[3]){INT32_MAX, 0, 0}), ends + 1);
    fixture_finish(&f);
}

// ---- the check

// Makes cells unsound in one of many ways; false: there is no such way.
static bool spoil(int way, prom_view_cells *c, const prom_model *m)
{
    uint32_t *last = &c->leaves[c->entry_count - 1];
    switch (way) {
    case 0:
        return c->size = 0, true;
    case 1:
        return c->size = (double)NAN, true;
    case 2:
        return c->size = INFINITY, true;
    case 3:
        return c->size = -c->size, true;
    case 4:
        return c->origin[1] = (double)NAN, true;
    case 5:
        return c->origin[2] = -1e300, true;
    case 6:
        return c->cells[5].at[0]--, true; // twice the same cube
    case 7:
        return c->cells[5].at[2] -= 9, true;
    case 8:
        return c->cells[3].first++, true;
    case 9:
        return c->cells[3].count--, true;
    case 10:
        return c->cells[11].count++, true;
    case 11:
        return c->cells[3].count = UINT32_MAX, true;
    case 12:
        return c->entry_count--, true;
    case 13:
        return c->leaves[1] = c->leaves[0], true;
    case 14:
        return c->leaves[0] = 1, true; // a cluster
    case 15:
        return *last = m->tree_count, true; // the sky
    case 16:
        return *last = PROM_NONE, true;
    case 17:
        return c->cell_count = 0, true;
    default:
        return false;
    }
}

static void check_finds(void **state)
{
    (void)state;
    uint64_t cell;
    for (int way = 0;; way++) {
        fixture f;
        fixture_init(&f, 3, 4);
        assert_null(prom_view_cells_check(&f.cells, &f.model, &cell));
        bool spoiled = spoil(way, &f.cells, &f.model);
        const char *wrong = prom_view_cells_check(&f.cells, &f.model, &cell);
        fixture_finish(&f);
        assert_true(cell < 12);
        if (!spoiled) break;
        if (!wrong) fail_msg("way %d", way);
    }
    const prom_view_cells none = {0};
    assert_null(prom_view_cells_check(&none, &(prom_model){0}, &cell));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_round_up),
        cmocka_unit_test(every_point_has_its_cell),
        cmocka_unit_test(points_that_are_nowhere),
        cmocka_unit_test(check_finds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

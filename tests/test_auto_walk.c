// LINK: prom_scenes prom_builder prom_metaobj
#define TOWN_FILE "test_auto_walk.prom"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scenes/path.h"
#include "scenes/walk_map.h"
#include "walk_town.h"

static void test_walks_on_the_ground(void **unused)
{
    (void)unused;
    prom_model model;
    prom_error error = {0};
    prom_path path, again;
    prom_container *container = open_town(&model);
    assert_int_equal(prom_path_auto(container, &model, 600, &path, &error), PROM_OK);
    assert_int_equal(prom_path_auto(container, &model, 600, &again, &error), PROM_OK);
    assert_int_equal(path.keys.count, 600);
    assert_memory_equal(path.keys.data, again.keys.data, 600 * sizeof *path.keys.data);
    double way = 0;
    for (size_t i = 0; i < 600; i++) {
        const double *p = path.keys.data[i].position;
        assert_true(fabs(p[1] - ground(p[0], p[2]) - 1.7) < 0.6);
        assert_false(in_tower(p[0], p[2], 0.5));
        for (int k = 0; k < 4; k++) assert_true(isfinite(path.keys.data[i].orientation[k]));
        if (!i) continue;
        const double *b = path.keys.data[i - 1].position;
        double step = hypot(p[0] - b[0], p[2] - b[2]);
        assert_true(step < 1); // under 30 m/s
        way += step;
    }
    assert_true(way > 100);
    prom_path_finish(&path);
    prom_path_finish(&again);
    prom_model_finish(&model);
    prom_container_close(container);
}

static void test_map(void **unused)
{
    (void)unused;
    prom_model model;
    prom_error error = {0};
    prom_walk_map map;
    prom_container *container = open_town(&model);
    const double low[2] = {-100, -80}, high[2] = {100, 80};
    assert_int_equal(prom_walk_map_init(&map, container, &model, low, high, 1.7, &error),
                     PROM_OK);
    size_t grounds = 0;
    uint32_t street = prom_walk_map_at(&map, 16, ground(16, 16), 16);
    uint32_t cellar = prom_walk_map_at(&map, 16, -25, 16);
    assert_int_not_equal(street, PROM_NONE);
    assert_int_not_equal(cellar, PROM_NONE);
    assert_int_equal(map.floors.data[street].open, 1);
    assert_int_equal(map.floors.data[cellar].open, 0);
    assert_int_not_equal(map.floors.data[street].component, map.floors.data[cellar].component);
    for (size_t i = 0; i < map.floors.count; i++) {
        const prom_walk_floor *f = &map.floors.data[i];
        double p[3];
        prom_walk_map_point(&map, (uint32_t)i, p);
        assert_true(p[0] >= low[0] && p[0] <= high[0] && p[2] >= low[1] &&
                    p[2] <= high[1] + map.cell);
        if (f->component == map.floors.data[street].component) {
            grounds++;
            assert_true(fabs(p[1] - ground(p[0], p[2])) < 0.4);
            assert_false(in_tower(p[0], p[2], -map.cell));
        }
        for (int side = 0; side < 4; side++) {
            uint32_t n = prom_walk_map_neighbour(&map, (uint32_t)i, side);
            if (n == PROM_NONE) continue;
            assert_true(fabs((double)(map.floors.data[n].y - f->y)) <= map.step);
            assert_int_equal(map.floors.data[n].component, f->component);
        }
    }
    // The streets take most of the area: 1 - (12/32)^2.
    assert_true((double)grounds * map.cell * map.cell > 0.75 * 200 * 160);
    prom_walk_map_finish(&map);
    prom_model_finish(&model);
    prom_container_close(container);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_map),
        cmocka_unit_test(test_walks_on_the_ground),
    };
    return cmocka_run_group_tests(tests, write_town, remove_town);
}

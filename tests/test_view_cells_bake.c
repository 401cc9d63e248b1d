// LINK: prom_builder prom_render prom_traverse prom_benefit prom_metaobj
// View cells of a yard of which it is known what can be seen: a wall across it hides one crate,
// a pane of glass does not hide another.
#include "builder/view_cells.h"

#include "builder/cell_view.h"
#include "builder/panorama.h"
#include "builder/pipeline.h"
#include "metaobj/base/log.h"
#include "metaobj/container.h"
#include "metaobj/view_cells.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include <cmocka.h>

#define SCENE "view_cells_bake.obj"
#define MATERIALS "view_cells_bake.mtl"
#define MODEL "view_cells_bake.prom"

// ---- the yard

static int vertices;

static void write_box(FILE *f, const char *name, const char *material, const double low[3],
                      const double high[3])
{
    static const int quads[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                    {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
    fprintf(f, "o %s\nusemtl %s\n", name, material);
    for (int v = 0; v < 8; v++)
        fprintf(f, "v %g %g %g\n", (v & 1 ? high : low)[0], (v & 2 ? high : low)[1],
                (v & 4 ? high : low)[2]);
    for (int q = 0; q < 6; q++)
        fprintf(f, "f %d %d %d %d\n", vertices + quads[q][0], vertices + quads[q][1],
                vertices + quads[q][2], vertices + quads[q][3]);
    vertices += 8;
}

static void write_yard(void)
{
    static const struct {
        const char *name, *material;
        double low[3], high[3];
    } boxes[] = {
        {"ground", "stone", {-20, -1, -20}, {20, 0, 20}},
        {"wall", "stone", {5, 0, -20}, {5.2, 6, 20}},
        {"pane", "glass", {-3.1, 0.1, -3}, {-3, 3, 3}},
        {"crate_free", "wood", {1.5, 0.1, 3}, {2.5, 1.1, 4}},
        {"crate_walled", "wood", {8, 0.1, -0.5}, {9, 1.1, 0.5}},
        {"crate_glazed", "wood", {-6, 0.1, -0.5}, {-5, 1.1, 0.5}},
        {"crate_half", "wood", {-0.5, 0.1, -8}, {0.5, 1.1, -7}},
        {"screen", "stone", {-3, 0.05, -6.6}, {0, 3, -6.5}},
    };
    FILE *f = fopen(MATERIALS, "w");
    assert_non_null(f);
    fputs("newmtl stone\nKd .6 .6 .6\nnewmtl wood\nKd .5 .3 .1\n"
          "newmtl glass\nKd .6 .8 .9\nd 0.3\n",
          f);
    fclose(f);
    f = fopen(SCENE, "w");
    assert_non_null(f);
    vertices = 0;
    fputs("mtllib " MATERIALS "\n", f);
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++)
        write_box(f, boxes[i].name, boxes[i].material, boxes[i].low, boxes[i].high);
    fclose(f);
}

static bool have_gl;

static void build_yard(void)
{
    prom_error error = {0};
    prom_build_options options = {.objects = {.min_triangles = 12}, .view_cells_follow = true};
    if (prom_build(SCENE, MODEL, &options, NULL, &error)) fail_msg("%s", error.text);
}

static int make_yard(void **state)
{
    (void)state;
    prom_error error = {0};
    prom_context *context = prom_context_create_headless(&error);
    have_gl = context != NULL;
    if (!have_gl) print_message("skipped: %s\n", error.text);
    prom_context_destroy(context);
    write_yard();
    return 0;
}

static int remove_yard(void **state)
{
    (void)state;
    static const char *const names[] = {SCENE, MATERIALS, MODEL, MODEL ".work"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) unlink(names[i]);
    return 0;
}

// Two cells side by side, from x = -1 to 1 and from there to 3.
static const double walk[][3] = {{-0.7, 1.6, 0}, {-0.4, 1.6, 0}, {0, 1.6, 0.1}, {0, 1.6, 0},
                                 {0.6, 1.6, 0},  {1.4, 1.6, 0},  {2.4, 1.6, 0}};
#define WALK (sizeof walk / sizeof *walk)

static prom_view_cells_report bake(const prom_view_cells_options *options)
{
    prom_view_cells_report report = {0};
    prom_error error = {0};
    if (prom_view_cells_build(MODEL, walk, WALK, options, &report, &error))
        fail_msg("%s", error.text);
    return report;
}

typedef struct yard {
    prom_container *container;
    prom_model model;
    prom_view_cells cells;
} yard;

static yard open_yard(void)
{
    prom_error error = {0};
    yard y = {.container = prom_container_open(MODEL, &error)};
    if (!y.container) fail_msg("%s", error.text);
    assert_int_equal(prom_container_load_model(y.container, &y.model, &error), PROM_OK);
    assert_int_equal(prom_container_read_view_cells(y.container, &y.model, &y.cells, &error),
                     PROM_OK);
    return y;
}

static void close_yard(yard *y)
{
    prom_view_cells_finish(&y->cells);
    prom_model_finish(&y->model);
    prom_container_close(y->container);
}

static uint32_t node_of(const prom_model *m, const char *name)
{
    for (uint32_t n = 0; n < m->tree_count; n++)
        if (!m->child_count[n] && strstr(m->names + m->name[n], name)) return n;
    fail_msg("there is no leaf %s", name);
    return PROM_NONE;
}

// 0: not in the cell.
static float share_at(const yard *y, const double eye[3], uint32_t node)
{
    const prom_view_cell *cell = prom_view_cells_at(&y->cells, eye);
    assert_non_null(cell);
    for (uint32_t i = cell->first; i < cell->first + cell->count; i++)
        if (y->cells.leaves[i] == node) return prom_view_share_decode(y->cells.shares[i]);
    return 0;
}

static uint64_t content(void)
{
    prom_error error = {0};
    uint64_t hash = 0;
    prom_container *c = prom_container_open(MODEL, &error);
    if (!c) fail_msg("%s", error.text);
    assert_int_equal(prom_container_content_hash(c, &hash, &error), PROM_OK);
    prom_container_close(c);
    return hash;
}

static void count_stage(void *user, const char *name, uint64_t hash, double ms)
{
    assert_true(ms >= 0);
    if (!strcmp(name, "view cells")) *(unsigned *)user += hash != 0;
}

// ---- what shows

static void a_cell_holds_what_shows_from_it(void **state)
{
    (void)state;
    if (!have_gl) skip();
    build_yard();
    prom_view_cells_report report = bake(&(prom_view_cells_options){0});
    yard y = open_yard();
    assert_int_equal(report.cells, 2);
    assert_int_equal(y.cells.cell_count, 2);
    assert_true(y.cells.size == 2);
    assert_true(report.mean_share > 0.5 && report.mean_share < 1);
    for (size_t i = 0; i < WALK; i++) {
        float free = share_at(&y, walk[i], node_of(&y.model, "crate_free"));
        float glazed = share_at(&y, walk[i], node_of(&y.model, "crate_glazed"));
        float half = share_at(&y, walk[i], node_of(&y.model, "crate_half"));
        assert_true(free > 0.8f);
        assert_true(glazed > 0.8f);
        assert_true(half > 0.1f && half < 0.95f);
        assert_true(share_at(&y, walk[i], node_of(&y.model, "pane")) > 0.8f);
        assert_true(share_at(&y, walk[i], node_of(&y.model, "crate_walled")) == 0);
    }
    unsigned stages = 0;
    prom_error error;
    assert_int_equal(prom_container_stages(y.container, count_stage, &stages, &error), PROM_OK);
    assert_int_equal(stages, 1);
    close_yard(&y);
}

// An eye elsewhere in a cell sees next to nothing that the cell does not know.
static void other_eyes_of_a_cell_miss_little(void **state)
{
    (void)state;
    if (!have_gl) skip();
    enum { PX = 512 };
    prom_error error = {0};
    yard y = open_yard();
    prom_context *context = prom_context_create_headless(&error);
    prom_renderer *renderer = prom_renderer_create(context, &error);
    assert_non_null(renderer);
    assert_int_equal(prom_renderer_load(renderer, y.container, &y.model, &error), PROM_OK);
    prom_panorama_camera *camera = prom_panorama_camera_create(renderer, &y.model, PX, &error);
    assert_non_null(camera);
    prom_panorama p;
    prom_panorama_init(&p, PX);
    size_t seen = 0, missing = 0;
    float *shares = prom_alloc(y.model.tree_count, sizeof *shares);
    for (int i = 0; i < 12; i++) {
        const double eye[3] = {-0.6 + 0.25 * i, 1 + 0.1 * i, 0.9 - 0.16 * i};
        memcpy(p.eye, eye, sizeof eye);
        prom_panorama_take(camera, &p);
        for (uint32_t n = 0; n < y.model.tree_count; n++) shares[n] = share_at(&y, eye, n);
        for (size_t k = 0; k < (size_t)PROM_PANORAMA_FACES * PX * PX; k++) {
            if (p.opaque[k] == PROM_NONE) continue;
            assert_true(p.opaque[k] < y.model.tree_count);
            seen++;
            missing += !(shares[p.opaque[k]] > 0);
        }
    }
    prom_free(shares);
    assert_true(seen > 12 * PX * PX);
    assert_true((double)missing < 1e-3 * (double)seen);
    prom_panorama_finish(&p);
    prom_panorama_camera_destroy(camera);
    prom_renderer_destroy(renderer);
    prom_context_destroy(context);
    close_yard(&y);
}

// ---- the work

static void known_cells_are_taken_over(void **state)
{
    (void)state;
    if (!have_gl) skip();
    build_yard();
    bake(&(prom_view_cells_options){.anew = true});
    const uint64_t wanted = content();
    build_yard();
    assert_int_not_equal(content(), wanted); // without cells
    prom_view_cells_report report = bake(&(prom_view_cells_options){0});
    assert_int_equal(report.cells_taken, report.cells);
    assert_int_equal(content(), wanted);
    build_yard();
    report = bake(&(prom_view_cells_options){.anew = true});
    assert_int_equal(report.cells_taken, 0);
    assert_int_equal(content(), wanted);
    build_yard();
    report = bake(&(prom_view_cells_options){.face_px = 128}); // other pictures
    assert_int_equal(report.cells_taken, 0);
    build_yard();
    report = bake(&(prom_view_cells_options){.drop_work = true});
    assert_int_equal(report.cells_taken, 0); // what the last one did not use was dropped
    assert_int_equal(content(), wanted);
    assert_int_not_equal(access(MODEL ".work", F_OK), 0);
}

static void a_model_that_is_none_is_an_error(void **state)
{
    (void)state;
    prom_error error = {0};
    const prom_view_cells_options options = {0};
    assert_int_equal(prom_view_cells_build("missing.prom", walk, WALK, &options, NULL, &error),
                     PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "missing.prom"));
    assert_int_equal(prom_view_cells_build(SCENE, walk, WALK, &options, NULL, NULL),
                     PROM_ERR_INPUT);
    assert_int_not_equal(access(SCENE ".part", F_OK), 0);
    assert_int_not_equal(access("missing.prom.part", F_OK), 0);
}

// ---- parts

static void six_faces_are_all_around(void **state)
{
    (void)state;
    float *angles = prom_panorama_angles(256);
    double sum = 0;
    for (size_t i = 0; i < 256 * 256; i++) sum += (double)angles[i];
    prom_free(angles);
    assert_true(fabs(6 * sum - 4 * M_PI) < 1e-4);
}

static double distance_of(const double a[3], const double b[3])
{
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

// Every eye is in a cell; a cell is looked out of from a few, spread over it.
static void eyes_are_gathered_into_cells(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    double(*eyes)[3] = prom_alloc(COUNT, sizeof *eyes);
    prom_error error = {0};
    prom_eye_cells cells;
    for (int i = 0; i < COUNT; i++) {
        eyes[i][0] = 40 * sin(0.011 * i);
        eyes[i][1] = 1.6 + (i % 7 ? 0 : 0.3);
        eyes[i][2] = 0.03 * i;
    }
    assert_int_equal(prom_eye_cells_gather((const double(*)[3])eyes, COUNT, 3, &cells, &error),
                     PROM_OK);
    assert_true(cells.grid.size == 3);
    uint64_t sum = 0;
    for (size_t c = 0; c < cells.cells.count; c++) {
        const prom_eye_cell *cell = &cells.cells.data[c];
        if (c) assert_true(prom_view_cube_order(cell[-1].at, cell->at) < 0);
        assert_in_range(cell->eye_count, 2, PROM_EYES_OF_CELL);
        sum += cell->eye_count;
        for (uint32_t i = 0; i < cell->eye_count; i++) {
            int32_t at[3];
            assert_true(prom_view_cells_cube(&cells.grid, eyes[cell->eyes[i]], at));
            if (cell->eye_count > 2) assert_memory_equal(at, cell->at, sizeof at);
            for (uint32_t k = 0; k < i && cell->eye_count > 2; k++)
                assert_true(distance_of(eyes[cell->eyes[i]], eyes[cell->eyes[k]]) >= 1.5);
        }
    }
    assert_int_equal(sum, cells.eye_count);
    for (int i = 0; i < COUNT; i++) {
        int32_t at[3];
        bool found = false;
        assert_true(prom_view_cells_cube(&cells.grid, eyes[i], at));
        for (size_t c = 0; c < cells.cells.count && !found; c++)
            found = !prom_view_cube_order(cells.cells.data[c].at, at);
        assert_true(found);
    }
    prom_eye_cells_finish(&cells);
    prom_free(eyes);
}

static void cells_are_larger_where_they_would_be_many(void **state)
{
    (void)state;
    enum { SIDE = 200 };
    double(*eyes)[3] = prom_calloc(SIDE * SIDE, sizeof *eyes);
    prom_error error = {0};
    prom_eye_cells cells;
    for (int i = 0; i < SIDE * SIDE; i++) eyes[i][0] = i % SIDE, eyes[i][2] = i / SIDE;
    const double(*all)[3] = (const double(*)[3])eyes;
    assert_int_equal(prom_eye_cells_gather(all, SIDE * SIDE, 0, &cells, &error), PROM_OK);
    assert_in_range(cells.cells.count, 200, 400);
    assert_true(cells.grid.size > 2);
    prom_eye_cells_finish(&cells);
    assert_int_equal(prom_eye_cells_gather(all, 100, 0, &cells, &error), PROM_OK);
    assert_true(cells.grid.size == 2);
    prom_eye_cells_finish(&cells);
    assert_int_equal(prom_eye_cells_gather(all, 0, 0, &cells, &error), PROM_ERR_INPUT);
    eyes[1][1] = 1e300;
    assert_int_equal(prom_eye_cells_gather(all, 2, 1, &cells, &error), PROM_ERR_INPUT);
    eyes[1][1] = NAN;
    assert_int_equal(prom_eye_cells_gather(all, 2, 1, &cells, &error), PROM_ERR_INPUT);
    prom_eye_cells_finish(&cells);
    prom_free(eyes);
}

// Three cells in a row, the last one apart: neighbours give half, others nothing.
static void neighbours_count_half(void **state)
{
    (void)state;
    uint32_t children[4] = {3, 0, 0, 0};
    prom_model model = {.tree_count = 4, .child_count = children};
    const float shares[3][4] = {{1, 1, 0.25f, 0}, {1, 0.125f, 0, 0}, {1, 0, 0, 0.5f}};
    prom_cell_view views[3];
    prom_eye_cells cells = {.grid = {.size = 1}};
    static const int32_t x[3] = {0, 1, 3};
    for (int i = 0; i < 3; i++) {
        prom_eye_cell cell = {.at = {x[i], 0, 0}};
        prom_array_push(&cells.cells, cell);
        prom_cell_view_set(&views[i], &model, shares[i]);
    }
    prom_view_cells joined;
    uint64_t wrong;
    prom_cell_views_join(views, &cells, &model, &joined);
    assert_null(prom_view_cells_check(&joined, &model, &wrong));
    const struct {
        uint32_t leaf;
        float share;
    } wanted[] = {{1, 1}, {2, 0.25f}, {1, 0.5f}, {2, 0.125f}, {3, 0.5f}};
    assert_int_equal(joined.entry_count, 5);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(joined.leaves[i], wanted[i].leaf);
        assert_float_equal(prom_view_share_decode(joined.shares[i]), wanted[i].share, 1e-6);
    }
    prom_view_cells_finish(&joined);
    for (int i = 0; i < 3; i++) prom_cell_view_finish(&views[i]);
    prom_eye_cells_finish(&cells);
}

// Bytes of a unit come back, or count as none.
static void a_damaged_unit_is_none(void **state)
{
    (void)state;
    uint32_t children[5] = {4, 0, 0, 0, 0};
    const float shares[5] = {1, 0.3f, 0, 1e-9f, 1};
    prom_model model = {.tree_count = 5, .child_count = children};
    prom_cell_view view, other;
    prom_pack pack = {0};
    prom_cell_view_set(&view, &model, shares);
    assert_int_equal(view.count, 3);
    prom_cell_view_pack(&view, &pack);
    assert_true(prom_cell_view_unpack(&other, &model, &pack));
    assert_memory_equal(other.leaves, view.leaves, 3 * sizeof *view.leaves);
    assert_memory_equal(other.codes, view.codes, 3);
    prom_cell_view_finish(&other);
    size_t whole = pack.count;
    for (pack.count = 0; pack.count < whole; pack.count++)
        assert_false(prom_cell_view_unpack(&other, &model, &pack));
    static const uint8_t wrong[][2] = {{0, 4}, {0, 255}, {4, 0}, {4, 3}, {12, 5}, {15, 1}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        uint8_t before = pack.data[wrong[i][0]];
        pack.data[wrong[i][0]] = wrong[i][1];
        assert_false(prom_cell_view_unpack(&other, &model, &pack));
        assert_null(other.leaves);
        pack.data[wrong[i][0]] = before;
    }
    prom_array_finish(&pack);
    prom_cell_view_finish(&view);
}

int main(void)
{
    prom_log_set_level(PROM_LOG_WARNING);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(six_faces_are_all_around),
        cmocka_unit_test(eyes_are_gathered_into_cells),
        cmocka_unit_test(cells_are_larger_where_they_would_be_many),
        cmocka_unit_test(neighbours_count_half),
        cmocka_unit_test(a_damaged_unit_is_none),
        cmocka_unit_test(a_model_that_is_none_is_an_error),
        cmocka_unit_test(a_cell_holds_what_shows_from_it),
        cmocka_unit_test(other_eyes_of_a_cell_miss_little),
        cmocka_unit_test(known_cells_are_taken_over),
    };
    return cmocka_run_group_tests(tests, make_yard, remove_yard);
}

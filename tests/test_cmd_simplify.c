// LINK: prom_builder prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
// `promenade simplify` from outside: it goes as far as it was told, leaves what was to stay,
// and refuses what cannot be.
#include "builder/mesh_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "simplify_command.h"

static json_t *simplify(const char *arguments)
{
    expect(0, "simplify %s --report r.json -q", arguments);
    json_t *json = json_load_file("r.json", 0, NULL);
    assert_non_null(json);
    return json;
}

// ---- what was asked for

static void targets_are_reached(void **state)
{
    (void)state;
    static const char *const pieces[] = {"antiqueChair", "couch",    "plantie",
                                         "teddyBear",    "oakTable", "televisionCabinet"};
    const char *shared = getenv("PROM_SHARED");
    if (!shared || !exists(shared)) skip();
    for (int i = 0; i < 6; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/scenes/furniture-cc0/%s/%s.obj", shared, pieces[i],
                 pieces[i]);
        for (double ratio = 0.5; ratio > 0.05; ratio /= 5) {
            char arguments[1200];
            snprintf(arguments, sizeof arguments, "%s --ratio %g --loose -o f.obj", path,
                     ratio);
            json_t *json = simplify(arguments);
            const double target = round(ratio * number(json, "before.triangles"));
            const double left = number(json, "after.triangles");
            assert_true(number(json, "target_triangles") == target);
            if (left > target || left < 0.99 * target - 2)
                fail_msg("%s: %g triangles, not %g", pieces[i], left, target);
            json_decref(json);
        }
    }
}

static void the_report_says_what_is_in_the_file(void **state)
{
    (void)state;
    json_t *json = simplify("two.obj --triangles 300 --metric qem -o q.obj");
    assert_string_equal(json_string_value(json_object_get(json, "metric")), "qem");
    assert_true(json_is_true(json_object_get(json, "reached")));
    assert_true(number(json, "before.triangles") == 2 * SIDE * SIDE);
    assert_true(number(json, "after.triangles") <= 300);
    assert_true(number(json, "error_units") > 0);
    assert_true(json_is_object(json_object_get(json, "repair")));
    prom_mesh_file file;
    assert_int_equal(prom_mesh_file_read("q.obj", NULL, NULL, &file, NULL), PROM_OK);
    assert_true(number(json, "after.triangles") == file.mesh.index_count / 3);
    assert_int_equal(file.mesh.submesh_count, 2);
    prom_mesh_file_finish(&file);
    json_decref(json);
    expect(0, "simplify two.obj --triangles 300 -o q.obj");
    assert_non_null(strstr(run.out, "1152 to"));
    json = simplify("two.obj --ratio 0.5 --no-repair -o q.obj");
    assert_true(json_is_null(json_object_get(json, "repair")));
    json_decref(json);
}

static void the_error_is_limited(void **state)
{
    (void)state;
    double before = INFINITY;
    for (double most = 0.001; most < 0.1; most *= 5) {
        char arguments[128];
        snprintf(arguments, sizeof arguments, "two.obj --max-error %g --metric qem -o e.obj",
                 most);
        json_t *json = simplify(arguments);
        assert_true(number(json, "error_units") <= most * (1 + 1e-6));
        assert_true(number(json, "after.triangles") < before);
        before = number(json, "after.triangles");
        json_decref(json);
    }
    expect(0, "simplify two.obj --max-error 0.001 --triangles 10 -q -o e.obj");
    assert_non_null(strstr(run.err, "triangles are left, not 10"));
}

static bool holds_place(const prom_mesh *mesh, const float place[3])
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        if (!memcmp(mesh->vertices[i].position, place, 3 * sizeof *place)) return true;
    return false;
}

// Of the first file's vertices, at least along the border where only that counts, all are in
// the second.
static void assert_places_kept(const char *from, const char *in, bool border)
{
    static const double origin[3] = {0, 0, 0};
    prom_mesh_file files[2];
    prom_mesh_file_read(from, NULL, origin, &files[0], NULL);
    prom_mesh_file_read(in, NULL, origin, &files[1], NULL);
    for (uint32_t i = 0; i < files[0].mesh.vertex_count; i++) {
        const float *p = files[0].mesh.vertices[i].position;
        const bool outer = p[0] <= 0 || p[0] >= 2 || p[2] <= 0 || p[2] >= 2;
        if (border && !outer) continue;
        if (!holds_place(&files[1].mesh, p))
            fail_msg("%s has no vertex at %g %g %g", in, (double)p[0], (double)p[1],
                     (double)p[2]);
    }
    for (int i = 0; i < 2; i++) prom_mesh_file_finish(&files[i]);
}

static void half_edges_move_no_vertex(void **state)
{
    (void)state;
    expect(0, "simplify two.obj --ratio 0.2 --half-edge -q -o h.obj");
    assert_places_kept("h.obj", "two.obj", false);
}

static void locked_borders_stay(void **state)
{
    (void)state;
    expect(0, "simplify two.obj --ratio 0.3 --lock-border -q -o l.obj");
    assert_places_kept("two.obj", "l.obj", true);
}

// ---- refusals

static void wrong_calls_are_told(void **state)
{
    (void)state;
    expect(0, "simplify --help");
    expect(1, "simplify two.obj -o x.obj --ratio 0.5 --metric prettiest");
    assert_non_null(strstr(run.err, "qem-attributes"));
    expect(1, "simplify two.obj -o x.obj --ratio 0");
    expect(1, "simplify two.obj -o x.obj --ratio 1.5");
    expect(1, "simplify two.obj -o x.obj --triangles 0");
    expect(1, "simplify two.obj -o x.obj --max-error -1");
    expect(1, "simplify two.obj -o x.obj");
    expect(1, "simplify two.obj -o x.obj --ratio 0.5 --triangles 3");
    expect(1, "simplify two.obj -o x.obj --ratio 0.5 --no-repair --weld 0.1");
    expect(1, "simplify two.obj -o x.stl --ratio 0.5");
    expect(1, "simplify two.obj --ratio 0.5");
    expect(1, "simplify -o x.obj --ratio 0.5");
    expect(1, "simplify two.obj -o two.obj --ratio 0.5");
    expect(2, "simplify missing.obj -o x.obj --ratio 0.5");
    expect(4, "simplify two.obj -o nowhere/x.obj --ratio 0.5");
    assert_false(exists("x.obj"));
}

static void what_has_no_triangles_is_refused(void **state)
{
    (void)state;
    write_text("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    write_text("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    expect(2, "simplify points.obj -o x.obj --ratio 0.5");
    expect(2, "simplify line.obj -o x.obj --ratio 0.5");
    assert_non_null(strstr(run.err, "line.obj"));
    assert_false(exists("x.obj"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(targets_are_reached),
        cmocka_unit_test(the_report_says_what_is_in_the_file),
        cmocka_unit_test(the_error_is_limited),
        cmocka_unit_test(half_edges_move_no_vertex),
        cmocka_unit_test(locked_borders_stay),
        cmocka_unit_test(wrong_calls_are_told),
        cmocka_unit_test(what_has_no_triangles_is_refused),
    };
    return cmocka_run_group_tests_name("cmd_simplify", tests, setup, teardown);
}

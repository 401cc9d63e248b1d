// LINK: prom_builder prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
// Meshes written as OBJ, PLY and GLB: read again they are what they were, and nothing
// half-written stays behind.
#include "builder/mesh_write.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/resource.h>

#include <cmocka.h>

#include "simplify_command.h"

#define BYTES 5e-3 // what rounding a material's colour to bytes may change

// Nothing moved, and nothing looks different by more than `tolerance` in any view.
static void assert_same(const char *a, const char *b, double tolerance)
{
    expect(0, "compare-mesh %s %s --json --samples 20000 --size-px 64 --views %d", a, b,
           has_gl ? 26 : 0);
    json_t *json = json_loads(run.out, 0, NULL);
    assert_non_null(json);
    if (number(json, "hausdorff_units") > 0) fail_msg("%s: lies elsewhere than %s", b, a);
    assert_true(number(json, "a.triangles") == number(json, "b.triangles"));
    assert_true(number(json, "b_to_a.normal_rms_degrees") < 0.5); // of signed bytes
    json_t *looks = json_object_get(json, "looks");
    for (size_t i = 0; i < json_array_size(looks); i++)
        if (number(json_array_get(looks, i), "worst") > tolerance)
            fail_msg("%s: looks unlike %s: %g", b, a,
                     number(json_array_get(looks, i), "worst"));
    json_decref(json);
}

// ---- formats

static void formats_give_back_what_they_got(void **state)
{
    (void)state;
    static const char *const names[] = {"two", "one", "masked", "glass", "far"};
    for (int i = 0; i < 5; i++) {
        char in[32];
        snprintf(in, sizeof in, "%s.obj", names[i]);
        expect(0, "simplify %s --ratio 1 -q -o o.obj", in);
        assert_same(in, "o.obj", 1e-3);
        expect(0, "simplify %s --ratio 1 -q -o o.glb", in);
        assert_same(in, "o.glb", 1e-3);
    }
    expect(0, "simplify o.glb --ratio 1 -q -o oo.glb");
    assert_same("far.obj", "oo.glb", 1e-3);
    expect(0, "simplify one.obj --ratio 1 -q -o o.ply");
    assert_same("one.obj", "o.ply", BYTES);
    expect(0, "simplify o.ply --ratio 1 -q -o oo.obj");
    assert_same("one.obj", "oo.obj", BYTES);
}

static void colors_of_vertices_are_kept(void **state)
{
    (void)state;
    static const char *const outputs[] = {"c.ply", "c.glb", "c.obj"};
    for (int i = 0; i < 3; i++) {
        expect(0, "simplify colored.ply --ratio 1 -q -o %s", outputs[i]);
        assert_same("colored.ply", outputs[i], BYTES);
    }
}

static void files_of_pictures_are_named_not_copied(void **state)
{
    (void)state;
    expect(0, "simplify masked.obj --ratio 0.5 -q -o below/m.obj");
    assert_true(text_has("below/m.mtl", "map_Kd ../red.png\n"));
    assert_true(text_has("below/m.mtl", "map_d ../mask.png\n"));
    static const char *const known[] = {"m.obj", "m.mtl", NULL};
    assert_int_equal(count_others("below", known), 0);
}

static void embedded_pictures_are_written_beside(void **state)
{
    (void)state;
    expect(0, "simplify two.obj --ratio 1 -q -o alone/two.glb");
    expect(0, "simplify alone/two.glb --ratio 1 -q -o alone/out.obj");
    static const char *const known[] = {"two.glb",       "out.obj",       "out.mtl",
                                        "out.obj-0.png", "out.obj-1.png", NULL};
    assert_int_equal(count_others("alone", known), 0);
    assert_true(text_has("alone/out.mtl", "map_Kd out.obj-1.png\n"));
    assert_same("two.obj", "alone/out.obj", 1e-3);
    expect(0, "simplify alone/two.glb --ratio 0.5 -q -o alone/out.obj"); // over its own files
}

static void a_ply_says_what_it_cannot_keep(void **state)
{
    (void)state;
    expect(0, "simplify two.obj --ratio 1 -q -o many.ply");
    assert_non_null(strstr(run.err, "many.ply: PLY can name one picture only"));
}

// ---- all or nothing

static void the_materials_of_others_are_not_replaced(void **state)
{
    (void)state;
    expect(1, "simplify colored.ply -o sheet.obj --ratio 1");
    assert_non_null(strstr(run.err, "sheet.mtl"));
    assert_true(text_has("sheet.mtl", "map_Kd grate.png"));
    assert_false(exists("sheet.obj"));
}

// Files may grow to `bytes` in what runs from now on.
static void limit_files(rlim_t bytes)
{
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes == RLIM_INFINITY ? limit.rlim_max : bytes;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

// In the parent's own address space: reading needs large files between the processes.
static void write_fails_whole(const prom_mesh_file *file, const char *path)
{
    prom_error error = {0};
    limit_files(2000);
    prom_status status = prom_mesh_write(path, file, NULL, &error);
    limit_files(RLIM_INFINITY);
    assert_int_equal(status, PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, path));
}

static void half_written_files_never_stay(void **state)
{
    (void)state;
    assert_int_equal(mkdir("full", 0777), 0);
    write_text("full/o.obj", "# mine\n");
    prom_mesh_file file;
    assert_int_equal(prom_mesh_file_read("two.obj", NULL, NULL, &file, NULL), PROM_OK);
    signal(SIGXFSZ, SIG_IGN);
    write_fails_whole(&file, "full/o.obj");
    write_fails_whole(&file, "full/o.ply");
    write_fails_whole(&file, "full/o.glb");
    signal(SIGXFSZ, SIG_DFL);
    prom_mesh_file_finish(&file);
    static const char *const known[] = {"o.obj", NULL};
    assert_int_equal(count_others("full", known), 0);
    assert_true(text_has("full/o.obj", "# mine\n"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formats_give_back_what_they_got),
        cmocka_unit_test(colors_of_vertices_are_kept),
        cmocka_unit_test(files_of_pictures_are_named_not_copied),
        cmocka_unit_test(embedded_pictures_are_written_beside),
        cmocka_unit_test(a_ply_says_what_it_cannot_keep),
        cmocka_unit_test(the_materials_of_others_are_not_replaced),
        cmocka_unit_test(half_written_files_never_stay),
    };
    return cmocka_run_group_tests_name("mesh_write", tests, setup, teardown);
}

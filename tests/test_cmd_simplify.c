// LINK: prom_builder prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
// `promenade simplify` from outside: what it writes is what it read where nothing is collapsed,
// targets are reached, and nothing half-done stays behind.
#include "builder/mesh_file.h"
#include "builder/mesh_write.h"
#include "metaobj/base/alloc.h"
#include "picture_bytes.h"
#include "run_program.h"

#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cmocka.h>
#include <jansson.h>

#define BYTES 5e-3 // what rounding a material's colour to bytes may change
#define SIDE 24    // quads along a sheet

static program_run run;
static bool has_gl;

static void expect(int code, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void expect(int code, const char *format, ...)
{
    char arguments[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(arguments, sizeof arguments, format, list);
    va_end(list);
    run_program(&run, arguments);
    if (run.code != code) fail_msg("promenade %s: %d: %s", arguments, run.code, run.err);
}

static FILE *create(const char *name)
{
    FILE *out = fopen(name, "w");
    assert_non_null(out);
    return out;
}

static void write_text(const char *name, const char *text)
{
    FILE *out = create(name);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

// A picture whose texels all differ a little.
static void write_picture(const char *name, uint8_t red, int channels)
{
    static picture_bytes png;
    uint8_t pixels[16 * 16 * 4];
    for (int i = 0; i < 256; i++) {
        const uint8_t texel[4] = {red, (uint8_t)i, (uint8_t)(255 - i),
                                  (uint8_t)(i % 16 < 5 ? 0 : 255)};
        memcpy(pixels + channels * i, texel, (size_t)channels);
    }
    png_form form = {.width = 16, .height = 16, .depth = 8, .type = channels == 4 ? 6 : 2};
    make_png(&png, &form, pixels, (size_t)(16 * channels));
    FILE *out = create(name);
    assert_int_equal(fwrite(png.data, 1, png.count, out), png.count);
    assert_int_equal(fclose(out), 0);
}

static double height(int i, int j)
{
    return 0.2 * sin(0.4 * i) * cos(0.3 * j);
}

// A waved square, its left half of material `left`, its right half of `right`.
static void write_sheet(const char *name, const char *library, double x, const char *left,
                        const char *right)
{
    FILE *out = create(name);
    fprintf(out, "mtllib %s\n", library);
    for (int i = 0; i <= SIDE; i++)
        for (int j = 0; j <= SIDE; j++)
            fprintf(out, "v %.9g %.9g %.9g\nvt %.9g %.9g\n", x + 2.0 * i / SIDE, height(i, j),
                    2.0 * j / SIDE, 1.5 * i / SIDE, 1.0 * j / SIDE);
    for (int i = 0; i < SIDE; i++) {
        if (i == 0) fprintf(out, "usemtl %s\n", left);
        if (i == SIDE / 2) fprintf(out, "usemtl %s\n", right);
        for (int j = 0; j < SIDE; j++) {
            const int a = i * (SIDE + 1) + j + 1, b = a + SIDE + 1;
            fprintf(out, "f %d/%d %d/%d %d/%d %d/%d\n", a, a, a + 1, a + 1, b + 1, b + 1, b, b);
        }
    }
    assert_int_equal(fclose(out), 0);
}

static void write_colored(const char *name)
{
    FILE *out = create(name);
    fprintf(out,
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0 255 10 20\n1 0.1 0.3 30 255 40\n0.2 1 0.1 50 60 255\n0.1 0.2 1 128 128 0\n"
            "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    assert_int_equal(fclose(out), 0);
}

static void write_inputs(void)
{
    write_text("sheet.mtl", "newmtl red\nKd 1 1 1\nmap_Kd red.png\n"
                            "newmtl grate\nKd 0.5 0.8 0.9\nmap_Kd grate.png\n"
                            "newmtl masked\nKd 1 1 1\nmap_Kd red.png\nmap_d mask.png\n"
                            "newmtl plain\nKd 0.2 0.5 0.7\n"
                            "newmtl glass\nKd 0.3 0.6 0.2\nd 0.4\n");
    write_picture("red.png", 200, 3);
    write_picture("grate.png", 90, 4);
    write_picture("mask.png", 30, 3);
    write_sheet("two.obj", "sheet.mtl", 0, "red", "grate");
    write_sheet("one.obj", "sheet.mtl", 0, "grate", "grate");
    write_sheet("masked.obj", "sheet.mtl", 0, "masked", "plain");
    write_sheet("glass.obj", "sheet.mtl", 0, "glass", "red");
    write_sheet("far.obj", "sheet.mtl", -5000, "plain", "red");
    write_colored("colored.ply");
    assert_int_equal(mkdir("below", 0777), 0);
    assert_int_equal(mkdir("alone", 0777), 0);
}

static double number(const json_t *json, const char *path)
{
    char keys[128];
    snprintf(keys, sizeof keys, "%s", path);
    for (char *key = strtok(keys, "."); key; key = strtok(NULL, "."))
        json = json_object_get(json, key);
    if (!json_is_number(json)) fail_msg("%s is no number", path);
    return json_number_value(json);
}

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

static json_t *simplify(const char *arguments)
{
    expect(0, "simplify %s --report r.json -q", arguments);
    json_t *json = json_load_file("r.json", 0, NULL);
    assert_non_null(json);
    return json;
}

static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

static bool text_has(const char *path, const char *part)
{
    char text[4096];
    slurp(path, text, sizeof text);
    return strstr(text, part) != NULL;
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

static int setup(void **state)
{
    (void)state;
    enter_scratch();
    write_inputs();
    run_program(&run, "compare-mesh one.obj one.obj --samples 1 --views 1 --size-px 16");
    has_gl = run.code != 3;
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    leave_scratch();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formats_give_back_what_they_got),
        cmocka_unit_test(colors_of_vertices_are_kept),
        cmocka_unit_test(files_of_pictures_are_named_not_copied),
        cmocka_unit_test(embedded_pictures_are_written_beside),
        cmocka_unit_test(a_ply_says_what_it_cannot_keep),
        cmocka_unit_test(targets_are_reached),
        cmocka_unit_test(the_report_says_what_is_in_the_file),
        cmocka_unit_test(the_error_is_limited),
        cmocka_unit_test(half_edges_move_no_vertex),
        cmocka_unit_test(locked_borders_stay),
        cmocka_unit_test(wrong_calls_are_told),
        cmocka_unit_test(what_has_no_triangles_is_refused),
        cmocka_unit_test(the_materials_of_others_are_not_replaced),
        cmocka_unit_test(half_written_files_never_stay),
    };
    return cmocka_run_group_tests_name("cmd_simplify", tests, setup, teardown);
}

// LINK: prom_builder prom_metaobj
// Import: what arrives from each format, and what happens with files that are wrong.
#include "scene_files.h"

#include "builder/image_io.h"
#include "builder/import_parts.h"
#include "metaobj/base/log.h"

#include <signal.h>
#include <sys/resource.h>

static prom_source import_good(const char *path)
{
    prom_source source;
    prom_error error = {0};
    prom_status status = prom_source_import(path, NULL, &source, &error);
    if (status) fail_msg("%s", error.text);
    return source;
}

static prom_error import_bad(const char *path, const prom_import_options *options)
{
    prom_source source;
    prom_error error = {0};
    assert_int_equal(prom_source_import(path, options, &source, &error), PROM_ERR_INPUT);
    assert_int_equal(error.status, PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, path)); // an error names its file
    assert_null(strchr(error.text, '\n'));
    assert_int_equal(source.meshes.count, 0);
    return error;
}

static const prom_source_node *node_named(const prom_source *source, const char *name)
{
    for (size_t i = 0; i < source->nodes.count; i++)
        if (!strcmp(source->nodes.data[i].name, name)) return &source->nodes.data[i];
    fail_msg("no node '%s'", name);
    return NULL;
}

static void write_png(const char *name, uint32_t side, const uint8_t color[4])
{
    uint8_t pixels[64 * 64 * 4];
    for (uint32_t i = 0; i < side * side; i++) memcpy(pixels + 4 * i, color, 4);
    assert_int_equal(prom_image_write_png(scene_path(name), side, side, 4, pixels, NULL), 0);
}

// ---- OBJ

#define CUBE                                                                                   \
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"                 \
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"

static void a_missing_texture_is_a_neutral_color(void **state)
{
    (void)state;
    scene_write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl lost\nKd 0 0 0\nmap_Kd nowhere.png\n");
    const char *path = scene_write("a.obj", "mtllib a.mtl\n" CUBE
                                            "o one\nusemtl red\nf 1/1 4/4 3/3 2/2\no two\n"
                                            "usemtl lost\nf 5/1 6/2 7/3 8/4\n");
    prom_source s = import_good(path);
    assert_int_equal(s.meshes.count, 2);
    assert_int_equal(s.materials.count, 2);
    assert_int_equal(s.images.count, 1);
    assert_true(s.images.data[0].missing);
    assert_string_equal(s.images.data[0].name, "nowhere.png");
    assert_int_equal(s.images.data[0].width, 1);
    for (size_t i = 0; i < 2; i++) {
        const prom_material *m = &s.materials.data[s.meshes.data[i].submeshes[0].material];
        assert_int_equal(m->alpha_mode, PROM_ALPHA_OPAQUE);
        // A black colour beside a texture is white.
        float green = m->texture == PROM_NONE ? 0 : 1;
        assert_float_equal(m->base_color[1], green, 1e-6);
        assert_int_equal(s.meshes.data[i].index_count, 6);
    }
    prom_source_finish(&s);
}

static void v_runs_down_the_picture(void **state)
{
    (void)state;
    prom_source s = import_good(scene_write("uv.obj", CUBE "f 1/1 2/2 3/3\n"));
    const prom_mesh *m = &s.meshes.data[0];
    for (uint32_t i = 0; i < 3; i++) {
        const prom_vertex *v = &m->vertices[m->indices[i]];
        assert_float_equal(v->uv[0], v->position[0], 1e-6); // vt: u = x, v = y, from below
        assert_float_equal(v->uv[1], 1 - v->position[1], 1e-6);
    }
    prom_source_finish(&s);
}

static void diffuse_is_srgb_and_opacity_blends(void **state)
{
    (void)state;
    scene_write("d.mtl", "newmtl glass\nKd 0.5 0.5 0.5\nd 0.25\n");
    prom_source s =
        import_good(scene_write("d.obj", "mtllib d.mtl\n" CUBE "usemtl glass\nf 1 2 3\n"));
    const prom_material *m = &s.materials.data[0];
    assert_float_equal(m->base_color[0], 0.21404, 1e-4);
    assert_float_equal(m->base_color[3], 0.25, 1e-6);
    assert_int_equal(m->alpha_mode, PROM_ALPHA_BLEND);
    prom_source_finish(&s);
}

static void a_separate_mask_becomes_alpha(void **state)
{
    (void)state;
    write_png("Leaf.png", 8, (uint8_t[4]){10, 200, 30, 255});
    uint8_t half[4 * 4 * 3];
    for (int i = 0; i < 16; i++) memset(half + 3 * i, i % 4 < 2 ? 0 : 255, 3);
    prom_image_write_png(scene_path("mask.png"), 4, 4, 3, half, NULL);
    // Backslashes and another case of letters: as such files come.
    scene_write("m.mtl", "newmtl leaf\nKd 1 1 1\nmap_Kd C:\\pics\\leaf.PNG\nmap_d mask.png\n");
    prom_source s =
        import_good(scene_write("m.obj", "mtllib m.mtl\n" CUBE "usemtl leaf\nf 1/1 2/2 3/3\n"));
    assert_int_equal(s.images.count, 1);
    const prom_source_image *image = &s.images.data[0];
    assert_false(image->missing);
    assert_int_equal(image->width, 8);
    assert_int_equal(image->rgba[0], 10);
    assert_int_equal(image->rgba[3], 0);
    assert_int_equal(image->rgba[4 * 7 + 3], 255);
    const prom_material *m = &s.materials.data[0];
    assert_int_equal(m->alpha_mode, PROM_ALPHA_MASK);
    assert_int_equal(m->double_sided, 1);
    assert_float_equal(m->alpha_cutoff, 0.5, 1e-6);
    prom_source_finish(&s);
}

static void edges_of_a_box_stay_sharp(void **state)
{
    (void)state;
    prom_source s = import_good(scene_write(
        "box.obj", CUBE "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n"));
    const prom_mesh *m = &s.meshes.data[0];
    assert_int_equal(m->index_count, 36);
    assert_int_equal(m->vertex_count, 24); // three normals at each corner
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        const int8_t *n = m->vertices[v].normal;
        assert_int_equal(abs(n[0]) + abs(n[1]) + abs(n[2]), 127);
    }
    prom_source_finish(&s);
}

static void unusable_triangles_are_left_out(void **state)
{
    (void)state;
    prom_source s = import_good(
        scene_write("nan.obj", CUBE "v nan 0 0\nv 1e30 0 0\nf 1 2 3\nf 1 2 9\nf 1 2 10\n"
                                    "f 1 1 2\nf 1 3 4\n"));
    assert_int_equal(s.meshes.data[0].index_count, 6);
    assert_null(prom_mesh_check(&s.meshes.data[0], (uint32_t)s.materials.count));
    prom_source_finish(&s);
}

// ---- glTF

static void instances_share_a_mesh_and_keep_the_hierarchy(void **state)
{
    (void)state;
    prom_source s = import_good(scene_write_gltf(
        "inst.gltf", "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":["
                     "{\"name\":\"top\",\"translation\":[10,0,0],\"children\":[1,2]},"
                     "{\"name\":\"left\",\"mesh\":0,\"translation\":[0,5,0]},"
                     "{\"name\":\"mirrored\",\"mesh\":0,\"scale\":[-2,2,2]}],"
                     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]"));
    assert_int_equal(s.meshes.count, 1);
    assert_int_equal(s.mesh_refs.count, 2);
    const prom_source_node *left = node_named(&s, "left"), *other = node_named(&s, "mirrored");
    assert_string_equal(s.nodes.data[left->parent].name, "top");
    assert_float_equal(left->world[12], 10, 1e-9);
    assert_float_equal(left->world[13], 5, 1e-9);
    assert_float_equal(left->local[12], 0, 1e-9);
    assert_float_equal(other->world[0], -2, 1e-9);
    assert_int_equal(s.mesh_refs.data[left->first_mesh], s.mesh_refs.data[other->first_mesh]);
    for (size_t i = 1; i < s.nodes.count; i++) assert_true(s.nodes.data[i].parent < i);
    prom_source_finish(&s);
}

static void gltf_colors_are_linear_and_equal_materials_merge(void **state)
{
    (void)state;
    prom_source s = import_good(scene_write_gltf(
        "mat.gltf",
        "\"scenes\":[{\"nodes\":[0]}],\"scene\":0,\"nodes\":[{\"mesh\":0}],\"materials\":["
        "{\"name\":\"a\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1]}},"
        "{\"name\":\"b\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1]},"
        "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.4},"
        "{\"name\":\"c\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.5]},"
        "\"alphaMode\":\"BLEND\",\"doubleSided\":true}],"
        "\"meshes\":[{\"primitives\":["
        "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"COLOR_0\":2},\"material\":0},"
        "{\"attributes\":{\"POSITION\":0},\"material\":1},"
        "{\"attributes\":{\"POSITION\":0},\"material\":2}]}]"));
    assert_int_equal(s.meshes.count, 3);
    assert_int_equal(s.materials.count, 2); // b masks nothing: it is a
    const prom_material *a = &s.materials.data[0], *c = &s.materials.data[1];
    assert_float_equal(a->base_color[0], 0.5, 1e-6);
    assert_int_equal(a->alpha_mode, PROM_ALPHA_OPAQUE);
    assert_int_equal(a->double_sided, 0);
    assert_int_equal(c->alpha_mode, PROM_ALPHA_BLEND);
    assert_int_equal(c->double_sided, 1);
    assert_float_equal(c->base_color[3], 0.5, 1e-6);
    const prom_mesh *m = &s.meshes.data[0];
    for (uint32_t i = 0; i < 3; i++) {
        const prom_vertex *v = &m->vertices[m->indices[i]];
        // uv = position in the file, v = 0 is the first row already.
        assert_float_equal(v->uv[0], v->position[0], 1e-6);
        assert_float_equal(v->uv[1], v->position[1], 1e-6);
        if (v->position[0] + v->position[1] == 0) assert_int_equal(v->color[0], 188);
        assert_int_equal(v->normal[2], 127);
    }
    prom_source_finish(&s);
}

static void an_embedded_picture_is_read(void **state)
{
    (void)state;
    uint8_t pixels[2 * 2 * 4], *png;
    size_t bytes;
    for (int i = 0; i < 4; i++)
        memcpy(pixels + 4 * i, (uint8_t[4]){(uint8_t)(60 * i), 0, 255, i ? 255 : 0}, 4);
    assert_int_equal(prom_image_encode_png(2, 2, 4, pixels, &png, &bytes, NULL), 0);
    char *data = scene_base64(png, bytes), rest[4096];
    snprintf(
        rest, sizeof rest,
        "\"scenes\":[{\"nodes\":[0]}],\"scene\":0,\"nodes\":[{\"mesh\":0}],"
        "\"images\":[{\"uri\":\"data:image/png;base64,%s\"}],\"textures\":[{\"source\":0}],"
        "\"materials\":[{\"alphaMode\":\"MASK\",\"pbrMetallicRoughness\":"
        "{\"baseColorTexture\":{\"index\":0}}}],\"meshes\":[{\"primitives\":["
        "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]}]",
        data);
    prom_source s = import_good(scene_write_gltf("emb.gltf", rest));
    assert_int_equal(s.images.count, 1);
    assert_int_equal(s.images.data[0].width, 2);
    assert_memory_equal(s.images.data[0].rgba + 4, pixels + 4, 12);
    assert_int_equal(s.images.data[0].rgba[3], 0);
    assert_int_equal(s.materials.data[0].alpha_mode, PROM_ALPHA_MASK);
    assert_int_equal(s.materials.data[0].double_sided, 0);
    free(data);
    prom_free(png);
    prom_source_finish(&s);
}

// ---- PLY

static void a_ply_has_smooth_normals_and_its_colors(void **state)
{
    (void)state;
    // A shallow pyramid without normals: its top vertex takes the mean of four faces.
    prom_source s = import_good(scene_write(
        "p.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                 "property float z\nproperty uchar red\nproperty uchar green\n"
                 "property uchar blue\nelement face 4\n"
                 "property list uchar int vertex_indices\nend_header\n"
                 "-1 0 -1 255 0 0\n1 0 -1 0 255 0\n1 0 1 0 0 255\n-1 0 1 128 128 128\n"
                 "0 0.2 0 255 255 255\n3 1 0 4\n3 2 1 4\n3 3 2 4\n3 0 3 4\n"));
    const prom_mesh *m = &s.meshes.data[0];
    assert_int_equal(m->index_count, 12);
    assert_int_equal(m->vertex_count, 5);
    for (uint32_t v = 0; v < 5; v++) {
        const prom_vertex *p = &m->vertices[v];
        if (p->position[1] > 0) assert_int_equal(p->normal[1], 127);
        if (p->position[0] < 0 && p->position[2] > 0) assert_int_equal(p->color[0], 128);
    }
    assert_float_equal(s.materials.data[0].base_color[0], 1, 1e-6); // colours replace the grey
    prom_source_finish(&s);
}

// ---- the same file, the same content

static void equal_files_have_equal_hashes(void **state)
{
    (void)state;
    prom_source a = import_good(scene_write("h1.obj", CUBE "f 1 2 3\nf 1 3 4\n"));
    prom_source b = import_good(scene_write("h2.obj", CUBE "f 1 2 3\nf 1 3 4\n"));
    prom_source c = import_good(scene_write("h2.obj", CUBE "f 1 2 3\nf 1 3 8\n"));
    prom_source d = import_good(scene_path("h2.obj"));
    assert_int_equal(c.content_hash, d.content_hash);
    assert_int_not_equal(b.content_hash, c.content_hash);
    assert_int_equal(a.nodes.count, b.nodes.count);
    assert_true(a.file_bytes > 0);
    prom_source_finish(&a);
    prom_source_finish(&b);
    prom_source_finish(&c);
    prom_source_finish(&d);
}

// ---- wrong files

static void wrong_files_are_one_clear_error(void **state)
{
    (void)state;
    import_bad(scene_path("absent.obj"), NULL);
    prom_error error = import_bad(scene_folder, NULL);
    assert_non_null(strstr(error.text, "folder"));
    error = import_bad(scene_write("x.foo", "what is this\n"), NULL);
    assert_non_null(strstr(error.text, "format"));
    error = import_bad(scene_write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n"), NULL);
    error = import_bad(scene_write("flat.obj", CUBE "f 1 1 1\n"), NULL);
    assert_non_null(strstr(error.text, "has no triangles"));
    import_bad(scene_write("broken.gltf", "{\"asset\":{\"version\":\"2.0\"},\n\"nodes\":[\n"),
               NULL);
    import_bad(scene_write("empty.ply", ""), NULL);
}

static void a_truncated_file_never_ends_the_program(void **state)
{
    (void)state;
    scene_write_gltf("whole.gltf",
                     "\"scenes\":[{\"nodes\":[0]}],\"scene\":0,\"nodes\":[{\"mesh\":0}],"
                     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]");
    char text[2048];
    FILE *f = fopen(scene_path("whole.gltf"), "rb");
    assert_non_null(f);
    size_t n = fread(text, 1, sizeof text, f);
    fclose(f);
    for (size_t cut = 0; cut + 3 < n; cut += 37)
        import_bad(scene_write_bytes("cut.gltf", text, cut), NULL);
}

// ---- a loader that dies

static void die(void)
{
    raise(SIGSEGV);
}

static void spin(void)
{
    for (volatile unsigned i = 0;; i++) {
    }
}

static void sleep_on(void)
{
    for (;;) pause();
}

static prom_error with_hook(void (*hook)(void), const prom_import_options *options)
{
    const char *path = scene_write("hook.obj", CUBE "f 1 2 3\n");
    prom_import_child_hook = hook;
    prom_error error = import_bad(path, options);
    prom_import_child_hook = NULL;
    print_message("%s\n", error.text);
    return error;
}

static void a_crash_names_the_signal(void **state)
{
    (void)state;
    assert_non_null(strstr(with_hook(die, NULL).text, "crashed (signal 11"));
}

static void a_loop_and_a_hang_end_in_time(void **state)
{
    (void)state;
    prom_import_options brief = {.time_s = 1};
    // On a busy machine the clock may come first.
    prom_error spun = with_hook(spin, &brief);
    assert_true(strstr(spun.text, "within 1 s of processor time") ||
                strstr(spun.text, "within 4 s by the clock"));
    assert_non_null(strstr(with_hook(sleep_on, &brief).text, "within 4 s by the clock"));
}

#ifndef PROM_SANITIZE
static void hoard(void)
{
    for (;;) memset(prom_alloc(1 << 20, 16), 1, 1 << 24);
}

static void too_much_memory_says_so(void **state)
{
    (void)state;
    prom_import_options small = {.memory_bytes = 256u << 20};
    assert_non_null(strstr(with_hook(hoard, &small).text, "out of memory (limit 256 MiB)"));
}
#endif

// ---- what the child hands over is not trusted

static size_t pack(prom_source *source, uint8_t **data)
{
    size_t bytes = 0;
    prom_error none = {0};
    FILE *file = open_memstream((char **)data, &bytes);
    assert_non_null(file);
    assert_true(prom_import_pack(file, source, NULL, 0, &none));
    fclose(file);
    return bytes;
}

static void damaged_results_are_refused(void **state)
{
    (void)state;
    prom_source s = import_good(scene_write("w.obj", CUBE "f 1/1 2/2 3/3\n")), out;
    uint8_t *data = NULL;
    size_t bytes = pack(&s, &data);
    assert_int_equal(prom_import_unpack(data, bytes, "w", &out, NULL), PROM_OK);
    assert_int_equal(out.content_hash, s.content_hash);
    prom_source_finish(&out);
    for (size_t cut = 0; cut < bytes; cut++) {
        uint8_t *exact = malloc(cut + 1); // an exact size shows every byte read too many
        assert_non_null(exact);
        memcpy(exact + 1, data, cut);
        assert_int_equal(prom_import_unpack(exact + 1, cut, "w", &out, NULL), PROM_ERR_INPUT);
        free(exact);
    }
    for (size_t bit = 0; bit < bytes * 8; bit++) {
        data[bit / 8] ^= (uint8_t)(1u << bit % 8);
        if (!prom_import_unpack(data, bytes, "w", &out, NULL)) {
            assert_null(prom_mesh_check(&out.meshes.data[0], (uint32_t)out.materials.count));
            prom_source_finish(&out);
        }
        data[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    free(data);
    prom_source_finish(&s);
}

static void names_are_made_printable(void **state)
{
    (void)state;
    prom_source s = import_good(scene_write("n.obj", CUBE "f 1 2 3\n")), out;
    s.nodes.data[0].name = "a\n\xff\xc3\xa9\xe2\x82z";
    uint8_t *data = NULL;
    size_t bytes = pack(&s, &data);
    assert_int_equal(prom_import_unpack(data, bytes, "n", &out, NULL), PROM_OK);
    assert_string_equal(out.nodes.data[0].name, "a??\xc3\xa9??z");
    free(data);
    prom_source_finish(&out);
    prom_source_finish(&s);
}

int main(void)
{
    prom_log_set_level(PROM_LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_missing_texture_is_a_neutral_color),
        cmocka_unit_test(v_runs_down_the_picture),
        cmocka_unit_test(diffuse_is_srgb_and_opacity_blends),
        cmocka_unit_test(a_separate_mask_becomes_alpha),
        cmocka_unit_test(edges_of_a_box_stay_sharp),
        cmocka_unit_test(unusable_triangles_are_left_out),
        cmocka_unit_test(instances_share_a_mesh_and_keep_the_hierarchy),
        cmocka_unit_test(gltf_colors_are_linear_and_equal_materials_merge),
        cmocka_unit_test(an_embedded_picture_is_read),
        cmocka_unit_test(a_ply_has_smooth_normals_and_its_colors),
        cmocka_unit_test(equal_files_have_equal_hashes),
        cmocka_unit_test(wrong_files_are_one_clear_error),
        cmocka_unit_test(a_truncated_file_never_ends_the_program),
        cmocka_unit_test(a_crash_names_the_signal),
        cmocka_unit_test(a_loop_and_a_hang_end_in_time),
#ifndef PROM_SANITIZE
        cmocka_unit_test(too_much_memory_says_so),
#endif
        cmocka_unit_test(damaged_results_are_refused),
        cmocka_unit_test(names_are_made_printable),
    };
    return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}

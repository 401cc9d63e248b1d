// LINK: prom_scenes prom_builder prom_metaobj
// Tiles: what is copied, what stands once, and what is refused.
#include "scene_files.h"

#include "builder/image_io.h"
#include "builder/source.h"
#include "metaobj/base/log.h"
#include "scenes/tile.h"

#define MESH "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1}"
#define SCENE "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"

static prom_source import_good(const char *path)
{
    prom_source source;
    prom_error error = {0};
    prom_status status = prom_source_import(path, NULL, &source, &error);
    if (status) fail_msg("%s", error.text);
    return source;
}

static void tile_good(const char *in, const char *out, uint32_t columns, uint32_t rows)
{
    prom_tile_options options = {columns, rows, {0, 0}};
    prom_error error = {0};
    prom_status status = prom_tile_write(in, out, &options, &error);
    if (status) fail_msg("%s", error.text);
}

static prom_error tile_bad(const char *in, prom_status expected)
{
    prom_tile_options options = {3, 3, {0, 0}};
    prom_error error = {0};
    unsigned before = scene_folder_count();
    assert_int_equal(prom_tile_write(in, scene_path("bad.glb"), &options, &error), expected);
    assert_int_equal(scene_folder_count(), before); // nothing half-written stays
    assert_non_null(strstr(error.text, in));
    return error;
}

static uint64_t placed_triangles(const prom_source *s)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < s->mesh_refs.count; i++)
        sum += s->meshes.data[s->mesh_refs.data[i]].index_count / 3;
    return sum;
}

static unsigned nodes_named(const prom_source *s, const char *name,
                            const prom_source_node **last)
{
    unsigned count = 0;
    for (size_t i = 0; i < s->nodes.count; i++)
        if (!strcmp(s->nodes.data[i].name, name)) {
            count++;
            if (last) *last = &s->nodes.data[i];
        }
    return count;
}

static char *slurp(const char *path, size_t *bytes)
{
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    char *data = calloc(1, 1 << 20);
    assert_non_null(data);
    *bytes = fread(data, 1, (1 << 20) - 1, f);
    fclose(f);
    return data;
}

static void nine_tiles_have_nine_times_the_triangles(void **state)
{
    (void)state;
    const char *in = scene_write_gltf(
        "t.gltf",
        SCENE "\"nodes\":[{\"name\":\"top\",\"children\":[1,2]},"
              "{\"name\":\"thing\",\"mesh\":0,\"translation\":[1,2,3],"
              "\"extras\":{\"lods\":[{\"mesh\":0,\"distance\":80.5}]}},"
              "{\"name\":\"other\",\"mesh\":0,\"translation\":[4,0,9]}]," MESH "}]}]");
    const char *out = scene_path("t.glb");
    tile_good(in, out, 3, 3);
    prom_source a = import_good(in), b = import_good(out);
    assert_int_equal(placed_triangles(&b), 9 * placed_triangles(&a));
    assert_int_equal(b.meshes.count, a.meshes.count); // shared, not copied
    assert_int_equal(nodes_named(&b, "thing", NULL), 9);
    // Spacing: the size of the layout: x from 1 to 5, z from 3 to 9.
    const prom_source_node *tile = NULL;
    assert_int_equal(nodes_named(&b, "tile_2_0", &tile), 1);
    assert_float_equal(tile->world[12], 4, 1e-5);
    assert_float_equal(tile->world[13], 0, 1e-5);
    assert_float_equal(tile->world[14], -6, 1e-5);
    assert_int_equal(nodes_named(&b, "tile_1_1", &tile), 1); // the original stays in place
    assert_float_equal(tile->world[12], 0, 1e-9);
    prom_source_finish(&a);
    prom_source_finish(&b);
    size_t bytes;
    unsigned lods = 0;
    char *data = slurp(out, &bytes);
    for (const char *c = data + 20;
         (c = strstr(c, "{\"lods\":[{\"mesh\":0,\"distance\":80.5}]}")); c++)
        lods++;
    assert_int_equal(lods, 9);
    free(data);
}

static void pictures_and_buffers_are_embedded(void **state)
{
    (void)state;
    uint8_t pixels[4 * 4 * 4];
    memset(pixels, 77, sizeof pixels);
    prom_image_write_png(scene_path("my pic.png"), 4, 4, 4, pixels, NULL);
    scene_write_bytes("tri.bin", &scene_triangle_unit, sizeof scene_triangle_unit);
    char *text = scene_gltf(
        "tri.bin", SCENE
        "\"nodes\":[{\"mesh\":0}],\"images\":[{\"uri\":\"my%20pic.png\"},"
        "{\"uri\":\"lost.png\"}],\"textures\":[{\"source\":0},{\"source\":1}],"
        "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}]," MESH
        ",\"material\":0}]}]");
    tile_good(scene_write("e.gltf", text), scene_path("e.glb"), 2, 1);
    free(text);
    unlink(scene_path("my pic.png"));
    unlink(scene_path("tri.bin"));
    prom_source s = import_good(scene_path("e.glb"));
    assert_int_equal(placed_triangles(&s), 2);
    assert_int_equal(s.images.count, 1);
    assert_false(s.images.data[0].missing);
    assert_int_equal(s.images.data[0].rgba[0], 77);
    // And a .glb can be tiled again.
    tile_good(scene_path("e.glb"), scene_path("ee.glb"), 1, 5);
    prom_source again = import_good(scene_path("ee.glb"));
    assert_int_equal(placed_triangles(&again), 10);
    assert_false(again.images.data[0].missing);
    prom_source_finish(&s);
    prom_source_finish(&again);
}

// 36 things 10 apart; a ground and a sky 1000 wide share the mesh of node 36; another sky hangs
// below a node that also holds a thing.
static void the_backdrop_stands_once(void **state)
{
    (void)state;
    char rest[16384];
    int n = snprintf(rest, sizeof rest, "\"scene\":0,\"scenes\":[{\"nodes\":[");
    for (int i = 0; i < 38; i++)
        n += snprintf(rest + n, sizeof rest - (size_t)n, "%s%d", i ? "," : "", i);
    n += snprintf(rest + n, sizeof rest - (size_t)n, "]}],\"nodes\":[");
    for (int i = 0; i < 36; i++)
        n += snprintf(rest + n, sizeof rest - (size_t)n,
                      "{\"name\":\"thing\",\"mesh\":0,\"translation\":[%d,0,%d]},", i % 6 * 10,
                      i / 6 * 10);
    snprintf(rest + n, sizeof rest - (size_t)n,
             "{\"name\":\"ground and sky\",\"mesh\":1},"
             "{\"name\":\"group\",\"translation\":[5,0,5],\"children\":[38,39]},"
             "{\"name\":\"thing\",\"mesh\":0},"
             "{\"name\":\"sky\",\"mesh\":0,\"scale\":[1000,1000,1000]}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]},"
             "{\"primitives\":[{\"attributes\":{\"POSITION\":3}},"
             "{\"attributes\":{\"POSITION\":4}}]}]");
    char *data = scene_base64(&scene_triangle_unit, sizeof scene_triangle_unit);
    // The accessors 3 and 4 claim wider bounds than the unit triangle: the layout goes by them.
    char *text = scene_gltf("@", rest), *whole = malloc(strlen(text) + strlen(data) + 512);
    assert_non_null(whole);
    char *at = strchr(text, '@'), *end = strstr(text, "\"type\":\"VEC4\"}]");
    assert_non_null(end);
    end += strlen("\"type\":\"VEC4\"}");
    sprintf(whole, "%.*sdata:;base64,%s%.*s,%s,%s%s", (int)(at - text), text, data,
            (int)(end - at - 1), at + 1,
            "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
            "\"min\":[0,0,0],\"max\":[60,0,60]}",
            "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
            "\"min\":[-500,0,-500],\"max\":[500,100,500]}",
            end);
    const char *in = scene_write("b.gltf", whole), *out = scene_path("b.glb");
    tile_good(in, out, 3, 3);
    prom_source s = import_good(out);
    // 37 things and the ground nine times, two skies once.
    assert_int_equal(placed_triangles(&s), 9 * 38 + 2);
    const prom_source_node *sky = NULL, *tile = NULL;
    assert_int_equal(nodes_named(&s, "tile_2_1", &tile), 1);
    assert_float_equal(tile->world[12], 60, 1e-4);
    unsigned with_mesh = 0;
    for (size_t i = 0; i < s.nodes.count; i++)
        with_mesh += !strcmp(s.nodes.data[i].name, "sky") && s.nodes.data[i].mesh_count;
    assert_int_equal(with_mesh, 1);
    nodes_named(&s, "sky", &sky);
    assert_true(sky->mesh_count == 1);
    assert_float_equal(sky->world[0], 1000, 1e-3); // where it stood
    assert_float_equal(sky->world[12], 5, 1e-4);
    free(data);
    free(text);
    free(whole);
    prom_source_finish(&s);
}

static void wrong_input_is_one_clear_error(void **state)
{
    (void)state;
    prom_error error = tile_bad(scene_write("x.obj", "v 0 0 0\n"), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "tiling needs"));
    error = tile_bad(scene_write("l.gltf", "{\n\"asset\": {\"version\": \"2.0\"},\n, }\n"),
                     PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "line 3"));
    error =
        tile_bad(scene_write("v1.gltf", "{\"asset\":{\"version\":\"1.0\"}}"), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "glTF 2"));
    tile_bad(scene_path("absent.gltf"), PROM_ERR_INPUT);
    tile_bad(scene_write_gltf("loop.gltf", SCENE "\"nodes\":[{\"children\":[1]},"
                                                 "{\"children\":[0]}]," MESH "}]}]"),
             PROM_ERR_INPUT);
    tile_bad(
        scene_write_gltf("child.gltf", SCENE "\"nodes\":[{\"children\":[7]}]," MESH "}]}]"),
        PROM_ERR_INPUT);
    tile_bad(scene_write_gltf("none.gltf", SCENE "\"nodes\":[{}]"), PROM_ERR_INPUT);
    char *text = scene_gltf("gone.bin", SCENE "\"nodes\":[{\"mesh\":0}]," MESH "}]}]");
    error = tile_bad(scene_write("gone.gltf", text), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "gone.bin"));
    scene_write_bytes("gone.bin", "short", 5);
    tile_bad(scene_path("gone.gltf"), PROM_ERR_INPUT);
    free(text);
}

static void wrong_options_are_usage_errors(void **state)
{
    (void)state;
    const char *in = scene_write_gltf("o.gltf", SCENE "\"nodes\":[{\"mesh\":0}]," MESH "}]}]");
    const prom_tile_options wrong[] = {
        {0, 3, {0, 0}}, {3, 1u << 20, {0, 0}}, {3, 3, {-1, 0}}, {3, 3, {0, 1.0 / 0.0}}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(prom_tile_write(in, scene_path("o.glb"), &wrong[i], NULL),
                         PROM_ERR_USAGE);
    prom_tile_options good = {1, 1, {0, 0}};
    assert_int_equal(prom_tile_write(in, scene_path("no/o.glb"), &good, NULL), PROM_ERR_OUTPUT);
}

static void a_damaged_glb_never_ends_the_program(void **state)
{
    (void)state;
    const char *in = scene_write_gltf("d.gltf", SCENE "\"nodes\":[{\"mesh\":0}]," MESH "}]}]");
    tile_good(in, scene_path("d.glb"), 1, 1);
    size_t bytes;
    char *data = slurp(scene_path("d.glb"), &bytes);
    prom_tile_options options = {2, 2, {0, 0}};
    for (size_t cut = 0; cut < bytes; cut++)
        assert_int_not_equal(prom_tile_write(scene_write_bytes("d2.glb", data, cut),
                                             scene_path("d3.glb"), &options, NULL),
                             PROM_OK);
    for (size_t bit = 0; bit < bytes * 8; bit += 31) {
        data[bit / 8] = (char)(data[bit / 8] ^ 1 << bit % 8);
        prom_tile_write(scene_write_bytes("d2.glb", data, bytes), scene_path("d3.glb"),
                        &options, NULL);
        data[bit / 8] = (char)(data[bit / 8] ^ 1 << bit % 8);
    }
    free(data);
}

int main(void)
{
    prom_log_set_level(PROM_LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nine_tiles_have_nine_times_the_triangles),
        cmocka_unit_test(pictures_and_buffers_are_embedded),
        cmocka_unit_test(the_backdrop_stands_once),
        cmocka_unit_test(wrong_input_is_one_clear_error),
        cmocka_unit_test(wrong_options_are_usage_errors),
        cmocka_unit_test(a_damaged_glb_never_ends_the_program),
    };
    return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}

// LINK: prom_builder prom_metaobj
// Levels of detail by a scene's artist, and what is said about glTF files that show nothing.
#include "scene_files.h"

#include "builder/objects.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/log.h"

// Mesh 0 is the fixture's triangle; 1 and 2 are the same one, as an artist's coarser meshes.
#define MESHES                                                                                 \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]},"                        \
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]},"                     \
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":1}]}],"                    \
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0,0,1]}},"               \
    "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,1,1]}}]"
#define SCENE(roots) "\"scene\":0,\"scenes\":[{\"nodes\":[" roots "]}],\"nodes\":["

static prom_source import_good(const char *path)
{
    prom_source source;
    prom_error error = {0};
    if (prom_source_import(path, NULL, &source, &error)) fail_msg("%s", error.text);
    return source;
}

static prom_source import_gltf(const char *rest)
{
    return import_good(scene_write_gltf("levels.gltf", rest));
}

static void expect_error(const char *path, const char *text)
{
    prom_source source;
    prom_error error = {0};
    assert_int_equal(prom_source_import(path, NULL, &source, &error), PROM_ERR_INPUT);
    if (!strstr(error.text, text)) fail_msg("'%s' is not in '%s'", text, error.text);
    assert_non_null(strstr(error.text, path));
}

static const prom_source_node *node_named(const prom_source *source, const char *name)
{
    for (size_t i = 0; i < source->nodes.count; i++)
        if (!strcmp(source->nodes.data[i].name, name)) return &source->nodes.data[i];
    fail_msg("no node '%s'", name);
    return NULL;
}

// The red part of the material of the first mesh of a level; tells the meshes apart.
static float red_of(const prom_source *s, uint32_t first_mesh)
{
    const prom_mesh *m = &s->meshes.data[s->mesh_refs.data[first_mesh]];
    return s->materials.data[m->submeshes[0].material].base_color[0];
}

static uint32_t placed_meshes(const prom_source *s)
{
    uint32_t count = 0;
    for (size_t i = 0; i < s->nodes.count; i++) count += s->nodes.data[i].mesh_count;
    return count;
}

// ---- extras.lods

static void meshes_named_in_extras_become_levels(void **state)
{
    (void)state;
    prom_source s = import_gltf(SCENE(
        "0,1,2") "{\"name\":\"a\",\"mesh\":0,\"extras\":{\"lods\":["
                 "{\"mesh\":0,\"distance\":80},{\"mesh\":1,\"distance\":500.5},"
                 "{\"mesh\":2,\"distance\":2000}]}},"
                 "{\"name\":\"b\",\"mesh\":0,\"translation\":[5,0,0],\"extras\":{\"lods\":["
                 "{\"mesh\":0,\"distance\":80},{\"mesh\":1,\"distance\":500.5},"
                 "{\"mesh\":2,\"distance\":2000}]}},"
                 "{\"name\":\"c\",\"mesh\":0}]," MESHES);
    const prom_source_node *a = node_named(&s, "a"), *c = node_named(&s, "c");
    assert_int_equal(a->level_count, 2);
    assert_float_equal(a->until, 80, 0);
    const prom_source_level *l = &s.levels.data[a->first_level];
    assert_float_equal(l[0].until, 500.5, 0);
    assert_float_equal(l[1].until, 2000, 0);
    assert_float_equal(red_of(&s, a->first_mesh), 1, 0); // white
    assert_float_equal(red_of(&s, l[0].first_mesh), 1, 0);
    assert_float_equal(red_of(&s, l[1].first_mesh), 0, 0);
    assert_int_equal(c->level_count, 0);
    assert_true(isinf(c->until));
    assert_int_equal(placed_meshes(&s), 3); // the levels place nothing
    assert_int_equal(s.mesh_refs.count, 7);
    for (size_t i = 0; i < s.nodes.count; i++)
        assert_null(strstr(s.nodes.data[i].name, "promenade"));

    // a and b share a shape with levels; c, without any, has one of its own.
    prom_objects objects;
    assert_int_equal(prom_objects_find(&s, NULL, &objects, NULL), PROM_OK);
    assert_int_equal(objects.shapes.count, 2);
    assert_int_equal(objects.objects.count, 3);
    for (size_t i = 0; i < 2; i++) {
        const prom_shape *shape = &objects.shapes.data[i];
        assert_int_equal(shape->level_count, shape->instances == 2 ? 2 : 0);
        if (!shape->level_count) continue;
        assert_float_equal(shape->until, 80, 0);
        assert_float_equal(shape->levels[1].until, 2000, 0);
        assert_int_equal(shape->levels[1].mesh.index_count, 3);
    }
    prom_objects_finish(&objects);
    prom_source_finish(&s);
}

static void levels_that_contradict_themselves_are_ignored(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "{\"mesh\":0,\"distance\":80},{\"mesh\":1,\"distance\":70}", // falling
        "{\"mesh\":0,\"distance\":80},{\"mesh\":9,\"distance\":90}", // no such mesh
        "{\"mesh\":1,\"distance\":80},{\"mesh\":2,\"distance\":90}", // not the node's own
        "{\"mesh\":0,\"distance\":\"far\"},{\"mesh\":1,\"distance\":90}",
        "{\"mesh\":0,\"distance\":-1},{\"mesh\":1,\"distance\":90}",
        "1,2"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char rest[2048];
        snprintf(rest, sizeof rest,
                 SCENE("0") "{\"mesh\":0,\"extras\":{\"lods\":[%s]}}]," MESHES, wrong[i]);
        prom_source s = import_gltf(rest);
        assert_int_equal(s.levels.count, 0);
        assert_int_equal(placed_meshes(&s), 1);
        prom_source_finish(&s);
    }
}

// ---- MSFT_lod

#define LOD(ids, shares)                                                                       \
    "\"extensions\":{\"MSFT_lod\":{\"ids\":[" ids "]}},"                                       \
    "\"extras\":{\"MSFT_screencoverage\":[" shares "]}"

static void shares_of_the_picture_become_distances(void **state)
{
    (void)state;
    // The two instances differ in scale, so their distances do.
    prom_source s = import_gltf(SCENE("0,1") "{\"name\":\"a\",\"mesh\":0," LOD(
        "2,3", "0.5,0.1,0.01") "},"
                               "{\"name\":\"b\",\"mesh\":0,\"scale\":[4,4,4]," LOD(
                                   "2,3", "0.5,0.1") "},"
                                                     "{\"name\":\"x\",\"mesh\":1},{\"name\":"
                                                     "\"y\",\"mesh\":2}]," MESHES);
    const prom_source_node *a = node_named(&s, "a"), *b = node_named(&s, "b");
    assert_int_equal(s.levels.count, 4);
    assert_int_equal(placed_meshes(&s), 2);
    // A disc of half the picture's area, 60 degrees high and 16:9: the sphere around a triangle
    // of 1 x 1 has the radius sqrt(2) / 2.
    const float area = 4 * 16.0f / 9, radius = sqrtf(0.5f), pi = 3.14159265f;
    float expected = radius * sqrtf(3) * sqrtf(pi / (area * 0.5f));
    assert_float_equal(a->until, expected, 0.005f * expected);
    assert_float_equal(b->until, 4 * a->until, 0.01f * b->until);
    const prom_source_level *l = &s.levels.data[a->first_level];
    assert_float_equal(l[0].until, a->until * sqrtf(5), 0.01f * l[0].until);
    assert_float_equal(l[1].until, a->until * sqrtf(50), 0.01f * l[1].until);
    assert_true(
        isinf(s.levels.data[b->first_level + 1].until)); // no share given: to any distance
    prom_source_finish(&s);
}

static void a_level_may_be_a_hierarchy(void **state)
{
    (void)state;
    // Node 0 with a child; its level is node 2, turned and moved, with a child of its own.
    prom_source s = import_gltf(SCENE(
        "0,2") "{\"name\":\"a\",\"mesh\":0,\"translation\":[10,0,0],\"children\":[1]"
               "," LOD("2",
                       "0.5,0.1") "},"
                                  "{\"name\":\"a-child\",\"mesh\":0,\"translation\":[0,3,0]},"
                                  "{\"name\":\"low\",\"translation\":[11,0,0],\"children\":["
                                  "3]},"
                                  "{\"mesh\":1,\"scale\":[-1,1,2]}]," MESHES);
    const prom_source_node *a = node_named(&s, "a");
    assert_int_equal(a->mesh_count, 2); // its own and its child's
    assert_int_equal(node_named(&s, "a-child")->mesh_count, 0);
    assert_int_equal(a->level_count, 1);
    assert_int_equal(placed_meshes(&s), 2); // "low" is no node of the scene any more
    for (size_t i = 0; i < s.nodes.count; i++)
        assert_string_not_equal(s.nodes.data[i].name, "low");
    prom_box child = prom_mesh_bounds(&s.meshes.data[s.mesh_refs.data[a->first_mesh + 1]]);
    assert_float_equal(child.min[1], 3, 1e-6);
    const prom_mesh *low =
        &s.meshes.data[s.mesh_refs.data[s.levels.data[a->first_level].first_mesh]];
    prom_box box = prom_mesh_bounds(low); // x: 1 - [0, 1]
    assert_float_equal(box.min[0], 0, 1e-5);
    assert_float_equal(box.max[0], 1, 1e-5);
    // Mirrored: the triangle still runs counter-clockwise as its normal says.
    const prom_vertex *v = low->vertices;
    const uint32_t *t = low->indices;
    float ax = v[t[1]].position[0] - v[t[0]].position[0];
    float ay = v[t[1]].position[1] - v[t[0]].position[1];
    float bx = v[t[2]].position[0] - v[t[0]].position[0];
    float by = v[t[2]].position[1] - v[t[0]].position[1];
    assert_true((ax * by - ay * bx) * (float)v[t[0]].normal[2] > 0);
    prom_source_finish(&s);
}

static void broken_ids_are_ignored(void **state)
{
    (void)state;
    static const char *const wrong[] = {LOD("0", "0.5"), LOD("7", "0.5"), LOD("\"1\"", "0.5"),
                                        LOD("1", "0.1,0.5"), LOD("1", "-1")};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char rest[2048];
        snprintf(rest, sizeof rest, SCENE("0") "{\"mesh\":0,%s},{\"mesh\":1}]," MESHES,
                 wrong[i]);
        prom_source s = import_gltf(rest);
        assert_int_equal(s.levels.count, 0);
        assert_int_equal(placed_meshes(&s), 1);
        prom_source_finish(&s);
    }
}

// ---- the same in a .glb, with the buffer in the container

static void put32(uint8_t *at, uint32_t v)
{
    for (int k = 0; k < 4; k++) at[k] = (uint8_t)(v >> (8 * k));
}

static size_t make_glb(const char *json, uint8_t *out)
{
    size_t n = (strlen(json) + 3) / 4 * 4, bin = sizeof scene_triangle_unit;
    memcpy(out, "glTF", 4);
    put32(out + 4, 2);
    put32(out + 8, (uint32_t)(28 + n + bin));
    put32(out + 12, (uint32_t)n);
    memcpy(out + 16, "JSON", 4);
    memset(out + 20, ' ', n);
    memcpy(out + 20, json, strlen(json));
    put32(out + 20 + n, (uint32_t)bin);
    memcpy(out + 24 + n, "BIN\0", 4);
    memcpy(out + 28 + n, &scene_triangle_unit, bin);
    return 28 + n + bin;
}

static void a_binary_container_keeps_its_levels(void **state)
{
    (void)state;
    char *text = scene_gltf("@", SCENE("0") "{\"mesh\":0,\"extras\":{\"lods\":[{\"mesh\":0,"
                                            "\"distance\":8},{\"mesh\":1,\"distance\":20}]}}]"
                                            "," MESHES);
    char *uri = strstr(text, "\"uri\":\"@\",");
    memset(uri, ' ', strlen("\"uri\":\"@\","));
    uint8_t *glb = malloc(strlen(text) + 256);
    assert_non_null(glb);
    size_t bytes = make_glb(text, glb);
    prom_source s = import_good(scene_write_bytes("l.glb", glb, bytes));
    assert_int_equal(s.levels.count, 1);
    prom_source_finish(&s);
    // Cut anywhere, it is refused with a line that names it.
    for (size_t cut = 0; cut < bytes; cut += 53)
        expect_error(scene_write_bytes("cut.glb", glb, cut), "");
    put32(glb + 12, 0x7fffffff);
    expect_error(scene_write_bytes("long.glb", glb, bytes), "chunk at byte 12");
    free(glb);
    free(text);
}

// ---- files that show nothing, or not what they promise

static void what_is_wrong_with_a_file_is_said(void **state)
{
    (void)state;
    static const struct {
        const char *rest, *says;
    } cases[] = {
        {"\"nodes\":[{}]", "has no triangles (it holds no mesh)"},
        {"\"scene\":0,\"scenes\":[{}],\"nodes\":[{\"mesh\":0}]," MESHES,
         "has no triangles (no node of its scene places a mesh)"},
        {SCENE("0") "{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"mode\":1,"
                    "\"attributes\":{\"POSITION\":0}}]}]",
         "has no triangles (its meshes hold points"},
        {SCENE("0") "{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                    "\"POSITION\":7}}]}]",
         "\"POSITION\" of a primitive of mesh 0 is no index into its 3 accessors"},
        {SCENE("0") "{\"mesh\":5}]," MESHES, "\"mesh\" of node 0 is no index"},
        {SCENE("3") "{\"mesh\":0}]," MESHES, "entry 0 of scene 0"},
        {SCENE("0") "{\"children\":[1]},{\"children\":[0]}]," MESHES, "its own ancestor"},
        {SCENE("0") "{\"children\":[0.5]}]," MESHES, "child 0 of node 0"},
        {"\"nodes\":7", "\"nodes\" is no array"},
        {"\"nodes\":[7]", "element 0 of its \"nodes\" is no object"},
        {"\"nodes\":[,]", "line 5, column 10"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        expect_error(scene_write_gltf("wrong.gltf", cases[i].rest), cases[i].says);
}

static void missing_data_is_named(void **state)
{
    (void)state;
    static const char rest[] = SCENE("0") "{\"mesh\":0}]," MESHES;
    char *text = scene_gltf("gone.bin", rest);
    expect_error(scene_write("gone.gltf", text), "there is no file 'gone.bin' (buffer 0)");
    scene_write_bytes("gone.bin", &scene_triangle_unit, 20);
    expect_error(scene_path("gone.gltf"), "buffer 0 gone.bin has 20 bytes, 36 are used");
    // In another case of letters, as on systems that do not care.
    scene_write_bytes("Gone.BIN", &scene_triangle_unit, sizeof scene_triangle_unit);
    unlink(scene_path("gone.bin"));
    prom_source s = import_good(scene_path("gone.gltf"));
    assert_int_equal(placed_meshes(&s), 1);
    prom_source_finish(&s);
    free(text);
    text = scene_gltf("data:application/octet-stream;base64,AAAA", rest);
    expect_error(scene_write("short.gltf", text), "buffer 0 has 3 bytes, 36 are used");
    free(text);
}

static void a_file_without_a_scene_shows_all_of_it(void **state)
{
    (void)state;
    prom_source s = import_gltf("\"nodes\":[{\"children\":[1]},{\"mesh\":0}]," MESHES);
    assert_int_equal(placed_meshes(&s), 1);
    prom_source_finish(&s);
    s = import_gltf(
        "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1}]," MESHES);
    assert_int_equal(placed_meshes(&s), 1);
    prom_source_finish(&s);
}

int main(void)
{
    prom_log_set_level(PROM_LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes_named_in_extras_become_levels),
        cmocka_unit_test(levels_that_contradict_themselves_are_ignored),
        cmocka_unit_test(shares_of_the_picture_become_distances),
        cmocka_unit_test(a_level_may_be_a_hierarchy),
        cmocka_unit_test(broken_ids_are_ignored),
        cmocka_unit_test(a_binary_container_keeps_its_levels),
        cmocka_unit_test(what_is_wrong_with_a_file_is_said),
        cmocka_unit_test(missing_data_is_named),
        cmocka_unit_test(a_file_without_a_scene_shows_all_of_it),
    };
    return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}

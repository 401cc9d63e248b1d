// LINK: prom_builder prom_render prom_traverse prom_benefit prom_metaobj
// Weights by name, from the scene's nodes into the model.
#include "builder/pipeline.h"
#include "metaobj/container.h"
#include "render/context.h"
#include "scene_files.h"

static bool have_gl(void)
{
    prom_error error;
    prom_context *context = prom_context_create_headless(&error);
    if (!context) print_message("skipped: %s\n", error.text);
    prom_context_destroy(context);
    return context != NULL;
}

// A node without geometry, `statues`, over `arm` and `leg` > `toe`; beside it a `wall`. All
// show the same tetrahedron.
static const char *write_statues(void)
{
    static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const uint16_t indices[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    uint8_t bytes[sizeof positions + sizeof indices];
    memcpy(bytes, positions, sizeof positions);
    memcpy(bytes + sizeof positions, indices, sizeof indices);
    char text[4096], *data = scene_base64(bytes, sizeof bytes);
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,4]}],"
        "\"nodes\":[{\"name\":\"statues\",\"children\":[1,2]},"
        "{\"name\":\"arm\",\"mesh\":0,\"translation\":[3,0,0]},"
        "{\"name\":\"leg\",\"mesh\":0,\"translation\":[6,0,0],\"children\":[3]},"
        "{\"name\":\"toe\",\"mesh\":0,\"translation\":[0,0,3]},"
        "{\"name\":\"wall\",\"mesh\":0,\"translation\":[9,0,0]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,1]},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],"
        "\"buffers\":[{\"byteLength\":72,\"uri\":\"data:application/"
        "octet-stream;base64,%s\"}]}",
        data);
    free(data);
    return scene_write("statues.gltf", text);
}

static uint64_t build(const char *scene, const prom_weight_rules *rules, prom_model *model)
{
    prom_build_options options = {.weights = *rules};
    prom_error error = {0};
    if (prom_build(scene, scene_path("statues.prom"), &options, NULL, &error))
        fail_msg("%s", error.text);
    prom_container *c = prom_container_open(scene_path("statues.prom"), &error);
    assert_non_null(c);
    uint64_t hash = 0;
    assert_int_equal(prom_container_content_hash(c, &hash, &error), PROM_OK);
    assert_int_equal(prom_container_load_model(c, model, &error), PROM_OK);
    prom_container_close(c);
    return hash;
}

static float weight_of(const prom_model *m, const char *name)
{
    for (uint32_t n = 0; n < m->node_count; n++)
        if (!strcmp(m->names + m->name[n], name)) return m->weight[n];
    fail_msg("no node %s", name);
    return 0;
}

static void names_weigh_what_is_below_them(void **state)
{
    (void)state;
    if (!have_gl()) skip();
    const char *scene = write_statues();
    const prom_weight_rules none = {0};
    const prom_weight_rules rules = {
        .list = {{"stat*", 4, false}, {"leg", 0.5f, false}, {"nothing", 9, false}}, .count = 3};
    prom_model plain = {0}, weighted = {0};
    uint64_t plain_hash = build(scene, &none, &plain);
    uint64_t weighted_hash = build(scene, &rules, &weighted);
    for (uint32_t n = 0; n < plain.node_count; n++) assert_true(plain.weight[n] == 1);
    assert_true(weight_of(&weighted, "arm") == 4);
    assert_true(weight_of(&weighted, "leg") == 0.5f);
    assert_true(weight_of(&weighted, "toe") == 0.5f);
    assert_true(weight_of(&weighted, "wall") == 1);
    for (uint32_t n = 0; n < weighted.node_count; n++)
        if (weighted.child_count[n]) assert_true(weighted.weight[n] == 1);
    assert_true(plain_hash != weighted_hash);
    prom_model_finish(&plain);
    prom_model_finish(&weighted);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(names_weigh_what_is_below_them)};
    return cmocka_run_group_tests_name("weights of builds", tests, scene_folder_make,
                                       scene_folder_remove);
}

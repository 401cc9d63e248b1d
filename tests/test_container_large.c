// LINK: prom_metaobj
// LABEL: slow
// Meshes and textures that take more than one chunk.
#include "container_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static void assert_ok(prom_status status, const prom_error *error)
{
    if (status) print_error("%s\n", error->text);
    assert_int_equal(status, PROM_OK);
}

static void several_chunks(void **state)
{
    (void)state;
    prom_error error;
    fixture f;
    fixture_init(&f, 1, 2);
    uint32_t seed = 1;
    prom_mesh_finish(&f.meshes[0]);
    fixture_grid(&f.meshes[0], 1700, &seed); // 81 MB of vertices, 69 MB of indices
    prom_texture_finish(&f.textures[0]);
    fixture_picture(&f.textures[0], PROM_TEXTURE_COLOR, 4300, 4100, &seed);
    const prom_mesh *m = &f.meshes[0];
    const prom_texture *t = &f.textures[0];
    assert_true(m->index_count * sizeof *m->indices > PROM_CONTAINER_CHUNK_BYTES);
    assert_true(prom_texture_bytes(t) > PROM_CONTAINER_CHUNK_BYTES);
    f.model.meshes[0] = (prom_mesh_info){m->vertex_count, m->index_count, m->submesh_count};
    f.model.textures[0] =
        (prom_texture_info){t->kind, t->width, t->height, t->layers, t->levels};
    char *path = fixture_path("large");
    assert_ok(fixture_write(&f, path, 1, &error), &error);

    prom_container *c = prom_container_open(path, &error);
    assert_non_null(c);
    prom_model model;
    assert_ok(prom_container_load_model(c, &model, &error), &error);
    prom_mesh mesh;
    assert_ok(prom_container_read_mesh(c, &model, 0, &mesh, &error), &error);
    assert_true(prom_mesh_hash(&mesh, 0) == prom_mesh_hash(m, 0));
    assert_memory_equal(mesh.vertices, m->vertices, m->vertex_count * sizeof *m->vertices);
    prom_mesh_finish(&mesh);
    assert_ok(prom_container_read_mesh(c, &model, 1, &mesh, &error), &error);
    assert_true(prom_mesh_hash(&mesh, 0) == prom_mesh_hash(&f.meshes[1], 0));
    prom_mesh_finish(&mesh);
    prom_texture texture;
    assert_ok(prom_container_read_texture(c, &model, 0, &texture, &error), &error);
    assert_memory_equal(texture.pixels, t->pixels, prom_texture_bytes(t));
    prom_texture_finish(&texture);
    prom_model_finish(&model);
    prom_container_close(c);
    unlink(path);
    prom_free(path);
    fixture_finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(several_chunks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

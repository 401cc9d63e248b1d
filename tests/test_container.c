// LINK: prom_metaobj
// The container: what is written comes back, and nothing half-written stays.
#include "container_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/stat.h>

#include <cmocka.h>

static void assert_ok(prom_status status, const prom_error *error)
{
    if (status) print_error("%s\n", error->text);
    assert_int_equal(status, PROM_OK);
}

static bool exists(const char *path)
{
    struct stat info;
    return !stat(path, &info);
}

static void assert_same_triangles(const prom_mesh *a, const prom_mesh *b)
{
    assert_int_equal(a->index_count, b->index_count);
    for (uint32_t i = 0; i < a->index_count; i += 3) {
        const uint32_t *x = a->indices + i, *y = b->indices + i;
        bool same = false;
        for (int r = 0; r < 3; r++)
            same |= x[0] == y[r] && x[1] == y[(r + 1) % 3] && x[2] == y[(r + 2) % 3];
        assert_true(same);
    }
}

static void assert_same_mesh(const prom_mesh *a, const prom_mesh *b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_memory_equal(a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices);
    assert_int_equal(a->submesh_count, b->submesh_count);
    assert_memory_equal(a->submeshes, b->submeshes, a->submesh_count * sizeof *a->submeshes);
    assert_same_triangles(a, b);
    assert_int_equal(prom_mesh_hash(a, 0), prom_mesh_hash(b, 0));
}

#define assert_same_array(a, b, field, count)                                                  \
    assert_memory_equal((a)->field, (b)->field, (count) * sizeof *(a)->field)

static void assert_same_model(const prom_model *a, const prom_model *b)
{
    assert_int_equal(a->node_count, b->node_count);
    assert_int_equal(a->tree_count, b->tree_count);
    assert_same_array(a, b, parent, a->node_count);
    assert_same_array(a, b, first_child, a->node_count);
    assert_same_array(a, b, child_count, a->node_count);
    assert_same_array(a, b, prototype, a->node_count);
    assert_same_array(a, b, center, a->node_count);
    assert_same_array(a, b, half, a->node_count);
    assert_same_array(a, b, radius, a->node_count);
    for (uint32_t n = 0; n < a->node_count; n++) {
        assert_string_equal(a->names + a->name[n], b->names + b->name[n]);
        assert_memory_equal(a->placement[n].origin, b->placement[n].origin,
                            sizeof a->placement[n].origin);
        assert_memory_equal(a->placement[n].basis, b->placement[n].basis,
                            sizeof a->placement[n].basis);
    }
    assert_int_equal(a->prototype_count, b->prototype_count);
    for (uint32_t p = 0; p < a->prototype_count; p++) {
        prom_prototype x = a->prototypes[p], y = b->prototypes[p];
        if (!x.rep_count) x.first_rep = y.first_rep = 0; // without meaning
        assert_memory_equal(&x, &y, sizeof x);
    }
    assert_int_equal(a->rep_count, b->rep_count);
    assert_same_array(a, b, reps, a->rep_count);
    assert_same_array(a, b, accuracy, a->rep_count);
    assert_same_array(a, b, coverage, a->prototype_count);
    assert_int_equal(a->share_count, b->share_count);
    assert_same_array(a, b, shares, a->share_count);
    assert_int_equal(a->material_count, b->material_count);
    assert_same_array(a, b, materials, a->material_count);
    assert_int_equal(a->mesh_count, b->mesh_count);
    assert_same_array(a, b, meshes, a->mesh_count);
    assert_int_equal(a->texture_count, b->texture_count);
    assert_same_array(a, b, textures, a->texture_count);
}

static void check_stage(void *user, const char *name, uint64_t content_hash, double ms)
{
    assert_string_equal(name, "import");
    assert_true(content_hash == 0xfedcba9876543210u);
    assert_true(ms == 12.5);
    ++*(int *)user;
}

static void round_trip(void **state)
{
    (void)state;
    prom_error error;
    fixture f;
    fixture_init(&f, 5, 7);
    uint64_t row;
    assert_null(prom_model_check(&f.model, &row));
    char *path = fixture_path("round");
    assert_ok(fixture_write(&f, path, 12.5, &error), &error);
    prom_container *c = prom_container_open(path, &error);
    assert_non_null(c);
    assert_string_equal(prom_container_meta(c, "source"), "fixture");
    assert_null(prom_container_meta(c, "nothing"));
    int stages = 0;
    assert_ok(prom_container_stages(c, check_stage, &stages, &error), &error);
    assert_int_equal(stages, 1);
    prom_model m;
    assert_ok(prom_container_load_model(c, &m, &error), &error);
    assert_same_model(&f.model, &m);
    for (uint32_t i = 0; i < FIXTURE_MESHES; i++) {
        prom_mesh mesh;
        assert_ok(prom_container_read_mesh(c, &m, i, &mesh, &error), &error);
        assert_same_mesh(&f.meshes[i], &mesh);
        prom_mesh_finish(&mesh);
    }
    for (uint32_t i = 0; i < FIXTURE_TEXTURES; i++) {
        prom_texture t;
        assert_ok(prom_container_read_texture(c, &m, i, &t, &error), &error);
        assert_memory_equal(t.pixels, f.textures[i].pixels, prom_texture_bytes(&t));
        prom_texture_finish(&t);
    }
    prom_mesh none;
    assert_int_equal(prom_container_read_mesh(c, &m, FIXTURE_MESHES, &none, &error),
                     PROM_ERR_INPUT);
    prom_model_finish(&m);
    prom_container_close(c);
    unlink(path);
    prom_free(path);
    fixture_finish(&f);
}

static uint64_t content_hash(const char *path)
{
    prom_error error;
    uint64_t hash = 0;
    prom_container *c = prom_container_open(path, &error);
    assert_non_null(c);
    assert_ok(prom_container_content_hash(c, &hash, &error), &error);
    prom_container_close(c);
    return hash;
}

static void same_input_same_hash(void **state)
{
    (void)state;
    prom_error error;
    fixture f;
    fixture_init(&f, 3, 4);
    char *path = fixture_path("hash");
    assert_ok(fixture_write(&f, path, 1, &error), &error);
    uint64_t first = content_hash(path);
    assert_ok(fixture_write(&f, path, 99, &error), &error);
    assert_true(first == content_hash(path)); // durations do not count
    f.model.accuracy[2].bins[17][3] ^= 1;
    assert_ok(fixture_write(&f, path, 1, &error), &error);
    assert_true(first != content_hash(path));
    f.model.accuracy[2].bins[17][3] ^= 1;
    f.meshes[1].vertices[4].position[1] += 0.001f;
    assert_ok(fixture_write(&f, path, 1, &error), &error);
    assert_true(first != content_hash(path));
    unlink(path);
    prom_free(path);
    fixture_finish(&f);
}

static void unfinished_leaves_nothing(void **state)
{
    (void)state;
    prom_error error;
    fixture f;
    fixture_init(&f, 2, 2);
    char *path = fixture_path("unfinished");
    char *part = prom_format("%s.part", path), *journal = prom_format("%s-journal", part);
    prom_writer *w = prom_writer_create(path, &error);
    assert_non_null(w);
    assert_ok(prom_writer_add_mesh(w, &f.meshes[0], NULL, &error), &error);
    assert_true(exists(part));
    assert_int_equal(prom_writer_finish(w, &error), PROM_ERR_OUTPUT); // no model yet
    prom_writer_destroy(w);
    assert_false(exists(part));
    assert_false(exists(journal));
    assert_false(exists(path));
    prom_free(journal);
    prom_free(part);
    prom_free(path);
    fixture_finish(&f);
}

static void replaces_leftover(void **state)
{
    (void)state;
    prom_error error;
    fixture f;
    fixture_init(&f, 2, 2);
    char *path = fixture_path("leftover");
    char *part = prom_format("%s.part", path);
    FILE *file = fopen(part, "wb");
    assert_non_null(file);
    fputs("what a killed build left behind", file);
    fclose(file);
    assert_ok(fixture_write(&f, path, 1, &error), &error);
    assert_ok(fixture_read_all(path, &error), &error);
    assert_false(exists(part));
    unlink(path);
    prom_free(part);
    prom_free(path);
    fixture_finish(&f);
}

static void one_writer_at_a_time(void **state)
{
    (void)state;
    prom_error error;
    char *path = fixture_path("twice");
    char *part = prom_format("%s.part", path);
    prom_writer *first = prom_writer_create(path, &error);
    assert_non_null(first);
    assert_null(prom_writer_create(path, &error));
    assert_int_equal(error.status, PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, "another build"));
    assert_true(exists(part)); // the first one's, untouched
    prom_writer_destroy(first);
    prom_free(part);
    prom_free(path);
}

static void unwritable_place(void **state)
{
    (void)state;
    prom_error error;
    assert_null(prom_writer_create("no-such-folder/x.prom", &error));
    assert_int_equal(error.status, PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, "no-such-folder/x.prom"));
    assert_null(prom_writer_create(".", &error));
    assert_int_equal(error.status, PROM_ERR_OUTPUT);
}

static void writer_refuses_bad_data(void **state)
{
    (void)state;
    prom_error error;
    fixture f;
    fixture_init(&f, 2, 2);
    char *path = fixture_path("bad");
    prom_writer *w = prom_writer_create(path, &error);
    assert_non_null(w);
    f.meshes[0].indices[7] = f.meshes[0].vertex_count;
    assert_int_equal(prom_writer_add_mesh(w, &f.meshes[0], NULL, &error), PROM_ERR_OUTPUT);
    prom_texture t = f.textures[0];
    t.levels = 1;
    assert_int_equal(prom_writer_add_texture(w, &t, NULL, &error), PROM_ERR_OUTPUT);
    // Its meshes were never added.
    assert_int_equal(prom_writer_put_model(w, &f.model, &error), PROM_ERR_OUTPUT);
    f.model.parent[3] = 2;
    assert_int_equal(prom_writer_put_model(w, &f.model, &error), PROM_ERR_OUTPUT);
    prom_writer_destroy(w);
    prom_free(path);
    fixture_finish(&f);
}

static void refuses_other_files(void **state)
{
    (void)state;
    prom_error error;
    char *path = fixture_path("other");
    assert_null(prom_container_open(path, &error));
    assert_int_equal(error.status, PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "No such file"));
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs("a letter", file);
    fclose(file);
    assert_null(prom_container_open(path, &error));
    assert_non_null(strstr(error.text, "is not a .prom container"));
    assert_null(prom_container_open(".", &error));
    assert_int_equal(error.status, PROM_ERR_INPUT);
    unlink(path);
    prom_free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip),
        cmocka_unit_test(same_input_same_hash),
        cmocka_unit_test(unfinished_leaves_nothing),
        cmocka_unit_test(replaces_leftover),
        cmocka_unit_test(one_writer_at_a_time),
        cmocka_unit_test(unwritable_place),
        cmocka_unit_test(writer_refuses_bad_data),
        cmocka_unit_test(refuses_other_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

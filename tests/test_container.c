// LINK: prom_metaobj
// The container: what is written comes back, and nothing half-written stays.
#include "container_fixture.h"

#include "metaobj/base/log.h"
#include "metaobj/container_schema.h"

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
    f.model.accuracy[2][17][3] ^= 1;
    assert_ok(fixture_write(&f, path, 1, &error), &error);
    assert_true(first != content_hash(path));
    f.model.accuracy[2][17][3] ^= 1;
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

static void run_sql(const char *path, const char *sql)
{
    sqlite3 *db;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, sql, NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
}

static void assert_refused_after(const fixture *f, const char *sql, const char *expected)
{
    prom_error error = {0};
    char *path = fixture_path("changed");
    assert_ok(fixture_write(f, path, 1, &error), &error);
    run_sql(path, sql);
    assert_int_equal(fixture_read_all(path, &error), PROM_ERR_INPUT);
    if (!strstr(error.text, expected)) print_error("%s\n%s\n", sql, error.text);
    assert_non_null(strstr(error.text, expected));
    unlink(path);
    prom_free(path);
}

static void refuses_changed_files(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 3, 4);
    static const char *const cases[][2] = {
        {"PRAGMA application_id=7", "is not a .prom container"},
        {"PRAGMA user_version=2", "container format 2"},
        {"PRAGMA user_version=0", "container format 0"},
        {"DROP TABLE material", "table material is missing"},
        {"DROP TABLE node; CREATE VIEW node AS SELECT * FROM mesh", "table node is missing"},
        {"ALTER TABLE node ADD COLUMN more TEXT",
         "table node is missing or not of this format"},
        {"UPDATE node SET prototype=99 WHERE id=5", "table node"},
        {"UPDATE node SET first_child=-1 WHERE id=1", "table node, row 1: first_child is out"},
        {"UPDATE node SET radius=9e999 WHERE id=2", "table node, row 2: radius is not finite"},
        {"UPDATE node SET id=99 WHERE id=2", "table node, row 2: id is out of range"},
        {"DELETE FROM node WHERE id=14", "table node"},
        {"INSERT INTO mesh VALUES(4,1,1,1,1,1)", "table mesh, row 4: there is a row too many"},
        {"UPDATE accuracy SET value=x'00' WHERE id=3", "table accuracy, row 3: value has the"},
        {"UPDATE prototype SET child_count=5 WHERE id=1", "table prototype, row 1: shares has"},
        {"UPDATE mesh SET vertex_count=4000000000 WHERE id=1",
         "table mesh, row 1: it claims more data than the file holds"},
        {"UPDATE texture SET width=9000 WHERE id=0", "table texture, row 0: its kind or size"},
        {"UPDATE chunk SET data=x'0011' WHERE id=1", "table chunk, row 1"},
        {"UPDATE chunk SET checksum=checksum+1 WHERE id=4",
         "table chunk, row 4: its data do not"},
        {"DELETE FROM chunk WHERE id=7", "table chunk, row 7: the row is missing"},
        {"UPDATE chunk SET codec=9 WHERE id=0", "table chunk, row 0"},
        {"UPDATE table_rows SET row_count=4000000000 WHERE id=1", "table table_rows, row 1"},
        {"DELETE FROM table_rows WHERE id=9", "table table_rows, row 9: the row is missing"},
        {"UPDATE meta SET value='other'", "table meta"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused_after(&f, cases[i][0], cases[i][1]);
    fixture_finish(&f);
}

// Changes rows as a newer program might have written them, hashes included.
static void rewrite(const char *path, const char *sql, prom_table table)
{
    run_sql(path, sql);
    sqlite3 *db;
    uint64_t rows, hash;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(prom_table_hash(db, table, NULL, &rows, &hash), SQLITE_OK);
    sqlite3_close(db);
    char *update = prom_format("UPDATE table_rows SET row_count=%lld, hash=%lld WHERE id=%d",
                               (long long)rows, (long long)hash, (int)table);
    run_sql(path, update);
    prom_free(update);
}

static void unknown_kind_is_left_out(void **state)
{
    (void)state;
    prom_error error;
    fixture f;
    fixture_init(&f, 3, 4);
    char *path = fixture_path("newer");
    assert_ok(fixture_write(&f, path, 1, &error), &error);
    rewrite(path, "UPDATE representation SET kind=77, mesh=1234 WHERE id=1",
            PROM_TABLE_REPRESENTATION);
    prom_container *c = prom_container_open(path, &error);
    assert_non_null(c);
    prom_model m;
    prom_log_set_level(PROM_LOG_ERROR);
    assert_ok(prom_container_load_model(c, &m, &error), &error);
    prom_log_set_level(PROM_LOG_INFO);
    assert_int_equal(m.rep_count, f.model.rep_count - 1);
    assert_int_equal(m.prototypes[0].rep_count, 2);
    assert_int_equal(m.prototypes[1].first_rep, 2);
    for (uint32_t r = 1; r < m.rep_count; r++) {
        assert_memory_equal(&m.reps[r], &f.model.reps[r + 1], sizeof m.reps[r]);
        assert_memory_equal(m.accuracy[r], f.model.accuracy[r + 1], sizeof m.accuracy[r]);
    }
    prom_model_finish(&m);
    prom_container_close(c);
    // A leaf that loses its only mesh cannot be drawn.
    rewrite(path, "UPDATE representation SET kind=77 WHERE id=5", PROM_TABLE_REPRESENTATION);
    prom_log_set_level(PROM_LOG_ERROR);
    assert_int_equal(fixture_read_all(path, &error), PROM_ERR_INPUT);
    prom_log_set_level(PROM_LOG_INFO);
    assert_non_null(strstr(error.text, "a leaf prototype has no mesh (row 3)"));
    unlink(path);
    prom_free(path);
    fixture_finish(&f);
}

// Rows that a hostile writer made, with right hashes: the values themselves must be refused.
static void hostile_rows(void **state)
{
    (void)state;
    static const struct {
        const char *sql;
        prom_table table;
    } cases[] = {
        {"UPDATE node SET prototype=99 WHERE id=5", PROM_TABLE_NODE},
        {"UPDATE node SET parent=2 WHERE id=5", PROM_TABLE_NODE},
        {"UPDATE node SET first_child=5 WHERE id=1", PROM_TABLE_NODE},
        {"UPDATE node SET child_count=4000000000 WHERE id=1", PROM_TABLE_NODE},
        {"UPDATE node SET parent=NULL WHERE id=3", PROM_TABLE_NODE},
        {"UPDATE node SET background=1 WHERE id=3", PROM_TABLE_NODE},
        {"UPDATE node SET half_x=1e300 WHERE id=3", PROM_TABLE_NODE},
        {"UPDATE node SET name=CAST(x'610062' AS TEXT) WHERE id=3", PROM_TABLE_NODE},
        {"DELETE FROM node", PROM_TABLE_NODE},
        {"UPDATE prototype SET radius=-1 WHERE id=0", PROM_TABLE_PROTOTYPE},
        {"UPDATE prototype SET flags=0 WHERE id=1", PROM_TABLE_PROTOTYPE},
        {"DELETE FROM prototype WHERE id=3", PROM_TABLE_PROTOTYPE},
        {"UPDATE representation SET mesh=4 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET texture=0 WHERE id=2", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET texture=NULL WHERE id=2", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET prototype=1 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET prototype=8 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET shading=5 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET max_size_px=0 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET near_k=-1 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"DELETE FROM accuracy WHERE id=5", PROM_TABLE_ACCURACY},
        {"UPDATE mesh SET index_count=index_count+1 WHERE id=0", PROM_TABLE_MESH},
        {"UPDATE mesh SET vertex_count=vertex_count-1 WHERE id=0", PROM_TABLE_MESH},
        {"UPDATE mesh SET first_chunk=3 WHERE id=0", PROM_TABLE_MESH},
        {"UPDATE mesh SET first_chunk=9223372036854775807 WHERE id=0", PROM_TABLE_MESH},
        {"DELETE FROM mesh", PROM_TABLE_MESH},
        {"UPDATE texture SET levels=3 WHERE id=0", PROM_TABLE_TEXTURE},
        {"UPDATE texture SET width=8192,height=8192,levels=14 WHERE id=1", PROM_TABLE_TEXTURE},
        {"UPDATE material SET texture=1", PROM_TABLE_MATERIAL},
        {"UPDATE material SET alpha_mode=3", PROM_TABLE_MATERIAL},
        {"DELETE FROM material", PROM_TABLE_MATERIAL},
    };
    prom_error error;
    fixture f;
    fixture_init(&f, 3, 4);
    char *path = fixture_path("hostile");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_ok(fixture_write(&f, path, 1, &error), &error);
        rewrite(path, cases[i].sql, cases[i].table);
        error.text[0] = 0;
        prom_status status = fixture_read_all(path, &error);
        if (status != PROM_ERR_INPUT) print_error("%s\n", cases[i].sql);
        assert_int_equal(status, PROM_ERR_INPUT);
        assert_non_null(strstr(error.text, path));
    }
    unlink(path);
    prom_free(path);
    fixture_finish(&f);
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
        cmocka_unit_test(refuses_changed_files),
        cmocka_unit_test(unknown_kind_is_left_out),
        cmocka_unit_test(hostile_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// LINK: prom_metaobj
// View cells in the container: they come back, they may come later, and damage stays damage.
#include "container_fixture.h"

#include <setjmp.h>
#include <sqlite3.h>
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

static void assert_same_cells(const prom_view_cells *a, const prom_view_cells *b)
{
    assert_int_equal(a->cell_count, b->cell_count);
    assert_int_equal(a->entry_count, b->entry_count);
    assert_memory_equal(a->origin, b->origin, sizeof a->origin);
    assert_true(a->size == b->size);
    assert_true(prom_view_cells_hash(a, 0) == prom_view_cells_hash(b, 0));
    if (!a->cell_count) return;
    assert_memory_equal(a->cells, b->cells, a->cell_count * sizeof *a->cells);
    if (!a->entry_count) return;
    assert_memory_equal(a->leaves, b->leaves, a->entry_count * sizeof *a->leaves);
    assert_memory_equal(a->shares, b->shares, a->entry_count);
}

// Reads the file whole; its cells must be these. The content hash.
static uint64_t assert_holds(const char *path, const prom_view_cells *expected)
{
    prom_error error = {0};
    uint64_t hash;
    assert_ok(fixture_read_hash(path, &hash, &error), &error);
    prom_container *c = prom_container_open(path, &error);
    assert_non_null(c);
    prom_model m;
    prom_view_cells cells;
    assert_ok(prom_container_load_model(c, &m, &error), &error);
    assert_ok(prom_container_read_view_cells(c, &m, &cells, &error), &error);
    assert_same_cells(&cells, expected);
    assert_int_equal(prom_container_view_cell_bytes(c) > 0, expected->entry_count > 0);
    assert_true(prom_container_view_cell_bytes(c) <= 5 * (uint64_t)expected->entry_count);
    prom_view_cells_finish(&cells);
    prom_model_finish(&m);
    prom_container_close(c);
    return hash;
}

static uint64_t write_with(fixture *f, const char *path, const prom_view_cells *cells)
{
    prom_error error = {0};
    prom_view_cells own = f->cells;
    f->cells = *cells;
    assert_ok(fixture_write(f, path, 1, &error), &error);
    f->cells = own;
    return assert_holds(path, cells);
}

static uint64_t put_later(const char *path, const prom_view_cells *cells)
{
    prom_error error = {0};
    prom_writer *w = prom_writer_reopen(path, &error);
    if (!w) print_error("%s\n", error.text);
    assert_non_null(w);
    assert_ok(prom_writer_put_view_cells(w, cells, &error), &error);
    assert_ok(prom_writer_finish(w, &error), &error);
    prom_writer_destroy(w);
    return assert_holds(path, cells);
}

static const prom_view_cells no_view_cells;

static void cells_come_back(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 5, 40);
    char *path = fixture_path("cells");
    uint64_t with = write_with(&f, path, &f.cells);
    assert_true(with == write_with(&f, path, &f.cells));
    assert_true(with != write_with(&f, path, &no_view_cells));
    f.cells.shares[77] ^= 1;
    assert_true(with != write_with(&f, path, &f.cells));
    f.cells.shares[77] ^= 1;
    f.cells.origin[0] += 0.5;
    assert_true(with != write_with(&f, path, &f.cells));
    // Cells from which nothing shows.
    prom_view_cell blind[2] = {{{-1, 0, 0}, 0, 0}, {{0, 0, 0}, 0, 0}};
    write_with(&f, path, &(prom_view_cells){.size = 1, .cell_count = 2, .cells = blind});
    unlink(path);
    prom_free(path);
    fixture_finish(&f);
}

// Cells that come later make the file that has them from the start, whatever was there before.
static void cells_come_later(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 5, 40);
    prom_view_cells more;
    uint32_t seed = 8;
    fixture_view_cells(&more, &f.model, 300, &seed);
    char *path = fixture_path("later"), *part = prom_format("%s.part", path);
    uint64_t without = write_with(&f, path, &no_view_cells);
    uint64_t with_more = write_with(&f, path, &more), with = write_with(&f, path, &f.cells);
    assert_true(with_more == put_later(path, &more));
    assert_true(without == put_later(path, &no_view_cells));
    assert_true(without == put_later(path, &no_view_cells));
    assert_true(with == put_later(path, &f.cells));
    struct stat first, last;
    assert_int_equal(stat(path, &first), 0);
    for (int i = 0; i < 10; i++) {
        assert_true(with_more == put_later(path, &more));
        assert_true(with == put_later(path, &f.cells));
    }
    assert_int_equal(stat(path, &last), 0);
    assert_true(last.st_size <= first.st_size + 2 * 65536); // the pages are used again
    assert_false(exists(part));
    unlink(path);
    prom_free(part);
    prom_free(path);
    prom_view_cells_finish(&more);
    fixture_finish(&f);
}

static void count_stages(void *user, const char *name, uint64_t content_hash, double ms)
{
    uint64_t *hashes = user;
    hashes[strcmp(name, "import") != 0] += content_hash;
    assert_true(ms == (strcmp(name, "import") ? 6 : 1));
}

static void stages_and_facts_come_later(void **state)
{
    (void)state;
    prom_error error = {0};
    fixture f;
    fixture_init(&f, 2, 2);
    char *path = fixture_path("stages");
    write_with(&f, path, &f.cells);
    for (uint64_t hash = 5; hash < 7; hash++) {
        prom_writer *w = prom_writer_reopen(path, &error);
        assert_non_null(w);
        assert_ok(prom_writer_add_stage(w, "view cells", hash, (double)hash, &error), &error);
        assert_ok(prom_writer_set_meta(w, "cells", "a path", &error), &error);
        assert_ok(prom_writer_finish(w, &error), &error);
        prom_writer_destroy(w);
        assert_holds(path, &f.cells);
    }
    prom_container *c = prom_container_open(path, &error);
    assert_non_null(c);
    uint64_t hashes[2] = {0};
    assert_ok(prom_container_stages(c, count_stages, hashes, &error), &error);
    assert_true(hashes[0] == 0xfedcba9876543210u);
    assert_true(hashes[1] == 6); // the second in the first one's place
    assert_string_equal(prom_container_meta(c, "source"), "fixture");
    assert_string_equal(prom_container_meta(c, "cells"), "a path");
    prom_container_close(c);
    unlink(path);
    prom_free(path);
    fixture_finish(&f);
}

static void refused_cells(void **state)
{
    (void)state;
    prom_error error = {0};
    fixture f;
    fixture_init(&f, 2, 2);
    char *path = fixture_path("refused"), *part = prom_format("%s.part", path);
    prom_writer *w = prom_writer_create(path, &error);
    assert_non_null(w);
    assert_int_equal(prom_writer_put_view_cells(w, &f.cells, &error), PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, "there is no model yet"));
    prom_writer_destroy(w);
    write_with(&f, path, &f.cells);
    w = prom_writer_reopen(path, &error);
    assert_non_null(w);
    uint32_t leaf = f.cells.leaves[0];
    f.cells.leaves[0] = 1;
    assert_int_equal(prom_writer_put_view_cells(w, &f.cells, &error), PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, "has children (cell 0)"));
    f.cells.leaves[0] = leaf;
    // What belongs to a build only.
    assert_int_equal(prom_writer_put_model(w, &f.model, &error), PROM_ERR_OUTPUT);
    assert_int_equal(prom_writer_add_mesh(w, &f.meshes[0], NULL, &error), PROM_ERR_OUTPUT);
    assert_int_equal(prom_writer_add_texture(w, &f.textures[0], NULL, &error), PROM_ERR_OUTPUT);
    assert_null(prom_writer_create(path, &error)); // it holds the lock
    assert_null(prom_writer_reopen(path, &error));
    assert_non_null(strstr(error.text, "another build"));
    assert_true(exists(part));
    prom_writer_destroy(w);
    assert_false(exists(part));
    assert_holds(path, &f.cells);
    unlink(path);
    prom_free(part);
    prom_free(path);
    fixture_finish(&f);
}

// Damage of every table is found before it could get a right hash.
static void damage_is_not_taken_over(void **state)
{
    (void)state;
    static const char *const damages[] = {
        "UPDATE meta SET value='other'",
        "UPDATE node SET radius=radius+1 WHERE id=2",
        "UPDATE accuracy SET value=zeroblob(180) WHERE id=0",
        "INSERT INTO cost_profile VALUES(0,'a','b')",
        "UPDATE view_cell SET leaf_count=0 WHERE id=1",
        "UPDATE stage SET ms=5",
        "DELETE FROM table_rows WHERE id=3",
        "PRAGMA user_version=2",
    };
    prom_error error;
    fixture f;
    fixture_init(&f, 2, 2);
    char *path = fixture_path("taken"), *part = prom_format("%s.part", path);
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        write_with(&f, path, &f.cells);
        sqlite3 *db;
        assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
        assert_int_equal(sqlite3_exec(db, damages[i], NULL, NULL, NULL), SQLITE_OK);
        sqlite3_close(db);
        error = (prom_error){0};
        if (prom_writer_reopen(path, &error)) fail_msg("%s", damages[i]);
        assert_int_equal(error.status, PROM_ERR_INPUT);
        assert_non_null(strstr(error.text, path));
        assert_false(exists(part));
    }
    unlink(path);
    assert_null(prom_writer_reopen(path, &error));
    assert_int_equal(error.status, PROM_ERR_INPUT);
    assert_false(exists(path));
    assert_false(exists(part));
    prom_free(part);
    prom_free(path);
    fixture_finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_come_back),
        cmocka_unit_test(cells_come_later),
        cmocka_unit_test(stages_and_facts_come_later),
        cmocka_unit_test(refused_cells),
        cmocka_unit_test(damage_is_not_taken_over),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// LINK: prom_metaobj
// The container: rows changed by hand, by a newer program, or by somebody hostile.
#include "container_fixture.h"

#include "metaobj/base/log.h"
#include "metaobj/container_schema.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static void assert_ok(prom_status status, const prom_error *error)
{
    if (status) print_error("%s\n", error->text);
    assert_int_equal(status, PROM_OK);
}

static void run_sql(const char *path, const char *sql)
{
    sqlite3 *db;
    char *text = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    if (sqlite3_exec(db, sql, NULL, NULL, &text) != SQLITE_OK)
        fail_msg("%s: %s", sql, text ? text : "?");
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
        {"PRAGMA user_version=2147483647", "container format 2147483647"},
        {"PRAGMA user_version=0", "container format 0"},
        {"DROP TABLE material", "table material is missing"},
        {"DROP TABLE node; CREATE VIEW node AS SELECT * FROM mesh", "table node is missing"},
        {"ALTER TABLE node ADD COLUMN more TEXT",
         "table node is missing or not of this format"},
        {"CREATE VIEW more AS SELECT * FROM node", "not of this format"},
        {"CREATE TRIGGER t AFTER INSERT ON node BEGIN DELETE FROM mesh; END",
         "not of this format"},
        {"CREATE INDEX i ON accuracy(id,value)", "not of this format"},
        {"CREATE VIRTUAL TABLE v USING fts4(x)", "not of this format"},
        {"CREATE TABLE more(x)", "not of this format"},
        {"PRAGMA page_size=4096; PRAGMA journal_mode=DELETE; VACUUM", "header is damaged"},
        {"PRAGMA auto_vacuum=FULL; VACUUM", "header is damaged"},
        {"PRAGMA journal_mode=WAL", "has a write-ahead log"},
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
        {"UPDATE table_rows SET row_count=4000000000 WHERE id=1",
         "table node has 17 rows of 4000000000"},
        {"DELETE FROM table_rows WHERE id=11", "table table_rows, row 11: the row is missing"},
        {"UPDATE view_cell SET leaf_count=leaf_count-1 WHERE id=2", "table view_cell"},
        {"UPDATE view_cell SET x=2147483648 WHERE id=2", "row 2: x is out of range"},
        {"DELETE FROM view_grid", "table view_grid has 0 rows of 1"},
        {"UPDATE view_grid SET size=3", "table view_grid"},
        {"DELETE FROM chunk WHERE id=15", "table chunk, row 15: the row is missing"},
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
    assert_int_equal(prom_table_hash(db, table, NULL, UINT64_MAX, &rows, &hash), SQLITE_OK);
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
        assert_memory_equal(&m.accuracy[r], &f.model.accuracy[r + 1], sizeof m.accuracy[r]);
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
        {"UPDATE node SET origin_x=1e300 WHERE id=3", PROM_TABLE_NODE},
        {"UPDATE node SET basis_xy=1e30 WHERE id=3", PROM_TABLE_NODE},
        {"UPDATE node SET name=CAST(x'610062' AS TEXT) WHERE id=3", PROM_TABLE_NODE},
        {"DELETE FROM node", PROM_TABLE_NODE},
        {"UPDATE prototype SET radius=-1 WHERE id=0", PROM_TABLE_PROTOTYPE},
        {"UPDATE prototype SET flags=0 WHERE id=1", PROM_TABLE_PROTOTYPE},
        {"UPDATE prototype SET center_z=-1e20 WHERE id=0", PROM_TABLE_PROTOTYPE},
        {"DELETE FROM prototype WHERE id=3", PROM_TABLE_PROTOTYPE},
        {"UPDATE representation SET mesh=4 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET texture=0 WHERE id=2", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET texture=NULL WHERE id=2", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET prototype=1 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET prototype=8 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET shading=5 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET max_size_px=0 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET near_k=-1 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET error=1e19 WHERE id=1", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET switch_distance=0 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"UPDATE representation SET layers=0 WHERE id=0", PROM_TABLE_REPRESENTATION},
        {"DELETE FROM accuracy WHERE id=5", PROM_TABLE_ACCURACY},
        {"UPDATE mesh SET index_count=index_count+1 WHERE id=0", PROM_TABLE_MESH},
        {"UPDATE mesh SET vertex_count=vertex_count-1 WHERE id=0", PROM_TABLE_MESH},
        {"UPDATE mesh SET first_chunk=3 WHERE id=0", PROM_TABLE_MESH},
        {"UPDATE mesh SET first_chunk=9223372036854775807 WHERE id=0", PROM_TABLE_MESH},
        {"UPDATE mesh SET vertex_count=4294967295, first_chunk=0", PROM_TABLE_MESH},
        {"DELETE FROM mesh", PROM_TABLE_MESH},
        {"UPDATE texture SET levels=3 WHERE id=0", PROM_TABLE_TEXTURE},
        {"UPDATE texture SET width=8192,height=8192,levels=14 WHERE id=1", PROM_TABLE_TEXTURE},
        {"UPDATE material SET texture=1", PROM_TABLE_MATERIAL},
        {"UPDATE material SET alpha_mode=3", PROM_TABLE_MATERIAL},
        {"DELETE FROM material", PROM_TABLE_MATERIAL},
        {"DELETE FROM view_grid", PROM_TABLE_VIEW_GRID},
        {"INSERT INTO view_grid SELECT 1,0,0,0,size,content_hash,first_chunk FROM view_grid",
         PROM_TABLE_VIEW_GRID},
        {"UPDATE view_grid SET size=0", PROM_TABLE_VIEW_GRID},
        {"UPDATE view_grid SET size=-2.5", PROM_TABLE_VIEW_GRID},
        {"UPDATE view_grid SET size=1e300", PROM_TABLE_VIEW_GRID},
        {"UPDATE view_grid SET origin_z=-1e300", PROM_TABLE_VIEW_GRID},
        {"UPDATE view_grid SET origin_z=origin_z+1", PROM_TABLE_VIEW_GRID},
        {"UPDATE view_grid SET first_chunk=first_chunk+1", PROM_TABLE_VIEW_GRID},
        {"UPDATE view_grid SET first_chunk=0", PROM_TABLE_VIEW_GRID},
        {"UPDATE view_grid SET first_chunk=9223372036854775807", PROM_TABLE_VIEW_GRID},
        {"UPDATE view_grid SET content_hash=content_hash/2", PROM_TABLE_VIEW_GRID},
        {"DELETE FROM view_cell", PROM_TABLE_VIEW_CELL},
        {"DELETE FROM view_cell WHERE id=11", PROM_TABLE_VIEW_CELL},
        {"UPDATE view_cell SET x=1 WHERE id=0", PROM_TABLE_VIEW_CELL},
        {"UPDATE view_cell SET leaf_count=4294967295", PROM_TABLE_VIEW_CELL},
        {"UPDATE view_cell SET leaf_count=100000000 WHERE id=3", PROM_TABLE_VIEW_CELL},
        {"UPDATE view_cell SET leaf_count=-1 WHERE id=3", PROM_TABLE_VIEW_CELL},
        {"UPDATE view_cell SET leaf_count=leaf_count+2*id-1 WHERE id<2", PROM_TABLE_VIEW_CELL},
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
        cmocka_unit_test(refuses_changed_files),
        cmocka_unit_test(unknown_kind_is_left_out),
        cmocka_unit_test(hostile_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

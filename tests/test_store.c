// LINK: prom_builder prom_metaobj PkgConfig::SQLITE
// The store of a build's units: what is put comes back, and nothing else does.
#include "builder/store.h"

#include "failing_vfs.h"
#include "metaobj/base/log.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include <cmocka.h>

#define MODEL "store_test.prom"
#define WORK "store_test.prom.work"

static prom_store *open_store(prom_unit_kind redo)
{
    prom_error error = {0};
    prom_store *store = prom_store_open(MODEL, redo, &error);
    if (!store) fail_msg("%s", error.text);
    return store;
}

static void put(prom_store *store, prom_unit_kind kind, uint64_t key, const char *text)
{
    prom_pack pack = {0};
    prom_error error = {0};
    prom_pack_bytes(&pack, text, strlen(text));
    assert_int_equal(prom_store_put(store, kind, key, &pack, &error), PROM_OK);
    prom_array_finish(&pack);
}

static bool has(prom_store *store, prom_unit_kind kind, uint64_t key, const char *text)
{
    prom_pack pack = {0};
    bool found = prom_store_get(store, kind, key, &pack);
    if (found) {
        assert_int_equal(pack.count, strlen(text));
        assert_memory_equal(pack.data, text, pack.count);
    }
    prom_array_finish(&pack);
    return found;
}

static int fresh(void **state)
{
    (void)state;
    unlink(WORK);
    unlink(WORK "-journal");
    return 0;
}

static void units_come_back_in_a_later_run(void **state)
{
    (void)state;
    prom_store *store = open_store(PROM_UNIT_COUNT);
    put(store, PROM_UNIT_LEAF, 7, "seven");
    put(store, PROM_UNIT_LEAF, UINT64_MAX, "last");
    prom_store_close(store);
    store = open_store(PROM_UNIT_COUNT);
    assert_true(has(store, PROM_UNIT_LEAF, 7, "seven"));
    assert_true(has(store, PROM_UNIT_LEAF, UINT64_MAX, "last"));
    assert_false(has(store, PROM_UNIT_CLUSTER, 7, ""));
    assert_false(has(store, PROM_UNIT_LEAF, 8, ""));
    put(store, PROM_UNIT_LEAF, 7, "another");
    assert_true(has(store, PROM_UNIT_LEAF, 7, "another"));
    prom_store_close(store);
}

static void later_kinds_are_redone(void **state)
{
    (void)state;
    prom_store *store = open_store(PROM_UNIT_COUNT);
    put(store, PROM_UNIT_LEVELS, 1, "levels");
    put(store, PROM_UNIT_MERGE, 1, "merge");
    prom_store_close(store);
    store = open_store(PROM_UNIT_LEAF);
    assert_true(has(store, PROM_UNIT_LEVELS, 1, "levels"));
    assert_false(has(store, PROM_UNIT_MERGE, 1, ""));
    prom_store_close(store);
}

static void pruning_keeps_what_was_used(void **state)
{
    (void)state;
    prom_error error = {0};
    prom_store *store = open_store(PROM_UNIT_COUNT);
    for (uint64_t k = 0; k < 50; k++) put(store, PROM_UNIT_LEAF, k, "old");
    prom_store_close(store);
    store = open_store(PROM_UNIT_COUNT);
    assert_true(has(store, PROM_UNIT_LEAF, 3, "old"));
    put(store, PROM_UNIT_LEAF, 100, "new");
    assert_int_equal(prom_store_prune(store, PROM_UNIT_LEVELS, PROM_UNIT_COUNT, &error),
                     PROM_OK);
    prom_store_close(store);
    store = open_store(PROM_UNIT_COUNT);
    for (uint64_t k = 0; k < 50; k++)
        assert_int_equal(has(store, PROM_UNIT_LEAF, k, "old"), k == 3);
    assert_true(has(store, PROM_UNIT_LEAF, 100, "new"));
    prom_store_close(store);
}

static void pruning_spares_other_kinds(void **state)
{
    (void)state;
    prom_error error = {0};
    prom_store *store = open_store(PROM_UNIT_COUNT);
    put(store, PROM_UNIT_LEAF, 1, "leaf");
    put(store, PROM_UNIT_VIEW_CELL, 1, "cell");
    prom_store_close(store);
    store = open_store(PROM_UNIT_COUNT);
    assert_int_equal(prom_store_prune(store, PROM_UNIT_LEVELS, PROM_UNIT_VIEW_CELL, &error),
                     PROM_OK);
    prom_store_close(store);
    store = open_store(PROM_UNIT_COUNT);
    assert_false(has(store, PROM_UNIT_LEAF, 1, ""));
    assert_true(has(store, PROM_UNIT_VIEW_CELL, 1, "cell"));
    prom_store_close(store);
}

// Bytes all over the file, one at a time: units come back as they were, or not at all, and new
// ones are taken.
static void damage_costs_units_and_nothing_else(void **state)
{
    (void)state;
    prom_error error = {0};
    prom_log_set_level(PROM_LOG_ERROR);
    prom_store *store = open_store(PROM_UNIT_COUNT);
    for (uint64_t k = 0; k < 8; k++) put(store, PROM_UNIT_LEAF, k, "a unit of work, in bytes");
    prom_store_close(store);
    FILE *f = fopen(WORK, "rb");
    assert_non_null(f);
    static uint8_t whole[1 << 20];
    size_t size = fread(whole, 1, sizeof whole, f);
    fclose(f);
    assert_in_range(size, 1000, sizeof whole - 1);
    unsigned lost = 0;
    for (size_t at = 61; at < size; at += 211) {
        f = fopen(WORK, "wb");
        whole[at] ^= 0x55;
        fwrite(whole, 1, at % 3 ? size : at, f); // changed, or cut short
        fclose(f);
        whole[at] ^= 0x55;
        store = open_store(PROM_UNIT_COUNT);
        for (uint64_t k = 0; k < 8; k++)
            lost += !has(store, PROM_UNIT_LEAF, k, "a unit of work, in bytes");
        for (uint64_t k = 0; k < 16; k++) put(store, PROM_UNIT_LEAF, k, "made again");
        assert_true(has(store, PROM_UNIT_LEAF, 15, "made again"));
        assert_int_equal(prom_store_prune(store, PROM_UNIT_LEVELS, PROM_UNIT_COUNT, &error),
                         PROM_OK);
        prom_store_close(store);
    }
    assert_true(lost > 0);
    prom_log_set_level(PROM_LOG_WARNING);
}

static void a_full_disk_is_an_error_that_says_so(void **state)
{
    (void)state;
    prom_error error = {0};
    prom_store *store = open_store(PROM_UNIT_COUNT);
    prom_pack pack = {0};
    prom_pack_bytes(&pack, "unit", 4);
    failing_vfs_arm(FAILING_WRITE, SQLITE_FULL, 1, true);
    assert_int_equal(prom_store_put(store, PROM_UNIT_LEAF, 1, &pack, &error), PROM_ERR_OUTPUT);
    failing_vfs_arm(0, 0, 0, false);
    assert_non_null(strstr(error.text, "full"));
    assert_non_null(strstr(error.text, WORK));
    assert_int_equal(prom_store_put(store, PROM_UNIT_LEAF, 1, &pack, &error), PROM_OK);
    assert_true(has(store, PROM_UNIT_LEAF, 1, "unit"));
    prom_array_finish(&pack);
    prom_store_close(store);
}

static void another_file_of_that_name_is_not_touched(void **state)
{
    (void)state;
    static const char notes[] = "somebody's notes about their work";
    prom_error error = {0};
    char text[64] = "";
    FILE *f = fopen(WORK, "w+");
    assert_non_null(f);
    fputs(notes, f);
    fclose(f);
    assert_null(prom_store_open(MODEL, PROM_UNIT_COUNT, &error));
    assert_int_equal(error.status, PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, WORK));
    f = fopen(WORK, "r");
    assert_non_null(fgets(text, sizeof text, f));
    fclose(f);
    assert_string_equal(text, notes);
}

static void another_programs_database_is_not_touched(void **state)
{
    (void)state;
    prom_error error = {0};
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(WORK, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, "CREATE TABLE hours(n)", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
    assert_null(prom_store_open(MODEL, PROM_UNIT_COUNT, &error));
    assert_int_equal(error.status, PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, WORK));
    assert_int_equal(sqlite3_open(WORK, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, "INSERT INTO hours VALUES(8)", NULL, NULL, NULL),
                     SQLITE_OK);
    sqlite3_close(db);
}

static void deleting_is_allowed_any_time(void **state)
{
    (void)state;
    prom_error error = {0};
    prom_store *store = open_store(PROM_UNIT_COUNT);
    put(store, PROM_UNIT_LEAF, 1, "one");
    unlink(WORK);
    put(store, PROM_UNIT_LEAF, 2, "two");
    assert_true(has(store, PROM_UNIT_LEAF, 2, "two"));
    prom_store_close(store);
    store = open_store(PROM_UNIT_COUNT);
    put(store, PROM_UNIT_LEAF, 1, "one");
    prom_store_close(store);
    assert_int_equal(prom_store_delete(MODEL, &error), PROM_OK);
    assert_int_not_equal(access(WORK, F_OK), 0);
    assert_int_equal(prom_store_delete(MODEL, &error), PROM_OK); // nothing there
}

int main(void)
{
    prom_log_set_level(PROM_LOG_WARNING);
    failing_vfs_install();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(units_come_back_in_a_later_run, fresh),
        cmocka_unit_test_setup(later_kinds_are_redone, fresh),
        cmocka_unit_test_setup(pruning_keeps_what_was_used, fresh),
        cmocka_unit_test_setup(pruning_spares_other_kinds, fresh),
        cmocka_unit_test_setup(damage_costs_units_and_nothing_else, fresh),
        cmocka_unit_test_setup(a_full_disk_is_an_error_that_says_so, fresh),
        cmocka_unit_test_setup(another_file_of_that_name_is_not_touched, fresh),
        cmocka_unit_test_setup(another_programs_database_is_not_touched, fresh),
        cmocka_unit_test_setup(deleting_is_allowed_any_time, fresh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

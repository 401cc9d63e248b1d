// LINK: prom_metaobj
// Damaged containers: in the header, by whole pages, and with chunks that a hostile writer
// made. Reading gives an error or the very same content, never a crash (the sanitizer build
// watches the rest). For cuts and flips anywhere see test_container_bits.
#include "container_fixture.h"

#include "metaobj/base/hash.h"
#include "metaobj/base/log.h"

#include <setjmp.h>
#include <sqlite3.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

typedef struct image {
    uint8_t *bytes;
    size_t count;
    char *path;
    uint64_t content_hash;
} image;

static image load_image(void)
{
    prom_error error;
    fixture f;
    fixture_init(&f, 3, 4);
    image i = {.path = fixture_path("damage")};
    assert_int_equal(fixture_write(&f, i.path, 1, &error), PROM_OK);
    fixture_finish(&f);
    assert_int_equal(fixture_read_hash(i.path, &i.content_hash, &error), PROM_OK);
    FILE *file = fopen(i.path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    i.count = (size_t)ftell(file);
    rewind(file);
    i.bytes = prom_alloc(i.count, 1);
    assert_int_equal(fread(i.bytes, 1, i.count, file), i.count);
    fclose(file);
    return i;
}

static void drop_image(image *i)
{
    unlink(i->path);
    prom_free(i->path);
    prom_free(i->bytes);
}

static prom_status read_bytes(const image *i, size_t count, prom_error *error)
{
    FILE *file = fopen(i->path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(i->bytes, 1, count, file), count);
    fclose(file);
    *error = (prom_error){0};
    uint64_t hash;
    prom_status status = fixture_read_hash(i->path, &hash, error);
    if (status)
        assert_non_null(strstr(error->text, i->path));
    else
        assert_true(hash == i->content_hash); // the damage was in nothing that counts
    return status;
}

// The 100 bytes that say how to read all others.
static void flipped_header_bits(void **state)
{
    (void)state;
    prom_error error;
    image i = load_image();
    int refused = 0, bits = 100 * 8;
    prom_log_set_level(PROM_LOG_ERROR);
    for (int bit = 0; bit < bits; bit++) {
        i.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        refused += read_bytes(&i, i.count, &error) != PROM_OK;
        i.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    prom_log_set_level(PROM_LOG_INFO);
    print_message("%d of %d flips refused\n", refused, bits);
    // The rest is the list of free pages, the schema's age and SQLite's own version: 16 bytes
    // that a reader has no use for.
    assert_int_equal(refused, bits - 16 * 8);
    drop_image(&i);
}

// Whole pages swapped or blanked: checksums of rows and chunks must find them.
static void blanked_pages(void **state)
{
    (void)state;
    prom_error error;
    image i = load_image();
    const size_t page = 65536;
    uint8_t *kept = prom_alloc(page, 1);
    for (size_t at = page; at + page <= i.count; at += page) {
        memcpy(kept, i.bytes + at, page);
        memset(i.bytes + at, 0, page);
        prom_status status = read_bytes(&i, i.count, &error);
        memcpy(i.bytes + at, kept, page);
        // cost_profile is empty, and so are the indices of unique columns that nobody reads.
        if (status == PROM_OK) print_message("page %zu blanked: not read\n", at / page);
        bool empty = i.bytes[at] == 0x0a || (i.bytes[at] == 0x0d && !i.bytes[at + 4]);
        assert_true(status == PROM_ERR_INPUT || empty);
    }
    prom_free(kept);
    drop_image(&i);
}

static void exec(sqlite3 *db, const char *sql)
{
    assert_int_equal(sqlite3_exec(db, sql, NULL, NULL, NULL), SQLITE_OK);
}

// Changes some bytes of a chunk, or cuts it, and gives it the right checksum.
static void spoil_chunk(sqlite3 *db, int64_t id, uint32_t *seed)
{
    sqlite3_stmt *get, *set;
    sqlite3_prepare_v2(db, "SELECT data FROM chunk WHERE id=?", -1, &get, NULL);
    sqlite3_bind_int64(get, 1, id);
    assert_int_equal(sqlite3_step(get), SQLITE_ROW);
    int count = sqlite3_column_bytes(get, 0);
    uint8_t *data = prom_alloc((size_t)count, 1);
    memcpy(data, sqlite3_column_blob(get, 0), (size_t)count);
    sqlite3_finalize(get);
    for (uint32_t k = fixture_random(seed) % 4 + 1; k; k--)
        data[fixture_random(seed) % (uint32_t)count] ^= (uint8_t)(fixture_random(seed) | 1);
    if (fixture_random(seed) % 4 == 0) count = (int)(fixture_random(seed) % (uint32_t)count);
    sqlite3_prepare_v2(db, "UPDATE chunk SET data=?2, checksum=?3 WHERE id=?1", -1, &set, NULL);
    sqlite3_bind_int64(set, 1, id);
    sqlite3_bind_blob(set, 2, data, count, SQLITE_STATIC);
    sqlite3_bind_int64(set, 3, (int64_t)prom_hash(data, (size_t)count, 0));
    assert_int_equal(sqlite3_step(set), SQLITE_DONE);
    sqlite3_finalize(set);
    prom_free(data);
}

// A hostile file has right checksums: the decoders themselves must stand it, and the hash of
// the decoded content must find it. (A few bytes of meshoptimizer's formats are padding.)
static void spoiled_chunks(void **state)
{
    (void)state;
    prom_error error;
    image i = load_image();
    uint32_t seed = 17;
    sqlite3 *db;
    assert_int_equal(sqlite3_open(i.path, &db), SQLITE_OK);
    exec(db, "CREATE TEMP TABLE kept AS SELECT * FROM chunk; PRAGMA synchronous=OFF");
    const int chunks = 3 * FIXTURE_MESHES + FIXTURE_TEXTURES + 2; // the cells' two
    int refused = 0;
    for (int k = 0; k < 20 * chunks; k++) {
        spoil_chunk(db, k % chunks, &seed);
        refused += fixture_read_all(i.path, &error) != PROM_OK;
        exec(db, "REPLACE INTO chunk SELECT * FROM kept");
    }
    assert_int_equal(fixture_read_all(i.path, &error), PROM_OK);
    print_message("%d of %d spoiled chunks refused\n", refused, 20 * chunks);
    assert_true(refused > 18 * chunks);
    sqlite3_close(db);
    drop_image(&i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flipped_header_bits),
        cmocka_unit_test(blanked_pages),
        cmocka_unit_test(spoiled_chunks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

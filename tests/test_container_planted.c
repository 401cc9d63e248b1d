// LINK: prom_metaobj
// What somebody else may put at a container's place or beside it, or do to it while it is read.
#include "container_fixture.h"

#include <fcntl.h>
#include <setjmp.h>
#include <sqlite3.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cmocka.h>

typedef struct setting {
    char *path;
    uint64_t hash;
} setting;

static int set_up(void **state)
{
    setting *s = prom_calloc(1, sizeof *s);
    prom_error error;
    fixture f;
    fixture_init(&f, 3, 4);
    s->path = fixture_path("planted");
    assert_int_equal(fixture_write(&f, s->path, 1, &error), PROM_OK);
    assert_int_equal(fixture_read_hash(s->path, &s->hash, &error), PROM_OK);
    fixture_finish(&f);
    *state = s;
    return 0;
}

static int tear_down(void **state)
{
    setting *s = *state;
    unlink(s->path);
    prom_free(s->path);
    prom_free(s);
    return 0;
}

static void assert_refused(const char *path, const char *expected)
{
    prom_error error = {0};
    assert_null(prom_container_open(path, &error));
    assert_int_equal(error.status, PROM_ERR_INPUT);
    if (!strstr(error.text, expected)) print_error("%s\n", error.text);
    assert_non_null(strstr(error.text, expected));
    assert_non_null(strstr(error.text, path));
}

static void assert_unchanged(const setting *s)
{
    prom_error error = {0};
    uint64_t hash;
    prom_status status = fixture_read_hash(s->path, &hash, &error);
    if (status) print_error("%s\n", error.text);
    assert_int_equal(status, PROM_OK);
    assert_true(hash == s->hash);
}

static void write_bytes(const char *path, const void *bytes, size_t count)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    fclose(file);
}

static void copy_file(const char *from, const char *to)
{
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    char bytes[4096];
    assert_non_null(in);
    assert_non_null(out);
    for (size_t n; (n = fread(bytes, 1, sizeof bytes, in)) > 0;) fwrite(bytes, 1, n, out);
    fclose(in);
    fclose(out);
}

// Leaves the rollback journal of a transaction on `path` as a killed program would: SQLite
// would roll it back into whatever it finds under the name.
static char *plant_journal(const setting *s)
{
    char *victim = fixture_path("victim"), *journal = prom_format("%s-journal", victim);
    copy_file(s->path, victim);
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        sqlite3 *db;
        bool good = sqlite3_open(victim, &db) == SQLITE_OK &&
                    sqlite3_exec(db,
                                 "PRAGMA cache_size=1; BEGIN; UPDATE meta SET value='evil';"
                                 "DELETE FROM node; DELETE FROM chunk",
                                 NULL, NULL, NULL) == SQLITE_OK &&
                    sqlite3_db_cacheflush(db) == SQLITE_OK;
        _exit(good ? 0 : 1); // without a commit
    }
    int status;
    waitpid(child, &status, 0);
    assert_int_equal(status, 0);
    char *planted = prom_format("%s-journal", s->path);
    assert_int_equal(rename(journal, planted), 0);
    unlink(victim);
    prom_free(journal);
    prom_free(victim);
    return planted;
}

static void journals_beside_it_are_not_looked_at(void **state)
{
    const setting *s = *state;
    char *planted = plant_journal(s);
    struct stat before, after;
    assert_int_equal(stat(planted, &before), 0);
    assert_true(before.st_size > 512);
    assert_unchanged(s);
    assert_int_equal(stat(planted, &after), 0); // nor deleted
    assert_int_equal(before.st_size, after.st_size);
    unlink(planted);
    prom_free(planted);
}

static void logs_beside_it_are_not_looked_at(void **state)
{
    const setting *s = *state;
    char *wal = prom_format("%s-wal", s->path), *shm = prom_format("%s-shm", s->path);
    write_bytes(wal, "\x37\x7f\x06\x82 not a log", 15);
    write_bytes(shm, "nor this", 8);
    assert_unchanged(s);
    unlink(wal);
    unlink(shm);
    prom_free(wal);
    prom_free(shm);
}

static void other_things_than_files(void **state)
{
    (void)state;
    char *path = fixture_path("thing");
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_refused(path, "is no file"); // and does not wait for a writer
    unlink(path);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_refused(path, "is no file");
    rmdir(path);
    assert_refused("/dev/null", "is no file");
    assert_int_equal(symlink(path, path), 0);
    assert_refused(path, "cannot open");
    unlink(path);
    write_bytes(path, "", 0);
    assert_refused(path, "is empty");
    write_bytes(path, "SQLite format 3", 16);
    assert_refused(path, "is not a .prom container");
    unlink(path);
    prom_free(path);
}

static void links_are_followed(void **state)
{
    const setting *s = *state;
    prom_error error;
    char *path = fixture_path("link");
    uint64_t hash = 0;
    assert_int_equal(symlink(s->path, path), 0);
    assert_int_equal(fixture_read_hash(path, &hash, &error), PROM_OK);
    assert_true(hash == s->hash);
    unlink(path);
    prom_free(path);
}

static void names_are_no_addresses(void **state)
{
    const setting *s = *state;
    prom_error error;
    uint64_t hash = 0;
    char *path = prom_format("file:%s?mode=memory", s->path);
    assert_int_equal(rename(s->path, path), 0);
    assert_int_equal(fixture_read_hash(path, &hash, &error), PROM_OK);
    assert_true(hash == s->hash);
    assert_int_equal(rename(path, s->path), 0);
    prom_free(path);
    assert_refused(":memory:", "cannot open");
}

// A file of many gigabytes that takes no room on the disk, with a header that fits: what it
// claims must not be allocated.
static void sparse_files(void **state)
{
    const setting *s = *state;
    const uint64_t pages = 1u << 22; // 256 GiB
    prom_error error;
    int fd = open(s->path, O_RDWR);
    assert_true(fd >= 0);
    if (ftruncate(fd, (off_t)(pages * 65536))) {
        close(fd);
        skip(); // the file system has no such files
    }
    assert_refused(s->path, "belong to it");
    uint8_t count[4] = {(uint8_t)(pages >> 24), (uint8_t)(pages >> 16), (uint8_t)(pages >> 8),
                        (uint8_t)pages};
    assert_int_equal(pwrite(fd, count, 4, 28), 4);
    assert_unchanged(s); // pages that nobody names are no harm
    sqlite3 *db;
    assert_int_equal(sqlite3_open(s->path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db,
                                  "PRAGMA synchronous=OFF;"
                                  "UPDATE table_rows SET row_count=4000000000",
                                  NULL, NULL, NULL),
                     SQLITE_OK);
    sqlite3_close(db);
    close(fd);
    assert_int_equal(fixture_read_all(s->path, &error), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "rows of 4000000000"));
}

// Reads all bulk data of an open container; how many of them came.
static uint32_t read_bulk(prom_container *c, const prom_model *m, const char *path)
{
    prom_error error = {0};
    uint32_t good = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        prom_mesh mesh;
        bool read = prom_container_read_mesh(c, m, i, &mesh, &error) == PROM_OK;
        prom_mesh_finish(&mesh);
        assert_true(read || strstr(error.text, path));
        good += read;
    }
    for (uint32_t i = 0; i < m->texture_count; i++) {
        prom_texture texture;
        bool read = prom_container_read_texture(c, m, i, &texture, &error) == PROM_OK;
        prom_texture_finish(&texture);
        assert_true(read || strstr(error.text, path));
        good += read;
    }
    return good;
}

enum { BULK_COUNT = FIXTURE_MESHES + FIXTURE_TEXTURES };

static void a_name_that_changes_its_file(void **state)
{
    const setting *s = *state;
    prom_error error;
    prom_model m;
    prom_container *c = prom_container_open(s->path, &error);
    assert_non_null(c);
    unlink(s->path);
    write_bytes(s->path, "another file", 12);
    assert_int_equal(prom_container_load_model(c, &m, &error), PROM_OK);
    assert_int_equal(read_bulk(c, &m, s->path), BULK_COUNT);
    prom_model_finish(&m);
    prom_container_close(c);
}

static void a_file_cut_while_it_is_open(void **state)
{
    const setting *s = *state;
    for (off_t bytes = 3 * 65536; bytes >= 0; bytes -= 65536) {
        prom_error error;
        prom_model m;
        prom_container *c = prom_container_open(s->path, &error);
        assert_non_null(c);
        assert_int_equal(prom_container_load_model(c, &m, &error), PROM_OK);
        char *kept = fixture_path("kept");
        copy_file(s->path, kept);
        assert_int_equal(truncate(s->path, bytes), 0);
        uint64_t hash;
        assert_true(read_bulk(c, &m, s->path) < BULK_COUNT);
        prom_status status = prom_container_content_hash(c, &hash, &error);
        assert_true(status == PROM_ERR_INPUT || hash == s->hash);
        prom_model_finish(&m);
        if (prom_container_load_model(c, &m, &error) == PROM_OK) prom_model_finish(&m);
        prom_container_close(c);
        assert_int_equal(rename(kept, s->path), 0);
        prom_free(kept);
    }
}

static void a_file_that_changes_while_it_is_open(void **state)
{
    const setting *s = *state;
    uint32_t seed = 5;
    for (int k = 0; k < 40; k++) {
        prom_error error;
        prom_model m;
        prom_container *c = prom_container_open(s->path, &error);
        assert_non_null(c);
        char *kept = fixture_path("kept");
        copy_file(s->path, kept);
        int fd = open(s->path, O_WRONLY);
        for (int page = 1; page < 30; page++) {
            char junk[64];
            for (size_t i = 0; i < sizeof junk; i++) junk[i] = (char)fixture_random(&seed);
            off_t at = page * 65536 + (k % 2 ? (off_t)(fixture_random(&seed) % 65536) : 0);
            if (at + 64 > 16 * 65536) break;
            assert_int_equal(pwrite(fd, junk, sizeof junk, at), sizeof junk);
        }
        close(fd);
        if (prom_container_load_model(c, &m, &error) == PROM_OK) {
            read_bulk(c, &m, s->path);
            prom_model_finish(&m);
        }
        prom_container_close(c);
        assert_int_equal(rename(kept, s->path), 0);
        prom_free(kept);
    }
}

#define each_with_a_file(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        each_with_a_file(journals_beside_it_are_not_looked_at),
        each_with_a_file(logs_beside_it_are_not_looked_at),
        cmocka_unit_test(other_things_than_files),
        each_with_a_file(links_are_followed),
        each_with_a_file(names_are_no_addresses),
        each_with_a_file(sparse_files),
        each_with_a_file(a_name_that_changes_its_file),
        each_with_a_file(a_file_cut_while_it_is_open),
        each_with_a_file(a_file_that_changes_while_it_is_open),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

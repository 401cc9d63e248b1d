// LINK: prom_metaobj
// A disk that fails under the container's writer: whichever call it is, there is one clear
// error, the file that was there before is untouched, and no .part stays.
#include "container_fixture.h"
#include "failing_vfs.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/stat.h>
#include <sys/syscall.h>

#include <cmocka.h>

// ---- the writer's own calls: these definitions stand before the C library's

static enum { CALL_NONE, CALL_FSYNC, CALL_FTRUNCATE, CALL_RENAME, CALL_WRITE } failing_call;
static int failing_errno;

static bool fails(int call)
{
    if (failing_call != (unsigned)call) return false;
    errno = failing_errno;
    return true;
}

int fsync(int fd)
{
    return fails(CALL_FSYNC) ? -1 : (int)syscall(SYS_fsync, fd);
}

int ftruncate(int fd, off_t bytes)
{
    return fails(CALL_FTRUNCATE) ? -1 : (int)syscall(SYS_ftruncate, fd, bytes);
}

int rename(const char *from, const char *to)
{
    return fails(CALL_RENAME) ? -1 : (int)syscall(SYS_rename, from, to);
}

ssize_t write(int fd, const void *bytes, size_t count)
{
    return fails(CALL_WRITE) ? -1 : syscall(SYS_write, fd, bytes, count);
}

// ---- a file to keep, and a writer that fails

typedef struct setting {
    fixture f;
    char *path, *part, *journal;
    uint8_t *bytes; // of the file as it was
    size_t count;
} setting;

static size_t read_file(const char *path, uint8_t **bytes)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    size_t count = (size_t)ftell(file);
    rewind(file);
    *bytes = prom_alloc(count, 1);
    assert_int_equal(fread(*bytes, 1, count, file), count);
    fclose(file);
    return count;
}

static bool exists(const char *path)
{
    struct stat info;
    return !lstat(path, &info);
}

static int set_up(void **state)
{
    setting *s = prom_calloc(1, sizeof *s);
    prom_error error;
    failing_vfs_arm(0, SQLITE_OK, 0, false);
    fixture_init(&s->f, 2, 2);
    s->path = fixture_path("writer");
    s->part = prom_format("%s.part", s->path);
    s->journal = prom_format("%s-journal", s->part);
    assert_int_equal(fixture_write(&s->f, s->path, 1, &error), PROM_OK);
    s->count = read_file(s->path, &s->bytes);
    *state = s;
    return 0;
}

static int tear_down(void **state)
{
    setting *s = *state;
    failing_call = CALL_NONE;
    failing_vfs_arm(0, SQLITE_OK, 0, false);
    unlink(s->path);
    fixture_finish(&s->f);
    prom_free(s->bytes);
    prom_free(s->path);
    prom_free(s->part);
    prom_free(s->journal);
    prom_free(s);
    return 0;
}

static void assert_nothing_done(const setting *s)
{
    uint8_t *bytes;
    assert_int_equal(read_file(s->path, &bytes), s->count);
    assert_memory_equal(bytes, s->bytes, s->count);
    prom_free(bytes);
    assert_false(exists(s->part));
    assert_false(exists(s->journal));
}

static void assert_clear(const prom_error *error, const char *path, const char *expected)
{
    static const char *const unclear[] = {"malformed",    "logic error", "disk I/O",
                                          "not an error", "database",    "SQL"};
    bool good = strstr(error->text, path) && strstr(error->text, expected);
    for (size_t i = 0; i < sizeof unclear / sizeof *unclear; i++)
        good = good && !strstr(error->text, unclear[i]);
    if (!good) print_error("%s\n", error->text);
    assert_true(good);
}

typedef prom_status write_file(const setting *s, prom_error *error);

static prom_status build(const setting *s, prom_error *error)
{
    return fixture_write(&s->f, s->path, 1, error);
}

// Other cells in the place of those that are there.
static prom_status put_cells(const setting *s, prom_error *error)
{
    prom_view_cells cells;
    uint32_t seed = 4;
    fixture_view_cells(&cells, &s->f.model, 50, &seed);
    prom_writer *w = prom_writer_reopen(s->path, error);
    prom_status status = w ? prom_writer_put_view_cells(w, &cells, error) : error->status;
    if (!status) status = prom_writer_add_stage(w, "view cells", 2, 3, error);
    if (!status) status = prom_writer_finish(w, error);
    prom_writer_destroy(w);
    prom_view_cells_finish(&cells);
    return status;
}

static void put_back(const setting *s)
{
    FILE *file = fopen(s->path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(s->bytes, 1, s->count, file), s->count);
    fclose(file);
}

static void every_call_of(write_file *run, const setting *s, unsigned mask, int code,
                          const char *expected)
{
    prom_error error;
    failing_vfs_arm(mask, code, 0, false);
    assert_int_equal(run(s, &error), PROM_OK);
    long calls = failing_vfs_calls();
    put_back(s);
    assert_true(calls > 0);
    for (long n = 1; n <= 2 * calls; n++) {
        error = (prom_error){0};
        failing_vfs_arm(mask, code, (n + 1) / 2, n & 1); // once, and for good
        prom_status status = run(s, &error);
        assert_true(failing_vfs_failed() > 0);
        failing_vfs_arm(0, SQLITE_OK, 0, false);
        if (status == PROM_OK) print_error("call %ld of %ld did not matter\n", n, calls);
        assert_int_equal(status, PROM_ERR_OUTPUT);
        assert_clear(&error, s->path, expected);
        assert_nothing_done(s);
    }
    print_message("%ld calls\n", calls);
}

static void every_call_fails(const setting *s, unsigned mask, int code, const char *expected)
{
    every_call_of(build, s, mask, code, expected);
    every_call_of(put_cells, s, mask, code, expected);
}

static void a_full_disk(void **state)
{
    every_call_fails(*state, FAILING_WRITE, SQLITE_FULL, "the disk is full");
}

static void writes_that_fail(void **state)
{
    every_call_fails(*state, FAILING_WRITE, SQLITE_IOERR, "cannot write");
}

static void syncs_that_fail(void **state)
{
    every_call_fails(*state, FAILING_SYNC, SQLITE_IOERR, "cannot write");
}

static void journals_that_cannot_be_made(void **state)
{
    every_call_fails(*state, FAILING_OPEN, SQLITE_IOERR, "cannot write");
}

static void journals_that_cannot_go(void **state)
{
    every_call_fails(*state, FAILING_DELETE, SQLITE_IOERR, "cannot write");
}

static void own_calls_of(write_file *run, const setting *s, unsigned last)
{
    static const struct {
        int error;
        const char *text;
    } reasons[] = {{ENOSPC, "the disk is full"}, {EDQUOT, "quota"}, {EIO, "error"}};
    for (unsigned call = CALL_FSYNC; call <= last; call++)
        for (size_t r = 0; r < sizeof reasons / sizeof *reasons; r++) {
            prom_error error = {0};
            failing_call = call;
            failing_errno = reasons[r].error;
            prom_status status = run(s, &error);
            failing_call = CALL_NONE;
            assert_int_equal(status, PROM_ERR_OUTPUT);
            assert_clear(&error, s->path, reasons[r].text);
            assert_nothing_done(s);
        }
}

static void own_calls_that_fail(void **state)
{
    own_calls_of(build, *state, CALL_RENAME);
    own_calls_of(put_cells, *state, CALL_WRITE); // of the copy
}

// After an error every call says so, and none writes on.
static void a_writer_that_has_failed(void **state)
{
    const setting *s = *state;
    prom_error error = {0};
    prom_writer *w = prom_writer_create(s->path, &error);
    assert_non_null(w);
    assert_int_equal(prom_writer_add_mesh(w, &s->f.meshes[0], NULL, &error), PROM_OK);
    failing_vfs_arm(FAILING_ANY, SQLITE_FULL, 1, true);
    assert_int_equal(prom_writer_add_stage(w, "one", 1, 1, &error), PROM_ERR_OUTPUT);
    assert_clear(&error, s->path, "the disk is full");
    failing_vfs_arm(FAILING_ANY, SQLITE_FULL, 0, false);
    assert_int_equal(prom_writer_add_mesh(w, &s->f.meshes[1], NULL, &error), PROM_ERR_OUTPUT);
    assert_clear(&error, s->path, "an earlier write failed");
    assert_int_equal(prom_writer_add_texture(w, &s->f.textures[0], NULL, &error),
                     PROM_ERR_OUTPUT);
    assert_clear(&error, s->path, "an earlier write failed");
    assert_int_equal(prom_writer_add_stage(w, "two", 2, 1, &error), PROM_ERR_OUTPUT);
    assert_clear(&error, s->path, "an earlier write failed");
    assert_int_equal(prom_writer_put_model(w, &s->f.model, &error), PROM_ERR_OUTPUT);
    assert_int_equal(prom_writer_finish(w, &error), PROM_ERR_OUTPUT);
    assert_clear(&error, s->path, "an earlier write failed");
    assert_int_equal(failing_vfs_calls(), 0);
    prom_writer_destroy(w);
    assert_nothing_done(s);
}

// Somebody cleans the folder up and builds anew: that build's .part is not ours to name.
static void a_part_that_is_taken_away(void **state)
{
    const setting *s = *state;
    prom_error error = {0};
    prom_writer *w = prom_writer_create(s->path, &error);
    assert_non_null(w);
    for (int i = 0; i < FIXTURE_MESHES; i++)
        assert_int_equal(prom_writer_add_mesh(w, &s->f.meshes[i], NULL, &error), PROM_OK);
    for (int i = 0; i < FIXTURE_TEXTURES; i++)
        assert_int_equal(prom_writer_add_texture(w, &s->f.textures[i], NULL, &error), PROM_OK);
    assert_int_equal(prom_writer_put_model(w, &s->f.model, &error), PROM_OK);
    unlink(s->part);
    prom_writer *other = prom_writer_create(s->path, &error);
    assert_non_null(other);
    assert_int_equal(prom_writer_finish(w, &error), PROM_ERR_OUTPUT);
    assert_clear(&error, s->path, "another program");
    prom_writer_destroy(w);
    assert_true(exists(s->part));
    prom_writer_destroy(other);
    assert_nothing_done(s);
}

static void a_part_that_is_no_file(void **state)
{
    const setting *s = *state;
    prom_error error = {0};
    assert_int_equal(mkfifo(s->part, 0600), 0);
    assert_null(prom_writer_create(s->path, &error));
    assert_clear(&error, s->path, "no plain file");
    assert_true(exists(s->part)); // not ours
    unlink(s->part);
    assert_int_equal(symlink("elsewhere", s->part), 0);
    assert_null(prom_writer_create(s->path, &error));
    assert_clear(&error, s->path, "symbolic link");
    assert_true(exists(s->part));
    assert_false(exists("elsewhere"));
    unlink(s->part);
    assert_nothing_done(s);
}

#define each_with_a_file(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        each_with_a_file(a_full_disk),
        each_with_a_file(writes_that_fail),
        each_with_a_file(syncs_that_fail),
        each_with_a_file(journals_that_cannot_be_made),
        each_with_a_file(journals_that_cannot_go),
        each_with_a_file(own_calls_that_fail),
        each_with_a_file(a_writer_that_has_failed),
        each_with_a_file(a_part_that_is_taken_away),
        each_with_a_file(a_part_that_is_no_file),
    };
    failing_vfs_install();
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// LINK: prom_metaobj
// Damaged containers: cut short anywhere or with any bit flipped, reading gives an error or the
// very same content, never a crash (the sanitizer build watches the rest).
#include "container_fixture.h"

#include "metaobj/base/log.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

typedef struct image {
    uint8_t *bytes;
    size_t count;
    char *path;
} image;

static image load_image(void)
{
    prom_error error;
    fixture f;
    fixture_init(&f, 3, 4);
    image i = {.path = fixture_path("damage")};
    assert_int_equal(fixture_write(&f, i.path, 1, &error), PROM_OK);
    fixture_finish(&f);
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
    prom_status status = fixture_read_all(i->path, error);
    if (status) assert_non_null(strstr(error->text, i->path));
    return status;
}

static void cut_short(void **state)
{
    (void)state;
    prom_error error;
    image i = load_image();
    uint32_t seed = 3;
    for (int k = 0; k < 100; k++) {
        size_t count = k < 8 ? (size_t)k * 16 : fixture_random(&seed) % i.count;
        assert_int_equal(read_bytes(&i, count, &error), PROM_ERR_INPUT);
    }
    assert_int_equal(read_bytes(&i, i.count - 1, &error), PROM_ERR_INPUT);
    assert_int_equal(read_bytes(&i, i.count, &error), PROM_OK);
    drop_image(&i);
}

// Offsets of bytes that carry something: pages hold long runs of zeros between header and
// cells.
static size_t next_used(const image *i, uint32_t *seed)
{
    for (;;) {
        size_t at = ((size_t)fixture_random(seed) << 24 | fixture_random(seed)) % i->count;
        if (i->bytes[at]) return at;
    }
}

static void flipped_bits(void **state)
{
    (void)state;
    prom_error error;
    image i = load_image();
    uint32_t seed = 11;
    int refused = 0, flips = 300;
    prom_log_set_level(PROM_LOG_ERROR);
    for (int k = 0; k < flips; k++) {
        // A third of them in SQLite's header and the schema's table of cells behind it.
        size_t at = k % 3 ? next_used(&i, &seed) : next_used(&i, &seed) % 136;
        uint8_t bit = (uint8_t)(1u << (fixture_random(&seed) & 7));
        i.bytes[at] ^= bit;
        refused += read_bytes(&i, i.count, &error) != PROM_OK;
        i.bytes[at] ^= bit;
    }
    prom_log_set_level(PROM_LOG_INFO);
    print_message("%d of %d flips refused\n", refused, flips);
    // The rest changes counters of SQLite's header that a reader has no use for.
    assert_true(refused * 10 > flips * 8);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cut_short),
        cmocka_unit_test(flipped_bits),
        cmocka_unit_test(blanked_pages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

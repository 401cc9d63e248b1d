// LINK: prom_metaobj
// The codecs of the bulk data between pages that nobody may touch: each buffer ends where its
// data end, so that reading or writing a byte past one is a crash, in any library and build.
#include "metaobj/container_schema.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

// Memory whose last byte is followed by a forbidden page.
typedef struct guarded {
    uint8_t *start, *end;
    size_t mapped;
} guarded;

static guarded guarded_make(size_t bytes)
{
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    size_t mapped = (bytes + page - 1) / page * page + page;
    uint8_t *all =
        mmap(NULL, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(all != MAP_FAILED);
    assert_int_equal(mprotect(all + mapped - page, page, PROT_NONE), 0);
    return (guarded){all, all + mapped - page, mapped};
}

static void guarded_free(guarded *g)
{
    munmap(g->start, g->mapped);
}

static uint32_t random_below(uint64_t *state, uint64_t n)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((*state >> 32) % n);
}

// Elements such as meshes have: indices near each other, vertices that change slowly.
static void fill(const prom_stream *stream, uint8_t *data, uint64_t *seed)
{
    size_t bytes = (size_t)stream->count * stream->stride;
    for (size_t i = 0; i < bytes; i++)
        data[i] = (uint8_t)(i / stream->stride + random_below(seed, 3));
    for (size_t i = 0; stream->codec == PROM_CODEC_INDEX && i < stream->count; i++) {
        uint32_t index = (uint32_t)(i / 3 + i % 3 + random_below(seed, 2));
        memcpy(data + 4 * i, &index, 4);
    }
}

static void spoil(uint8_t *bytes, size_t count, uint64_t *seed)
{
    for (uint32_t k = random_below(seed, 5); k && count; k--)
        bytes[random_below(seed, count)] = (uint8_t)random_below(seed, 256);
}

// Decodes spoiled and cut copies of a chunk, each in a buffer of its very size.
static void decode_spoiled(const prom_stream *stream, const uint8_t *chunk, size_t count,
                           uint64_t *seed)
{
    size_t raw = (size_t)stream->count * stream->stride;
    guarded in = guarded_make(count), out = guarded_make(raw);
    for (int k = 0; k < 400; k++) {
        size_t part = k % 4 == 3 ? random_below(seed, count + 1) : count;
        uint8_t *bytes = in.end - part;
        memcpy(bytes, chunk, part);
        if (k) spoil(bytes, part, seed);
        bool good =
            prom_chunk_decode(stream, stream->codec, bytes, part, out.end - raw, stream->count);
        assert_true(good || k); // the first is as it was written
        prom_chunk_decode(stream, PROM_CODEC_RAW, bytes, part, out.end - raw, stream->count);
    }
    guarded_free(&in);
    guarded_free(&out);
}

static void nothing_is_read_or_written_past_the_end(void **state)
{
    (void)state;
    static const uint64_t counts[] = {3, 9, 16, 255, 256, 258, 3000, 17001};
    static const prom_stream kinds[] = {{PROM_CODEC_VERTEX, 28, 0},
                                        {PROM_CODEC_INDEX, 4, 0},
                                        {PROM_CODEC_ZSTD, 12, 0},
                                        {PROM_CODEC_ZSTD, 1, 0}};
    uint64_t seed = 1;
    prom_bytes encoded = {0};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            prom_stream stream = kinds[k];
            stream.count = counts[c] / 3 * 3;
            size_t raw = (size_t)stream.count * stream.stride;
            guarded data = guarded_make(raw);
            fill(&stream, data.end - raw, &seed);
            prom_chunk_encode(&stream, data.end - raw, stream.count, &encoded);
            assert_true(encoded.count > 0);
            decode_spoiled(&stream, encoded.data, encoded.count, &seed);
            guarded_free(&data);
        }
    prom_array_finish(&encoded);
}

// What the reader refuses a claim by must be true of the smallest chunks there are.
static void no_chunk_is_smaller_than_the_least(void **state)
{
    (void)state;
    const uint64_t bytes = 8u << 20;
    uint8_t *zeros = prom_calloc(bytes, 1);
    prom_bytes encoded = {0};
    static const prom_stream kinds[] = {
        {PROM_CODEC_VERTEX, 28, 0}, {PROM_CODEC_INDEX, 4, 0}, {PROM_CODEC_ZSTD, 1, 0}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        prom_stream stream = kinds[k];
        stream.count = bytes / stream.stride / 3 * 3;
        prom_chunk_encode(&stream, zeros, stream.count, &encoded);
        uint64_t least = prom_codec_least_bytes(stream.codec, stream.count * stream.stride);
        print_message("codec %d: %zu bytes, least %llu\n", (int)stream.codec, encoded.count,
                      (unsigned long long)least);
        assert_true(encoded.count >= least);
    }
    prom_array_finish(&encoded);
    prom_free(zeros);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_read_or_written_past_the_end),
        cmocka_unit_test(no_chunk_is_smaller_than_the_least),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

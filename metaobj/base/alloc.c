#include "metaobj/base/alloc.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define BLOCK_BYTES ((size_t)1 << 18)

struct prom_arena_block {
    struct prom_arena_block *next;
    size_t used, size; // of the payload, which follows 16-byte aligned
};
#define HEADER_BYTES ((sizeof(struct prom_arena_block) + 15) & ~(size_t)15)

static _Noreturn void out_of_memory(size_t count, size_t size)
{
    fprintf(stderr, "error: out of memory (%zu x %zu bytes)\n", count, size);
    abort();
}

static size_t checked(size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > PTRDIFF_MAX)
        out_of_memory(count, size);
    return bytes ? bytes : 1;
}

void *prom_alloc(size_t count, size_t size)
{
    void *p = malloc(checked(count, size));
    if (!p) out_of_memory(count, size);
    return p;
}

void *prom_calloc(size_t count, size_t size)
{
    void *p = calloc(1, checked(count, size));
    if (!p) out_of_memory(count, size);
    return p;
}

void *prom_realloc(void *pointer, size_t count, size_t size)
{
    void *p = realloc(pointer, checked(count, size));
    if (!p) out_of_memory(count, size);
    return p;
}

void prom_free(void *pointer)
{
    free(pointer);
}

char *prom_strdup(const char *text)
{
    size_t bytes = strlen(text) + 1;
    return memcpy(prom_alloc(bytes, 1), text, bytes);
}

char *prom_format(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    int length = vsnprintf(NULL, 0, format, args);
    va_end(args);
    if (length < 0) return prom_strdup("");
    char *text = prom_alloc((size_t)length + 1, 1);
    va_start(args, format);
    vsnprintf(text, (size_t)length + 1, format, args);
    va_end(args);
    return text;
}

void *prom_arena_alloc(prom_arena *arena, size_t count, size_t size)
{
    size_t bytes = (checked(count, size) + 15) & ~(size_t)15;
    struct prom_arena_block *b = arena->blocks;
    if (!b || b->size - b->used < bytes) {
        size_t payload = bytes > BLOCK_BYTES ? bytes : BLOCK_BYTES;
        b = prom_calloc(1, checked(1, HEADER_BYTES + payload));
        b->size = payload;
        b->next = arena->blocks;
        arena->blocks = b;
    }
    char *p = (char *)b + HEADER_BYTES + b->used;
    b->used += bytes;
    return p;
}

char *prom_arena_strdup(prom_arena *arena, const char *text)
{
    size_t bytes = strlen(text) + 1;
    return memcpy(prom_arena_alloc(arena, bytes, 1), text, bytes);
}

void prom_arena_finish(prom_arena *arena)
{
    while (arena->blocks) {
        struct prom_arena_block *next = arena->blocks->next;
        free(arena->blocks);
        arena->blocks = next;
    }
}

void *prom_array_grow_(void *data, size_t *capacity, size_t needed, size_t size)
{
    size_t grown = *capacity + *capacity / 2 + 8;
    if (grown < needed) grown = needed;
    *capacity = grown;
    return prom_realloc(data, grown, size);
}

void prom_memory_use(uint64_t *mapped, uint64_t *resident)
{
    unsigned long long all = 0, there = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f && fscanf(f, "%llu %llu", &all, &there) != 2) all = there = 0;
    if (f) fclose(f);
    const uint64_t page = (uint64_t)sysconf(_SC_PAGESIZE);
    *mapped = all * page;
    *resident = there * page;
}

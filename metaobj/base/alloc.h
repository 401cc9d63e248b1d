// Memory: checked allocation, arenas for what lives together, growable arrays.
//
// Allocation never returns NULL: when memory ends, the program ends with one line. Sizes that
// come from a file are checked against the file's own size before anything is allocated.
#ifndef PROM_METAOBJ_BASE_ALLOC_H
#define PROM_METAOBJ_BASE_ALLOC_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

// count x size bytes, aligned for every type; aborts on overflow. Zero bytes give a valid
// pointer.
void *prom_alloc(size_t count, size_t size);
void *prom_calloc(size_t count, size_t size);
void *prom_realloc(void *pointer, size_t count, size_t size);
void prom_free(void *pointer); // NULL is allowed
char *prom_strdup(const char *text);
// printf into a new string; free it with prom_free.
char *prom_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

// Bytes of address space that this process has mapped, and of them in memory now; 0 and 0 where
// the system does not tell.
void prom_memory_use(uint64_t *mapped, uint64_t *resident);

// An arena hands out memory that is freed all at once.
typedef struct prom_arena {
    struct prom_arena_block *blocks; // newest first
} prom_arena;                        // {0} is an empty arena

void *prom_arena_alloc(prom_arena *arena, size_t count, size_t size); // zeroed, 16-byte aligned
char *prom_arena_strdup(prom_arena *arena, const char *text);
void prom_arena_finish(prom_arena *arena);

// A growable array: `PROM_ARRAY(int) a = {0}; prom_array_push(&a, 1); prom_array_finish(&a);`
#define PROM_ARRAY(type)                                                                       \
    struct {                                                                                   \
        type *data;                                                                            \
        size_t count, capacity;                                                                \
    }

void *prom_array_grow_(void *data, size_t *capacity, size_t needed, size_t size);

#define prom_array_reserve(a, n)                                                               \
    ((a)->data = (n) > (a)->capacity                                                           \
                     ? prom_array_grow_((a)->data, &(a)->capacity, (n), sizeof *(a)->data)     \
                     : (a)->data)
#define prom_array_push(a, ...)                                                                \
    (prom_array_reserve((a), (a)->count + 1), (void)((a)->data[(a)->count++] = (__VA_ARGS__)))
// Makes room for n more, zeroed, and gives the first one's address.
#define prom_array_extend(a, n)                                                                \
    (prom_array_reserve((a), (a)->count + (n)), (a)->count += (n),                             \
     memset((a)->data + (a)->count - (n), 0, (n) * sizeof *(a)->data),                         \
     (a)->data + (a)->count - (n))
#define prom_array_finish(a) (prom_free((a)->data), (void)memset((a), 0, sizeof *(a)))

#endif

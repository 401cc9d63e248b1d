#include "builder/simplify/records.h"

#include <assert.h>
#include <stdlib.h>

void prom_records_init(prom_records *records, uint32_t triangle_slots)
{
    *records = (prom_records){.triangle_slots = triangle_slots};
    records->last = prom_alloc(triangle_slots, sizeof *records->last);
    memset(records->last, 0xff, triangle_slots * sizeof *records->last);
}

void prom_records_finish(prom_records *records)
{
    prom_array_finish(&records->records);
    prom_array_finish(&records->changes);
    prom_array_finish(&records->corners);
    prom_array_finish(&records->removed);
    prom_array_finish(&records->dependencies);
    prom_free(records->last);
    *records = (prom_records){0};
}

#define ARRAY_BYTES(a) ((a).capacity * sizeof *(a).data)

size_t prom_records_bytes(const prom_records *records)
{
    return ARRAY_BYTES(records->records) + ARRAY_BYTES(records->changes) +
           ARRAY_BYTES(records->corners) + ARRAY_BYTES(records->removed) +
           ARRAY_BYTES(records->dependencies) + records->triangle_slots * sizeof *records->last;
}

// ---- recording

static uint32_t current(const prom_records *records)
{
    assert(records->open);
    return (uint32_t)records->records.count - 1;
}

void prom_records_begin(prom_records *records, uint32_t from, uint32_t to, uint32_t next_vertex)
{
    assert(!records->open && from != to);
    const size_t count = records->records.count;
    if (!count) records->first_vertex = next_vertex;
    assert(!count || records->records.data[count - 1].vertices_end == next_vertex);
    prom_array_push(&records->records, (prom_record){.from = from, .to = to});
    records->open = true;
}

void prom_records_touch(prom_records *records, uint32_t triangle)
{
    const uint32_t record = current(records);
    assert(triangle < records->triangle_slots);
    const uint32_t last = records->last[triangle];
    if (last == record) return;
    records->last[triangle] = record;
    if (last != PROM_NONE) prom_array_push(&records->dependencies, last);
}

void prom_records_change(prom_records *records, uint32_t corner, uint32_t from, uint32_t to)
{
    assert(records->open && prom_records_touched(records, corner / 3));
    const size_t first = prom_record_changes(records, current(records)).first;
    const size_t count = records->changes.count;
    prom_vertex_change *data = records->changes.data;
    if (count == first || data[count - 1].from != from || data[count - 1].to != to)
        prom_array_push(&records->changes, (prom_vertex_change){.from = from, .to = to});
    prom_array_push(&records->corners, corner);
    records->changes.data[records->changes.count - 1].corners_end =
        (uint32_t)records->corners.count;
}

void prom_records_remove(prom_records *records, uint32_t triangle, const uint32_t corners[3])
{
    assert(records->open && prom_records_touched(records, triangle));
    prom_array_push(&records->removed,
                    (prom_removed_triangle){triangle, {corners[0], corners[1], corners[2]}});
}

static int by_number(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

// A handful as a rule, but points with thousands of triangles exist.
static void sort_numbers(uint32_t *numbers, size_t count)
{
    if (count > 64) {
        qsort(numbers, count, sizeof *numbers, by_number);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const uint32_t number = numbers[i];
        size_t k = i;
        for (; k && numbers[k - 1] > number; k--) numbers[k] = numbers[k - 1];
        numbers[k] = number;
    }
}

// Returns how many are left of numbers in order.
static size_t without_repeats(uint32_t *numbers, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (!kept || numbers[kept - 1] != numbers[i]) numbers[kept++] = numbers[i];
    return kept;
}

void prom_records_end(prom_records *records, float error, uint32_t next_vertex)
{
    const uint32_t number = current(records);
    const size_t first = prom_record_dependencies(records, number).first;
    const size_t count = records->dependencies.count - first;
    if (count) {
        uint32_t *own = records->dependencies.data + first;
        sort_numbers(own, count);
        records->dependencies.count = first + without_repeats(own, count);
    }
    // Corners and dependencies are the longest lists.
    assert(records->corners.count <= UINT32_MAX && records->dependencies.count <= UINT32_MAX);
    prom_record *record = records->records.data + number;
    record->error = error;
    record->changes_end = (uint32_t)records->changes.count;
    record->removed_end = (uint32_t)records->removed.count;
    record->dependencies_end = (uint32_t)records->dependencies.count;
    record->vertices_end = next_vertex;
    records->open = false;
}

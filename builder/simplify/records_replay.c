#include "builder/simplify/records.h"

#include <assert.h>

static uint32_t record_count(const prom_replay *replay)
{
    return (uint32_t)replay->records->records.count;
}

void prom_replay_init(prom_replay *replay, const prom_records *records, const uint32_t *corners)
{
    assert(!records->open);
    const size_t count = records->records.count, slots = records->triangle_slots;
    *replay = (prom_replay){.records = records};
    replay->corners = prom_alloc(3 * slots, sizeof *corners);
    replay->applied = prom_calloc(count, sizeof *replay->applied);
    replay->users = prom_calloc(count, sizeof *replay->users);
    if (slots) memcpy(replay->corners, corners, 3 * slots * sizeof *corners);
    for (size_t t = 0; t < slots; t++) replay->triangles += corners[3 * t] != PROM_NONE;
}

void prom_replay_finish(prom_replay *replay)
{
    prom_free(replay->corners);
    prom_free(replay->applied);
    prom_free(replay->users);
    *replay = (prom_replay){0};
}

bool prom_replay_can_apply(const prom_replay *replay, uint32_t record)
{
    if (record >= record_count(replay) || replay->applied[record]) return false;
    const prom_record_part part = prom_record_dependencies(replay->records, record);
    for (uint32_t i = part.first; i < part.end; i++)
        if (!replay->applied[replay->records->dependencies.data[i]]) return false;
    return true;
}

bool prom_replay_can_undo(const prom_replay *replay, uint32_t record)
{
    return record < record_count(replay) && replay->applied[record] && !replay->users[record];
}

static void set_corners(prom_replay *replay, uint32_t change, uint32_t expected, uint32_t to)
{
    const prom_record_part part = prom_change_corners(replay->records, change);
    for (uint32_t i = part.first; i < part.end; i++) {
        uint32_t *corner = replay->corners + replay->records->corners.data[i];
        assert(*corner == expected);
        *corner = to;
    }
    (void)expected; // where assertions are off
}

static void set_triangle(prom_replay *replay, uint32_t triangle, uint32_t a, uint32_t b,
                         uint32_t c)
{
    uint32_t *corners = replay->corners + 3 * (size_t)triangle;
    corners[0] = a, corners[1] = b, corners[2] = c;
}

static void mark(prom_replay *replay, uint32_t record, bool applied)
{
    replay->applied[record] = applied;
    if (applied) {
        if (replay->low == record) replay->low++;
        if (replay->high <= record) replay->high = record + 1;
    } else {
        if (replay->low > record) replay->low = record;
        if (replay->high == record + 1) replay->high--;
    }
    const prom_record_part part = prom_record_dependencies(replay->records, record);
    for (uint32_t i = part.first; i < part.end; i++) {
        uint32_t *users = replay->users + replay->records->dependencies.data[i];
        *users = applied ? *users + 1 : *users - 1;
    }
}

void prom_replay_apply(prom_replay *replay, uint32_t record)
{
    assert(prom_replay_can_apply(replay, record));
    const prom_records *records = replay->records;
    const prom_record_part changes = prom_record_changes(records, record);
    for (uint32_t i = changes.first; i < changes.end; i++)
        set_corners(replay, i, records->changes.data[i].from, records->changes.data[i].to);
    const prom_record_part removed = prom_record_removed(records, record);
    for (uint32_t i = removed.first; i < removed.end; i++)
        set_triangle(replay, records->removed.data[i].triangle, PROM_NONE, PROM_NONE,
                     PROM_NONE);
    replay->triangles -= removed.end - removed.first;
    mark(replay, record, true);
}

void prom_replay_undo(prom_replay *replay, uint32_t record)
{
    assert(prom_replay_can_undo(replay, record));
    const prom_records *records = replay->records;
    const prom_record_part removed = prom_record_removed(records, record);
    for (uint32_t i = removed.first; i < removed.end; i++) {
        const prom_removed_triangle *r = records->removed.data + i;
        set_triangle(replay, r->triangle, r->corners[0], r->corners[1], r->corners[2]);
    }
    replay->triangles += removed.end - removed.first;
    const prom_record_part changes = prom_record_changes(records, record);
    for (uint32_t i = changes.end; i-- > changes.first;)
        set_corners(replay, i, records->changes.data[i].to, records->changes.data[i].from);
    mark(replay, record, false);
}

// Records depend on earlier ones only: undone from the last, applied from the first, each can
// be.
void prom_replay_seek(prom_replay *replay, uint32_t count)
{
    assert(count <= record_count(replay));
    for (uint32_t i = replay->high; i-- > count;)
        if (replay->applied[i]) prom_replay_undo(replay, i);
    for (uint32_t i = replay->low; i < count; i++)
        if (!replay->applied[i]) prom_replay_apply(replay, i);
    replay->low = replay->high = count;
}

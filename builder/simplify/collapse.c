#include "builder/simplify/collapse.h"

#include "builder/simplify/corner.h"

#include <math.h>
#include <meshoptimizer.h>

// Relative error limit that stands for none (the mesh's extent is 1).
#define NO_LIMIT 1e6f

// The used vertices only: meshoptimizer looks at every vertex it is given, used or not.
typedef struct compact {
    float (*positions)[3];
    uint32_t *vertices; // to the work's
    uint32_t *indices;
    uint32_t count;
} compact;

static compact compact_init(const prom_work *work, const uint32_t *faces, size_t count,
                            const uint32_t *representative)
{
    uint32_t *ids = prom_alloc(work->base_count, sizeof *ids);
    memset(ids, 0xff, work->base_count * sizeof *ids);
    compact c = {prom_alloc(count, sizeof *c.positions), prom_alloc(count, sizeof *c.vertices),
                 prom_alloc(count, sizeof *c.indices), 0};
    for (size_t i = 0; i < count; i++) {
        uint32_t v = representative[faces[i]];
        if (ids[v] == PROM_NONE) {
            ids[v] = c.count;
            memcpy(c.positions[c.count], work->vertices.data[v].position, sizeof *c.positions);
            c.vertices[c.count++] = v;
        }
        c.indices[i] = ids[v];
    }
    prom_free(ids);
    return c;
}

static void compact_finish(compact *c)
{
    prom_free(c->positions);
    prom_free(c->vertices);
    prom_free(c->indices);
}

static float relative_limit(float max_error, float scale)
{
    if (!(max_error < INFINITY) || scale <= 0) return NO_LIMIT;
    return fminf(max_error / scale, NO_LIMIT);
}

static void append(const compact *c, const uint32_t *result, size_t count,
                   prom_index_array *out)
{
    for (size_t i = 0; i < count; i++) prom_array_push(out, c->vertices[result[i]]);
}

void prom_work_collapse_run(const prom_work *work, const uint32_t *faces, size_t count,
                            const prom_collapse_options *options,
                            const uint32_t *representative, prom_index_array *out, float *error)
{
    compact c = compact_init(work, faces, count, representative);
    uint32_t *result = prom_alloc(count, sizeof *result);
    float scale = meshopt_simplifyScale(c.positions[0], c.count, sizeof *c.positions);
    float relative = 0;
    size_t n =
        meshopt_simplify(result, c.indices, count, c.positions[0], c.count, sizeof *c.positions,
                         (size_t)options->target * 3, relative_limit(options->max_error, scale),
                         options->lock_border ? meshopt_SimplifyLockBorder : 0, &relative);
    append(&c, result, n, out);
    *error = fmaxf(*error, relative * scale);
    prom_free(result);
    compact_finish(&c);
}

static uint32_t distinct(const uint32_t *representative, uint32_t count)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++) n += representative[i] == i;
    return n;
}

// Whether a freer reading's result is worth the attributes it loses. A result near the target
// whose error is not half again as great is as good as it gets (both by taste).
static bool better(uint32_t target, size_t old_count, float old_error, size_t count,
                   float error)
{
    size_t near = (size_t)target * 3 * 11 / 10;
    if (old_count > near) return count * 20 < old_count * 19;
    return count <= near && error * 1.5f < old_error;
}

void prom_work_collapse(const prom_work *work, const prom_index_array *faces,
                        const prom_collapse_options *options, prom_index_array *out,
                        float *error)
{
    out->count = 0;
    *error = 0;
    if (!faces->count || options->target * (size_t)3 >= faces->count) {
        for (size_t i = 0; i < faces->count; i++) prom_array_push(out, faces->data[i]);
        return;
    }
    uint32_t *reading = prom_alloc(work->base_count, sizeof *reading);
    prom_index_array trial = {0};
    // Far reductions of plain meshes get new colours anyway: attributes must not hold them
    // back.
    bool far = options->plain && (size_t)options->target * 12 < faces->count;
    uint32_t last_distinct = 0;
    for (int r = far ? PROM_READ_POSITION : PROM_READ_ALL; r <= PROM_READ_POSITION; r++) {
        prom_read_vertices(work, (prom_reading)r, reading);
        uint32_t n = distinct(reading, work->base_count);
        bool first = last_distinct == 0;
        // Next to nothing is merged by this reading: it would bring the same again.
        if (!first && n + n / 64 >= last_distinct) continue;
        last_distinct = n;
        float trial_error = 0;
        trial.count = 0;
        prom_work_collapse_run(work, faces->data, faces->count, options, reading, &trial,
                               &trial_error);
        if (!first && !better(options->target, out->count, *error, trial.count, trial_error))
            continue;
        prom_choose_corners(work, faces, reading, options->plain, &trial);
        prom_index_array swap = *out;
        *out = trial;
        trial = swap;
        *error = trial_error;
    }
    prom_array_finish(&trial);
    prom_free(reading);
}

// The triangles of one owner after the other.
static void sort_by_owner(const prom_work *work, const prom_index_array *faces, uint32_t *start,
                          uint32_t *sorted)
{
    uint32_t owners = work->submesh_count * PROM_OWNERS;
    memset(start, 0, ((size_t)owners + 1) * sizeof *start);
    for (size_t i = 0; i < faces->count; i += 3)
        start[work->owners.data[faces->data[i]] + 1] += 3;
    for (uint32_t o = 0; o < owners; o++) start[o + 1] += start[o];
    uint32_t *at = prom_alloc(owners, sizeof *at);
    memcpy(at, start, owners * sizeof *at);
    for (size_t i = 0; i < faces->count; i += 3) {
        uint32_t *slot = &at[work->owners.data[faces->data[i]]];
        memcpy(sorted + *slot, faces->data + i, 3 * sizeof *sorted);
        *slot += 3;
    }
    prom_free(at);
}

static void sloppy_range(const prom_work *work, const uint32_t *faces, size_t count,
                         size_t target, float max_error, const uint32_t *reading,
                         prom_index_array *out, float *error)
{
    compact c = compact_init(work, faces, count, reading);
    uint32_t *result = prom_alloc(count, sizeof *result);
    float scale = meshopt_simplifyScale(c.positions[0], c.count, sizeof *c.positions);
    float relative = 0;
    size_t n = meshopt_simplifySloppy(result, c.indices, count, c.positions[0], c.count,
                                      sizeof *c.positions, target,
                                      relative_limit(max_error, scale), &relative);
    append(&c, result, n, out);
    *error = fmaxf(*error, relative * scale);
    prom_free(result);
    compact_finish(&c);
}

void prom_work_sloppy(const prom_work *work, const prom_index_array *faces, uint32_t target,
                      float max_error, prom_index_array *out, float *error)
{
    out->count = 0;
    *error = 0;
    if (!faces->count) return;
    uint32_t owners = work->submesh_count * PROM_OWNERS;
    uint32_t *start = prom_alloc((size_t)owners + 1, sizeof *start);
    uint32_t *sorted = prom_alloc(faces->count, sizeof *sorted);
    uint32_t *reading = prom_alloc(work->base_count, sizeof *reading);
    sort_by_owner(work, faces, start, sorted);
    prom_read_vertices(work, PROM_READ_POSITION, reading);
    for (uint32_t o = 0; o < owners; o++) {
        size_t count = start[o + 1] - start[o];
        size_t share = (size_t)((double)target * (double)count / (double)faces->count) * 3;
        if (share < 3) share = 3;
        if (share >= count)
            for (size_t i = 0; i < count; i++)
                prom_array_push(out, reading[sorted[start[o] + i]]);
        else
            sloppy_range(work, sorted + start[o], count, share, max_error, reading, out, error);
    }
    prom_choose_corners(work, faces, reading, false, out);
    prom_free(start);
    prom_free(sorted);
    prom_free(reading);
}

#include "builder/simplify/simplify.h"

#include "builder/simplify/reduce.h"

#include <assert.h>
#include <math.h>

// A level must have less than this share of the one before to be worth its bytes.
#define WORTH 0.85f
// Below this a coarser picture than the last level is a box's business (by taste).
enum { MIN_SLOPPY_FROM = 48, MIN_SLOPPY = 8 };

// Reduces and puts the mesh together; false when that is not smaller than `below` triangles.
static bool reduce(prom_work *work, const prom_reduce_options *options, uint32_t below,
                   prom_mesh *out, float *error)
{
    prom_index_array faces = {0};
    *error = prom_work_reduce(work, options, &faces);
    uint32_t triangles = prom_work_count(work, &faces);
    bool ok = triangles > 0 && triangles < below;
    if (ok) prom_work_emit(work, &faces, out);
    prom_array_finish(&faces);
    prom_work_reset(work);
    return ok;
}

bool prom_simplify(const prom_mesh *mesh, const prom_simplify_options *options, prom_mesh *out,
                   float *error)
{
    assert(!(options->sloppy && options->lock_border));
    *out = (prom_mesh){0};
    *error = 0;
    prom_work work;
    prom_work_init(&work, mesh);
    bool limited = options->max_error > 0, ok = false;
    prom_reduce_options reduction = {
        .target = options->target_triangles,
        .max_error = limited ? options->max_error : INFINITY,
        .lock_border = options->lock_border,
        .sloppy = options->sloppy,
    };
    // The limit steers an estimate; when the measured deviation is beyond it, tighten it and
    // leave cards alone.
    for (int attempt = 0; attempt < 4 && options->target_triangles < work.triangles;
         attempt++) {
        ok = reduce(&work, &reduction, work.triangles, out, error);
        if (!ok || !limited || *error <= options->max_error) break;
        prom_mesh_finish(out);
        *out = (prom_mesh){0};
        ok = false;
        reduction.max_error /= 3;
        reduction.keep_cards = true;
    }
    prom_work_finish(&work);
    if (!ok) *error = 0;
    return ok;
}

static uint32_t triangles_of(const prom_mesh *mesh)
{
    return mesh->index_count / 3;
}

// One candidate for the last level: near the target, and not fallen to pieces.
static bool candidate(prom_work *work, uint32_t target, bool sloppy, prom_mesh *out,
                      float *error)
{
    prom_reduce_options options = {.target = target, .max_error = INFINITY, .sloppy = sloppy};
    if (!reduce(work, &options, target + target / 2 + 1, out, error)) return false;
    if (triangles_of(out) >= target / 2) return true;
    prom_mesh_finish(out);
    *out = (prom_mesh){0};
    return false;
}

// The last, coarse level: vertex clustering or, where that comes nearer to the original with as
// few triangles, edge collapse.
static bool coarsest(prom_work *work, uint32_t target, prom_mesh *out, float *error)
{
    prom_mesh sloppy = {0};
    float sloppy_error;
    bool collapsed = candidate(work, target, false, out, error);
    bool clustered = candidate(work, target, true, &sloppy, &sloppy_error);
    if (clustered && (!collapsed || sloppy_error < *error)) {
        prom_mesh_finish(out);
        *out = sloppy;
        *error = sloppy_error;
        return true;
    }
    prom_mesh_finish(&sloppy);
    return collapsed;
}

uint32_t prom_simplify_levels(const prom_mesh *mesh, bool lock_border, uint32_t min_triangles,
                              uint32_t max_levels, prom_mesh *levels, float *errors)
{
    if (!max_levels || !mesh->index_count) return 0;
    memset(levels, 0, max_levels * sizeof *levels);
    prom_work work;
    prom_work_init(&work, mesh);
    if (work.triangles)
        prom_work_emit(&work, &work.indices, &levels[0]);
    else
        prom_mesh_copy(&levels[0], mesh); // nothing but degenerate triangles: leave it alone
    errors[0] = 0;
    uint32_t count = 1, target = work.triangles / 2;
    uint32_t regular = lock_border || max_levels == 1 ? max_levels : max_levels - 1;
    if (min_triangles < 1) min_triangles = 1;
    for (; count < regular && target >= min_triangles; target /= 2) {
        prom_reduce_options options = {target, INFINITY, .lock_border = lock_border};
        uint32_t last = triangles_of(&levels[count - 1]);
        uint32_t below = (uint32_t)ceilf(WORTH * (float)last);
        if (!reduce(&work, &options, below, &levels[count], &errors[count])) break;
        errors[count] = fmaxf(errors[count], errors[count - 1]);
        count++;
    }
    uint32_t last = triangles_of(&levels[count - 1]);
    if (!lock_border && count < max_levels && work.triangles && last >= MIN_SLOPPY_FROM) {
        target = last / 4 > MIN_SLOPPY ? last / 4 : MIN_SLOPPY;
        if (coarsest(&work, target, &levels[count], &errors[count])) {
            errors[count] = fmaxf(errors[count], errors[count - 1]);
            count++;
        }
    }
    prom_work_finish(&work);
    return count;
}

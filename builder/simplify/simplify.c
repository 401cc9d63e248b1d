#include "builder/simplify/simplify.h"

#include "builder/simplify/distance.h"
#include "builder/simplify/reduce.h"

#include <math.h>

// A level must have at most this share of the triangles of the one before to be worth its
// bytes.
#define WORTH 0.7f
// By taste: the least and greatest error of a level, as parts of the mesh's diagonal, and from
// one to the next.
#define FIRST_ERROR (1.0f / 4096)
#define LAST_ERROR (1.0f / 6)
#define ERROR_STEP 2.25f
#define FINE_STEP 1.5f // at which it is seen whether a level is worth it
// Where much falls away within one step of the error, a level keeps this share of the one
// before; the first takes whatever costs next to nothing.
#define LEAST_SHARE 0.4f

static uint32_t triangles_of(const prom_mesh *mesh)
{
    return mesh->index_count / 3;
}

// The next levels after the first; returns the count with it.
static uint32_t add_levels(prom_work *work, bool lock_border, uint32_t min_triangles,
                           uint32_t max_levels, prom_mesh *levels, float *errors)
{
    const prom_reduce_options options = {.lock_border = lock_border, .loose = !lock_border};
    prom_reduction *reduction = prom_reduction_create(work, &options);
    prom_index_array faces = {0};
    uint32_t count = 1;
    float e = FIRST_ERROR, least = FIRST_ERROR; // for the next level
    while (e <= LAST_ERROR && count < max_levels) {
        const uint32_t last = triangles_of(&levels[count - 1]);
        if (last <= min_triangles) break;
        const uint32_t target = count > 1 ? (uint32_t)(LEAST_SHARE * (float)last) : 0;
        prom_reduction_run(reduction, target, e * work->diagonal, &faces);
        const uint32_t triangles = prom_work_count(work, &faces);
        const bool enough = triangles <= target;
        if (triangles && (float)triangles <= WORTH * (float)last && (e >= least || enough)) {
            errors[count] = fmaxf(prom_work_deviation(work, &faces), errors[count - 1]);
            prom_work_emit(work, &faces, &levels[count++]);
            least = e * ERROR_STEP;
        }
        prom_work_reset(work);
        if (!enough) e *= FINE_STEP;
    }
    prom_array_finish(&faces);
    prom_reduction_destroy(reduction);
    return count;
}

uint32_t prom_simplify_levels(const prom_mesh *mesh, bool lock_border, uint32_t min_triangles,
                              uint32_t max_levels, prom_mesh *levels, float *errors)
{
    if (!max_levels || !mesh->index_count) return 0;
    memset(levels, 0, max_levels * sizeof *levels);
    uint32_t count = 1;
    prom_work work;
    prom_work_init(&work, mesh);
    errors[0] = 0;
    if (work.triangles) {
        prom_work_emit(&work, &work.indices, &levels[0]);
        count = add_levels(&work, lock_border, min_triangles, max_levels, levels, errors);
    } else {
        prom_mesh_copy(&levels[0], mesh); // nothing but degenerate triangles: leave it alone
    }
    prom_work_finish(&work);
    return count;
}

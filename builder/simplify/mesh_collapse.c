#include "builder/simplify/mesh_collapse.h"

#include <assert.h>

void prom_collapse_mesh_faces(const prom_collapse_mesh *mesh, prom_work *work,
                              prom_index_array *out)
{
    const size_t made = mesh->vertices.count - mesh->base_vertices;
    uint32_t *ids = prom_alloc(made, sizeof *ids);
    memset(ids, 0xff, made * sizeof *ids);
    for (size_t c = 0; c < 3 * (size_t)mesh->triangle_slots; c++) {
        uint32_t v = mesh->corners[c];
        if (v == PROM_NONE) continue;
        if (v >= mesh->base_vertices) {
            uint32_t *id = &ids[v - mesh->base_vertices];
            if (*id == PROM_NONE)
                *id = prom_work_append(work, &mesh->vertices.data[v], mesh->group.data[v]);
            v = *id;
        }
        prom_array_push(out, v);
    }
    prom_free(ids);
}

void prom_mesh_collapse_init(prom_mesh_collapse *collapse, const prom_mesh *mesh,
                             const prom_collapse_options *options)
{
    assert(!options->locked && !options->records);
    prom_work *work = &collapse->work;
    prom_work_init(work, mesh);
    prom_collapse_mesh_init(&collapse->mesh, work->vertices.data, work->base_count,
                            work->owners.data, work->indices.data, work->indices.count);
    collapse->collapser = prom_collapser_create(&collapse->mesh, options);
}

void prom_mesh_collapse_finish(prom_mesh_collapse *collapse)
{
    prom_collapser_destroy(collapse->collapser);
    prom_collapse_mesh_finish(&collapse->mesh);
    prom_work_finish(&collapse->work);
    *collapse = (prom_mesh_collapse){0};
}

uint32_t prom_mesh_collapse_triangles(const prom_mesh_collapse *collapse)
{
    const prom_collapse_mesh *mesh = &collapse->mesh;
    const prom_work *work = &collapse->work;
    if (work->triangles == work->indices.count / 3) return mesh->triangles; // no back sides
    uint32_t count = mesh->triangles;
    for (uint32_t t = 0; t < mesh->triangle_slots; t++) {
        const uint32_t v = mesh->corners[3 * t];
        count += v != PROM_NONE && mesh->group.data[v] & PROM_OWNER_BACK;
    }
    return count;
}

float prom_mesh_collapse_run(prom_mesh_collapse *collapse, uint32_t target_triangles,
                             float max_error)
{
    float error = 0;
    for (;;) {
        const uint32_t left = prom_mesh_collapse_triangles(collapse);
        if (left <= target_triangles) return error;
        const uint32_t fronts = collapse->mesh.triangles;
        // Each of these takes a back side along, or does not: half of what is too much at a
        // time does not go too far.
        const uint32_t away =
            left == fronts ? left - target_triangles : (left - target_triangles + 1) / 2;
        const float most = prom_collapser_run(collapse->collapser,
                                              fronts > away ? fronts - away : 0, max_error);
        error = most > error ? most : error;
        if (collapse->mesh.triangles == fronts) return error;
    }
}

void prom_mesh_collapse_emit(prom_mesh_collapse *collapse, prom_mesh *out)
{
    prom_index_array faces = {0};
    prom_collapse_mesh_faces(&collapse->mesh, &collapse->work, &faces);
    prom_work_emit(&collapse->work, &faces, out);
    prom_array_finish(&faces);
}

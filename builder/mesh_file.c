#include "builder/mesh_file.h"

#include <stdlib.h>

// What indices of triangles over vertices can number.
#define MOST_CORNERS (UINT32_MAX / 2)

// A mesh where a node shows it.
typedef struct placed {
    uint32_t material, order;
    const prom_mesh *mesh;
    const double *world;
} placed;

typedef PROM_ARRAY(placed) placed_array;

static int by_material(const void *pa, const void *pb)
{
    const placed *a = pa, *b = pb;
    if (a->material != b->material) return a->material < b->material ? -1 : 1;
    return a->order < b->order ? -1 : a->order > b->order;
}

static void collect(const prom_source *source, placed_array *all)
{
    for (size_t n = 0; n < source->nodes.count; n++) {
        const prom_source_node *node = &source->nodes.data[n];
        for (uint32_t i = 0; i < node->mesh_count; i++) {
            const prom_mesh *mesh =
                &source->meshes.data[source->mesh_refs.data[node->first_mesh + i]];
            prom_array_push(all, (placed){mesh->submeshes[0].material, (uint32_t)all->count,
                                          mesh, node->world});
        }
    }
    if (all->count) qsort(all->data, all->count, sizeof *all->data, by_material);
}

static void position(const double w[16], const float p[3], double out[3])
{
    for (int r = 0; r < 3; r++)
        out[r] = w[r] * p[0] + w[4 + r] * p[1] + w[8 + r] * p[2] + w[12 + r];
}

// The origin where the mesh is near it, else a multiple of its size, of a power of two: a
// difference to that has no more digits than the float had.
static void make_round(double center[3], double size)
{
    const double step = size > 0 ? exp2(ceil(log2(size))) : 1;
    for (int k = 0; k < 3; k++)
        center[k] = fabs(center[k]) < 4 * step ? 0 : step * round(center[k] / step);
}

static void choose_origin(const placed_array *all, double center[3])
{
    double min[3] = {INFINITY, INFINITY, INFINITY}, max[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < all->count; i++)
        for (uint32_t v = 0; v < all->data[i].mesh->vertex_count; v++) {
            double p[3];
            position(all->data[i].world, all->data[i].mesh->vertices[v].position, p);
            for (int k = 0; k < 3; k++) {
                min[k] = fmin(min[k], p[k]);
                max[k] = fmax(max[k], p[k]);
            }
        }
    double size = 0;
    for (int k = 0; k < 3; k++) {
        center[k] = (min[k] + max[k]) / 2;
        size = fmax(size, max[k] - min[k]);
    }
    make_round(center, size);
}

// Behind the first `vertices` and `indices` of out.
static void append(const placed *from, const double origin[3], uint32_t vertices,
                   uint32_t indices, prom_mesh *out)
{
    float normal[9];
    bool mirrored = prom_normal_matrix(from->world, normal);
    for (uint32_t v = 0; v < from->mesh->vertex_count; v++) {
        const prom_vertex *in = &from->mesh->vertices[v];
        prom_vertex *to = &out->vertices[vertices + v];
        double p[3];
        *to = *in;
        position(from->world, in->position, p);
        for (int k = 0; k < 3; k++) to->position[k] = (float)(p[k] - origin[k]);
        prom_turn_normal(normal, in->normal, to->normal);
    }
    for (uint32_t i = 0; i < from->mesh->index_count; i++) {
        uint32_t k = i % 3, corner = mirrored && k ? i - k + 3 - k : i;
        out->indices[indices + i] = vertices + from->mesh->indices[corner];
    }
}

static void join(const placed_array *all, const double origin[3], uint32_t vertex_count,
                 uint32_t index_count, prom_mesh *out)
{
    uint32_t vertices = 0, indices = 0, submeshes = 0;
    for (size_t i = 0; i < all->count; i++)
        submeshes += !i || all->data[i].material != all->data[i - 1].material;
    prom_mesh_init(out, vertex_count, index_count, submeshes);
    prom_submesh *sub = out->submeshes;
    for (size_t i = 0; i < all->count; i++) {
        const placed *from = &all->data[i];
        if (i && from->material != all->data[i - 1].material) sub++;
        if (!sub->index_count) *sub = (prom_submesh){indices, 0, from->material};
        append(from, origin, vertices, indices, out);
        vertices += from->mesh->vertex_count;
        indices += from->mesh->index_count;
        sub->index_count += from->mesh->index_count;
    }
}

static prom_status make(const char *path, const placed_array *all, const double origin[3],
                        prom_mesh_file *file, prom_error *error)
{
    uint64_t vertices = 0, indices = 0;
    for (size_t i = 0; i < all->count; i++) {
        vertices += all->data[i].mesh->vertex_count;
        indices += all->data[i].mesh->index_count;
    }
    if (vertices > MOST_CORNERS || indices > MOST_CORNERS)
        return prom_fail(error, PROM_ERR_UNSUPPORTED,
                         "%s: has %.3g million triangles with all instances, too many for one "
                         "mesh",
                         path, (double)indices / 3e6);
    if (origin)
        memcpy(file->origin, origin, sizeof file->origin);
    else
        choose_origin(all, file->origin);
    join(all, file->origin, (uint32_t)vertices, (uint32_t)indices, &file->mesh);
    if (prom_mesh_check(&file->mesh, (uint32_t)file->source.materials.count))
        return prom_fail(error, PROM_ERR_INPUT, "%s: has positions that no float can hold",
                         path);
    return PROM_OK;
}

prom_status prom_mesh_file_read(const char *path, const prom_import_options *options,
                                const double origin[3], prom_mesh_file *file, prom_error *error)
{
    *file = (prom_mesh_file){0};
    prom_status status = prom_source_import(path, options, &file->source, error);
    if (status) return status;
    placed_array all = {0};
    collect(&file->source, &all);
    status = make(path, &all, origin, file, error);
    prom_array_finish(&all);
    if (status) prom_mesh_file_finish(file);
    return status;
}

void prom_mesh_file_finish(prom_mesh_file *file)
{
    prom_mesh_finish(&file->mesh);
    prom_source_finish(&file->source);
    *file = (prom_mesh_file){0};
}

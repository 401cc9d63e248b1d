// LINK: prom_builder prom_simplify prom_metaobj meshoptimizer::meshoptimizer
// A model simplified by our metrics and by meshoptimizer, for tests/bench/simplify.sh: all from
// one mesh that was mended first, each timed without reading and writing (the least of up to
// three runs in two seconds).
//
// Usage: bench_simplify MODEL FOLDER PERCENT...
// Writes FOLDER/base.obj (the mended mesh) and FOLDER/METHOD-PERCENT.obj; prints lines of
// METHOD,PERCENT,TARGET,TRIANGLES,MS.
#include "builder/mesh_write.h"
#include "builder/simplify/mesh_collapse.h"
#include "builder/simplify/repair.h"
#include "metaobj/base/clock.h"

#include <math.h>
#include <meshoptimizer.h>
#include <stdio.h>
#include <stdlib.h>

#define RUNS 3
#define ENOUGH_MS 2000

static const struct {
    const char *name, *metric; // no metric: meshoptimizer
    bool half_edge;
} methods[] = {
    {"qem", "qem", false},
    {"qem-half", "qem", true},
    {"qem-attributes", "qem-attributes", false},
    {"qem-attributes-half", "qem-attributes", true},
    {"meshoptimizer", NULL, false},
};

enum { METHODS = sizeof methods / sizeof *methods };

static void fail(const prom_error *error)
{
    fprintf(stderr, "bench_simplify: %s\n", error->text);
    exit(error->status);
}

static double ours(const prom_mesh *mesh, int method, uint32_t target, prom_mesh *out)
{
    const prom_collapse_options options = {
        .metric = prom_collapse_metric_find(methods[method].metric),
        .half_edge = methods[method].half_edge};
    prom_mesh_collapse c = {0};
    prom_work_init(&c.work, mesh);
    const double start = prom_clock_ms();
    prom_collapse_mesh_init(&c.mesh, c.work.vertices.data, c.work.base_count,
                            c.work.owners.data, c.work.indices.data, c.work.indices.count);
    c.collapser = prom_collapser_create(&c.mesh, &options);
    prom_mesh_collapse_run(&c, target, INFINITY);
    const double ms = prom_clock_ms() - start;
    prom_mesh_collapse_emit(&c, out);
    prom_mesh_collapse_finish(&c);
    return ms;
}

// Sorts triangles, whose order is lost, by the submesh that their vertices are of.
static void assemble(const prom_mesh *mesh, const uint32_t *indices, size_t count,
                     prom_mesh *out)
{
    uint32_t *submesh = prom_alloc(mesh->vertex_count, sizeof *submesh), next = 0;
    for (uint32_t s = 0; s < mesh->submesh_count; s++)
        for (uint32_t i = 0; i < mesh->submeshes[s].index_count; i++)
            submesh[mesh->indices[mesh->submeshes[s].first_index + i]] = s;
    prom_mesh_init(out, mesh->vertex_count, (uint32_t)count, mesh->submesh_count);
    memcpy(out->vertices, mesh->vertices, mesh->vertex_count * sizeof *out->vertices);
    out->submesh_count = 0;
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const uint32_t first = next;
        for (size_t i = 0; i < count; i += 3)
            if (submesh[indices[i]] == s)
                for (size_t k = 0; k < 3; k++) out->indices[next++] = indices[i + k];
        if (next > first)
            out->submeshes[out->submesh_count++] =
                (prom_submesh){first, next - first, mesh->submeshes[s].material};
    }
    prom_free(submesh);
}

static double theirs(const prom_mesh *mesh, uint32_t target, prom_mesh *out)
{
    uint32_t *indices = prom_alloc(mesh->index_count, sizeof *indices);
    const double start = prom_clock_ms();
    const size_t count = meshopt_simplify(
        indices, mesh->indices, mesh->index_count, mesh->vertices[0].position,
        mesh->vertex_count, sizeof *mesh->vertices, 3 * (size_t)target, 1e9f, 0, NULL);
    const double ms = prom_clock_ms() - start;
    assemble(mesh, indices, count, out);
    prom_free(indices);
    return ms;
}

static double simplify(const prom_mesh *mesh, int method, uint32_t target, prom_mesh *out)
{
    double least = INFINITY, all = 0;
    for (int run = 0; run < RUNS && all < ENOUGH_MS; run++) {
        if (run) prom_mesh_finish(out);
        const double ms = methods[method].metric ? ours(mesh, method, target, out)
                                                 : theirs(mesh, target, out);
        least = fmin(least, ms);
        all += ms;
    }
    return least;
}

static void write_mesh(const prom_mesh_file *file, const char *model, const char *folder,
                       const char *name)
{
    prom_error error;
    char *path = prom_format("%s/%s.obj", folder, name);
    if (prom_mesh_write(path, file, model, &error)) fail(&error);
    prom_free(path);
}

static bool is_plain(const prom_mesh_file *file)
{
    for (size_t i = 0; i < file->source.materials.count; i++)
        if (file->source.materials.data[i].texture != PROM_NONE) return false;
    return true;
}

static void make_plain(prom_mesh *mesh)
{
    const uint32_t count = mesh->vertex_count;
    float(*positions)[3] = prom_alloc(count, sizeof *positions);
    float(*normals)[3] = prom_calloc(count, sizeof *normals);
    uint32_t *first = prom_alloc(count, sizeof *first);
    for (uint32_t i = 0; i < count; i++)
        memcpy(positions[i], mesh->vertices[i].position, sizeof *positions);
    prom_first_equal(positions, count, sizeof *positions, first);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) normals[first[i]][k] += mesh->vertices[i].normal[k];
    for (uint32_t i = 0; i < count; i++)
        prom_pack_normal(normals[first[i]], mesh->vertices[i].normal);
    for (uint32_t i = 0; i < mesh->index_count; i++) mesh->indices[i] = first[mesh->indices[i]];
    prom_free(first);
    prom_free(normals);
    prom_free(positions);
}

static void read_mesh(const char *model, prom_mesh_file *file)
{
    prom_error error;
    if (prom_mesh_file_read(model, NULL, NULL, file, &error)) fail(&error);
    prom_mesh_repair(&file->mesh, NULL, &(prom_repair_report){0});
    if (is_plain(file)) make_plain(&file->mesh);
    prom_mesh_collapse collapse;
    prom_mesh_collapse_init(&collapse, &file->mesh, &(prom_collapse_options){0});
    prom_mesh_finish(&file->mesh);
    prom_mesh_collapse_emit(&collapse, &file->mesh); // what all get
    prom_mesh_collapse_finish(&collapse);
}

static void measure(prom_mesh_file *file, const char *model, const char *folder,
                    const char *percent)
{
    prom_mesh base = file->mesh;
    const uint32_t triangles = base.index_count / 3;
    const uint32_t target = (uint32_t)fmax(1, round(atof(percent) / 100 * triangles));
    for (int m = 0; m < METHODS; m++) {
        const double ms = simplify(&base, m, target, &file->mesh);
        char *name = prom_format("%s-%s", methods[m].name, percent);
        if (file->mesh.index_count) write_mesh(file, model, folder, name);
        printf("%s,%s,%u,%u,%.3f\n", methods[m].name, percent, target,
               file->mesh.index_count / 3, ms);
        fflush(stdout);
        prom_free(name);
        prom_mesh_finish(&file->mesh);
    }
    file->mesh = base;
}

int main(int argc, char **argv)
{
    if (argc < 4) {
        fputs("Usage: bench_simplify MODEL FOLDER PERCENT...\n", stderr);
        return 1;
    }
    prom_mesh_file file;
    read_mesh(argv[1], &file);
    write_mesh(&file, argv[1], argv[2], "base");
    for (int i = 3; i < argc; i++) measure(&file, argv[1], argv[2], argv[i]);
    prom_mesh_file_finish(&file);
    return 0;
}

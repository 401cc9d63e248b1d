// LINK: prom_simplify meshoptimizer::meshoptimizer
// Time of the engine against meshoptimizer's on the same mesh: a bumpy torus of any size, with
// texture, normals and colours or plain. Prints milliseconds of initialisation and collapsing,
// with and without records, and the peak in bytes per vertex.
//
// Usage: bench_collapse [TRIANGLES... (1e4 1e5)]
#include "builder/simplify/engine.h"

#include "metaobj/base/clock.h"

#include <math.h>
#include <meshoptimizer.h>
#include <stdio.h>
#include <stdlib.h>

// Larger ones are brought to a tenth only.
#define LARGE 3e5

typedef struct torus {
    prom_vertex *vertices;
    uint32_t *indices;
    uint32_t vertex_count;
    size_t index_count;
} torus;

static void set_vertex(prom_vertex *v, double s, double t)
{
    const double tau = 6.283185307179586, a = tau * s, b = tau * t;
    const double tube = 0.4 + 0.03 * sin(9 * a) * cos(7 * b) + 0.003 * sin(61 * a + 47 * b);
    v->position[0] = (float)((1 + tube * cos(b)) * cos(a));
    v->position[1] = (float)(tube * sin(b));
    v->position[2] = (float)((1 + tube * cos(b)) * sin(a));
    const float normal[3] = {(float)(cos(b) * cos(a)), (float)sin(b), (float)(cos(b) * sin(a))};
    prom_pack_normal(normal, v->normal);
    for (int k = 0; k < 4; k++) v->color[k] = 255;
    v->uv[0] = (float)(8 * s);
    v->uv[1] = (float)(4 * t);
}

// n x n quads. Textured ones are cut open along two circles in the vertices alone.
static void init_torus(torus *mesh, uint32_t n, bool textured)
{
    const uint32_t row = textured ? n + 1 : n;
    mesh->vertex_count = row * row;
    mesh->index_count = 6 * (size_t)n * n;
    mesh->vertices = prom_calloc(mesh->vertex_count, sizeof *mesh->vertices);
    mesh->indices = prom_alloc(mesh->index_count, sizeof *mesh->indices);
    for (uint32_t i = 0; i < row; i++)
        for (uint32_t j = 0; j < row; j++) {
            prom_vertex *v = &mesh->vertices[i * row + j];
            set_vertex(v, (double)(i % n) / n, (double)(j % n) / n);
            if (textured)
                v->uv[0] = 8 * (float)i / (float)n, v->uv[1] = 4 * (float)j / (float)n;
            else
                memset(v->normal, 0, sizeof v->normal), v->uv[0] = v->uv[1] = 0;
        }
    uint32_t *index = mesh->indices;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) {
            const uint32_t a = i * row + j, b = i * row + (j + 1) % row;
            const uint32_t c = (i + 1) % row * row + j, d = (i + 1) % row * row + (j + 1) % row;
            const uint32_t quad[6] = {a, b, c, c, b, d};
            memcpy(index, quad, sizeof quad);
            index += 6;
        }
}

static double borrowed(const torus *mesh, size_t triangles, size_t *left)
{
    uint32_t *out = prom_alloc(mesh->index_count, sizeof *out);
    const double start = prom_clock_ms();
    *left = meshopt_simplify(out, mesh->indices, mesh->index_count, mesh->vertices[0].position,
                             mesh->vertex_count, sizeof *mesh->vertices, 3 * triangles, 1e9f, 0,
                             NULL) /
            3;
    const double ms = prom_clock_ms() - start;
    prom_free(out);
    return ms;
}

static void own(const torus *mesh, uint32_t triangles, const char *metric, bool half_edge,
                bool recorded, double theirs)
{
    prom_collapse_mesh work;
    const double start = prom_clock_ms();
    prom_collapse_mesh_init(&work, mesh->vertices, mesh->vertex_count, NULL, mesh->indices,
                            mesh->index_count);
    const double built = prom_clock_ms() - start;
    prom_records records;
    prom_records_init(&records, work.triangle_slots);
    const prom_collapse_options options = {.metric = prom_collapse_metric_find(metric),
                                           .half_edge = half_edge,
                                           .records = recorded ? &records : NULL};
    prom_collapser *collapser = prom_collapser_create(&work, &options);
    const float error = prom_collapser_run(collapser, triangles, INFINITY);
    const double all = prom_clock_ms() - start;
    prom_collapse_stats s;
    prom_collapser_stats(collapser, &s);
    printf("| %-14s | %-4s | %-7s | %8u | %7.0f | %7.0f | %7.0f | %5.1f | %4.0f | %.2e |\n",
           metric, half_edge ? "half" : "full", recorded ? "records" : "", s.triangles, built,
           s.init_ms, s.run_ms, all / theirs, (double)s.peak_bytes / mesh->vertex_count,
           (double)error);
    prom_collapser_destroy(collapser);
    prom_records_finish(&records);
    prom_collapse_mesh_finish(&work);
}

static void measure(double wanted, bool textured)
{
    static const double ratios[] = {0.5, 0.1, 0.02};
    torus mesh;
    init_torus(&mesh, (uint32_t)sqrt(wanted / 2), textured);
    for (size_t i = 0; i < sizeof ratios / sizeof *ratios; i++) {
        if (wanted > LARGE && ratios[i] != 0.1) continue;
        const uint32_t target = (uint32_t)(ratios[i] * (double)mesh.index_count / 3);
        size_t left;
        const double theirs = borrowed(&mesh, target, &left);
        printf("%s, %zu triangles to %u; meshoptimizer: %zu in %.0f ms\n",
               textured ? "textured" : "plain", mesh.index_count / 3, target, left, theirs);
        own(&mesh, target, "qem", true, false, theirs);
        own(&mesh, target, "qem", false, false, theirs);
        own(&mesh, target, "qem-attributes", false, false, theirs);
        own(&mesh, target, "qem-attributes", false, true, theirs);
    }
    prom_free(mesh.vertices);
    prom_free(mesh.indices);
}

int main(int argc, char **argv)
{
    static const double usual[] = {1e4, 1e5};
    puts("| metric | edge | | triangles | mesh ms | init ms | run ms | x meshoptimizer |"
         " bytes/vertex | error |");
    for (int i = 0; i < (argc > 1 ? argc - 1 : 2); i++)
        for (int textured = 0; textured < 2; textured++)
            measure(argc > 1 ? atof(argv[i + 1]) : usual[i], textured);
    return 0;
}

// LINK: prom_builder prom_render prom_traverse prom_benefit prom_metaobj
// What measuring accuracies takes, and what it saves to compare pictures in some directions
// only.
// Usage: bench_measure spheres COUNT FILE.glb   writes that many different bumpy spheres of
//                                               5,000 triangles
//        bench_measure build SCENE MODEL [METRIC]  builds a model
//        bench_measure grids SCENE MODEL [METRIC]  builds it, then again with pictures
//                                               compared in all directions, and tells how far
//                                               the tables differ
#include "benefit/accuracy.h"
#include "builder/pipeline.h"
#include "metaobj/base/clock.h"
#include "metaobj/container.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

// ---- spheres

#define RINGS 50
#define COLUMNS 51 // 2 * COLUMNS * (RINGS - 1) triangles
#define VERTICES (COLUMNS * (RINGS - 1) + 2)
#define TRIANGLES (2 * COLUMNS * (RINGS - 1))

static void make_sphere(uint32_t number, float (*positions)[3])
{
    const float bumps = 2.0f + (float)(number % 7),
                depth = 0.04f + 0.02f * (float)(number % 11);
    const float twist = 0.37f * (float)number;
    for (uint32_t v = 0; v < VERTICES; v++) {
        uint32_t ring = v == 0 ? 0 : v == VERTICES - 1 ? RINGS : 1 + (v - 1) / COLUMNS;
        float theta = 3.14159265f * (float)ring / RINGS;
        float phi = 6.2831853f * (float)((v + COLUMNS - 1) % COLUMNS) / COLUMNS;
        float r = 1.0f + depth * (sinf(bumps * phi + twist) * sinf(3.0f * theta + twist) +
                                  0.4f * sinf(11.0f * phi) * sinf(9.0f * theta + twist));
        positions[v][0] = r * sinf(theta) * cosf(phi);
        positions[v][1] = r * cosf(theta);
        positions[v][2] = r * sinf(theta) * sinf(phi);
    }
}

static void make_triangles(uint32_t (*corners)[3])
{
    uint32_t n = 0;
    for (uint32_t ring = 0; ring < RINGS; ring++)
        for (uint32_t c = 0; c < COLUMNS; c++) {
            uint32_t next = (c + 1) % COLUMNS, below = 1 + ring * COLUMNS;
            uint32_t a = ring ? below - COLUMNS + c : 0, b = ring ? below - COLUMNS + next : 0;
            uint32_t d = ring + 1 < RINGS ? below + c : VERTICES - 1;
            uint32_t e = ring + 1 < RINGS ? below + next : VERTICES - 1;
            if (ring) memcpy(corners[n++], (uint32_t[]){a, b, e}, 12);
            if (ring + 1 < RINGS) memcpy(corners[n++], (uint32_t[]){a, e, d}, 12);
        }
}

// The glTF of spheres whose vertices stand one after the other behind the common triangles.
static void write_json(FILE *f, uint32_t count, const float (*boxes)[2][3])
{
    const uint32_t indices = TRIANGLES * 12, vertices = VERTICES * 12;
    fprintf(f,
            "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"buffers\":[{\"byteLength\":%llu}],",
            (unsigned long long)indices + (unsigned long long)count * vertices);
    fprintf(f, "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%u}", indices);
    for (uint32_t i = 0; i < count; i++)
        fprintf(f, ",{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%u}",
                indices + i * vertices, vertices);
    fprintf(f,
            "],\"accessors\":[{\"bufferView\":0,\"componentType\":5125,\"count\":%u,"
            "\"type\":\"SCALAR\"}",
            TRIANGLES * 3);
    for (uint32_t i = 0; i < count; i++) {
        const float *low = boxes[i][0], *high = boxes[i][1];
        fprintf(f,
                ",{\"bufferView\":%u,\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\","
                "\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]}",
                i + 1, VERTICES, (double)low[0], (double)low[1], (double)low[2],
                (double)high[0], (double)high[1], (double)high[2]);
    }
    fprintf(f, "],\"materials\":[");
    for (uint32_t i = 0; i < 8; i++)
        fprintf(f,
                "%s{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%g,%g,%g,1],"
                "\"metallicFactor\":0}}",
                i ? "," : "", i & 1 ? 0.8 : 0.3, i & 2 ? 0.8 : 0.3, i & 4 ? 0.8 : 0.3);
    fprintf(f, "],\"meshes\":[");
    for (uint32_t i = 0; i < count; i++)
        fprintf(f,
                "%s{\"primitives\":[{\"attributes\":{\"POSITION\":%u},\"indices\":0,"
                "\"material\":%u}]}",
                i ? "," : "", i + 1, i % 8);
    fprintf(f, "],\"nodes\":[");
    for (uint32_t i = 0; i < count; i++)
        fprintf(f, "%s{\"name\":\"sphere_%u\",\"mesh\":%u,\"translation\":[%u,0,%u]}",
                i ? "," : "", i, i, i % 32 * 4, i / 32 * 4);
    fprintf(f, "],\"scenes\":[{\"nodes\":[");
    for (uint32_t i = 0; i < count; i++) fprintf(f, "%s%u", i ? "," : "", i);
    fprintf(f, "]}]}");
}

static void find_box(const float (*positions)[3], float box[2][3])
{
    for (int a = 0; a < 3; a++) {
        box[0][a] = INFINITY;
        box[1][a] = -INFINITY;
        for (uint32_t v = 0; v < VERTICES; v++) {
            box[0][a] = fminf(box[0][a], positions[v][a]);
            box[1][a] = fmaxf(box[1][a], positions[v][a]);
        }
    }
}

static void write_spheres(uint32_t count, const char *path)
{
    static uint32_t corners[TRIANGLES][3];
    float(*positions)[VERTICES][3] = prom_alloc(count, sizeof *positions);
    float(*boxes)[2][3] = prom_alloc(count, sizeof *boxes);
    make_triangles(corners);
    for (uint32_t i = 0; i < count; i++) {
        make_sphere(i, positions[i]);
        find_box((const float(*)[3])positions[i], boxes[i]);
    }
    char *json;
    size_t bytes;
    FILE *text = open_memstream(&json, &bytes);
    write_json(text, count, (const float(*)[2][3])boxes);
    while (ftell(text) % 4) fputc(' ', text);
    fclose(text);
    const size_t binary = sizeof corners + count * sizeof *positions;
    const uint32_t header[5] = {0x46546c67, 2, (uint32_t)(28 + bytes + binary), (uint32_t)bytes,
                                0x4e4f534a};
    const uint32_t chunk[2] = {(uint32_t)binary, 0x004e4942};
    FILE *f = fopen(path, "wb");
    if (!f) perror(path), exit(1);
    fwrite(header, 1, sizeof header, f);
    fwrite(json, 1, bytes, f);
    fwrite(chunk, 1, sizeof chunk, f);
    fwrite(corners, 1, sizeof corners, f);
    fwrite(positions, sizeof *positions, count, f);
    fclose(f);
    free(json);
    prom_free(positions);
    prom_free(boxes);
}

// ---- builds

static double cpu_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void print_stage(void *user, const char *name, uint64_t hash, double ms)
{
    (void)user, (void)hash;
    if (ms >= 100) printf("  %-10s %8.1f s\n", name, ms / 1000);
}

static void build(const char *scene, const char *path, const prom_build_options *options,
                  prom_model *model)
{
    prom_error error = {0};
    prom_build_report r;
    double start = prom_clock_ms(), cpu = cpu_s();
    if (prom_build(scene, path, options, &r, &error)) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    cpu = cpu_s() - cpu;
    printf("%s: %.1f s, %.1f s of processors; %u prototypes, %u representations, %.0f MiB\n",
           path, (prom_clock_ms() - start) / 1000, cpu, r.prototypes, r.representations,
           (double)r.peak_bytes / (1 << 20));
    if (r.views)
        printf("  compared in %llu of %llu directions, %.1f %%; accuracies %.2f MiB\n",
               (unsigned long long)r.views_compared, (unsigned long long)r.views,
               100.0 * (double)r.views_compared / (double)r.views,
               (double)r.representations * sizeof(prom_accuracy_row) / (1 << 20));
    prom_container *c = prom_container_open(path, &error);
    if (!c || prom_container_load_model(c, model, &error)) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    prom_container_stages(c, print_stage, NULL, &error);
    prom_container_close(c);
}

// ---- what is interpolated against what is compared

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void print_differences(const prom_model *all, const prom_model *some, uint32_t kind)
{
    PROM_ARRAY(float) differences = {0};
    double sum = 0, bias = 0;
    for (uint32_t r = 0; r < all->rep_count; r++)
        for (uint32_t d = PROM_DIRS_COARSE; d < PROM_DIRS && all->reps[r].kind == kind; d++)
            for (uint32_t s = 0; s < PROM_SIZES; s++) {
                float off = prom_accuracy_of_byte(some->accuracy[r].bins[d][s]) -
                            prom_accuracy_of_byte(all->accuracy[r].bins[d][s]);
                prom_array_push(&differences, fabsf(off));
                sum += (double)fabsf(off);
                bias += (double)off;
            }
    size_t n = differences.count;
    if (n) {
        qsort(differences.data, n, sizeof *differences.data, by_value);
        printf("  %-13s %8zu accuracies of fine directions: off by %.4f on average (bias "
               "%+.4f), p99 %.3f, p99.9 %.3f, most %.3f\n",
               prom_rep_kind_name(kind), n, sum / (double)n, bias / (double)n,
               (double)differences.data[n * 99 / 100], (double)differences.data[n * 999 / 1000],
               (double)differences.data[n - 1]);
    }
    prom_array_finish(&differences);
}

static void compare_grids(const char *scene, const char *path, prom_build_options *options)
{
    prom_model all = {0}, some = {0};
    options->keep_views = true;
    build(scene, path, options, &some);
    options->measure.everywhere = true;
    build(scene, path, options, &all);
    if (all.rep_count == some.rep_count)
        for (uint32_t kind = 0; kind < PROM_REP_KIND_COUNT; kind++)
            print_differences(&all, &some, kind);
    prom_model_finish(&all);
    prom_model_finish(&some);
}

int main(int argc, char **argv)
{
    prom_build_options options = {.objects = {.max_triangles = 8192}};
    if (argc == 5) options.measure.metric = argv[4];
    if (argc == 4 && !strcmp(argv[1], "spheres")) {
        write_spheres((uint32_t)atoi(argv[2]), argv[3]);
    } else if (argc >= 4 && !strcmp(argv[1], "build")) {
        prom_model model = {0};
        build(argv[2], argv[3], &options, &model);
        prom_model_finish(&model);
    } else if (argc >= 4 && !strcmp(argv[1], "grids")) {
        compare_grids(argv[2], argv[3], &options);
    } else {
        fprintf(stderr, "usage: bench_measure spheres COUNT FILE.glb | build SCENE MODEL "
                        "[METRIC] | grids SCENE MODEL [METRIC]\n");
        return 1;
    }
    return 0;
}

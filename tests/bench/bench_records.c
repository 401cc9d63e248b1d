// LINK: prom_builder prom_simplify prom_metaobj
// What records of collapses cost and what their graph is like. Each of qem and qem-attributes,
// by half and full edges, takes the scene's greatest mesh as far as it goes, with records and
// without in turn. Processor times, the least of all rounds. Usage: bench_records SCENE
// [ROUNDS]
#include "builder/simplify/engine.h"
#include "builder/source.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

// Processor time: all is done by one thread, and the machine may be shared.
static double now_ms(void)
{
    return (double)clock() * 1e3 / CLOCKS_PER_SEC;
}

static double least(double a, double b)
{
    return a < b ? a : b;
}

typedef struct timed_run {
    prom_collapse_mesh mesh;
    prom_records records;
    uint32_t *original;
    double ms;
} timed_run;

static void timed_run_init(timed_run *run, const prom_mesh *mesh, prom_collapse_options options,
                           bool recorded)
{
    const double start = now_ms();
    prom_collapse_mesh_init(&run->mesh, mesh->vertices, mesh->vertex_count, NULL, mesh->indices,
                            mesh->index_count);
    const double ready = now_ms();
    const size_t corners = 3 * (size_t)run->mesh.triangle_slots;
    run->original = prom_alloc(corners, sizeof *run->original);
    memcpy(run->original, run->mesh.corners, corners * sizeof *run->original);
    const double copied = now_ms();
    prom_records_init(&run->records, run->mesh.triangle_slots);
    options.records = recorded ? &run->records : NULL;
    prom_collapser *collapser = prom_collapser_create(&run->mesh, &options);
    prom_collapser_run(collapser, 0, INFINITY);
    prom_collapser_destroy(collapser);
    run->ms = now_ms() - copied + ready - start;
}

static void timed_run_finish(timed_run *run)
{
    prom_collapse_mesh_finish(&run->mesh);
    prom_records_finish(&run->records);
    prom_free(run->original);
}

// Records in the longest chain of which each rests on the one before.
static uint32_t longest_chain(const prom_records *records)
{
    const uint32_t count = (uint32_t)records->records.count;
    uint32_t *depth = prom_alloc(count, sizeof *depth), longest = 0;
    for (uint32_t i = 0; i < count; i++) {
        const prom_record_part part = prom_record_dependencies(records, i);
        depth[i] = 1;
        for (uint32_t k = part.first; k < part.end; k++) {
            const uint32_t below = depth[records->dependencies.data[k]];
            if (depth[i] <= below) depth[i] = below + 1;
        }
        if (longest < depth[i]) longest = depth[i];
    }
    prom_free(depth);
    return longest;
}

// Marks a record and all that it rests on; returns how many.
static uint32_t count_ancestors(const prom_records *records, uint32_t record, uint8_t *marked)
{
    uint32_t count = 0;
    memset(marked, 0, record);
    marked[record] = 1;
    for (uint32_t i = record + 1; i-- > 0;) {
        if (!marked[i]) continue;
        count++;
        const prom_record_part part = prom_record_dependencies(records, i);
        for (uint32_t k = part.first; k < part.end; k++)
            marked[records->dependencies.data[k]] = 1;
    }
    return count - 1;
}

// Over a thousand records, evenly picked among the first `end`.
static double mean_ancestors(const prom_records *records, uint32_t end)
{
    uint8_t *marked = prom_alloc(end, 1);
    const uint32_t step = end / 1000 + 1;
    double sum = 0.0, picked = 0.0;
    for (uint32_t i = 0; i < end; i += step, picked++)
        sum += count_ancestors(records, i, marked);
    prom_free(marked);
    return sum / picked;
}

static void print_graph(const timed_run *run)
{
    const prom_records *records = &run->records;
    const uint32_t count = (uint32_t)records->records.count;
    const double n = count;
    printf("  a record: %.2f changes in %.2f corners, %.2f triangles, %.2f dependencies\n",
           (double)records->changes.count / n, (double)records->corners.count / n,
           (double)records->removed.count / n, (double)records->dependencies.count / n);
    printf("  ancestors: %.1f in the mean, %.1f of the first half, %.1f of the first tenth; "
           "longest chain %u\n",
           mean_ancestors(records, count), mean_ancestors(records, count / 2 + 1),
           mean_ancestors(records, count / 10 + 1), longest_chain(records));
}

static void print_replay(const timed_run *run)
{
    prom_replay replay;
    const uint32_t count = (uint32_t)run->records.records.count;
    prom_replay_init(&replay, &run->records, run->original);
    const double start = now_ms();
    prom_replay_seek(&replay, count);
    const double applied = now_ms();
    prom_replay_seek(&replay, 0);
    const double undone = now_ms();
    printf("  replayed: %.1f million applied a second, %.1f million undone\n",
           count / (applied - start) / 1e3, count / (undone - applied) / 1e3);
    prom_replay_finish(&replay);
}

static void measure(const prom_mesh *mesh, const prom_collapse_options *options, int rounds)
{
    double plain_ms = INFINITY, recorded_ms = INFINITY;
    for (int round = 0; round < rounds; round++) {
        timed_run plain, recorded;
        timed_run_init(&plain, mesh, *options, false);
        timed_run_init(&recorded, mesh, *options, true);
        plain_ms = least(plain_ms, plain.ms);
        recorded_ms = least(recorded_ms, recorded.ms);
        if (round == rounds - 1 && recorded.records.records.count) {
            printf("%s, %s edges: %u triangles to %u by %zu collapses\n", options->metric->name,
                   options->half_edge ? "half" : "full", mesh->index_count / 3,
                   recorded.mesh.triangles, recorded.records.records.count);
            printf("  %.0f ms without records, %.0f ms with (%.2f times)\n", plain_ms,
                   recorded_ms, recorded_ms / plain_ms);
            printf("  %.0f bytes per vertex\n",
                   (double)prom_records_bytes(&recorded.records) / recorded.mesh.points);
            print_graph(&recorded);
            print_replay(&recorded);
        }
        timed_run_finish(&plain);
        timed_run_finish(&recorded);
    }
}

static const prom_mesh *greatest(const prom_source *source)
{
    const prom_mesh *best = source->meshes.data;
    for (size_t i = 1; i < source->meshes.count; i++)
        if (source->meshes.data[i].index_count > best->index_count)
            best = source->meshes.data + i;
    return best;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fprintf(stderr, "usage: %s SCENE [ROUNDS]\n", argv[0]);
        return 1;
    }
    prom_source source;
    prom_error error = {0};
    if (prom_source_import(argv[1], &(prom_import_options){0}, &source, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 2;
    }
    if (source.meshes.count)
        for (int way = 0; way < 4; way++)
            measure(greatest(&source),
                    &(prom_collapse_options){
                        .metric = prom_collapse_metric_find(way / 2 ? "qem-attributes" : "qem"),
                        .half_edge = way % 2},
                    argc > 2 ? atoi(argv[2]) : 3);
    prom_source_finish(&source);
    return 0;
}

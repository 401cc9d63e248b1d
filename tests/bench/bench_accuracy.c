// LINK: prom_benefit prom_metaobj
// Times the look-up of accuracies: nanoseconds for a place in the tables, and for an accuracy
// there, by range of sizes; the tables are larger than the caches, and views come in an order
// of their own. Usage: bench_accuracy [REPRESENTATIONS]
#include "../random_model.h"
#include "benefit/accuracy.h"
#include "metaobj/base/clock.h"

#include <stdio.h>
#include <stdlib.h>

enum { LOOKS = 1 << 16, REPS_PER_LOOK = 4, ROUNDS = 20 };

typedef struct look {
    float uv[2], size_px;
    uint32_t first_rep;
} look;

static void fill_looks(const prom_model *m, look *looks, float low_px, float high_px)
{
    uint64_t seed = 4;
    for (int i = 0; i < LOOKS; i++) {
        looks[i] = (look){
            .uv = {random_unit(&seed), random_unit(&seed)},
            .size_px = low_px * powf(high_px / low_px, random_unit(&seed)),
            .first_rep = random_below(&seed, m->rep_count - REPS_PER_LOOK + 1),
        };
    }
}

// Nanoseconds for a look: its place, and `reps` accuracies.
static double time_looks(const prom_model *m, const look *looks, uint32_t reps)
{
    double best = INFINITY;
    static volatile float sink;
    for (int round = 0; round < ROUNDS; round++) {
        float sum = 0.0f;
        double start = prom_clock_ms();
        for (int i = 0; i < LOOKS; i++) {
            prom_accuracy_place place;
            prom_accuracy_place_init(&place, looks[i].uv, looks[i].size_px);
            sum += place.t;
            for (uint32_t r = 0; r < reps; r++)
                sum += prom_accuracy(m, looks[i].first_rep + r, &place, 1.0f);
        }
        best = fmin(best, prom_clock_ms() - start);
        sink = sum;
    }
    (void)sink;
    return 1e6 * best / LOOKS;
}

int main(int argc, char **argv)
{
    long reps = argc > 1 ? strtol(argv[1], NULL, 10) : 20000;
    if (reps < REPS_PER_LOOK || reps > 10000000) {
        fprintf(stderr, "usage: bench_accuracy [REPRESENTATIONS 4..10000000]\n");
        return 1;
    }
    static const struct {
        const char *name;
        float low_px, high_px;
    } ranges[] = {
        {"small", 2, 8}, {"tables", 8, 128}, {"large", 128, 512}, {"near", 512, 4096}};
    prom_model m = {0};
    uint64_t seed = 1;
    m.reps = prom_alloc((size_t)reps, sizeof *m.reps);
    m.accuracy = prom_alloc((size_t)reps, sizeof *m.accuracy);
    m.meshes = prom_alloc((size_t)reps, sizeof *m.meshes);
    while (m.rep_count < (uint32_t)reps)
        random_add_rep(&m, &seed, PROM_REP_MESH, 1, 0.01f, 100, 0.9f);
    look *looks = prom_alloc(LOOKS, sizeof *looks);
    printf("tables of %.1f MiB; best of %d rounds\n",
           (double)(reps * (long)sizeof *m.accuracy) / (1 << 20), ROUNDS);
    printf("%-8s %10s %14s %12s\n", "sizes", "place ns", "accuracy ns", "both ns");
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        fill_looks(&m, looks, ranges[i].low_px, ranges[i].high_px);
        double place = time_looks(&m, looks, 0);
        double all = time_looks(&m, looks, REPS_PER_LOOK), both = time_looks(&m, looks, 1);
        printf("%-8s %10.1f %14.1f %12.1f\n", ranges[i].name, place,
               (all - place) / REPS_PER_LOOK, both);
    }
    prom_free(looks);
    prom_free(m.reps);
    prom_free(m.accuracy);
    prom_free(m.meshes);
    return 0;
}

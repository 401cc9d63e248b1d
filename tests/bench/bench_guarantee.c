// LINK: prom_traverse prom_benefit prom_metaobj
// The guarantee on simulated machines and scenes (tests/guarantee_simulation.h), many runs per
// case: share of missed frames with its interval, by quarter of the run; longest run of misses;
// runs whose misses cannot be explained by the accepted rate; use of the budget against the
// fixed frame's; misses after loads and turns (mean and worst of the runs). Nothing is timed.
// Usage: bench_guarantee [RUNS]
#include "../guarantee_simulation.h"

#include <stdio.h>

static const sim_case cases[] = {
    {.name = "quiet", .noise = 1.17},
    {.name = "noisy", .noise = 1.5},
    {.name = "1 in 10", .noise = 1.17, .miss_rate = 0.1},
    {.name = "1 in 1000", .noise = 1.17, .miss_rate = 0.001},
    {.name = "start 1.5", .noise = 1.17, .start = 1.5},
    {.name = "start 0.7", .noise = 1.17, .start = 0.7},
    {.name = "stalls", .noise = 1.17, .stall_ms = 4},
    {.name = "rare stalls", .noise = 1.17, .rare_stall_ms = 30},
    {.name = "wander 5 %", .noise = 1.17, .wander = 0.05},
    {.name = "wander 10 %", .noise = 1.17, .wander = 0.1},
    {.name = "gusts", .noise = 1.17, .gusts = 1.5},
    {.name = "hard gusts", .noise = 1.3, .gusts = 3},
    {.name = "drift", .noise = 1.17, .drift = 0.3},
    {.name = "terms", .noise = 1.17, .wrong_terms = 1.5},
    {.name = "load", .noise = 1.17, .load = 2},
    {.name = "loud load", .noise = 1.17, .load = 2, .load_noise = 1.5},
    {.name = "turns up", .noise = 1.17, .turn = 1.25},
    {.name = "turns down", .noise = 1.17, .turn = 0.8},
    {.name = "loud turns", .noise = 1.3, .turn = 1.25},
    {.name = "easy", .noise = 1.17, .easy = 0.3},
    {.name = "infeasible", .noise = 1.17, .hard = 1.2},
    {.name = "all at once",
     .noise = 1.17,
     .stall_ms = 4,
     .drift = 0.15,
     .wrong_terms = 1.5,
     .load = 1.6,
     .load_noise = 1.3,
     .turn = 1.25,
     .start = 1.3},
};

// Misses in the frames [0,first) and [first,first+SIM_WINDOW) after an event.
typedef struct window {
    double sum, count;
    int worst;
} window;

static void add_window(window *w, int misses)
{
    w->sum += misses, w->count++;
    if (misses > w->worst) w->worst = misses;
}

static void print_window(const window *w)
{
    if (w->count > 0)
        printf(" %5.2f/%-2d", w->sum / w->count, w->worst);
    else
        printf("     -   ");
}

static void show(const sim_case *c, int runs)
{
    static sim_run run;
    double misses = 0, contested = 0, quarters[4] = {0}, use = 0, fixed = sim_fixed_use(c);
    int longest[4] = {0}, beyond = 0;
    window after[3] = {0};
    double rate = c->miss_rate > 0 ? c->miss_rate : PROM_MISS_RATE;
    for (int r = 0; r < runs; r++) {
        sim_walk(c, (uint64_t)r * 1000003u + 1, &run);
        int m = sim_misses(&run, 0, SIM_FRAMES), n = sim_contested(&run, 0, SIM_FRAMES);
        double low, high;
        prom_miss_interval((uint32_t)m, (uint32_t)n, &low, &high);
        beyond += low > rate;
        misses += m, contested += n;
        for (int q = 0; q < 4; q++)
            quarters[q] += sim_misses(&run, q * SIM_FRAMES / 4, (q + 1) * SIM_FRAMES / 4);
        int l = sim_longest(&run);
        longest[l < 3 ? l : 3]++;
        use += sim_use(&run, 0, SIM_FRAMES);
        for (int i = 1; i < SIM_FRAMES; i++) {
            if (sim_loaded(c, i) && !sim_loaded(c, i - 1)) {
                add_window(&after[0], sim_misses(&run, i, i + 30));
                add_window(&after[1], sim_misses(&run, i + 30, i + 130));
            }
            if (sim_turning(c, i) && !sim_turning(c, i - 1))
                add_window(&after[2], sim_misses(&run, i, i + 100));
        }
    }
    double low, high;
    prom_miss_interval((uint32_t)misses, (uint32_t)contested, &low, &high);
    printf("%-12s %5.2f [%4.2f,%5.2f]", c->name, 100 * misses / contested, 100 * low,
           100 * high);
    for (int q = 0; q < 4; q++) printf(" %5.2f", 100 * quarters[q] / (runs * SIM_FRAMES / 4));
    printf(" %6.2f %6.2f %6.2f", 100.0 * longest[2] / runs, 100.0 * longest[3] / runs,
           100.0 * beyond / runs);
    printf("  %5.3f %5.3f", use / runs, use / runs / fixed);
    for (int w = 0; w < 3; w++) print_window(&after[w]);
    printf("\n");
}

int main(int argc, char **argv)
{
    int runs = argc > 1 ? atoi(argv[1]) : 200;
    if (runs < 1) return 1;
    printf(
        "%% of contested frames missed, of runs with longest runs of 2, of more, of runs with\n"
        "too many misses; use of budget, and of the fixed frame's; misses mean/worst\n");
    printf("%-12s missed and interval      quarters of the run   2 in row  more  beyond "
           "use  of fixed  load30  next100 turn100\n",
           "case");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) show(&cases[i], runs);
    return 0;
}

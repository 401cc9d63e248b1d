// A machine and a scene made of numbers, walked through under the guarantee: frame times are
// drawn at random around what the chosen cut truly costs.
#ifndef PROM_TESTS_GUARANTEE_SIMULATION_H
#define PROM_TESTS_GUARANTEE_SIMULATION_H

#include "traverse/guarantee.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIM_FRAMES = 600, SIM_WINDOW = 100 };

// What happens, by name; each in [0,1] or in units of the usual frame.
typedef struct sim_case {
    const char *name;
    double noise;         // p99 / p50 of a frame drawn again and again
    double stall_ms;      // every 12 to 15 frames
    double rare_stall_ms; // every 150 frames
    double
        wander; // prediction is off by this (standard deviation), for some 20 frames each time
    double gusts; // the pace while others use the machine, now and then for some ten frames
    double drift; // the pace goes up and down by this, once in 300 frames
    double wrong_terms; // pixels cost this times what was calibrated, geometry as little less
    double load;        // the pace in the middle half of the run
    double load_noise;  // and its noise
    double turn;        // the first frames after each turn (every 150) cost this times more
    double easy;        // full detail is predicted at this part of the budget for 200 frames
    double hard;        // the cheapest cut is at this times the budget for 60 frames
    double start;       // the pace of the machine against the calibration
    double miss_rate;   // 0: PROM_MISS_RATE
} sim_case;

typedef struct sim_frame {
    double ms, predicted_ms, margin, scale;
    bool contested, miss; // contested: full detail is over the budget, the cheapest cut within
} sim_frame;

typedef struct sim_run {
    sim_frame frames[SIM_FRAMES];
    prom_guarantee guarantee; // as it was left
} sim_run;

#define SIM_BUDGET_MS 33.0
#define SIM_TURN_FRAMES 5
#define SIM_TURN_PERIOD 150

static double sim_uniform(uint64_t *seed)
{
    uint64_t z = *seed += 0x9e3779b97f4a7c15u; // splitmix64
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return ((double)((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
}

static double sim_gauss(uint64_t *seed)
{
    return sqrt(-2 * log(sim_uniform(seed))) * cos(6.283185307179586 * sim_uniform(seed));
}

// Log-normal with the median 1 and the given p99 / p50.
static double sim_noise(double p99_p50, uint64_t *seed)
{
    return exp(log(p99_p50) / 2.326348 * sim_gauss(seed));
}

static bool sim_loaded(const sim_case *c, int i)
{
    return c->load > 0 && i >= SIM_FRAMES / 4 && i < 3 * SIM_FRAMES / 4;
}

static bool sim_turning(const sim_case *c, int i)
{
    return c->turn > 0 && i >= SIM_TURN_PERIOD && i % SIM_TURN_PERIOD < SIM_TURN_FRAMES;
}

static double sim_pace(const sim_case *c, int i)
{
    double pace = c->start > 0 ? c->start : 1;
    if (c->drift > 0) pace *= 1 + c->drift * sin(6.283185307179586 * i / 300);
    if (sim_loaded(c, i)) pace *= c->load;
    if (sim_turning(c, i)) pace *= c->turn;
    return pace;
}

static double sim_jitter(const sim_case *c, int i)
{
    return sim_loaded(c, i) && c->load_noise > 0 ? c->load_noise : c->noise;
}

// What a frame spends on fixed work, geometry, shaded and hidden pixels; it sways slowly, and
// jumps every 40 frames.
static void sim_mix(int i, double mix[PROM_TERMS])
{
    double pixels = 0.45 + 0.1 * sin(i / 17.0) + (i / 40 % 2 ? 0.2 : -0.2);
    double terms[PROM_TERMS] = {0.05, 0.8 - pixels, pixels, 0.15};
    memcpy(mix, terms, sizeof terms);
}

static double sim_stall(const sim_case *c, int *next, uint64_t *seed)
{
    if ((*next)-- > 0) return 0;
    *next = 11 + (int)(4 * sim_uniform(seed));
    return c->stall_ms;
}

static double sim_gust(const sim_case *c, bool *blows, uint64_t *seed)
{
    if (c->gusts <= 0) return 1;
    if (sim_uniform(seed) < 0.1) *blows = !*blows;
    return *blows ? c->gusts : 1;
}

// The cut: predicted at nearly what is allowed, unless full detail is less or nothing as cheap
// can be had.
static double sim_select(const sim_case *c, const prom_guarantee *g, int i, sim_frame *frame,
                         uint64_t *seed)
{
    double allowed = prom_guarantee_allowed(g);
    double full = c->easy > 0 && i < 200 ? c->easy * SIM_BUDGET_MS : INFINITY;
    double cheapest = c->hard > 0 && i % 200 >= 140 ? c->hard * SIM_BUDGET_MS : 0;
    frame->contested = allowed >= cheapest && allowed <= full;
    return fmax(fmin(allowed * (1 - 0.03 * sim_uniform(seed)), full), cheapest);
}

static void sim_draw(const sim_case *c, const prom_guarantee *g, int i, double stall,
                     uint64_t *seed, prom_guarantee_frame *frame)
{
    double predicted = 0, actual = 0, mix[PROM_TERMS], wrong[PROM_TERMS] = {1, 1, 1, 1};
    if (c->wrong_terms > 0)
        wrong[PROM_TERM_PIXELS] = c->wrong_terms,
        wrong[PROM_TERM_GEOMETRY] = 1 / c->wrong_terms;
    sim_mix(i, mix);
    for (int t = 0; t < PROM_TERMS; t++) predicted += mix[t] * g->terms.factors[t];
    double size = frame->terms_ms[0] / predicted;
    for (int t = 0; t < PROM_TERMS; t++) {
        frame->terms_ms[t] = size * mix[t] * g->terms.factors[t];
        actual += size * mix[t] * wrong[t];
    }
    frame->draw_ms = actual * sim_pace(c, i) * sim_noise(sim_jitter(c, i), seed) + stall;
    if (i % 150 == 75) frame->draw_ms += c->rare_stall_ms;
    frame->other_ms = 1.0 * sim_noise(1.5, seed);
}

// What a calibration on a machine of this noise would keep back (app/calibration.c).
static double sim_margin(double p99_p50)
{
    double p95_p50 = exp(log(p99_p50) * 1.644854 / 2.326348);
    return fmin(fmax(1 - 1 / (p95_p50 * 1.08), 0.15), 0.3);
}

static void sim_walk(const sim_case *c, uint64_t seed, sim_run *run)
{
    prom_cost_model model = {.fixed_ms = 1, .margin = sim_margin(c->noise)};
    prom_guarantee_options options = {.budget_ms = SIM_BUDGET_MS,
                                      .miss_rate =
                                          c->miss_rate > 0 ? c->miss_rate : PROM_MISS_RATE};
    prom_guarantee *g = &run->guarantee;
    prom_guarantee_init(g, &model, &options);
    int next = 11;
    bool gust = false;
    double off = 0; // ln of what the prediction is off by, apart from all else
    for (int i = 0; i < SIM_FRAMES; i++) {
        sim_frame *out = &run->frames[i];
        prom_guarantee_frame frame = {.terms_ms = {sim_select(c, g, i, out, &seed)}};
        sim_draw(c, g, i, sim_stall(c, &next, &seed), &seed, &frame);
        off = 0.95 * off + sqrt(1 - 0.95 * 0.95) * c->wander * sim_gauss(&seed);
        frame.draw_ms *= exp(off) * sim_gust(c, &gust, &seed);
        out->ms = frame.draw_ms + frame.other_ms;
        out->miss = out->contested && out->ms > SIM_BUDGET_MS;
        out->margin = g->margin, out->scale = g->scale;
        prom_guarantee_feed(g, &frame);
    }
}

// ---- what came of it

static int sim_misses(const sim_run *run, int from, int to)
{
    int misses = 0;
    for (int i = from; i < to && i < SIM_FRAMES; i++) misses += run->frames[i].miss;
    return misses;
}

static int sim_contested(const sim_run *run, int from, int to)
{
    int count = 0;
    for (int i = from; i < to && i < SIM_FRAMES; i++) count += run->frames[i].contested;
    return count;
}

static int sim_longest(const sim_run *run)
{
    int longest = 0;
    for (int i = 0, now = 0; i < SIM_FRAMES; i++) {
        now = run->frames[i].miss ? now + 1 : 0;
        if (now > longest) longest = now;
    }
    return longest;
}

// Mean time of the contested frames over the budget.
static double sim_use(const sim_run *run, int from, int to)
{
    double sum = 0;
    for (int i = from; i < to; i++)
        if (run->frames[i].contested) sum += run->frames[i].ms;
    return sum / SIM_BUDGET_MS / fmax(sim_contested(run, from, to), 1);
}

static int sim_by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// The use of a fixed frame that misses as often as accepted: its mean / its quantile.
static double sim_fixed(const sim_case *c, double noise)
{
    enum { N = 20000 };
    static double ms[N];
    uint64_t seed = 7;
    bool gust = false;
    double sum = 0, rate = c->miss_rate > 0 ? c->miss_rate : PROM_MISS_RATE;
    for (int i = 0, next = 11; i < N; i++) {
        double stall = sim_stall(c, &next, &seed);
        ms[i] = 0.8 * SIM_BUDGET_MS * sim_noise(noise, &seed) + stall + sim_noise(1.5, &seed);
        ms[i] *= sim_gust(c, &gust, &seed);
        if (i % 150 == 75) ms[i] += c->rare_stall_ms;
        sum += ms[i];
    }
    qsort(ms, N, sizeof *ms, sim_by_value);
    return sum / N / ms[(size_t)(N * (1 - rate))];
}

static double sim_fixed_use(const sim_case *c)
{
    double quiet = sim_fixed(c, c->noise);
    return c->load_noise > 0 ? (quiet + sim_fixed(c, c->load_noise)) / 2 : quiet;
}

#endif

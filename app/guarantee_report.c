#include "app/guarantee_report.h"

#include <inttypes.h>
#include <stdio.h>

static void set(json_t *object, const char *key, json_t *value)
{
    json_object_set_new(object, key, value);
}

static void set_number(json_t *object, const char *key, double value)
{
    set(object, key, prom_json_number(value));
}

static json_t *spread_json(const prom_spread *s)
{
    json_t *json = json_object();
    set_number(json, "mean", s->mean);
    set_number(json, "p50", s->p50);
    set_number(json, "p95", s->p95);
    set_number(json, "p99", s->p99);
    set_number(json, "p999", s->p999);
    set_number(json, "max", s->max);
    set_number(json, "std", s->std);
    return json;
}

static json_t *misses_json(const prom_budget_use *use)
{
    json_t *json = json_object();
    set(json, "count", json_integer(use->misses));
    set(json, "longest_run", json_integer(use->longest_run));
    set_number(json, "rate_low", use->rate_low);
    set_number(json, "rate_high", use->rate_high);
    set_number(json, "overshoot", use->overshoot);
    return json;
}

static json_t *use_json(const prom_budget_use *use)
{
    json_t *json = json_object();
    set(json, "frames", json_integer(use->frames));
    set_number(json, "use_of_budget", use->use);
    set_number(json, "miss_rate", use->miss_rate);
    set_number(json, "std_ms", use->frame_ms.std);
    set(json, "misses", misses_json(use));
    return json;
}

static json_t *gap_json(const prom_gap_report *gap)
{
    if (!gap->frames) return json_null();
    json_t *json = json_object();
    set(json, "frames", json_integer(gap->frames));
    set_number(json, "mean", gap->share.mean);
    set_number(json, "p50", gap->share.p50);
    set_number(json, "p99", gap->share.p99);
    return json;
}

static json_t *floor_json(const prom_budget_report *r, const prom_noise_floor *floor)
{
    if (!r->floor_draws) return json_null(); // not asked for
    json_t *json = spread_json(&r->floor_ms);
    set(json, "draws", json_integer(r->floor_draws));
    set(json, "frame", json_integer(floor->frame));
    set_number(json, "target_ms", floor->target_ms);
    set_number(json, "chosen_ms", floor->chosen_ms);
    set_number(json, "mean_of_p99", r->floor_ms.mean / r->floor_ms.p99);
    return json;
}

static json_t *quarters_json(const prom_budget_report *r)
{
    json_t *json = json_array();
    for (int i = 0; i < PROM_QUARTERS; i++)
        json_array_append_new(json, json_integer(r->quarter_misses[i]));
    return json;
}

static json_t *hash_json(uint64_t hash)
{
    return json_sprintf("%016" PRIx64, hash);
}

static void set_misses(json_t *run, const prom_run_facts *f, const prom_budget_report *r)
{
    json_t *change = json_object(), *misses = misses_json(&r->all);
    set_number(change, "std", r->all.change_std);
    set_number(change, "p99", r->all.change_p99);
    set(misses, "quarters", quarters_json(r));
    set(run, "frame_ms", spread_json(&r->all.frame_ms));
    set(run, "change_ms", change);
    set_number(run, "miss_rate", r->all.miss_rate);
    set_number(run, "miss_rate_wanted", f->session->miss_rate);
    set(run, "misses", misses);
    set_number(run, "use_of_budget", r->all.use);
}

void prom_guarantee_add_json(json_t *run, const prom_run_facts *facts,
                             const prom_budget_report *report)
{
    const prom_budget_report *r = report;
    json_t *contested = use_json(&r->contested);
    json_t *turns = json_object(), *guarantee = json_object();
    set_misses(run, facts, r);
    set(contested, "gap", gap_json(&r->contested_gap));
    set(run, "contested", contested);
    set(run, "cold_start", use_json(&r->cold));
    set(turns, "turns", json_integer(r->turns));
    set(turns, "most_misses", json_integer(r->most_after_turn));
    set(run, "after_turn", turns);
    set(guarantee, "frozen", json_boolean(facts->session->frozen));
    set_number(guarantee, "scale", r->scale);
    set_number(guarantee, "margin", r->margin);
    set(run, "guarantee", guarantee);
    set(run, "gap", gap_json(&r->gap));
    set(run, "limited_frames", json_integer(r->limited_frames));
    set(run, "noise_floor", floor_json(r, &facts->result->floor));
    set_number(run, "use_of_floor", r->use_of_floor);
    set_number(run, "std_of_floor", r->std_of_floor);
    set(run, "cuts_hash", hash_json(r->cuts_hash));
}

// ---- text

static void print_misses(const char *what, const prom_budget_use *use)
{
    printf("%-10s %.1f %% (%u of %u; 95 %% sure: %.1f to %.1f %%), longest run %u", what,
           100 * use->miss_rate, use->misses, use->frames, 100 * use->rate_low,
           100 * use->rate_high, use->longest_run);
}

static void print_all(const prom_run_facts *facts, const prom_budget_report *r)
{
    const prom_spread *t = &r->all.frame_ms;
    printf("frame      mean %.1f ms, p50 %.1f, p95 %.1f, p99 %.1f, p99.9 %.1f, max %.1f, std "
           "%.1f; from one to the next std %.1f, p99 %.1f\n",
           t->mean, t->p50, t->p95, t->p99, t->p999, t->max, t->std, r->all.change_std,
           r->all.change_p99);
    print_misses("misses", &r->all);
    printf(", quarters %u %u %u %u, by %.0f %% on average; accepted %g %%\n",
           r->quarter_misses[0], r->quarter_misses[1], r->quarter_misses[2],
           r->quarter_misses[3], 100 * r->all.overshoot, 100 * facts->session->miss_rate);
    printf("budget     use %.0f %%; scale %.2f, margin %.0f %%%s\n", 100 * r->all.use, r->scale,
           100 * r->margin, facts->session->frozen ? ", frozen" : "");
}

static void print_gap(const char *what, const prom_gap_report *gap)
{
    if (!gap->frames) return;
    printf("%-10s gap mean %.2f %%, p50 %.2f, p99 %.2f in %u frames\n", what,
           100 * gap->share.mean, 100 * gap->share.p50, 100 * gap->share.p99, gap->frames);
}

static void print_floor(const prom_budget_report *r, const prom_noise_floor *floor)
{
    const prom_spread *t = &r->floor_ms;
    printf("floor      a cut of %.1f ms drawn %u times: mean %.1f ms, p50 %.1f, p95 %.1f, p99 "
           "%.1f, std %.1f, mean/p99 %.2f\n",
           floor->chosen_ms, r->floor_draws, t->mean, t->p50, t->p95, t->p99, t->std,
           t->mean / t->p99);
    if (r->contested.frames)
        printf("of floor   contested frames: use %.2f, std %.2f\n", r->use_of_floor,
               r->std_of_floor);
}

void prom_guarantee_print(const prom_run_facts *facts, const prom_budget_report *report)
{
    const prom_budget_report *r = report;
    print_all(facts, r);
    if (r->contested.frames) {
        print_misses("contested", &r->contested);
        printf(", use %.0f %%, std %.1f ms\n", 100 * r->contested.use,
               r->contested.frame_ms.std);
    }
    print_misses("cold start", &r->cold);
    printf(", use %.0f %%\n", 100 * r->cold.use);
    if (r->turns)
        printf("turns      %u fast ones; at most %u misses in %d frames from one on\n",
               r->turns, r->most_after_turn, PROM_TURN_FRAMES);
    print_gap("selection", &r->gap);
    print_gap("contested", &r->contested_gap);
    if (r->floor_draws) print_floor(r, &facts->result->floor);
    printf("cuts       %016" PRIx64 "\n", r->cuts_hash);
}

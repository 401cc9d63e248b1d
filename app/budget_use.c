#include "app/budget_use.h"

#include "metaobj/base/hash.h"

#include <math.h>

bool prom_is_contested(const prom_frame_record *record)
{
    return record->fits && record->limited;
}

// values: room for one of each record; returns how many there are.
static size_t find_changes(const prom_frame_record *records, size_t count,
                           prom_frame_wanted *wanted, double *values)
{
    size_t changes = 0;
    for (size_t i = 1; i < count; i++) {
        if (wanted && !(wanted(&records[i - 1]) && wanted(&records[i]))) continue;
        values[changes++] = fabs(records[i].frame_ms - records[i - 1].frame_ms);
    }
    return changes;
}

static void add_misses(const prom_frame_record *records, size_t count, double budget_ms,
                       prom_frame_wanted *wanted, prom_budget_use *use)
{
    uint32_t run = 0;
    for (size_t i = 0; i < count; i++) {
        bool miss = (!wanted || wanted(&records[i])) && records[i].frame_ms > budget_ms;
        run = miss ? run + 1 : 0;
        if (run > use->longest_run) use->longest_run = run;
        if (!miss) continue;
        use->misses++;
        use->overshoot += records[i].frame_ms / budget_ms - 1;
    }
    if (use->misses) use->overshoot /= use->misses;
    use->miss_rate = (double)use->misses / use->frames;
    prom_miss_interval(use->misses, use->frames, &use->rate_low, &use->rate_high);
}

prom_budget_use prom_budget_use_of(const prom_frame_record *records, size_t count,
                                   double budget_ms, prom_frame_wanted *wanted)
{
    prom_budget_use use = {0};
    double *values = prom_alloc(count, sizeof *values);
    for (size_t i = 0; i < count; i++)
        if (!wanted || wanted(&records[i])) values[use.frames++] = records[i].frame_ms;
    if (use.frames) {
        use.frame_ms = prom_spread_of(values, use.frames);
        use.use = use.frame_ms.mean / budget_ms;
        add_misses(records, count, budget_ms, wanted, &use);
        size_t changes = find_changes(records, count, wanted, values);
        prom_spread change = changes ? prom_spread_of(values, changes) : (prom_spread){0};
        use.change_std = change.std;
        use.change_p99 = change.p99;
    }
    prom_free(values);
    return use;
}

static void add_quarters(const prom_frame_record *records, size_t count, double budget_ms,
                         prom_budget_report *report)
{
    for (size_t i = 0; i < count; i++) {
        size_t quarter = i * PROM_QUARTERS / count;
        report->quarter_frames[quarter]++;
        report->quarter_misses[quarter] += records[i].frame_ms > budget_ms;
    }
}

static void add_turns(const prom_frame_record *records, size_t count, double budget_ms,
                      prom_budget_report *report)
{
    for (size_t i = 0; i < count; i++) {
        if (!records[i].turned) continue;
        uint32_t misses = 0;
        for (size_t k = i; k < count && k < i + PROM_TURN_FRAMES; k++)
            misses += records[k].frame_ms > budget_ms;
        report->turns++;
        if (misses > report->most_after_turn) report->most_after_turn = misses;
    }
}

static prom_gap_report gap_of(const prom_frame_record *records, size_t count,
                              prom_frame_wanted *wanted)
{
    prom_gap_report gap = {0};
    double *shares = prom_alloc(count, sizeof *shares);
    for (size_t i = 0; i < count; i++)
        if (!isnan(records[i].gap) && (!wanted || wanted(&records[i])))
            shares[gap.frames++] = records[i].gap;
    if (gap.frames) gap.share = prom_spread_of(shares, gap.frames);
    prom_free(shares);
    return gap;
}

static void add_floor(const prom_noise_floor *floor, prom_budget_report *report)
{
    report->use_of_floor = report->std_of_floor = NAN;
    report->floor_draws = (uint32_t)floor->ms.count;
    if (!report->floor_draws) return;
    double *ms = prom_alloc(floor->ms.count, sizeof *ms);
    memcpy(ms, floor->ms.data, floor->ms.count * sizeof *ms);
    report->floor_ms = prom_spread_of(ms, floor->ms.count);
    prom_free(ms);
    const prom_budget_use *contested = &report->contested;
    if (!contested->frames) return;
    report->use_of_floor = contested->use / (report->floor_ms.mean / report->floor_ms.p99);
    if (report->floor_ms.std > 0)
        report->std_of_floor = contested->frame_ms.std / report->floor_ms.std;
}

prom_budget_report prom_budget_report_of(const prom_loop_result *result, double budget_ms)
{
    const prom_frame_record *records = result->frames.data;
    size_t count = result->frames.count;
    prom_budget_report report = {
        .all = prom_budget_use_of(records, count, budget_ms, NULL),
        .contested = prom_budget_use_of(records, count, budget_ms, prom_is_contested),
        .cold = prom_budget_use_of(result->cold.data, result->cold.count, budget_ms, NULL),
        .gap = gap_of(records, count, NULL),
        .contested_gap = gap_of(records, count, prom_is_contested),
    };
    for (size_t i = 0; i < count; i++) {
        report.limited_frames += records[i].limited;
        report.scale += records[i].scale / (double)count;
        report.margin += records[i].margin / (double)count;
        report.cuts_hash =
            prom_hash(&records[i].cut_hash, sizeof records[i].cut_hash, report.cuts_hash);
    }
    add_quarters(records, count, budget_ms, &report);
    add_turns(records, count, budget_ms, &report);
    add_floor(&result->floor, &report);
    return report;
}

#include "app/statistics.h"

#include <math.h>
#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double nearest_rank(const double *sorted, size_t count, double share)
{
    double rank = ceil(share * (double)count);
    return sorted[rank < 1 ? 0 : (size_t)rank - 1];
}

prom_spread prom_spread_of(double *values, size_t count)
{
    double sum = 0, squares = 0;
    qsort(values, count, sizeof *values, compare);
    for (size_t i = 0; i < count; i++) sum += values[i];
    double mean = sum / (double)count;
    for (size_t i = 0; i < count; i++) squares += (values[i] - mean) * (values[i] - mean);
    return (prom_spread){
        .mean = mean,
        .p50 = nearest_rank(values, count, 0.50),
        .p95 = nearest_rank(values, count, 0.95),
        .p99 = nearest_rank(values, count, 0.99),
        .p999 = nearest_rank(values, count, 0.999),
        .max = values[count - 1],
        .std = sqrt(squares / (double)count),
    };
}

typedef struct ranked {
    double value;
    size_t place;
} ranked;

static int compare_ranked(const void *a, const void *b)
{
    return compare(&((const ranked *)a)->value, &((const ranked *)b)->value);
}

// Ranks less their mean; equal values share the mean of theirs.
static void find_ranks(const double *values, size_t count, ranked *sorted, double *ranks)
{
    for (size_t i = 0; i < count; i++) sorted[i] = (ranked){values[i], i};
    qsort(sorted, count, sizeof *sorted, compare_ranked);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && sorted[end].value == sorted[i].value;) end++;
        double rank = (double)(i + end - 1) / 2 - (double)(count - 1) / 2;
        for (size_t k = i; k < end; k++) ranks[sorted[k].place] = rank;
    }
}

double prom_spearman(const double *x, const double *y, size_t count)
{
    ranked *sorted = prom_alloc(count, sizeof *sorted);
    double *a = prom_alloc(2 * count, sizeof *a), *b = a + count;
    find_ranks(x, count, sorted, a);
    find_ranks(y, count, sorted, b);
    double ab = 0, aa = 0, bb = 0;
    for (size_t i = 0; i < count; i++) {
        ab += a[i] * b[i];
        aa += a[i] * a[i];
        bb += b[i] * b[i];
    }
    prom_free(sorted);
    prom_free(a);
    return aa > 0 && bb > 0 ? ab / sqrt(aa * bb) : NAN;
}

double prom_slope(const double *x, const double *y, size_t count)
{
    double xy = 0, xx = 0;
    for (size_t i = 0; i < count; i++) {
        xy += x[i] * y[i];
        xx += x[i] * x[i];
    }
    return xx > 0 ? xy / xx : NAN;
}

static void add_prediction(const prom_frame_record *records, size_t count,
                           prom_run_statistics *s)
{
    size_t known = 0;
    for (size_t i = 0; i < count; i++) {
        double predicted = records[i].predicted_ms, actual = records[i].draw_ms;
        if (!(predicted > 0) || !(actual > 0)) continue;
        known++;
        s->mape += fabs(predicted / actual - 1);
        s->worst_under = fmax(s->worst_under, actual / predicted - 1);
    }
    if (known) s->mape /= (double)known;
}

static void add_holes(const prom_frame_record *records, size_t count, prom_run_statistics *s)
{
    for (size_t i = 0; i < count; i++) {
        const prom_difference *d = &records[i].difference;
        if (!(d->found & PROM_COMPARE_HOLES)) continue;
        s->hole_frames++;
        s->holes_mean += d->holes;
        s->holes_max = fmax(s->holes_max, d->holes);
    }
    if (s->hole_frames) s->holes_mean /= s->hole_frames;
}

double prom_predicted_accuracy(const prom_frame_record *record)
{
    double pixels = record->benefit_px + record->loss_px;
    return pixels > 0 ? record->benefit_px / pixels : 1;
}

static void add_accuracy(const prom_frame_record *records, size_t count, prom_run_statistics *s)
{
    double least = 1;
    for (size_t i = 0; i < count; i++) {
        const prom_difference *d = &records[i].difference;
        if (!(d->found & PROM_COMPARE_ACCURACY)) continue;
        s->accuracy_frames++;
        s->accuracy_mean += d->accuracy;
        s->predicted_accuracy += prom_predicted_accuracy(&records[i]);
        least = fmin(least, d->accuracy);
    }
    if (!s->accuracy_frames) return;
    s->accuracy_mean /= s->accuracy_frames;
    s->predicted_accuracy /= s->accuracy_frames;
    s->accuracy_min = least;
}

// values: room for one of each record.
static void add_popping(const prom_frame_record *records, size_t count, prom_run_statistics *s)
{
    for (size_t i = 0; i < count; i++) {
        const prom_popped *p = &records[i].popped;
        if (!(p->valid_share > 0)) continue;
        s->popping_frames++;
        s->popped.flip += p->flip;
        s->popped.floor += p->floor;
        s->popped.valid_share += p->valid_share;
    }
    if (!s->popping_frames) return;
    s->popped.flip /= s->popping_frames;
    s->popped.floor /= s->popping_frames;
    s->popped.valid_share /= s->popping_frames;
}

static void add_quality(const prom_frame_record *records, size_t count, double *values,
                        prom_run_statistics *s)
{
    for (size_t i = 0; i < count; i++) {
        const prom_difference *d = &records[i].difference;
        if (!(d->found & PROM_COMPARE_QUALITY)) continue;
        values[s->quality_frames++] = d->flip;
        s->loss_share += d->loss;
        s->hidden_cost += d->hidden_cost;
        s->hidden_nodes += d->hidden_nodes;
    }
    if (!s->quality_frames) return;
    s->flip = prom_spread_of(values, s->quality_frames);
    s->loss_share /= s->quality_frames;
    s->hidden_cost /= s->quality_frames;
    s->hidden_nodes /= s->quality_frames;
}

prom_run_statistics prom_run_statistics_of(const prom_frame_record *records, size_t count)
{
    prom_run_statistics s = {0};
    double *values = prom_alloc(count, sizeof *values);
    for (size_t i = 0; i < count; i++) values[i] = records[i].select_ms;
    s.select_ms = prom_spread_of(values, count);
    for (size_t i = 0; i < count; i++) values[i] = records[i].predicted_ms;
    s.predicted_ms = prom_spread_of(values, count);
    add_quality(records, count, values, &s);
    add_popping(records, count, &s);
    prom_free(values);
    for (size_t i = 0; i < count; i++) {
        s.triangles += records[i].triangles / (double)count;
        s.resolution += records[i].resolution / (double)count;
        s.draws += records[i].draws / (double)count;
        s.cut_nodes += records[i].cut_nodes / (double)count;
        s.benefit_px += records[i].benefit_px / (double)count;
        s.loss_px += records[i].loss_px / (double)count;
        s.switches += records[i].switches.count / (double)count;
        s.switched_px += records[i].switches.px / (double)count;
    }
    add_prediction(records, count, &s);
    add_holes(records, count, &s);
    add_accuracy(records, count, &s);
    return s;
}

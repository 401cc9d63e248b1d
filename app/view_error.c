#include "app/view_error.h"

#include "benefit/metric.h"
#include "builder/measure_picture.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"

#include <assert.h>

struct prom_view_error {
    prom_metric *metric;
    prom_measured how;
    bool large;                    // large views are looked at,
    uint32_t view_px;              // of this side
    float step;                    // pixels of a view along one of a picture
    uint32_t side, pad, wide;      // of a picture; padded, so that the metric sees all around
    prom_patch view, truth, other; // reduced, but for the view
    float (*between)[4];
    prom_encoder encoder;
    uint8_t (*padded)[4];
    float *truth_features[PROM_BACKGROUNDS], *features, *map;
};

prom_view_error *prom_view_error_create(const prom_measured *measured, float size_px)
{
    assert(size_px <= PROM_VIEW_LARGE_PX);
    const prom_metric_class *class = prom_metric_named(measured->metric);
    if (!class) class = prom_metric_at(0);
    prom_view_error *e = prom_calloc(1, sizeof *e);
    e->how = *measured;
    e->large = size_px > PROM_VIEW_PX;
    e->view_px = e->large ? PROM_VIEW_LARGE_PX : PROM_VIEW_PX;
    e->step = (float)e->view_px / size_px;
    e->side = (uint32_t)ceilf(size_px);
    e->pad = prom_metric_radius_of(class->name, measured->ppd);
    e->wide = e->side + 2 * e->pad;
    size_t inner = (size_t)e->side * e->side, pixels = (size_t)e->wide * e->wide;
    e->metric = prom_metric_create(class->name, measured->ppd, e->wide, pixels, 1);
    size_t floats = prom_metric_feature_floats(e->metric, e->wide, e->wide);
    prom_encoder_init(&e->encoder);
    e->view.pixels = prom_alloc((size_t)e->view_px * e->view_px, sizeof *e->view.pixels);
    e->between = prom_alloc((size_t)e->view_px * e->side, sizeof *e->between);
    e->truth.pixels = prom_alloc(inner, sizeof *e->truth.pixels);
    e->other.pixels = prom_alloc(inner, sizeof *e->other.pixels);
    e->padded = prom_alloc(pixels, sizeof *e->padded);
    e->map = prom_alloc(pixels, sizeof *e->map);
    e->features = prom_alloc(floats, sizeof *e->features);
    for (int b = 0; b < PROM_BACKGROUNDS; b++)
        e->truth_features[b] = prom_alloc(floats, sizeof *e->truth_features[b]);
    return e;
}

void prom_view_error_destroy(prom_view_error *e)
{
    if (!e) return;
    prom_metric_destroy(e->metric);
    prom_free(e->view.pixels);
    prom_free(e->between);
    prom_free(e->truth.pixels);
    prom_free(e->other.pixels);
    prom_free(e->padded);
    prom_free(e->map);
    prom_free(e->features);
    for (int b = 0; b < PROM_BACKGROUNDS; b++) prom_free(e->truth_features[b]);
    prom_free(e);
}

uint32_t prom_view_error_side(const prom_view_error *e)
{
    return e->side;
}

const char *prom_view_error_metric(const prom_view_error *e)
{
    return prom_metric_class_of(e->metric)->name;
}

// ---- pictures

static void take_picture(prom_view_error *e, const prom_views *views, uint32_t dir,
                         prom_patch *out)
{
    const prom_part whole = {0, 0, e->view_px, e->view_px};
    prom_patch_take(views, e->large ? PROM_DIRS + dir : dir, whole, &e->view);
    prom_patch_reduce(&e->view, e->step, e->between, out);
}

static void take_features(prom_view_error *e, float *features)
{
    prom_picture picture = {
        .width = e->wide, .height = e->wide, .channels = 4, .pixels = e->padded};
    prom_metric_features(e->metric, &picture, features);
}

// The first pixel of row y inside of what is padded.
static size_t inner_row(const prom_view_error *e, uint32_t y)
{
    return (size_t)(y + e->pad) * e->wide + e->pad;
}

// Composes a picture, keeps it (rgb NULL: does not) and takes its features.
static void look(prom_view_error *e, const prom_patch *picture, float background,
                 uint8_t (*rgb)[3], float *features)
{
    prom_patch_compose(picture, &e->encoder, background, e->pad, e->padded);
    for (uint32_t y = 0; rgb && y < e->side; y++)
        for (uint32_t x = 0; x < e->side; x++)
            memcpy(*rgb++, e->padded[inner_row(e, y) + x], 3);
    take_features(e, features);
}

// ---- comparing

void prom_view_error_set_truth(prom_view_error *e, const prom_views *views, uint32_t dir,
                               uint8_t (*rgb)[3])
{
    take_picture(e, views, dir, &e->truth);
    for (int b = 0; b < PROM_BACKGROUNDS; b++)
        look(e, &e->truth, e->how.background[b], b == 0 ? rgb : NULL, e->truth_features[b]);
}

double prom_view_error_run(prom_view_error *e, const prom_views *views, uint32_t dir,
                           uint8_t (*rgb)[3], float *map, bool *vetoed)
{
    const bool squares = prom_metric_class_of(e->metric)->squares;
    const size_t pixels = (size_t)e->wide * e->wide;
    const double area = prom_patch_area(&e->truth);
    const float size_px = (float)e->view_px / e->step;
    double error = 0;
    *vetoed = false;
    take_picture(e, views, dir, &e->other);
    for (int b = 0; b < PROM_BACKGROUNDS; b++) {
        look(e, &e->other, e->how.background[b], b == 0 ? rgb : NULL, e->features);
        prom_metric_compare(e->metric, e->truth_features[b], e->features, e->wide, e->wide,
                            e->map);
        for (uint32_t y = 0; b == 0 && y < e->side; y++)
            memcpy(map + (size_t)y * e->side, e->map + inner_row(e, y), e->side * sizeof *map);
        error += prom_window_error(e->map, pixels, area, squares);
        *vetoed |= prom_window_vetoed(&e->how, size_px, area, e->map, e->wide, e->wide);
    }
    return 1 - error / PROM_BACKGROUNDS;
}

#include "app/info_sheet.h"

#include "app/canvas.h"
#include "app/info_object.h"
#include "app/object_views.h"
#include "app/view_error.h"
#include "benefit/accuracy.h"
#include "benefit/colour_map.h"
#include "builder/image_io.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

// Pixels; by taste.
#define MARGIN 16
#define GAP 4           // between a picture and its map
#define COLUMN_GAP 20   // and between columns
#define LINE_HEIGHT 20  // of text
#define HEAD_LINES 6    // above the columns' heads
#define LABEL_CHARS 17  // before the rows
#define LEAST_CHARS 64  // across
#define VIEW_PX 128     // smaller pictures are enlarged to about this
#define SCALE_WIDTH 120 // of the colours

static const uint8_t paper[3] = {38, 40, 44}, ink[3] = {232, 232, 232},
                     dim[3] = {160, 164, 172}, warning[3] = {255, 190, 80};

typedef struct sheet {
    const prom_model *model;
    uint32_t node, prototype, size; // size: bin
    uint32_t dirs[PROM_DIRS], dir_count;
    uint32_t side, zoom; // of a picture
    prom_object_views device;
    prom_views truth, views;
    prom_view_error *error;
    prom_canvas canvas;
    uint8_t (*rgb)[3], (*map_rgb)[3]; // of a picture
    float *map;
} sheet;

// ---- directions

static float distance(uint32_t a, uint32_t b)
{
    vec3 u, v;
    prom_direction_of_bin(a, u);
    prom_direction_of_bin(b, v);
    return glm_vec3_distance2(u, v);
}

// Around from +z, the fronts of most things, over +x.
static int from_above(const void *a, const void *b)
{
    vec3 u, v;
    prom_direction_of_bin(*(const uint32_t *)a, u);
    prom_direction_of_bin(*(const uint32_t *)b, v);
    if (fabsf(u[1] - v[1]) > 1e-3f) return u[1] > v[1] ? -1 : 1;
    float angles[2] = {atan2f(u[0], u[2]), atan2f(v[0], v[2])};
    for (int i = 0; i < 2; i++)
        if (angles[i] < -1e-3f) angles[i] += 2.0f * GLM_PIf;
    return (angles[0] > angles[1]) - (angles[0] < angles[1]);
}

static float height(uint32_t bin)
{
    vec3 v;
    prom_direction_of_bin(bin, v);
    return v[1];
}

// Whether a direction adds more than another: farther from those that there are, or as far and
// from higher up, for that is how things are seen.
static bool adds_more(const float *nearest, uint32_t a, uint32_t b)
{
    if (fabsf(nearest[a] - nearest[b]) > 1e-4f) return nearest[a] > nearest[b];
    return height(a) > height(b) + 1e-4f;
}

// `count` of the bins < among, +z one of them; each next one adds most. From those that look
// from above to those from below.
static void spread_directions(uint32_t count, uint32_t among, uint32_t *bins)
{
    const float front[3] = {0, 0, 1};
    float nearest[PROM_DIRS] = {0};
    nearest[prom_bin_of_direction(front)] = INFINITY; // the first
    for (uint32_t i = 0; i < count; i++) {
        uint32_t best = 0;
        for (uint32_t d = 1; d < among; d++)
            if (adds_more(nearest, d, best)) best = d;
        bins[i] = best;
        for (uint32_t d = 0; d < among; d++)
            if (i == 0 || distance(best, d) < nearest[d]) nearest[d] = distance(best, d);
    }
    qsort(bins, count, sizeof *bins, from_above);
}

static bool is_large(const sheet *s)
{
    return s->size >= PROM_SIZES;
}

// ---- layout

static uint32_t view_width(const sheet *s)
{
    return s->side * s->zoom;
}

static uint32_t column_x(const sheet *s, uint32_t column)
{
    return MARGIN + LABEL_CHARS * PROM_TEXT_WIDTH +
           column * (2 * view_width(s) + GAP + COLUMN_GAP);
}

static uint32_t row_y(const sheet *s, uint32_t row)
{
    uint32_t heads = HEAD_LINES * LINE_HEIGHT + LINE_HEIGHT / 2 + 2 * LINE_HEIGHT;
    return MARGIN + heads + row * (view_width(s) + GAP + 2 * LINE_HEIGHT);
}

// Returns where the text ends.
static uint32_t __attribute__((format(printf, 5, 6)))
print(sheet *s, uint32_t x, uint32_t y, const uint8_t rgb[3], const char *format, ...)
{
    char line[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    prom_canvas_text(&s->canvas, x, y, rgb, line);
    return x + (uint32_t)strlen(line) * PROM_TEXT_WIDTH;
}

static void start_canvas(sheet *s)
{
    uint32_t rows = 1 + s->model->prototypes[s->prototype].rep_count;
    uint32_t width = column_x(s, s->dir_count) - COLUMN_GAP + MARGIN;
    uint32_t least = 2 * MARGIN + LEAST_CHARS * PROM_TEXT_WIDTH;
    prom_canvas_init(&s->canvas, width > least ? width : least,
                     row_y(s, rows) - LINE_HEIGHT + MARGIN, paper);
}

// ---- the head

static uint32_t draw_scale(sheet *s, uint32_t x, uint32_t y)
{
    float errors[SCALE_WIDTH];
    uint8_t rgb[SCALE_WIDTH][3];
    for (uint32_t i = 0; i < SCALE_WIDTH; i++) errors[i] = (float)i / (SCALE_WIDTH - 1);
    prom_colour_map_paint(errors, SCALE_WIDTH, rgb[0]);
    for (uint32_t i = 0; i < SCALE_WIDTH; i++)
        prom_canvas_fill(&s->canvas, x + i, y, 1, PROM_TEXT_HEIGHT, rgb[i]);
    return x + SCALE_WIDTH;
}

// Whether what is measured here may be compared with what the model holds.
static bool same_metric(const sheet *s)
{
    return !strcmp(prom_view_error_metric(s->error), s->model->measured.metric);
}

static void draw_head(sheet *s)
{
    const prom_model *m = s->model;
    const prom_prototype *proto = &m->prototypes[s->prototype];
    uint32_t y = MARGIN, most = (s->canvas.width - 2 * MARGIN) / PROM_TEXT_WIDTH;
    char *title = prom_object_title(m, s->node);
    print(s, MARGIN, y, ink, "%.*s", (int)most, title);
    prom_free(title);
    print(s, MARGIN, y += LINE_HEIGHT, dim, "%s of %llu triangles",
          proto->flags & PROM_PROTO_CLUSTER ? "cluster" : "object",
          (unsigned long long)proto->triangles);
    print(s, MARGIN, y += LINE_HEIGHT, dim, "accuracy: %s, %.4g px per degree, %.3g px across",
          m->measured.metric, (double)m->measured.ppd, (double)prom_size_of_bin(s->size));
    uint32_t x =
        print(s, MARGIN, y += LINE_HEIGHT, dim, "left: the look; right: its error by %s, 0 ",
              prom_view_error_metric(s->error));
    print(s, draw_scale(s, x, y), y, dim, " 1");
    if (!same_metric(s)) return;
    print(s, MARGIN, y += LINE_HEIGHT, dim, "here: measured now, where that is off by %g",
          PROM_SHEET_TOLERANCE);
    if (m->measured.veto_error < 1)
        print(s, MARGIN, y + LINE_HEIGHT, dim,
              "veto: more than %.3g %% of it lies within parts that err by more than %.3g",
              100 - 100 * (double)m->measured.veto_percentile, (double)m->measured.veto_error);
}

static void draw_column_heads(sheet *s)
{
    uint32_t y = row_y(s, 0) - GAP - 2 * LINE_HEIGHT;
    for (uint32_t c = 0; c < s->dir_count; c++) {
        float d[3];
        prom_direction_of_bin(s->dirs[c], d);
        print(s, column_x(s, c), y, dim, "direction %u", s->dirs[c]);
        print(s, column_x(s, c), y + LINE_HEIGHT, ink, "%.2f %.2f %.2f", (double)(d[0] + 0.0f),
              (double)(d[1] + 0.0f), (double)(d[2] + 0.0f)); // -0 becomes 0
    }
}

// ---- rows

static void draw_picture(sheet *s, uint32_t x, uint32_t y, uint8_t (*rgb)[3])
{
    prom_canvas_picture(&s->canvas, x, y, s->side, s->side, s->zoom, (const uint8_t(*)[3])rgb);
}

static void draw_truth(sheet *s)
{
    uint32_t y = row_y(s, 0);
    const uint16_t *coverage = s->model->coverage[s->prototype];
    print(s, MARGIN, y, ink, "true look");
    if (!s->model->prototypes[s->prototype].rep_count)
        print(s, MARGIN, y + LINE_HEIGHT, dim, "no representation");
    for (uint32_t c = 0; c < s->dir_count; c++) {
        prom_view_error_set_truth(s->error, &s->truth, s->dirs[c], s->rgb);
        draw_picture(s, column_x(s, c), y, s->rgb);
        print(s, column_x(s, c), y + view_width(s) + GAP, dim, "covers %.1f %%",
              coverage[s->dirs[c]] * 100.0 / 65535);
    }
}

static double stored_accuracy(const sheet *s, uint32_t rep, uint32_t dir)
{
    const prom_accuracy_row *row = &s->model->accuracy[rep];
    return (double)prom_accuracy_of_byte(is_large(s) ? row->large[dir][s->size - PROM_SIZES]
                                                     : row->bins[dir][s->size]);
}

static void draw_accuracy(sheet *s, uint32_t x, uint32_t y, uint32_t rep, uint32_t dir,
                          double here, bool vetoed)
{
    const prom_representation *r = &s->model->reps[rep];
    double stored = stored_accuracy(s, rep, dir);
    bool shown = prom_size_of_bin(s->size) <= r->max_size_px;
    if (is_large(s) && r->kind != PROM_REP_MESH) {
        print(s, x, y, dim, "none, here %.2f", here);
        return;
    }
    x = print(s, x, y, shown ? ink : dim, "%.2f", stored);
    if (!same_metric(s) || fabs(stored - here) <= PROM_SHEET_TOLERANCE) return;
    print(s, x, y, warning,
          stored > 1 - (double)PROM_ERROR_MAX || !vetoed ? " here %.2f" : " veto, else %.2f",
          here);
}

static void draw_cell(sheet *s, uint32_t rep, uint32_t row, uint32_t column)
{
    uint32_t dir = s->dirs[column], x = column_x(s, column), y = row_y(s, row);
    prom_view_error_set_truth(s->error, &s->truth, dir, NULL);
    bool vetoed;
    double here = prom_view_error_run(s->error, &s->views, dir, s->rgb, s->map, &vetoed);
    prom_colour_map_paint(s->map, (size_t)s->side * s->side, s->map_rgb[0]);
    draw_picture(s, x, y, s->rgb);
    draw_picture(s, x + view_width(s) + GAP, y, s->map_rgb);
    draw_accuracy(s, x, y + view_width(s) + GAP, rep, dir, here, vetoed);
}

static void draw_label(sheet *s, const prom_representation *rep, uint32_t y)
{
    print(s, MARGIN, y, ink, "%s %u", prom_rep_kind_name(rep->kind), rep->level);
    print(s, MARGIN, y += LINE_HEIGHT, dim, "%u triangles", rep->triangles);
    if (rep->error > 0)
        print(s, MARGIN, y += LINE_HEIGHT, dim, "error %.3g", (double)rep->error);
    if (isfinite(rep->max_size_px))
        print(s, MARGIN, y += LINE_HEIGHT, dim, "up to %.3g px", (double)rep->max_size_px);
    if (rep->flags & PROM_REP_ARTIST) print(s, MARGIN, y + LINE_HEIGHT, dim, "of the scene");
}

static void draw_rows(sheet *s)
{
    const prom_prototype *proto = &s->model->prototypes[s->prototype];
    prom_object_views_take_truth(&s->device, s->node, is_large(s), &s->truth);
    draw_truth(s);
    for (uint32_t i = 0; i < proto->rep_count; i++) {
        uint32_t rep = proto->first_rep + i;
        draw_label(s, &s->model->reps[rep], row_y(s, 1 + i));
        prom_object_views_take(&s->device, s->prototype, rep, is_large(s), &s->views);
        for (uint32_t c = 0; c < s->dir_count; c++) draw_cell(s, rep, 1 + i, c);
    }
}

// ---- the sheet

static void sheet_init(sheet *s, const prom_sheet_options *options)
{
    s->prototype = s->model->prototype[s->node];
    s->size = (uint32_t)(prom_bin_of_size(options->size_px) + 0.5f);
    uint32_t dirs = is_large(s) ? PROM_DIRS_LARGE : PROM_DIRS;
    s->dir_count = options->directions < dirs ? options->directions : dirs;
    spread_directions(s->dir_count, dirs, s->dirs);
    s->error = prom_view_error_create(&s->model->measured, prom_size_of_bin(s->size));
    s->side = prom_view_error_side(s->error);
    s->zoom = s->side < VIEW_PX ? (VIEW_PX + s->side / 2) / s->side : 1;
    size_t pixels = (size_t)s->side * s->side;
    s->rgb = prom_alloc(pixels, sizeof *s->rgb);
    s->map_rgb = prom_alloc(pixels, sizeof *s->map_rgb);
    s->map = prom_alloc(pixels, sizeof *s->map);
    start_canvas(s);
}

static void sheet_finish(sheet *s)
{
    prom_canvas_finish(&s->canvas);
    prom_views_finish(&s->truth);
    prom_views_finish(&s->views);
    prom_view_error_destroy(s->error);
    prom_free(s->rgb);
    prom_free(s->map_rgb);
    prom_free(s->map);
    prom_object_views_finish(&s->device);
}

prom_status prom_info_write_sheet(prom_container *container, const prom_model *model,
                                  uint32_t node, const prom_sheet_options *options,
                                  const char *path, prom_error *error)
{
    sheet s = {.model = model, .node = node};
    prom_status status = prom_object_views_init(&s.device, container, model, error);
    if (status) return status;
    sheet_init(&s, options);
    draw_head(&s);
    draw_column_heads(&s);
    draw_rows(&s);
    status =
        prom_image_write_png(path, s.canvas.width, s.canvas.height, 3, s.canvas.rgb[0], error);
    sheet_finish(&s);
    return status;
}

#include "app/mesh_sheet.h"

#include "app/canvas.h"
#include "benefit/colour_map.h"
#include "builder/image_io.h"
#include "metaobj/base/alloc.h"

#include <stdarg.h>
#include <stdio.h>

// Pixels; by taste.
#define MARGIN 16
#define GAP 4
#define LINE_HEIGHT 20
#define HEAD_LINES 5 // two of names, an empty one, two of each column
#define LEAST_CHARS 72

static const uint8_t paper[3] = {38, 40, 44}, ink[3] = {232, 232, 232},
                     dim[3] = {160, 164, 172};

typedef struct sheet {
    const prom_mesh_comparison *comparison;
    prom_mesh_pictures *pictures;
    prom_canvas canvas;
    uint32_t views[PROM_MESH_SHEET_VIEWS], count;
    uint8_t (*rgb)[3]; // of a picture
} sheet;

static void __attribute__((format(printf, 5, 6)))
print(sheet *s, uint32_t x, uint32_t y, const uint8_t rgb[3], const char *format, ...)
{
    char line[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    prom_canvas_text(&s->canvas, x, y, rgb, line);
}

static double flip_of(const prom_mesh_comparison *c, uint32_t view)
{
    return c->views[view][PROM_LOOK_FLIP].all.mean;
}

// The worst ones by insertion; earlier ones first where they are equal.
static void choose_views(sheet *s)
{
    for (uint32_t v = 0; v < s->comparison->view_count; v++) {
        uint32_t at = s->count;
        while (at && flip_of(s->comparison, v) > flip_of(s->comparison, s->views[at - 1])) at--;
        if (at == PROM_MESH_SHEET_VIEWS) continue;
        if (s->count < PROM_MESH_SHEET_VIEWS) s->count++;
        for (uint32_t i = s->count - 1; i > at; i--) s->views[i] = s->views[i - 1];
        s->views[at] = v;
    }
}

static uint32_t column_x(const sheet *s, uint32_t column)
{
    return MARGIN + column * (s->comparison->size_px + GAP);
}

static uint32_t row_y(const sheet *s, uint32_t row)
{
    return MARGIN + HEAD_LINES * LINE_HEIGHT + row * (s->comparison->size_px + GAP);
}

static void draw_head(sheet *s)
{
    const prom_mesh_facts *f = s->comparison->facts;
    for (uint32_t i = 0; i < 2; i++)
        print(s, MARGIN, MARGIN + i * LINE_HEIGHT, ink, "%c: %u triangles, %.180s", "AB"[i],
              f[i].triangles, f[i].path);
}

static void draw_picture(sheet *s, uint32_t column, uint32_t row)
{
    const uint32_t side = s->comparison->size_px;
    prom_canvas_picture(&s->canvas, column_x(s, column), row_y(s, row), side, side, 1,
                        (const uint8_t(*)[3])s->rgb);
}

static void draw_column(sheet *s, uint32_t column)
{
    const prom_mesh_comparison *c = s->comparison;
    const uint32_t view = s->views[column], y = row_y(s, 0) - 2 * LINE_HEIGHT;
    const size_t pixels = (size_t)c->size_px * c->size_px;
    prom_look_difference differences[PROM_LOOK_METRICS];
    prom_mesh_pictures_compare(s->pictures, view, differences);
    for (int mesh = 0; mesh < 2; mesh++) {
        const uint8_t(*rgba)[4] = prom_mesh_pictures_rgba(s->pictures, mesh);
        for (size_t i = 0; i < pixels; i++) memcpy(s->rgb[i], rgba[i], 3);
        draw_picture(s, column, (uint32_t)mesh);
    }
    prom_colour_map_paint(prom_mesh_pictures_flip(s->pictures), pixels, s->rgb[0]);
    draw_picture(s, column, 2);
    float d[3];
    prom_cube_view_direction(view, d);
    print(s, column_x(s, column), y, dim, "from %.2f %.2f %.2f", (double)d[0], (double)d[1],
          (double)d[2]);
    print(s, column_x(s, column), y + LINE_HEIGHT, ink, "flip %.4f", flip_of(c, view));
}

prom_status prom_mesh_sheet_write(prom_mesh_pictures *pictures,
                                  const prom_mesh_comparison *comparison, const char *path,
                                  prom_error *error)
{
    sheet s = {.comparison = comparison, .pictures = pictures};
    choose_views(&s);
    uint32_t width = column_x(&s, s.count) - GAP + MARGIN;
    uint32_t least = 2 * MARGIN + LEAST_CHARS * PROM_TEXT_WIDTH;
    prom_canvas_init(&s.canvas, width > least ? width : least, row_y(&s, 3) - GAP + MARGIN,
                     paper);
    s.rgb = prom_alloc((size_t)comparison->size_px * comparison->size_px, sizeof *s.rgb);
    draw_head(&s);
    for (uint32_t i = 0; i < s.count; i++) draw_column(&s, i);
    prom_status status =
        prom_image_write_png(path, s.canvas.width, s.canvas.height, 3, s.canvas.rgb[0], error);
    prom_free(s.rgb);
    prom_canvas_finish(&s.canvas);
    return status;
}

#include "app/scatter.h"

#include <math.h>
#include <stdbool.h>

// Pixels of the picture.
enum { WIDTH = 760, HEIGHT = 700, LEFT = 84, TOP = 74, SIDE = 556, LEGEND = LEFT + SIDE + 16 };

// Okabe and Ito 2008: told apart with every kind of colour vision; and a grey.
static const char *const colours[PROM_SCATTER_GROUPS] = {"#0072b2", "#d55e00", "#009e73",
                                                         "#cc79a7", "#e69f00", "#56b4e9",
                                                         "#000",    "#f0e442", "#888"};

enum { FORMS = 4 };
#define FINE_DECADES 3.0 // on axes up to so long, twos and fives have lines too
#define MARGIN 0.04      // of the axes, around the points

typedef struct canvas {
    FILE *out;
    double linear, low, high; // of both axes; low and high on their scale
} canvas;

static double scaled(const canvas *c, double value)
{
    return asinh(value / c->linear);
}

static double across(const canvas *c, double value)
{
    return LEFT + SIDE * (scaled(c, value) - c->low) / (c->high - c->low);
}

static double down(const canvas *c, double value)
{
    return TOP + SIDE * (c->high - scaled(c, value)) / (c->high - c->low);
}

// Names come from files.
static void put_escaped(FILE *out, const char *text)
{
    for (; *text; text++) {
        if (*text == '<')
            fputs("&lt;", out);
        else if (*text == '&')
            fputs("&amp;", out);
        else
            fputc(*text, out);
    }
}

static void put_text(FILE *out, double x, double y, const char *attributes, const char *text)
{
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, attributes);
    put_escaped(out, text);
    fputs("</text>\n", out);
}

static void put_line(FILE *out, double x0, double y0, double x1, double y1, const char *class)
{
    fprintf(out, "<line class=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n",
            class, x0, y0, x1, y1);
}

// Markers of one area, also told apart by their form: disc, square, triangle, diamond, in turn.
// They stand at (0,0).
static const char markers[] = "<circle id=\"m0\" r=\"3.4\"/>\n"
                              "<rect id=\"m1\" x=\"-3\" y=\"-3\" width=\"6\" height=\"6\"/>\n"
                              "<path id=\"m2\" d=\"M0,-4.4 L4,2.8 L-4,2.8 Z\"/>\n"
                              "<path id=\"m3\" d=\"M0,-4.3 L4.3,0 L0,4.3 L-4.3,0 Z\"/>\n";

static void put_marker(FILE *out, uint32_t group, double x, double y)
{
    fprintf(out, "<use href=\"#m%u\" class=\"g%u\" x=\"%.1f\" y=\"%.1f\"/>\n", group % FORMS,
            group, x, y);
}

static void begin(FILE *out, uint32_t groups)
{
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
            "viewBox=\"0 0 %d %d\">\n<style>\n"
            "text { font: 13px 'DejaVu Sans', 'Helvetica Neue', Arial, sans-serif; "
            "fill: #222; }\n"
            ".title { font-size: 17px; font-weight: bold; }\n"
            ".tick { font-size: 11px; fill: #555; }\n"
            ".grid { stroke: #e6e6e6; }\n"
            ".axis { stroke: #9a9a9a; }\n"
            ".same { stroke: #333; stroke-width: 1.2; stroke-dasharray: 6 4; }\n",
            WIDTH, HEIGHT, WIDTH, HEIGHT);
    for (uint32_t g = 0; g < groups; g++)
        fprintf(out, ".g%u { fill: %s; fill-opacity: 0.55; stroke: %s; stroke-width: 0.6; }\n",
                g, colours[g], colours[g]);
    fprintf(out,
            "</style>\n<defs>\n%s</defs>\n"
            "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n",
            markers, WIDTH, HEIGHT);
}

static void put_tick(const canvas *c, double value)
{
    if (scaled(c, value) < c->low || scaled(c, value) > c->high) return;
    char text[32];
    double x = across(c, value), y = down(c, value);
    const char *class = value == 0 ? "axis" : "grid";
    put_line(c->out, x, TOP, x, TOP + SIDE, class);
    put_line(c->out, LEFT, y, LEFT + SIDE, y, class);
    snprintf(text, sizeof text, "%s%g", value < 0 ? "\u2212" : "", fabs(value));
    put_text(c->out, x, TOP + SIDE + 17, "class=\"tick\" text-anchor=\"middle\"", text);
    put_text(c->out, LEFT - 8, y + 4, "class=\"tick\" text-anchor=\"end\"", text);
}

static void put_axes(const canvas *c, const prom_scatter *plot)
{
    static const double steps[3] = {1, 2, 5};
    char attributes[128];
    bool fine = c->high - c->low < asinh(pow(10.0, FINE_DECADES));
    put_tick(c, 0);
    for (double value = c->linear; scaled(c, value) < fmax(c->high, -c->low); value *= 10)
        for (int i = 0; i < (fine ? 3 : 1); i++) {
            put_tick(c, steps[i] * value);
            put_tick(c, -steps[i] * value);
        }
    fprintf(c->out,
            "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" "
            "stroke=\"#9a9a9a\"/>\n",
            LEFT, TOP, SIDE, SIDE);
    put_line(c->out, LEFT, TOP + SIDE, LEFT + SIDE, TOP, "same");
    put_text(c->out, LEFT + SIDE / 2.0, TOP + SIDE + 44, "text-anchor=\"middle\"",
             plot->x_label);
    snprintf(attributes, sizeof attributes,
             "text-anchor=\"middle\" transform=\"rotate(-90 20 %g)\"", TOP + SIDE / 2.0);
    put_text(c->out, 20, TOP + SIDE / 2.0, attributes, plot->y_label);
}

static void put_points(const canvas *c, const prom_scatter *plot)
{
    for (size_t i = 0; i < plot->count; i++) {
        const prom_scatter_point *p = &plot->points[i];
        put_marker(c->out, p->group, across(c, p->x), down(c, p->y));
    }
}

static void put_legend(FILE *out, const prom_scatter *plot)
{
    double y = TOP + 14;
    for (uint32_t g = 0; g < plot->group_count; g++, y += 22) {
        put_marker(out, g, LEGEND + 5, y - 4);
        put_text(out, LEGEND + 16, y, "", plot->groups[g]);
    }
}

// Both axes reach over all values, 0 and the linear part, to both sides if values do.
static canvas canvas_of(const prom_scatter *plot, FILE *out)
{
    double least = 0, most = plot->linear;
    for (size_t i = 0; i < plot->count; i++) {
        const prom_scatter_point *p = &plot->points[i];
        least = fmin(least, fmin(p->x, p->y));
        most = fmax(most, fmax(p->x, p->y));
    }
    if (least < 0) least = fmin(least, -plot->linear);
    canvas c = {.out = out, .linear = plot->linear};
    double low = scaled(&c, least), high = scaled(&c, most), margin = MARGIN * (high - low);
    c.low = low - margin;
    c.high = high + margin;
    return c;
}

void prom_scatter_write(const prom_scatter *plot, FILE *out)
{
    const canvas c = canvas_of(plot, out);
    begin(out, plot->group_count);
    put_text(out, LEFT, 32, "class=\"title\"", plot->title);
    put_text(out, LEFT, 54, "class=\"tick\"", plot->subtitle);
    put_axes(&c, plot);
    put_points(&c, plot);
    put_legend(out, plot);
    fputs("</svg>\n", out);
}

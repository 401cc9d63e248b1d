#include "scenes/gallery_texture.h"

#include <math.h>
#include <stddef.h>

#define PI 3.14159265f

typedef prom_gallery_color color;
typedef color (*shader)(float x, float y); // picture coordinates in [0,1), y down

static int wrap(int i, int period)
{
    return (i % period + period) % period;
}

// Distance to the border of the unit cell that a coordinate is in, in cells.
static float border(float t)
{
    t -= floorf(t);
    return fminf(t, 1 - t);
}

// ---- floors

// Planed wood: `along` runs with the grain; both in cells of one picture.
static color plank(float along, float across, int id, color dark, color light)
{
    float tone = prom_noise_cell(id, 7, 3);
    float grain = prom_noise_tile(along * 0.25f + tone, across * 3, 32, 11) * 0.5f +
                  prom_noise_tile(along + tone, across * 2, 64, 12) * 0.5f;
    return prom_color_mix(dark, light, 0.20f + 0.5f * tone + 0.45f * (grain - 0.5f));
}

// Herringbone on a grid of 8 x 8 cells: each step of the stair is a plank of four cells.
static color herringbone(float x, float y)
{
    const color dark = prom_color_rgb(0xa0703e), light = prom_color_rgb(0xd8ab70);
    float u = x * 8, v = y * 8;
    int i = (int)u, j = (int)v, phase = wrap(i - j, 8);
    bool lies = phase < 4;
    int start = lies ? i - phase : j - (7 - phase);
    float along = lies ? (u - (float)start) / 4 : (v - (float)start) / 4;
    float across = lies ? v - (float)j : u - (float)i;
    int id = lies ? wrap(start, 8) * 16 + j : 200 + wrap(start, 8) * 16 + i;
    color c = lies ? plank(x, y, id, dark, light) : plank(y, x, id, dark, light);
    float edge = fminf(border(across), 4 * fminf(along, 1 - along));
    return prom_color_shade(c, edge < 0.045f ? 0.66f : 1);
}

// Square panels: a frame, and boards laid crosswise within.
static color panels(float x, float y)
{
    const color dark = prom_color_rgb(0x8a5c34), light = prom_color_rgb(0xc99a62);
    float u = x * 2 - floorf(x * 2), v = y * 2 - floorf(y * 2);
    int px = (int)(x * 2), py = (int)(y * 2);
    float edge = fminf(border(u), border(v));
    bool upright = border(u) < border(v);
    if (edge < 0.09f) {
        color c =
            upright ? plank(y, x, 10 + px, dark, light) : plank(x, y, 20 + py, dark, light);
        return prom_color_shade(c, edge < 0.008f || edge > 0.084f ? 0.62f : 0.92f);
    }
    float s = (u + v) * 4, t = (u - v) * 4;
    bool lies = ((px + py) & 1) == 0;
    int id = (int)floorf(lies ? s : t) + 40 * (px + 2 * py) + 100;
    color c = plank(lies ? t * 0.12f : s * 0.12f, lies ? s * 0.1f : t * 0.1f, id, dark, light);
    return prom_color_shade(c, border(lies ? s : t) < 0.04f ? 0.68f : 1);
}

static color boards(float x, float y)
{
    const color dark = prom_color_rgb(0x8f6b49), light = prom_color_rgb(0xcfae84);
    int row = (int)(y * 8);
    float u = x * 2 + prom_noise_cell(row, 1, 5), edge = border(y * 8);
    int id = row * 4 + wrap((int)floorf(u), 2);
    color c = plank(x, y, id, dark, light);
    return prom_color_shade(c, edge < 0.035f || border(u) < 0.006f ? 0.62f : 1);
}

static float veins(float x, float y, uint32_t seed)
{
    float bend = prom_noise_rough(x, y, 4, seed);
    float line = fabsf(prom_noise_tile(x + 0.3f * bend, y + 0.2f * bend, 5, seed + 7) - 0.5f);
    return (1 - prom_noise_step(0, 0.09f, line)) * (0.4f + bend);
}

static color checker(float x, float y)
{
    float u = x * 4, v = y * 4;
    bool dark = (((int)u + (int)v) & 1) == 1;
    float tone = prom_noise_cell((int)u, (int)v, 4) - 0.5f, vein = veins(x, y, 21);
    color c = dark ? prom_color_mix(prom_color_rgb(0x5b5f66), prom_color_rgb(0xb4b6b8), vein)
                   : prom_color_mix(prom_color_rgb(0xece6da), prom_color_rgb(0xb8ada0), vein);
    float edge = fminf(border(u), border(v));
    return prom_color_shade(c, (edge < 0.012f ? 0.75f : 1) + 0.06f * tone);
}

static color slabs(float x, float y)
{
    int row = (int)(y * 4);
    float u = x * 3 + (row % 2 ? 0.5f : 0), edge = fminf(border(u) / 3, border(y * 4) / 4);
    float tone = 0.84f + 0.07f * (prom_noise_cell(wrap((int)u, 3), row, 3) - 0.5f) +
                 0.10f * prom_noise_rough(x, y, 16, 4);
    return prom_color_shade((color){tone, tone * 0.965f, tone * 0.89f},
                            edge < 0.004f ? 0.7f : 1);
}

// Distance to the nearest and the second nearest centre of a hexagon grid tells the joint.
static color hexagons(float x, float y)
{
    float u = x * 8, v = y * 8;
    float nearest = 9, second = 9;
    int id = 0;
    for (int j = -1; j <= 2; j++) {
        for (int i = -1; i <= 1; i++) {
            int row = (int)floorf(v) + j, column = (int)floorf(u) + i;
            float cx = (float)column + (row & 1 ? 1.0f : 0.5f), cy = (float)row + 0.5f;
            float d = hypotf(u - cx, (v - cy) * 0.9f);
            if (d < nearest) {
                second = nearest;
                nearest = d;
                id = wrap(column, 8) * 8 + wrap(row, 8);
            } else {
                second = fminf(second, d);
            }
        }
    }
    static const uint32_t glazes[] = {0xb9694a, 0xc67c58, 0xa9583f, 0xd8c8ae, 0xb97252};
    color c = prom_color_rgb(glazes[(int)(prom_noise_cell(id, 3, 9) * 5)]);
    return prom_color_shade(c, (second - nearest < 0.06f ? 0.68f : 1) +
                                   0.16f * prom_noise_rough(x, y, 16, 2));
}

static color terrazzo(float x, float y)
{
    color c = prom_color_rgb(0xd9d3c8);
    for (int layer = 0; layer < 3; layer++) {
        int cells = 24 << layer;
        float v = prom_noise_tile(x, y, cells, 40 + (uint32_t)layer);
        static const uint32_t chips[] = {0x9a8f84, 0xb98a70, 0x77797c};
        c = prom_color_mix(c, prom_color_rgb(chips[layer]), prom_noise_step(0.72f, 0.78f, v));
    }
    float edge = fminf(border(x * 2), border(y * 2));
    return edge < 0.006f ? prom_color_rgb(0xa58b52) : c;
}

// ---- walls and stuffs

static color plaster(float x, float y)
{
    return prom_color_grey(0.95f + 0.05f * prom_noise_rough(x, y, 4, 1) +
                           0.03f * prom_noise_rough(x, y, 32, 2));
}

// Two offset rows of a leafy figure, woven.
static color damask(float x, float y)
{
    float u = x * 3, v = y * 2;
    float best = 0;
    for (int k = 0; k < 2; k++) {
        float a = u + 0.5f * (float)k, b = v + 0.5f * (float)k;
        a = 2 * (a - floorf(a)) - 1;
        b = 2 * (b - floorf(b)) - 1;
        float angle = atan2f(b, fabsf(a)), r = hypotf(a * 1.25f, b * 0.85f);
        float petal = 0.44f + 0.20f * cosf(6 * angle) + 0.10f * cosf(10 * angle + 8 * r);
        best =
            fmaxf(best, prom_noise_step(0, 0.07f, petal - r) * (0.75f + 0.25f * cosf(26 * r)));
    }
    float weave = 0.03f * (prom_noise_tile(x, y, 128, 3) - 0.5f);
    return prom_color_grey(0.86f + 0.14f * best + weave);
}

static color stripes(float x, float y)
{
    float s = prom_noise_step(-0.15f, 0.15f, sinf(2 * PI * x * 6));
    float line = fabsf(border(x * 6) - 0.25f) < 0.03f ? 0.05f : 0;
    return prom_color_grey(0.88f + 0.10f * s - line + 0.04f * prom_noise_rough(x, y, 32, 8));
}

static color ashlar(float x, float y)
{
    int row = (int)(y * 4);
    float u = x * 2 + (row % 2 ? 0.5f : 0), edge = fminf(border(u) / 2, border(y * 4) / 4);
    float tone = 0.94f + 0.06f * (prom_noise_cell(wrap((int)u, 2), row, 6) - 0.5f) +
                 0.10f * prom_noise_rough(x, y, 12, 3);
    return prom_color_shade((color){tone, tone * 0.97f, tone * 0.90f},
                            edge < 0.004f ? 0.86f : 1);
}

static color wood(float x, float y)
{
    float ring = prom_noise_tile(x * 0.5f, y, 4, 1) * 6 + y * 10;
    float tone = 0.84f + 0.10f * sinf(2 * PI * ring) * 0.5f +
                 0.22f * (prom_noise_tile(x * 0.125f, y, 64, 2) - 0.5f);
    return (color){tone, tone * 0.97f, tone * 0.93f};
}

static color marble(float x, float y)
{
    float v = 0.6f * veins(x, y, 31) + 0.3f * veins(y, x, 57);
    return prom_color_grey(0.97f - 0.22f * fmaxf(v, 0) + 0.06f * prom_noise_rough(x, y, 5, 9));
}

static color metal(float x, float y)
{
    return prom_color_grey(0.88f + 0.20f * prom_noise_rough(x, y, 6, 4) +
                           0.10f * prom_noise_rough(x, y, 40, 5));
}

static color fabric(float x, float y)
{
    float weave = 0.05f * sinf(2 * PI * x * 32) + 0.05f * sinf(2 * PI * y * 32);
    return prom_color_grey(0.90f + weave + 0.08f * prom_noise_rough(x, y, 8, 6));
}

// A rug once over the picture: borders, a field and a medallion.
static color carpet(float x, float y)
{
    float a = fabsf(x - 0.5f), b = fabsf(y - 0.5f), edge = 0.5f - fmaxf(a, b);
    color red = prom_color_rgb(0xa23a34), blue = prom_color_rgb(0x35476f),
          cream = prom_color_rgb(0xe2cfa4);
    float figure = sinf(a * 70) * sinf(b * 70);
    color c = prom_color_mix(red, blue, prom_noise_step(0.2f, 0.4f, figure) * 0.85f);
    float medal = a * 1.5f + b * 1.5f + 0.03f * cosf(24 * atan2f(b, a));
    if (medal < 0.34f) c = blue;
    if (medal < 0.31f) c = prom_color_mix(cream, red, prom_noise_step(0.1f, 0.2f, figure));
    if (medal < 0.12f) c = blue;
    if (edge < 0.13f) c = prom_color_mix(blue, cream, prom_noise_step(0.1f, 0.3f, figure));
    if (edge < 0.035f || (edge > 0.115f && edge < 0.13f)) c = red;
    if (edge < 0.012f) c = cream;
    return prom_color_shade(c, 1 + 0.25f * (prom_noise_tile(x, y, 128, 3) - 0.5f));
}

// A row of spines: the picture is a shelf wide and a shelf high.
static color books(float x, float y)
{
    static const uint32_t leathers[] = {0x7a3b2c, 0x5a4a32, 0x3f5446, 0x8a6a3c,
                                        0x49506a, 0x6d2f38, 0x9c8257, 0x4a3426};
    float u = x * 24, at = u - floorf(u);
    int id = (int)u;
    float top = 0.06f + 0.20f * prom_noise_cell(id, 2, 3);
    if (y < top) return prom_color_rgb(0x2b2019);
    color c = prom_color_rgb(leathers[(int)(prom_noise_cell(id, 5, 8) * 8)]);
    c = prom_color_shade(c, 0.75f + 0.5f * sinf(PI * at));
    float band = fabsf(y - top - 0.18f), low = fabsf(y - 0.82f);
    if (band < 0.015f || low < 0.012f) return prom_color_rgb(0xcaa65a);
    if (fabsf(y - top - 0.32f) < 0.06f && border(at) > 0.15f)
        c = prom_color_mix(c, prom_color_rgb(0xd8c39a), 0.6f * prom_noise_tile(x, y, 64, 3));
    return border(at) < 0.05f ? prom_color_shade(c, 0.5f) : c;
}

// ---- ceramics: y runs from the rim down

static color ceramic(float x, float y)
{
    float run = prom_noise_step(0.3f, 0.7f, y + 0.25f * prom_noise_rough(x, 0.5f, 8, 3));
    return prom_color_grey(0.95f - 0.28f * run + 0.10f * prom_noise_rough(x, y, 12, 9));
}

static color blue_white(float x, float y)
{
    color white = prom_color_rgb(0xeef0f2), blue = prom_color_rgb(0x2f4f9a);
    float u = x * 6 - floorf(x * 6) - 0.5f, v = y * 4 - floorf(y * 4) - 0.5f;
    float angle = atan2f(v, u), r = hypotf(u, v);
    float flower = prom_noise_step(0, 0.06f, 0.22f + 0.10f * cosf(5 * angle) - r);
    float vine = 1 - prom_noise_step(0.02f, 0.05f, fabsf(v - 0.3f * sinf(2 * PI * x * 6)));
    float band = border(y * 2) < 0.04f ? 1 : 0;
    return prom_color_mix(white, blue,
                          fminf(1, fmaxf(fmaxf(0.8f * flower, 0.7f * vine), band)));
}

// A meander between bands, black on fired clay.
static color red_figure(float x, float y)
{
    color clay = prom_color_rgb(0xcf7f4b), black = prom_color_rgb(0x2e2522);
    float u = x * 12 - floorf(x * 12), v = y * 3 - floorf(y * 3), w = v * 4 - 1;
    if (v < 0.25f || v > 0.5f) {
        bool petal = v > 0.5f && fabsf(u - 0.5f) < 0.35f * sinf(PI * (v - 0.5f) * 2);
        return petal ? clay : prom_color_shade(black, 1 + 0.2f * prom_noise_rough(x, y, 8, 2));
    }
    bool line = w < 0.14f || w > 0.86f || u < 0.14f ||
                (u < 0.72f && fabsf(w - 0.28f) < 0.07f) ||
                (fabsf(u - 0.65f) < 0.08f && w > 0.28f && w < 0.68f) ||
                (u > 0.35f && u < 0.72f && fabsf(w - 0.62f) < 0.07f);
    return line ? black : clay;
}

// A printed card.
static color label(float x, float y)
{
    color paper = prom_color_rgb(0xf4f1e8);
    int line = (int)(y * 9);
    float in = y * 9 - (float)line;
    float end = line == 1 ? 0.55f : 0.62f + 0.28f * prom_noise_cell(line, 3, 4);
    bool ink = line > 0 && line < 8 && line != 2 && x > 0.1f && x < end && in > 0.3f &&
               in < (line == 1 ? 0.8f : 0.62f) &&
               prom_noise_tile(x, (float)line / 9, 48, 5) > 0.3f;
    return ink ? prom_color_rgb(0x4a4744) : paper;
}

// ---- outside

static color grass(float x, float y)
{
    float blade = prom_noise_tile(x, y, 96, 7) - 0.5f, patch = prom_noise_rough(x, y, 4, 1);
    color green = {0.45f + 0.10f * patch, 0.57f + 0.07f * patch, 0.29f};
    return prom_color_shade(green, 1 + 0.35f * blade + 0.12f * prom_noise_rough(x, y, 12, 3));
}

static color gravel(float x, float y)
{
    float tone = 0.80f + 0.22f * (prom_noise_tile(x, y, 100, 2) - 0.5f) +
                 0.10f * prom_noise_rough(x, y, 6, 5);
    return (color){tone, tone * 0.95f, tone * 0.86f};
}

static color leaves(float x, float y)
{
    float a = prom_noise_tile(x, y, 24, 3), b = prom_noise_tile(x, y, 48, 4);
    color c = prom_color_mix(prom_color_rgb(0x3f5f2e), prom_color_rgb(0x8fae58), a);
    return prom_color_shade(c, 0.70f + 0.6f * b * a + 0.15f);
}

// From the zenith (top row) to the horizon, all around.
static color sky(float x, float y)
{
    color c = prom_color_mix(prom_color_rgb(0x6f9fd8), prom_color_rgb(0xdce8f0),
                             prom_noise_step(0, 1, y));
    float cloud = prom_noise_rough(x, y, 5, 17) + 0.5f * prom_noise_rough(x, y, 16, 23);
    float amount = prom_noise_step(0.02f, 0.30f, cloud) * prom_noise_step(0, 0.25f, y);
    return prom_color_mix(c, prom_color_rgb(0xfdfcf8), 0.85f * amount);
}

static const struct {
    const char *name;
    uint32_t size;
    shader draw;
} textures[PROM_GALLERY_TEXTURE_COUNT] = {
    [PROM_GALLERY_PLAIN] = {"plain", 0, NULL},
    [PROM_GALLERY_HERRINGBONE] = {"herringbone", 512, herringbone},
    [PROM_GALLERY_PANELS] = {"panels", 512, panels},
    [PROM_GALLERY_BOARDS] = {"boards", 512, boards},
    [PROM_GALLERY_CHECKER] = {"checker", 512, checker},
    [PROM_GALLERY_SLABS] = {"slabs", 512, slabs},
    [PROM_GALLERY_HEXAGONS] = {"hexagons", 512, hexagons},
    [PROM_GALLERY_TERRAZZO] = {"terrazzo", 512, terrazzo},
    [PROM_GALLERY_PLASTER] = {"plaster", 256, plaster},
    [PROM_GALLERY_DAMASK] = {"damask", 256, damask},
    [PROM_GALLERY_STRIPES] = {"stripes", 256, stripes},
    [PROM_GALLERY_ASHLAR] = {"ashlar", 256, ashlar},
    [PROM_GALLERY_WOOD] = {"wood", 256, wood},
    [PROM_GALLERY_MARBLE] = {"marble", 256, marble},
    [PROM_GALLERY_METAL] = {"metal", 256, metal},
    [PROM_GALLERY_FABRIC] = {"fabric", 256, fabric},
    [PROM_GALLERY_CARPET] = {"carpet", 256, carpet},
    [PROM_GALLERY_BOOKS] = {"books", 256, books},
    [PROM_GALLERY_CERAMIC] = {"ceramic", 256, ceramic},
    [PROM_GALLERY_BLUE_WHITE] = {"blue_white", 256, blue_white},
    [PROM_GALLERY_RED_FIGURE] = {"red_figure", 256, red_figure},
    [PROM_GALLERY_LABEL] = {"label", 64, label},
    [PROM_GALLERY_GRASS] = {"grass", 256, grass},
    [PROM_GALLERY_GRAVEL] = {"gravel", 256, gravel},
    [PROM_GALLERY_LEAVES] = {"leaves", 256, leaves},
    [PROM_GALLERY_SKY] = {"sky", 512, sky},
};

const char *prom_gallery_texture_name(prom_gallery_texture texture)
{
    return textures[texture].name;
}

uint32_t prom_gallery_texture_size(prom_gallery_texture texture)
{
    return textures[texture].size;
}

static uint8_t encode(float v)
{
    return (uint8_t)(255 * fminf(fmaxf(v, 0), 1) + 0.5f);
}

void prom_gallery_texture_draw(prom_gallery_texture texture, uint32_t size, uint8_t *rgb)
{
    for (uint32_t y = 0; y < size; y++) {
        for (uint32_t x = 0; x < size; x++) {
            color c = textures[texture].draw(((float)x + 0.5f) / (float)size,
                                             ((float)y + 0.5f) / (float)size);
            *rgb++ = encode(c.r);
            *rgb++ = encode(c.g);
            *rgb++ = encode(c.b);
        }
    }
}

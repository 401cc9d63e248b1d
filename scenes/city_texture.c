#include "scenes/city_texture.h"

#include "scenes/city_color.h"

#include <string.h>

typedef color (*shader)(float x, float y); // picture coordinates in [0,1), y down

// ---- walls and roofs

// Courses of blocks, every other one shifted by half; `joint` in the unit of the picture's
// width.
static color masonry(float x, float y, int columns, int rows, float joint, float variation)
{
    int row = (int)(y * (float)rows);
    float u = x * (float)columns + (row % 2 ? 0.5f : 0);
    int column = wrap((int)floorf(u), columns);
    float edge = fminf(border(u) / (float)columns, border(y * (float)rows) / (float)rows);
    float tone =
        0.93f + variation * (cell_random(column, row, 5) - 0.5f) + 0.10f * rough(x, y, 16, 9);
    color block = {tone, tone * (0.97f + 0.04f * cell_random(column, row, 6)), tone * 0.97f, 1};
    return edge < joint ? grey(0.93f + 0.06f * rough(x, y, 16, 3)) : block;
}

static color brick(float x, float y)
{
    return masonry(x, y, 6, 16, 0.006f, 0.30f);
}

static color stone(float x, float y)
{
    return shade(masonry(x, y, 3, 6, 0.007f, 0.14f), 0.98f);
}

static color plaster(float x, float y)
{
    return grey(0.92f + 0.09f * rough(x, y, 4, 1) + 0.05f * rough(x, y, 24, 2));
}

// Rows of pantiles: a wave across, a shadow under each row's lower edge.
static color tiles(float x, float y)
{
    int row = (int)(y * 8);
    float u = x * 10, v = y * 8 - (float)row;
    float tone =
        0.88f + 0.16f * sinf(2 * PI * u) + 0.16f * (cell_random((int)u, row, 3) - 0.5f);
    tone *= v > 0.88f ? 0.6f : 0.93f + 0.07f * v;
    return grey(fminf(tone + 0.08f * rough(x, y, 16, 4), 1));
}

static color slate(float x, float y)
{
    int row = (int)(y * 10);
    float u = x * 8 + (row % 2 ? 0.5f : 0), v = y * 10 - (float)row;
    float tone = 0.88f + 0.22f * (cell_random(wrap((int)u, 8), row, 3) - 0.5f);
    if (border(u) < 0.05f || v > 0.88f) tone *= 0.6f;
    return grey(tone + 0.08f * rough(x, y, 16, 4));
}

static color wood(float x, float y)
{
    float grain = 0.5f * noise(x * 4, y * 0.5f, 16, 1) + 0.5f * noise(x * 8, y, 16, 2);
    float tone =
        0.80f + 0.22f * (grain - 0.5f) + 0.08f * (cell_random((int)(x * 6), 0, 3) - 0.5f);
    return grey(border(x * 6) < 0.05f ? tone * 0.65f : tone);
}

static color awning(float x, float y)
{
    float stripe = (int)(x * 8) % 2 ? 1.0f : 0.0f;
    return shade(mix(grey(0.96f), (color){0.70f, 0.16f, 0.14f, 1}, stripe),
                 0.97f + 0.06f * rough(x, y, 8, 1));
}

// ---- the ground

static color asphalt(float x, float y)
{
    float speck = noise(x, y, 64, 7) - 0.5f;
    return shade((color){0.34f, 0.345f, 0.355f, 1},
                 1 + 0.18f * rough(x, y, 5, 1) + 0.22f * speck);
}

static color painted(color ground, float x, float y, uint32_t seed)
{
    return mix(ground, grey(0.84f), 0.80f + 0.35f * rough(x, y, 32, seed));
}

// The whole carriageway across: a dashed line in its middle, worn tracks, gutters.
static color lane(float x, float y)
{
    color c = asphalt(x, y);
    float track = fabsf(fabsf(x - 0.5f) - 0.13f);
    c = shade(c, 1 - 0.10f * fmaxf(0, 1 - track * 12));
    float dash = 2 * y - floorf(2 * y);
    if (fabsf(x - 0.5f) < 0.0075f && dash < 0.55f) c = painted(c, x, y, 2);
    if (x < 0.02f || x > 0.98f) c = shade(c, 0.78f);
    return c;
}

// The same with bays for parked cars along both sides: two in a picture's length.
static color road(float x, float y)
{
    color c = lane(x, y);
    float side = fminf(x, 1 - x), bay = 2 * y - floorf(2 * y);
    bool tick = side < 0.26f && side > 0.20f && fminf(bay, 1 - bay) < 0.011f;
    if (tick || fabsf(side - 0.26f) < 0.006f) c = painted(c, x, y, 4);
    return c;
}

static color zebra(float x, float y)
{
    float u = x * 7;
    bool stripe = u - floorf(u) > 0.25f && u - floorf(u) < 0.8f;
    color c = asphalt(x, y);
    return stripe ? mix(c, grey(0.88f), 0.82f + 0.35f * rough(x, y, 24, 2)) : c;
}

static color paving(float x, float y)
{
    int row = (int)(y * 4);
    float u = x * 4 + (row % 2 ? 0.5f : 0);
    float edge = fminf(border(u), border(y * 4));
    float tone = 0.64f + 0.09f * (cell_random(wrap((int)u, 4), row, 3) - 0.5f) +
                 0.08f * rough(x, y, 16, 4);
    return shade((color){tone, tone * 0.985f, tone * 0.95f, 1}, edge < 0.025f ? 0.72f : 1);
}

static color cobbles(float x, float y)
{
    int row = (int)(y * 16);
    float u = x * 16 + (row % 2 ? 0.5f : 0);
    float dx = border(u), dy = border(y * 16);
    float tone = 0.50f + 0.20f * (cell_random(wrap((int)u, 16), row, 3) - 0.5f);
    tone *= 0.62f + 0.38f * fminf(1, 6 * fminf(dx, dy)) + 0.1f * rough(x, y, 32, 4);
    return (color){tone * 1.02f, tone, tone * 0.97f, 1};
}

static color grass(float x, float y)
{
    float blade = noise(x, y, 48, 7) - 0.5f, patch = rough(x, y, 4, 1);
    color green = {0.39f + 0.08f * patch, 0.47f + 0.05f * patch, 0.25f, 1};
    return shade(green, 1 + 0.45f * blade + 0.15f * rough(x, y, 12, 3));
}

static color gravel(float x, float y)
{
    float tone = 0.66f + 0.22f * (noise(x, y, 56, 7) - 0.5f) + 0.10f * rough(x, y, 6, 1);
    return (color){tone, tone * 0.93f, tone * 0.80f, 1};
}

// Ripples across the flow, the sky in some of them.
static color water(float x, float y)
{
    float wave = rough(x, 2 * y, 6, 1), fine = noise(x, 3 * y, 24, 5) - 0.5f;
    color deep = {0.20f, 0.31f, 0.31f, 1}, sky = {0.42f, 0.53f, 0.57f, 1};
    return mix(deep, sky, fminf(fmaxf(0.34f + 0.42f * wave + 0.35f * fine, 0), 1));
}

// Rows of crops or vines, earth between them.
static color rows(float x, float y)
{
    float row = fabsf(sinf(6 * PI * x + 0.5f * rough(x, y, 6, 8)));
    color earth = shade((color){0.58f, 0.49f, 0.34f, 1}, 1 + 0.3f * rough(x, y, 16, 2));
    color green = shade((color){0.58f, 0.62f, 0.30f, 1}, 1 + 0.5f * rough(x, y, 24, 5));
    return mix(earth, green, fminf(1, 1.7f * row));
}

// ---- plants

static color bark(float x, float y)
{
    float ridge = noise(x * 4, y, 8, 1) - 0.5f;
    return shade((color){0.40f, 0.32f, 0.25f, 1}, 1 + 0.7f * ridge + 0.3f * rough(x, y, 8, 2));
}

// Flakes of three tones, as on a plane tree.
static color plane_bark(float x, float y)
{
    float patch = noise(x, y, 7, 3) + 0.35f * noise(x, y, 19, 4);
    color c = patch > 0.80f   ? (color){0.68f, 0.65f, 0.50f, 1}
              : patch > 0.55f ? (color){0.53f, 0.50f, 0.38f, 1}
                              : (color){0.42f, 0.40f, 0.31f, 1};
    return shade(c, 1 + 0.2f * rough(x, y, 12, 2));
}

static color birch(float x, float y)
{
    float mark = noise(x, y * 4, 8, 1);
    color c = shade((color){0.86f, 0.85f, 0.81f, 1}, 1 + 0.1f * rough(x, y, 8, 2));
    return mark > 0.76f ? shade(c, 0.35f) : c;
}

// Leaves scattered over the picture: each an ellipse with a lighter rib; the topmost shows.
static color leaves(float x, float y, int count, float length, float width, color dark,
                    color light)
{
    color c = mix(dark, light, 0.35f);
    c.a = 0;
    for (int i = 0; i < count; i++) {
        float angle = 2 * PI * cell_random(i, 0, 11), r = 0.40f * sqrtf(cell_random(i, 1, 11));
        float around = 2 * PI * cell_random(i, 2, 11);
        float dx = x - 0.5f - r * cosf(around), dy = y - 0.5f - r * sinf(around);
        float u = (dx * cosf(angle) + dy * sinf(angle)) / length;
        float v = (dy * cosf(angle) - dx * sinf(angle)) / width;
        // Pointed at both ends: the width falls with u^2.
        float taper = 1 - u * u;
        if (fabsf(u) >= 1 || fabsf(v) >= taper) continue;
        c = mix(dark, light, cell_random(i, 3, 11));
        if (fabsf(v) < 0.12f) c = shade(c, 1.18f);
        c = shade(c, v > 0 ? 1.0f : 0.86f);
        c.a = 1;
    }
    return c;
}

static color leaves_broad(float x, float y)
{
    return leaves(x, y, 46, 0.13f, 0.062f, (color){0.19f, 0.33f, 0.12f, 1},
                  (color){0.48f, 0.60f, 0.26f, 1});
}

static color leaves_small(float x, float y)
{
    return leaves(x, y, 85, 0.075f, 0.040f, (color){0.27f, 0.37f, 0.12f, 1},
                  (color){0.58f, 0.66f, 0.30f, 1});
}

static color leaves_red(float x, float y)
{
    return leaves(x, y, 46, 0.13f, 0.062f, (color){0.26f, 0.10f, 0.12f, 1},
                  (color){0.55f, 0.22f, 0.20f, 1});
}

// Long hanging leaves, one above the other.
static color leaves_hanging(float x, float y)
{
    color c = {0.50f, 0.56f, 0.28f, 0};
    for (int i = 0; i < 60; i++) {
        float lx = cell_random(i, 0, 21), ly = cell_random(i, 1, 21);
        float dx = x - (0.12f + 0.76f * lx) - 0.05f * sinf(7 * y + 6 * lx);
        float dy = (y - (0.08f + 0.84f * ly)) / 0.10f;
        if (fabsf(dy) >= 1 || fabsf(dx) >= 0.022f * (1 - dy * dy)) continue;
        c = mix((color){0.34f, 0.42f, 0.18f, 1}, (color){0.64f, 0.69f, 0.38f, 1},
                cell_random(i, 2, 21));
        c.a = 1;
    }
    return c;
}

// A fir branch from the lower edge's middle to the top: a stem with needles to both sides.
static color needles(float x, float y)
{
    float side = x - 0.5f, along = 1 - y;
    float reach = 0.47f * (1 - along) * (0.25f + fminf(1, along * 5)) + 0.02f;
    float comb = along - 0.55f * fabsf(side); // needles lean forward
    float needle = fabsf(comb * 30 - floorf(comb * 30) - 0.5f);
    bool in = fabsf(side) < 0.018f ||
              (fabsf(side) < reach && needle < 0.36f - 0.10f * fabsf(side) / reach);
    float tone = 0.8f + 0.5f * cell_random((int)floorf(comb * 30), side > 0, 3);
    color c = shade((color){0.13f, 0.25f, 0.15f, 1}, tone + 0.5f * fabsf(side));
    if (fabsf(side) < 0.018f) c = (color){0.30f, 0.23f, 0.16f, 1};
    c.a = in ? 1 : 0;
    return c;
}

// ---- windows: what is behind the glass, the sky's reflection above

static color glass(float x, float y)
{
    color c = mix((color){0.36f, 0.43f, 0.50f, 1}, (color){0.13f, 0.16f, 0.20f, 1},
                  fminf(1, y * 1.4f));
    return shade(c, 1 + 0.10f * sinf(9 * (x + 0.7f * y)));
}

static color window_curtain(float x, float y)
{
    float reach = 0.30f - 0.10f * y;
    if (fminf(x, 1 - x) > reach && y > 0.12f) return glass(x, y);
    return shade((color){0.80f, 0.78f, 0.72f, 1}, 0.82f + 0.14f * sinf(x * 70));
}

static color window_warm(float x, float y)
{
    color lit = mix((color){0.93f, 0.78f, 0.48f, 1}, (color){0.55f, 0.40f, 0.24f, 1}, y);
    return mix(lit, glass(x, y), fminf(x, 1 - x) < 0.12f ? 0.7f : 0.25f);
}

// A wide pane: a room's ceiling and back wall, dimly, and the sky.
static color window_wide(float x, float y)
{
    color room = mix((color){0.55f, 0.50f, 0.42f, 1}, (color){0.20f, 0.19f, 0.19f, 1},
                     fminf(1, 2.2f * fabsf(y - 0.18f)));
    if (x < 0.16f || x > 0.87f) room = (color){0.72f, 0.70f, 0.66f, 1};
    return shade(mix(glass(x, y), room, 0.62f), 1.15f);
}

// ---- the table

static const struct {
    const char *name;
    uint32_t size;
    bool masked;
    shader shade;
} textures[PROM_CITY_TEXTURE_COUNT] = {
    [PROM_CITY_PLAIN] = {"plain", 0, false, NULL},
    [PROM_CITY_BRICK] = {"brick", 256, false, brick},
    [PROM_CITY_PLASTER] = {"plaster", 128, false, plaster},
    [PROM_CITY_STONE] = {"stone", 256, false, stone},
    [PROM_CITY_TILES] = {"tiles", 256, false, tiles},
    [PROM_CITY_SLATE] = {"slate", 128, false, slate},
    [PROM_CITY_WOOD] = {"wood", 128, false, wood},
    [PROM_CITY_ASPHALT] = {"asphalt", 128, false, asphalt},
    [PROM_CITY_ROAD] = {"road", 512, false, road},
    [PROM_CITY_LANE] = {"lane", 512, false, lane},
    [PROM_CITY_ZEBRA] = {"zebra", 128, false, zebra},
    [PROM_CITY_PAVING] = {"paving", 128, false, paving},
    [PROM_CITY_COBBLES] = {"cobbles", 256, false, cobbles},
    [PROM_CITY_GRASS] = {"grass", 256, false, grass},
    [PROM_CITY_GRAVEL] = {"gravel", 128, false, gravel},
    [PROM_CITY_BARK] = {"bark", 128, false, bark},
    [PROM_CITY_ROWS] = {"rows", 128, false, rows},
    [PROM_CITY_PLANE_BARK] = {"plane_bark", 128, false, plane_bark},
    [PROM_CITY_BIRCH] = {"birch", 128, false, birch},
    [PROM_CITY_WINDOW_DARK] = {"window_dark", 64, false, glass},
    [PROM_CITY_WINDOW_CURTAIN] = {"window_curtain", 128, false, window_curtain},
    [PROM_CITY_WINDOW_WARM] = {"window_warm", 64, false, window_warm},
    [PROM_CITY_AWNING] = {"awning", 64, false, awning},
    [PROM_CITY_WINDOW_WIDE] = {"window_wide", 64, false, window_wide},
    [PROM_CITY_WATER] = {"water", 256, false, water},
    [PROM_CITY_SIGNS] = {"signs", 256, false, prom_city_sign_color},
    [PROM_CITY_CLOCK] = {"clock", 128, false, prom_city_clock_color},
    [PROM_CITY_POSTERS] = {"posters", 128, false, prom_city_poster_color},
    [PROM_CITY_LEAVES_BROAD] = {"leaves_broad", 128, true, leaves_broad},
    [PROM_CITY_LEAVES_SMALL] = {"leaves_small", 128, true, leaves_small},
    [PROM_CITY_LEAVES_RED] = {"leaves_red", 128, true, leaves_red},
    [PROM_CITY_LEAVES_HANGING] = {"leaves_hanging", 128, true, leaves_hanging},
    [PROM_CITY_NEEDLES] = {"needles", 128, true, needles},
};

const char *prom_city_texture_name(prom_city_texture texture)
{
    return textures[texture].name;
}

uint32_t prom_city_texture_size(prom_city_texture texture)
{
    return textures[texture].size;
}

bool prom_city_texture_masked(prom_city_texture texture)
{
    return textures[texture].masked;
}

static uint8_t to_byte(float v)
{
    return (uint8_t)(fminf(fmaxf(v, 0), 1) * 255 + 0.5f);
}

void prom_city_texture_draw(prom_city_texture texture, uint8_t *rgba)
{
    uint32_t size = textures[texture].size;
    for (uint32_t y = 0; y < size; y++) {
        for (uint32_t x = 0; x < size; x++, rgba += 4) {
            color c = textures[texture].shade(((float)x + 0.5f) / (float)size,
                                              ((float)y + 0.5f) / (float)size);
            rgba[0] = to_byte(c.r);
            rgba[1] = to_byte(c.g);
            rgba[2] = to_byte(c.b);
            rgba[3] = to_byte(c.a);
        }
    }
}

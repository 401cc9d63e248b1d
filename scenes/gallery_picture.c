// Paintings. Each painter works on coordinates of [0,1], y down, with x stretched by the
// aspect, and layers soft shapes from back to front.
#include "scenes/gallery_texture.h"

#include "scenes/random.h"

#include <math.h>

#define PI 3.14159265f

typedef prom_gallery_color color;

typedef struct canvas {
    float aspect;
    uint32_t noise; // seed of its noise
    color palette[6];
    float number[24]; // in [0,1): each painter's choices
} canvas;

typedef color (*painter)(const canvas *c, float x, float y);

static const uint32_t palettes[][6] = {
    {0x27364a, 0x5f7f94, 0xc8d4cf, 0xd9a860, 0xa8532e, 0x3d4a2c},
    {0x40263a, 0x8e4a55, 0xe0a07a, 0xf3dfae, 0x55708a, 0x2c3140},
    {0x2e4a3a, 0x6d8f5a, 0xd8d8a0, 0xf0e8d0, 0xb8763a, 0x44301f},
    {0x1f3a63, 0x3f76ae, 0xf2e6c8, 0xe9b93c, 0xc4372c, 0x1b1d24},
    {0x553322, 0xa06a3c, 0xe0bb80, 0xf5ead2, 0x6e8088, 0x2a2320},
    {0x4b5a78, 0xa8b6cc, 0xf0e2e0, 0xe8b8a8, 0x7a5a66, 0x30343f},
};

static float soft(float distance, float width)
{
    return prom_noise_step(-width, width, -distance);
}

static float rough(const canvas *c, float x, float y, int cells, uint32_t layer)
{
    // Coordinates may leave the unit square: the noise repeats there.
    return prom_noise_rough(x, y, cells, c->noise + 16 * layer);
}

// ---- landscapes

static color paint_sky(const canvas *c, float x, float y, float horizon)
{
    color sky = prom_color_mix(c->palette[1], c->palette[2],
                               prom_noise_step(0, horizon, y + 0.1f * rough(c, x, y, 4, 1)));
    float cloud = rough(c, x * 0.6f, y * 1.7f, 4, 2) * 1.4f + c->number[0] * 0.3f;
    sky = prom_color_mix(sky, c->palette[3], 0.8f * prom_noise_step(0.05f, 0.4f, cloud));
    float sun =
        hypotf(x - c->number[1] * c->aspect, y - horizon * (0.3f + 0.5f * c->number[2]));
    return prom_color_mix(sky, prom_color_rgb(0xfff3d0), soft(sun - 0.05f, 0.05f));
}

static color landscape(const canvas *c, float x, float y)
{
    float horizon = 0.42f + 0.2f * c->number[3];
    color out = paint_sky(c, x, y, horizon);
    for (int ridge = 0; ridge < 4; ridge++) {
        float depth = (float)ridge / 3;
        float top = horizon - 0.16f + 0.13f * (float)ridge +
                    (0.30f - 0.15f * depth) *
                        rough(c, x * 0.5f + (float)ridge * 0.37f, 0.5f, 3 + 2 * ridge, 5);
        color land = prom_color_mix(prom_color_mix(c->palette[1], c->palette[2], 0.5f),
                                    c->palette[5], 0.2f + 0.75f * depth);
        land = prom_color_mix(land, c->palette[3],
                              fmaxf(0, 0.7f * rough(c, x, y * 2, 10, 6)) * depth);
        out = prom_color_mix(out, land, soft(top - y, 0.006f));
    }
    if (c->number[4] > 0.45f) { // water in the middle
        float lake = fabsf(y - horizon - 0.20f) - 0.05f - 0.12f * rough(c, x, 0.3f, 3, 7);
        color water = paint_sky(c, x + 0.05f * rough(c, x, y * 8, 8, 8),
                                fmaxf(0, 2 * horizon - y), horizon);
        out = prom_color_mix(out, prom_color_shade(water, 0.88f), soft(lake, 0.008f));
    }
    for (int tree = 0; tree < 5; tree++) {
        float at = c->aspect * prom_noise_cell(tree, 1, c->noise);
        float size = 0.07f + 0.13f * prom_noise_cell(tree, 2, c->noise);
        float foot = horizon + 0.25f + 0.2f * prom_noise_cell(tree, 3, c->noise);
        float crown = hypotf(x - at, (y - foot + 1.6f * size) * 0.8f) - size +
                      0.12f * rough(c, x * 2, y * 2, 8, 9);
        bool trunk = fabsf(x - at) < 0.012f && y > foot - 1.5f * size && y < foot;
        if (trunk) out = prom_color_shade(c->palette[5], 0.7f);
        float light = 0.5f + (at - x - y + foot - 1.6f * size) * 2;
        out = prom_color_mix(out,
                             prom_color_mix(prom_color_shade(c->palette[5], 0.9f),
                                            c->palette[3], 0.45f * fminf(fmaxf(light, 0), 1)),
                             0.95f * soft(crown, 0.02f));
    }
    return out;
}

static color seascape(const canvas *c, float x, float y)
{
    float horizon = 0.38f + 0.2f * c->number[3];
    color out = paint_sky(c, x, y, horizon);
    if (y > horizon) {
        float near = (y - horizon) / (1 - horizon);
        float wave = rough(c, x * (2.2f - 1.4f * near), y * (7 - 4 * near), 8, 4);
        out = prom_color_mix(c->palette[1], c->palette[0], near * 0.8f);
        out =
            prom_color_mix(out, prom_color_rgb(0xf4f4ee), prom_noise_step(0.12f, 0.35f, wave));
    }
    for (int ship = 0; ship < 3; ship++) {
        float at = c->aspect * (0.15f + 0.7f * prom_noise_cell(ship, 1, c->noise));
        float size = 0.08f + 0.12f * prom_noise_cell(ship, 2, c->noise);
        float dx = (x - at) / size, dy = (y - horizon - 0.10f * size) / size;
        bool hull = dy > 0 && dy < 0.3f && fabsf(dx) < 0.8f - 0.8f * dy;
        bool sail = dy < -0.05f && dy > -1.6f && dx > -0.05f && dx < 0.75f * (1.6f + dy) / 1.6f;
        bool jib = dy < -0.05f && dy > -1.3f && dx < -0.1f && dx > -0.6f * (1.3f + dy) / 1.3f;
        if (hull) out = c->palette[5];
        if (sail || jib) out = prom_color_mix(c->palette[3], prom_color_rgb(0xffffff), 0.5f);
    }
    return out;
}

// ---- figures

static color portrait(const canvas *c, float x, float y)
{
    x = (x / c->aspect - 0.5f) * fminf(c->aspect, 1) * 1.25f;
    color out = prom_color_mix(prom_color_shade(c->palette[5], 0.9f), c->palette[4],
                               0.35f + 0.5f * rough(c, x + 0.5f, y, 3, 1) - 0.3f * y);
    static const uint32_t skins[] = {0xf0cdb0, 0xd9a884, 0xb57c55, 0x8a5a3c};
    static const uint32_t hairs[] = {0x2a1e18, 0x5a3a22, 0xa5753c, 0xb8b0a6};
    color skin = prom_color_rgb(skins[(int)(c->number[0] * 4)]);
    color hair = prom_color_rgb(hairs[(int)(c->number[1] * 4)]);
    float turn = 0.06f * (c->number[2] - 0.5f), hx = x - turn, hy = y - 0.40f;
    // Hair behind, shoulders, neck, collar, head, hair before.
    float mane = hypotf(hx / 0.20f,
                        (hy + 0.03f - 0.08f * c->number[3]) / (0.25f + 0.10f * c->number[3])) -
                 1;
    out = prom_color_mix(out, hair, soft(mane, 0.04f));
    float body = hypotf(x / 0.40f, (y - 1.02f) / 0.36f) - 1;
    color coat = prom_color_shade(
        prom_color_mix(c->palette[0], c->palette[(int)(c->number[4] * 5)], 0.6f),
        0.85f + 0.5f * rough(c, x + 0.5f, y * 0.5f, 8, 3));
    out = prom_color_mix(out, coat, soft(body, 0.02f));
    float neck = fmaxf(fabsf(x - 0.5f * turn) - 0.075f, fabsf(y - 0.62f) - 0.10f);
    out = prom_color_mix(out, prom_color_shade(skin, 0.82f), soft(neck, 0.015f));
    float collar = hypotf(x / 0.16f, (y - 0.74f) / 0.06f) - 1;
    out = prom_color_mix(out, prom_color_rgb(0xf2eee4), soft(collar, 0.08f) * (y > 0.71f));
    float head = hypotf(hx / 0.145f, hy / 0.20f) - 1;
    float light = 0.80f - 1.6f * (hx + 0.03f) + 0.1f * rough(c, x + 0.5f, y, 6, 5);
    color face = prom_color_shade(skin, fminf(fmaxf(light, 0.55f), 1.08f));
    float cheeks = hypotf((fabsf(hx) - 0.075f) / 0.05f, (hy - 0.05f) / 0.04f);
    face = prom_color_mix(face, prom_color_rgb(0xc86a58), 0.25f * soft(cheeks - 1, 0.8f));
    float eye = hypotf((fabsf(hx) - 0.055f) / 0.026f, (hy + 0.015f) / 0.013f);
    face = prom_color_mix(face, prom_color_rgb(0xe2d3c2), soft(eye - 1, 0.3f));
    face = prom_color_mix(face, prom_color_rgb(0x2c2420), soft(eye - 0.62f, 0.15f));
    float brow = hypotf((fabsf(hx) - 0.055f) / 0.036f, (hy + 0.055f) / 0.008f);
    face = prom_color_mix(face, hair, 0.8f * soft(brow - 1, 0.4f));
    float nose = hypotf((hx + 0.012f) / 0.014f, (hy - 0.04f) / 0.05f);
    face = prom_color_mix(face, prom_color_shade(skin, 0.72f), 0.6f * soft(nose - 1, 0.5f));
    float mouth = hypotf(hx / 0.042f, (hy - 0.115f) / 0.012f);
    face = prom_color_mix(face, prom_color_rgb(0xa24a42), 0.85f * soft(mouth - 1, 0.4f));
    out = prom_color_mix(out, face, soft(head, 0.03f));
    float fringe = hypotf((hx - 0.02f) / 0.17f, (hy + 0.16f) / 0.085f) - 1;
    return prom_color_mix(out, prom_color_shade(hair, 0.9f + rough(c, x + 0.5f, y, 12, 8)),
                          soft(fringe, 0.06f));
}

static color still_life(const canvas *c, float x, float y)
{
    float table = 0.66f;
    color out = prom_color_mix(prom_color_shade(c->palette[5], 0.8f), c->palette[4],
                               0.3f + 0.5f * x / c->aspect + 0.3f * rough(c, x, y, 3, 1));
    if (y > table) {
        float fold = sinf(18 * x + 6 * rough(c, x, y, 3, 2));
        out = prom_color_shade(prom_color_mix(c->palette[3], c->palette[2], y),
                               0.84f + 0.1f * fold);
    }
    for (int i = 0; i < 7; i++) {
        float r = 0.06f + 0.045f * prom_noise_cell(i, 3, c->noise);
        float cx = c->aspect * (0.18f + 0.64f * prom_noise_cell(i, 1, c->noise));
        float cy = table + 0.02f * (float)i - 0.02f;
        float d = hypotf(x - cx, y - cy),
              shadow = hypotf((x - cx - r) / 1.6f, (y - cy - r) * 3);
        static const uint32_t fruits[] = {0xc8402f, 0xe0a030, 0x8aa53a, 0x6b2f4a, 0xd87a35};
        color fruit = prom_color_rgb(fruits[(int)(prom_noise_cell(i, 4, c->noise) * 5)]);
        out = prom_color_shade(out, 1 - 0.4f * soft(shadow - r, 0.03f) * (y > table));
        float light = 0.95f - 0.6f * ((x - cx) + (y - cy)) / r;
        fruit = prom_color_shade(fruit, fminf(fmaxf(light, 0.35f), 1.2f));
        float shine = hypotf(x - cx + 0.35f * r, y - cy + 0.4f * r);
        fruit = prom_color_mix(fruit, prom_color_rgb(0xffffff),
                               0.7f * soft(shine - 0.12f * r, 0.01f));
        out = prom_color_mix(out, fruit, soft(d - r, 0.006f));
    }
    float jx = (x - c->aspect * (0.3f + 0.4f * c->number[5])) / 0.13f, jy = (y - 0.46f) / 0.24f;
    float belly = 0.55f + 0.45f * sinf(2.6f * (jy + 0.25f));
    bool jug = fabsf(jy) < 1 && fabsf(jx) < belly;
    if (jug && y < table + 0.03f)
        out = prom_color_shade(c->palette[1],
                               0.75f - 0.4f * jx + 0.25f * (jx > -0.55f && jx < -0.4f));
    return out;
}

// ---- abstract

static color fields(const canvas *c, float x, float y)
{
    color out = c->palette[(int)(c->number[0] * 6)];
    float top = 0;
    for (int i = 0; i < 3; i++) {
        float height = 0.18f + 0.22f * c->number[1 + i];
        float dx = fabsf(x / c->aspect - 0.5f) - 0.42f,
              dy = fabsf(y - top - 0.06f - height / 2) - height / 2;
        float edge = fmaxf(dx, dy) + 0.03f * rough(c, x, y, 12, 3);
        out = prom_color_mix(out, c->palette[(1 + i + (int)(c->number[5] * 5)) % 6],
                             0.92f * soft(edge, 0.02f));
        top += height + 0.05f;
    }
    return prom_color_shade(out, 1 + 0.25f * rough(c, x, y, 6, 5));
}

static void split(const canvas *c, float x, float y, float box[4], int depth, uint32_t *id)
{
    *id = 1;
    for (int i = 0; i < depth; i++) {
        int axis = box[2] - box[0] > box[3] - box[1] ? 0 : 1;
        float cut = box[axis] + (box[axis + 2] - box[axis]) *
                                    (0.3f + 0.4f * prom_noise_cell((int)*id, i, c->noise));
        bool high = (axis ? y : x) > cut;
        box[high ? axis : axis + 2] = cut;
        *id = *id * 2 + high;
    }
}

static color grid(const canvas *c, float x, float y)
{
    float box[4] = {0, 0, c->aspect, 1};
    uint32_t id;
    split(c, x, y, box, 4 + (int)(c->number[0] * 2), &id);
    float edge = fminf(fminf(x - box[0], box[2] - x), fminf(y - box[1], box[3] - y));
    if (edge < 0.012f) return prom_color_rgb(0x1c1b1e);
    static const uint32_t fills[] = {0xf1ede2, 0xf1ede2, 0xece6d4,
                                     0xc63a2c, 0x2c4f9c, 0xe8bb35};
    float pick = prom_noise_cell((int)id, 9, c->noise);
    return prom_color_shade(prom_color_rgb(fills[(int)(pick * 6)]),
                            1 + 0.1f * rough(c, x, y, 16, 2));
}

static color circles(const canvas *c, float x, float y)
{
    color out = prom_color_mix(c->palette[2], c->palette[3], y);
    for (int i = 0; i < 9; i++) {
        float cx = c->aspect * prom_noise_cell(i, 1, c->noise),
              cy = prom_noise_cell(i, 2, c->noise);
        float r = 0.06f + 0.2f * prom_noise_cell(i, 3, c->noise), d = hypotf(x - cx, y - cy);
        int ring = (int)(3.99f * d / r) + i;
        bool half = atan2f(y - cy, x - cx) > 2 * PI * prom_noise_cell(i, 4, c->noise) - PI;
        color fill = c->palette[(ring + (half ? 2 : 0)) % 6];
        out = prom_color_mix(out, fill, 0.9f * soft(d - r, 0.004f));
    }
    for (int i = 0; i < 5; i++) {
        float a = PI * prom_noise_cell(i, 5, c->noise), m = prom_noise_cell(i, 6, c->noise);
        float d = fabsf((x - c->aspect * m) * sinf(a) - (y - 0.5f) * cosf(a));
        out = prom_color_mix(out, prom_color_rgb(0x201d1c), 0.9f * soft(d - 0.006f, 0.003f));
    }
    return out;
}

// Strokes that follow a swirling flow.
static color flow(const canvas *c, float x, float y)
{
    for (int i = 0; i < 5; i++) {
        float a = 2 * PI * rough(c, x * 0.5f, y * 0.5f, 3, 2) * 1.6f + 6 * c->number[0];
        x += 0.018f * cosf(a);
        y += 0.018f * sinf(a);
    }
    float tone = 3 * (rough(c, x, y, 5, 4) + 0.5f) + 2 * rough(c, x, y, 20, 6);
    int i = (int)fminf(fmaxf(tone * 1.6f, 0), 4.99f);
    float t = tone * 1.6f - (float)i;
    return prom_color_mix(c->palette[i], c->palette[i + 1], prom_noise_step(0.2f, 0.8f, t));
}

// ---- the canvas

static const painter painters[] = {landscape, portrait, fields,   landscape, still_life,
                                   portrait,  circles,  seascape, grid,      flow};
#define PAINTERS (sizeof painters / sizeof *painters)

static uint8_t encode(float v)
{
    return (uint8_t)(255 * fminf(fmaxf(v, 0), 1) + 0.5f);
}

void prom_gallery_picture_draw(uint64_t seed, uint32_t number, float aspect, uint32_t size,
                               uint8_t *rgb)
{
    prom_random random = prom_random_stream(seed, 900, number);
    canvas c = {.aspect = aspect, .noise = (uint32_t)prom_random_next(&random)};
    uint32_t palette = prom_random_below(&random, sizeof palettes / sizeof *palettes);
    for (int i = 0; i < 6; i++) c.palette[i] = prom_color_rgb(palettes[palette][i]);
    for (int i = 0; i < 24; i++) c.number[i] = prom_random_unit(&random);
    // Upright formats are portraits more often, as in any collection.
    uint32_t kind = number % PAINTERS;
    if (aspect < 0.9f && c.number[23] < 0.4f) kind = 1;
    for (uint32_t j = 0; j < size; j++) {
        for (uint32_t i = 0; i < size; i++) {
            float x = ((float)i + 0.5f) / (float)size, y = ((float)j + 0.5f) / (float)size;
            color p = painters[kind](&c, x * aspect, y);
            // Weave and varnish.
            float tone = 1.02f + 0.10f * (prom_noise_tile(x, y, 90, c.noise + 3) - 0.5f) +
                         0.06f * (prom_noise_tile(x, y * 0.2f, 60, c.noise + 4) - 0.5f);
            *rgb++ = encode(p.r * tone);
            *rgb++ = encode(p.g * tone);
            *rgb++ = encode(p.b * tone);
        }
    }
}

// What people see of a front at street level and lean out of: doors, shops, balconies, flowers.
#include "scenes/city_wall.h"

#include <math.h>

#define DOOR_REVEAL 0.26f

void prom_city_build_balcony(prom_city *city, prom_solid *shape, const prom_facade *f,
                             const float o[4])
{
    float x0 = o[0] - 0.35f, x1 = o[2] + 0.35f, y = o[1] - 0.14f, z = 0.85f;
    prom_solid_use(shape, f->trim);
    prom_solid_box(shape, x0, y, 0, x1, y + 0.14f, z, PROM_FACE_NO_BACK);
    prom_solid_use(shape, f->wide ? f->frame : prom_city_plain(city, 0x30353a));
    prom_solid_box(shape, x0, y + 0.98f, z - 0.07f, x1, y + 1.04f, z, PROM_FACE_ALL);
    int rods = f->detail < 2 ? 4 : f->detail == 2 ? 8 : f->detail == 3 ? 14 : 24;
    for (int i = 0; i <= rods; i++) {
        float x = x0 + 0.03f + (x1 - x0 - 0.06f) * (float)i / (float)rods;
        prom_solid_box(shape, x - 0.014f, y + 0.14f, z - 0.05f, x + 0.014f, y + 0.98f,
                       z - 0.02f, PROM_FACE_SIDES);
    }
    for (int side = 0; side < 2; side++) {
        float x = side ? x1 - 0.04f : x0;
        prom_solid_box(shape, x, y + 0.98f, 0, x + 0.04f, y + 1.04f, z - 0.07f, PROM_FACE_ALL);
        for (int i = 1; i <= rods / 3; i++) {
            float at = z * (float)i / (float)(rods / 3 + 1);
            prom_solid_box(shape, x + 0.006f, y + 0.14f, at - 0.014f, x + 0.034f, y + 0.98f,
                           at + 0.014f, PROM_FACE_SIDES);
        }
    }
}

// ---- doors and shops

static void build_door_leaf(prom_solid *shape, const prom_facade *f, const float o[4], float z)
{
    prom_solid_use(shape, f->door);
    prom_solid_box(shape, o[0], o[1], z - 0.05f, o[2], o[3], z, PROM_FACE_FRONT);
    if (f->detail < 2) return;
    int rows = f->detail < 4 ? 3 : 5;
    float w = (o[2] - o[0]) / 2, h = (o[3] - o[1]) / (float)rows;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < rows; j++)
            prom_solid_box(shape, o[0] + w * (float)i + 0.09f, o[1] + h * (float)j + 0.08f, z,
                           o[0] + w * (float)(i + 1) - 0.09f, o[1] + h * (float)(j + 1) - 0.08f,
                           z + 0.025f, PROM_FACE_NO_BACK);
    prom_solid_use(shape, f->frame);
    prom_solid_box(shape, o[2] - 0.12f, o[1] + 1.0f, z, o[2] - 0.07f, o[1] + 1.12f, z + 0.06f,
                   PROM_FACE_NO_BACK);
}

void prom_front_door(prom_city *city, prom_solid *shape, const prom_facade *f, const float o[4],
                     prom_random *random)
{
    float z = -DOOR_REVEAL, head = fminf(o[1] + 2.1f, o[3] - 0.25f);
    prom_solid_use(shape, f->wall);
    prom_wall_reveal(shape, o, DOOR_REVEAL, true);
    build_door_leaf(shape, f, (float[]){o[0], o[1], o[2], head}, z);
    prom_solid_use(shape, f->frame);
    prom_solid_box(shape, o[0], head, z, o[2], head + 0.07f, z + 0.06f,
                   PROM_FACE_FRONT | PROM_FACE_TOP | PROM_FACE_BOTTOM);
    const float light[4] = {o[0], head + 0.07f, o[2], o[3]};
    prom_wall_glass(city, shape, light, z, false, random);
    prom_solid_use(shape, f->frame);
    if (f->detail > 1) prom_wall_bars(shape, light, 0, 2, z);
    prom_wall_surround(shape, f, o, f->pediments);
    prom_solid_use(shape, f->trim);
    prom_solid_box(shape, o[0] - 0.2f, -0.1f, -0.05f, o[2] + 0.2f, PROM_DOOR_STEP, 0.32f,
                   PROM_FACE_NO_BACK & ~PROM_FACE_BOTTOM);
}

void prom_city_build_sign(prom_city *city, prom_solid *shape, const prom_facade *f,
                          const float o[4], prom_random *random)
{
    float x0 = o[0] - 0.1f, x1 = o[2] + 0.1f, y0 = o[3] + 0.05f, y1 = o[3] + 0.52f, z = 0.08f;
    prom_solid_use(shape, f->door);
    prom_solid_box(shape, x0, y0, 0, x1, y1, z, PROM_FACE_NO_BACK);
    // The board is four times as wide as high.
    float half = fminf((x1 - x0) / 2 - 0.05f, 2 * (y1 - y0) - 0.1f), mid = (x0 + x1) / 2;
    float low = (y0 + y1) / 2 - half / 4, high = (y0 + y1) / 2 + half / 4;
    float row = (float)prom_random_below(random, PROM_CITY_SIGN_COUNT);
    const float uv[4] = {0, row / PROM_CITY_SIGN_COUNT, 1, (row + 1) / PROM_CITY_SIGN_COUNT};
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_SIGNS, 0xffffff, 1));
    prom_solid_picture_part(
        shape, (float[]){mid - half, low, z + 0.02f}, (float[]){mid + half, low, z + 0.02f},
        (float[]){mid + half, high, z + 0.02f}, (float[]){mid - half, high, z + 0.02f}, uv);
}

void prom_city_build_flowers(prom_city *city, prom_solid *shape, const float o[4],
                             prom_random *random)
{
    static const uint32_t blossoms[] = {0xd0344a, 0xe88aa8, 0xf0c040, 0xf4f0ec};
    float x0 = o[0] + 0.04f, x1 = o[2] - 0.04f, y = o[1], z0 = 0.02f, z1 = 0.24f;
    int count = prom_city_sides(city, 3);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, 0x7a5a42, 1));
    prom_solid_box(shape, x0, y, z0, x1, y + 0.16f, z1, PROM_FACE_NO_BACK);
    prom_paint green = prom_city_paint(city, PROM_CITY_LEAVES_SMALL, 0xd8e8d0, 1);
    prom_paint bloom = prom_city_plain(city, blossoms[prom_random_below(random, 4)]);
    for (int i = 0; i < count; i++) {
        float a = x0 + (x1 - x0) * (float)i / (float)count, w = (x1 - x0) / (float)count;
        float h = y + prom_random_between(random, 0.28f, 0.42f), tilt = 0.06f;
        prom_solid_use(shape, green);
        prom_solid_picture(shape, (float[]){a - 0.05f, y + 0.08f, z1 - 0.05f},
                           (float[]){a + w + 0.05f, y + 0.08f, z1 - 0.05f},
                           (float[]){a + w + 0.05f, h, z1 + tilt},
                           (float[]){a - 0.05f, h, z1 + tilt});
        prom_solid_use(shape, bloom);
        for (int k = 0; k < 2; k++) {
            float x = a + (0.25f + 0.4f * (float)k) * w, low = h - 0.08f - 0.07f * (float)k;
            prom_solid_box(shape, x, low, z1, x + 0.07f, low + 0.07f, z1 + 0.09f,
                           PROM_FACE_FRONT | PROM_FACE_TOP);
        }
    }
}

void prom_front_loading(prom_solid *shape, const prom_facade *f, const float o[4])
{
    float z = -0.2f, mid = (o[0] + o[2]) / 2;
    prom_solid_use(shape, f->wall);
    prom_wall_reveal(shape, o, 0.2f, true);
    prom_solid_use(shape, f->door);
    for (int i = 0; i < 2; i++) {
        const float leaf[4] = {i ? mid : o[0], o[1], i ? o[2] : mid, o[3]};
        prom_solid_box(shape, leaf[0], leaf[1], z - 0.05f, leaf[2], leaf[3], z,
                       PROM_FACE_FRONT);
        prom_wall_ring(shape, leaf, 0.12f, z, z + 0.04f);
        prom_solid_box(shape, leaf[0], (o[1] + o[3]) / 2 - 0.07f, z, leaf[2],
                       (o[1] + o[3]) / 2 + 0.07f, z + 0.035f,
                       PROM_FACE_FRONT | PROM_FACE_TOP | PROM_FACE_BOTTOM);
    }
    prom_solid_use(shape, f->trim);
    prom_solid_box(shape, o[0] - 0.15f, o[3], 0, o[2] + 0.15f, o[3] + 0.22f, 0.05f,
                   PROM_FACE_NO_BACK);
    prom_solid_box(shape, o[0] - 0.1f, o[1] - 0.12f, 0, o[2] + 0.1f, o[1], 0.16f,
                   PROM_FACE_NO_BACK);
}

static void build_awning(prom_city *city, prom_solid *shape, float x0, float x1, float y)
{
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_AWNING, 0xffffff, 2.4f));
    float low = y - 0.55f, z = 1.05f;
    float *a = (float[]){x0, low, z}, *b = (float[]){x1, low, z}, *c = (float[]){x1, y, 0.03f},
          *d = (float[]){x0, y, 0.03f};
    float *e = (float[]){x0, low - 0.2f, z}, *g = (float[]){x1, low - 0.2f, z};
    prom_solid_quad(shape, a, b, c, d);
    prom_solid_quad(shape, b, a, d, c);
    prom_solid_quad(shape, e, g, b, a);
    prom_solid_quad(shape, g, e, a, b);
}

void prom_front_shop(prom_city *city, prom_solid *shape, const prom_facade *f, const float o[4],
                     bool awning, prom_random *random)
{
    prom_solid_use(shape, f->wall);
    prom_wall_reveal(shape, o, PROM_REVEAL, true);
    prom_wall_glass(city, shape, o, -PROM_REVEAL, true, random);
    prom_solid_use(shape, f->door);
    prom_wall_ring(shape, o, 0.09f, -PROM_REVEAL, -0.03f);
    prom_wall_bars(shape, o, 1, f->detail < 2 ? 1 : 3, -PROM_REVEAL);
    prom_city_build_sign(city, shape, f, o, random);
    if (awning) build_awning(city, shape, o[0] - 0.1f, o[2] + 0.1f, o[3] + 0.03f);
}

// The town hall and the church: seen from afar, so that one knows where one is.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f

// ---- towers

// Four walls of a square tower about the frame's axis, from y0 to y1.
static void build_shaft(prom_solid *shape, float half, float y0, float y1)
{
    prom_solid_box(shape, -half, y0, -half, half, y1, half, PROM_FACE_SIDES);
}

static void build_cornice(prom_solid *shape, float half, float y)
{
    prom_solid_box(shape, -half - 0.12f, y, -half - 0.12f, half + 0.12f, y + 0.22f,
                   half + 0.12f, PROM_FACE_ALL);
    prom_solid_box(shape, -half - 0.26f, y + 0.22f, -half - 0.26f, half + 0.26f, y + 0.45f,
                   half + 0.26f, PROM_FACE_ALL);
}

// The same thing on all four sides.
static void windows_around(prom_city *city, prom_solid *shape, prom_paint frame, float half,
                           const float o[4], bool pointed, int leave_out)
{
    for (int i = 0; i < 4; i++) {
        if (i == leave_out) continue;
        prom_solid_frame old = prom_solid_enter(shape, 0, 0, 0, PI / 2 * (float)i);
        prom_solid_enter(shape, 0, 0, half, 0);
        prom_city_build_arch_window(city, shape, frame, o, pointed);
        prom_solid_leave(shape, old);
    }
}

static void build_clocks(prom_city *city, prom_solid *shape, float half, float y, float radius)
{
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_CLOCK, 0xffffff, 1));
    for (int i = 0; i < 4; i++) {
        prom_solid_frame old = prom_solid_enter(shape, 0, 0, 0, PI / 2 * (float)i);
        float z = half + 0.06f;
        static const float out[3] = {0, 0, 1};
        int n = prom_city_sides(city, 20);
        uint32_t hub = prom_solid_vertex(shape, (float[]){0, y, z}, out, 0.5f, 0.5f);
        for (int k = 0; k <= n; k++) {
            float a = 2 * PI * (float)(k % n) / (float)n, c = cosf(a), s = sinf(a);
            prom_solid_vertex(shape, (float[]){radius * c, y + radius * s, z}, out,
                              0.5f + 0.46f * c, 0.5f - 0.46f * s);
        }
        for (uint32_t k = 1; k <= (uint32_t)n; k++)
            prom_solid_triangle(shape, hub, hub + k, hub + k + 1);
        prom_solid_leave(shape, old);
    }
}

// Four sides below, eight above; the eight stand out a little and are closed from below.
static void build_spire(prom_solid *shape, float half, float y, float height)
{
    const float lower[3][2] = {
        {half * 1.52f, 0}, {half * 1.0f, 0.16f * height}, {half * 0.74f, 0.30f * height}};
    const float upper[4][2] = {{half * 0.5f, 0.26f * height},
                               {half * 0.755f, 0.30f * height},
                               {half * 0.2f, 0.8f * height},
                               {0, height}};
    prom_solid_frame old = prom_solid_enter(shape, 0, y, 0, PI / 4);
    prom_solid_lathe(shape, lower, 3, 4, false);
    prom_solid_lathe(shape, upper, 4, 8, false);
    prom_solid_leave(shape, old);
}

// A rod with a ball at a spire's point.
static void build_finial(prom_city *city, prom_solid *shape, float y)
{
    static const float ball[6][2] = {{0.05f, -0.3f}, {0.05f, 0.1f}, {0.22f, 0.3f},
                                     {0.05f, 0.5f},  {0.04f, 1.5f}, {0, 1.55f}};
    prom_solid_frame old = prom_solid_enter(shape, 0, y, 0, 0);
    prom_solid_use(shape, prom_city_plain(city, 0xc89a3c));
    prom_solid_lathe(shape, ball, 6, prom_city_sides(city, 8), false);
    prom_solid_leave(shape, old);
}

// ---- the town hall: an arcade, two storeys of halls, a steep roof and a tower in its middle

#define HALL_WIDTH 27.0f
#define HALL_DEPTH 13.0f
#define HALL_BAYS 9u

static void build_hall_walls(prom_city *city, prom_solid *shape, const prom_facade *f,
                             prom_random *random)
{
    const float *floors = f->floors;
    float w = HALL_WIDTH, d = HALL_DEPTH, in = 3, h = floors[1], thick = 0.6f;
    prom_facade inner = *f, back = *f, side = *f;
    prom_solid_frame old = prom_solid_enter(shape, -w / 2, 0, 0, 0);
    prom_city_build_facade(city, shape, f, random);
    prom_solid_use(shape, f->wall);
    prom_city_build_arcade(shape, w, HALL_BAYS, h, thick, city->options.detail < 3 ? 10 : 20);
    prom_solid_quad(shape, (float[]){0.02f, 0, -thick}, (float[]){0.02f, 0, -in},
                    (float[]){0.02f, h, -in}, (float[]){0.02f, h, -thick});
    prom_solid_quad(shape, (float[]){w - 0.02f, 0, -in}, (float[]){w - 0.02f, 0, -thick},
                    (float[]){w - 0.02f, h, -thick}, (float[]){w - 0.02f, h, -in});
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xf2ede2, 3));
    prom_solid_quad(shape, (float[]){0, h - 0.03f, -in}, (float[]){w, h - 0.03f, -in},
                    (float[]){w, h - 0.03f, -0.1f}, (float[]){0, h - 0.03f, -0.1f});
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PAVING, 0xe0d8cc, 1.6f));
    prom_solid_floor(shape, 0, -in, w, 0.02f, 0.03f, 4);
    prom_solid_enter(shape, 0, 0, -in, 0);
    inner.from = 0;
    inner.storeys = 1;
    inner.has_door = true;
    inner.door_bay = HALL_BAYS / 2;
    inner.balconies = 0;
    inner.surrounds = true;
    prom_city_build_facade(city, shape, &inner, random);
    prom_solid_leave(shape, old);
    back.from = side.from = 0;
    back.balconies = side.balconies = 0;
    side.width = d;
    side.bays = 4;
    const float at[3][3] = {{w / 2, -d, PI}, {-w / 2, -d, -PI / 2}, {w / 2, 0, PI / 2}};
    for (int i = 0; i < 3; i++) {
        old = prom_solid_enter(shape, at[i][0], 0, at[i][1], at[i][2]);
        prom_city_build_facade(city, shape, i ? &side : &back, random);
        prom_solid_leave(shape, old);
    }
}

static void build_hall_bands(prom_solid *shape, const prom_facade *f)
{
    static const float course[4][2] = {{0, 0}, {0, 0.09f}, {0.16f, 0.10f}, {0.22f, 0}};
    static const float cornice[7][2] = {{0, 0},         {0.06f, 0.08f}, {0.16f, 0.10f},
                                        {0.22f, 0.24f}, {0.34f, 0.34f}, {0.42f, 0.35f},
                                        {0.45f, 0}};
    const float at[4][4] = {{-HALL_WIDTH / 2, 0, 0, HALL_WIDTH},
                            {HALL_WIDTH / 2, -HALL_DEPTH, PI, HALL_WIDTH},
                            {-HALL_WIDTH / 2, -HALL_DEPTH, -PI / 2, HALL_DEPTH},
                            {HALL_WIDTH / 2, 0, PI / 2, HALL_DEPTH}};
    prom_solid_use(shape, f->trim);
    for (int i = 0; i < 4; i++) {
        prom_solid_frame old = prom_solid_enter(shape, at[i][0], 0, at[i][1], at[i][2]);
        prom_solid_frame wall = prom_solid_enter(shape, 0, f->floors[1] + 0.05f, 0, 0);
        prom_solid_moulding(shape, course, 4, -0.09f, at[i][3] + 0.09f);
        prom_solid_leave(shape, wall);
        prom_solid_enter(shape, 0, f->floors[f->storeys] - 0.45f, 0, 0);
        prom_solid_moulding(shape, cornice, 7, -0.3f, at[i][3] + 0.3f);
        prom_solid_leave(shape, old);
    }
}

static void build_hall_tower(prom_city *city, prom_solid *shape, const prom_facade *f,
                             prom_paint slate)
{
    const float half = 2.7f, base = f->floors[f->storeys] - 0.2f, top = base + 13;
    prom_solid_frame old = prom_solid_enter(shape, 0, 0, -half - 0.4f, 0);
    prom_solid_use(shape, f->wall);
    build_shaft(shape, half, base, top);
    prom_solid_use(shape, f->trim);
    build_cornice(shape, half, top);
    build_cornice(shape, half, base + 7.2f);
    windows_around(city, shape, f->trim, half,
                   (const float[]){-0.8f, base + 8.6f, 0.8f, base + 10.9f}, false, -1);
    build_clocks(city, shape, half, base + 5.4f, 1.35f);
    prom_solid_use(shape, slate);
    build_spire(shape, half, top + 0.45f, 10);
    build_finial(city, shape, top + 10.3f);
    prom_solid_leave(shape, old);
}

// A banner on the wall, three stripes of cloth on a rod.
static void build_banner(prom_city *city, prom_solid *shape, float x, float y)
{
    static const uint32_t colors[3] = {0x2f4f8a, 0xf2f0ea, 0xb83a34};
    const float rod[2][3] = {{x - 0.65f, y, 0.16f}, {x + 0.65f, y, 0.16f}};
    prom_solid_use(shape, prom_city_plain(city, 0xc89a3c));
    prom_solid_tube(shape, rod, (const float[]){0.03f, 0.03f}, 2, prom_city_sides(city, 6));
    for (int i = 0; i < 3; i++) {
        float a = x - 0.54f + 0.36f * (float)i;
        prom_solid_use(shape, prom_city_plain(city, colors[i]));
        prom_solid_box(shape, a, y - 3.0f, 0.14f, a + 0.36f, y - 0.02f, 0.18f, PROM_FACE_ALL);
    }
}

static void build_town_hall(prom_city *city, prom_solid *shape)
{
    static const float floors[4] = {0, 4.6f, 9.4f, 13.4f};
    prom_random random = prom_random_stream(city->options.seed, 420, 0);
    prom_paint slate = prom_city_paint(city, PROM_CITY_SLATE, 0x7f8f88, 2);
    prom_facade f = {
        .width = HALL_WIDTH,
        .bays = HALL_BAYS,
        .storeys = 3,
        .floors = floors,
        .from = 1,
        .wall = prom_city_paint(city, PROM_CITY_STONE, 0xe2d2b0, 2.4f),
        .trim = prom_city_paint(city, PROM_CITY_PLASTER, 0xf0e8d6, 3),
        .frame = prom_city_plain(city, 0xf2efe8),
        .door = prom_city_paint(city, PROM_CITY_WOOD, 0x5a4632, 1),
        .shutter = prom_city_paint(city, PROM_CITY_WOOD, 0x5a4632, 1),
        .surrounds = true,
        .pediments = true,
        .keystones = true,
        .balconies = 1u << HALL_BAYS / 2,
        .balcony_top = 1,
        .bars_across = 2,
        .bars_up = 1,
        .detail = (int)city->options.detail,
    };
    build_hall_walls(city, shape, &f, &random);
    build_hall_bands(shape, &f);
    prom_roof roof = {
        .kind = PROM_ROOF_HIP,
        .width = HALL_WIDTH,
        .depth = HALL_DEPTH,
        .base = floors[3],
        .pitch = 1,
        .cover = slate,
        .wall = f.wall,
        .trim = f.trim,
        .brick = prom_city_paint(city, PROM_CITY_BRICK, 0xb26e5e, 1.3f),
        .dormers = 3, // the middle one is in the tower
        .chimneys = 2,
        .window = f,
        .detail = f.detail,
    };
    roof.window.surrounds = false;
    prom_city_build_roof(city, shape, &roof, &random);
    build_hall_tower(city, shape, &f, slate);
    for (int i = -1; i <= 1; i += 2)
        build_banner(city, shape, HALL_WIDTH / HALL_BAYS * 1.5f * (float)i, floors[2] - 0.5f);
    prom_solid_use(shape, f.trim); // steps up to the arcade
    prom_solid_box(shape, -HALL_WIDTH / 2, -0.1f, -0.05f, HALL_WIDTH / 2, 0.02f, 0.5f,
                   PROM_FACE_NO_BACK);
}

// ---- the church: a tower in front, a nave with buttresses, a round choir

#define NAVE_HALF 5.2f
#define NAVE_LENGTH 22.0f
#define NAVE_WALL 8.4f
#define TOWER_HALF 3.1f

static void build_nave_side(prom_city *city, prom_solid *shape, prom_paint wall,
                            prom_paint trim, bool right)
{
    const int bays = 5;
    float z0 = -TOWER_HALF, bay = NAVE_LENGTH / (float)bays;
    prom_solid_frame old =
        right ? prom_solid_enter(shape, NAVE_HALF, 0, z0, PI / 2)
              : prom_solid_enter(shape, -NAVE_HALF, 0, z0 - NAVE_LENGTH, -PI / 2);
    prom_solid_use(shape, wall);
    prom_solid_quad(shape, (float[]){0, -0.1f, 0}, (float[]){NAVE_LENGTH, -0.1f, 0},
                    (float[]){NAVE_LENGTH, NAVE_WALL, 0}, (float[]){0, NAVE_WALL, 0});
    for (int i = 0; i <= bays; i++) {
        float x = fminf(fmaxf(bay * (float)i, 0.4f), NAVE_LENGTH - 0.4f);
        prom_solid_use(shape, wall);
        prom_solid_box(shape, x - 0.4f, -0.1f, 0, x + 0.4f, 4.2f, 1.3f,
                       PROM_FACE_FRONT | PROM_FACE_LEFT | PROM_FACE_RIGHT);
        prom_solid_box(shape, x - 0.4f, 4.2f, 0, x + 0.4f, 6.8f, 0.8f,
                       PROM_FACE_FRONT | PROM_FACE_LEFT | PROM_FACE_RIGHT);
        prom_solid_use(shape, trim);
        for (int k = 0; k < 2; k++) { // sloping tops
            float y = k ? 6.8f : 4.2f, out = k ? 0.8f : 1.3f, in = k ? 0 : 0.8f, up = 0.6f;
            float l = x - 0.4f, r = x + 0.4f;
            prom_solid_quad(shape, (float[]){l, y, out}, (float[]){r, y, out},
                            (float[]){r, y + up, in}, (float[]){l, y + up, in});
            prom_solid_flat_triangle(shape, (float[]){l, y, in}, (float[]){l, y, out},
                                     (float[]){l, y + up, in});
            prom_solid_flat_triangle(shape, (float[]){r, y, out}, (float[]){r, y, in},
                                     (float[]){r, y + up, in});
        }
        if (i == bays) continue;
        float mid = bay * ((float)i + 0.5f);
        prom_city_build_arch_window(city, shape, trim,
                                    (const float[]){mid - 0.75f, 2, mid + 0.75f, 5.4f}, true);
    }
    prom_solid_leave(shape, old);
}

static void build_choir(prom_city *city, prom_solid *shape, prom_paint wall, prom_paint trim,
                        prom_paint slate)
{
    // Half of eight sides behind the nave.
    const float r = 4.6f, in = r * cosf(PI / 8), half = r * sinf(PI / 8), top = 7.4f;
    prom_solid_frame old = prom_solid_enter(shape, 0, 0, -TOWER_HALF - NAVE_LENGTH, PI);
    for (int i = -2; i <= 2; i++) {
        prom_solid_frame choir = prom_solid_enter(shape, 0, 0, 0, PI / 4 * (float)i);
        prom_solid_enter(shape, 0, 0, in, 0);
        prom_solid_use(shape, wall);
        prom_solid_quad(shape, (float[]){-half, -0.1f, 0}, (float[]){half, -0.1f, 0},
                        (float[]){half, top, 0}, (float[]){-half, top, 0});
        if (i > -2 && i < 2)
            prom_city_build_arch_window(city, shape, trim,
                                        (const float[]){-0.7f, 2, 0.7f, 4.9f}, true);
        prom_solid_use(shape, slate);
        prom_solid_flat_triangle(shape, (float[]){-half - 0.18f, top - 0.15f, 0.35f},
                                 (float[]){half + 0.18f, top - 0.15f, 0.35f},
                                 (float[]){0, top + 3.6f, -in});
        prom_solid_leave(shape, choir);
    }
    prom_solid_leave(shape, old);
}

static void build_church_tower(prom_city *city, prom_solid *shape, prom_paint wall,
                               prom_paint trim, prom_paint slate)
{
    const float half = TOWER_HALF, top = 24;
    prom_solid_use(shape, wall);
    build_shaft(shape, half, -0.1f, top);
    prom_solid_use(shape, trim);
    build_cornice(shape, half, top);
    for (int i = 0; i < 2; i++)
        prom_solid_box(shape, -half - 0.1f, i ? 17 : 9.6f, -half - 0.1f, half + 0.1f,
                       i ? 17.3f : 9.9f, half + 0.1f, PROM_FACE_ALL);
    for (int i = 0; i < 2; i++)
        windows_around(city, shape, trim, half,
                       (const float[]){i ? 0.3f : -1.7f, 18.4f, i ? 1.7f : -0.3f, 21.4f}, true,
                       -1);
    build_clocks(city, shape, half, 14.2f, 1.4f);
    prom_solid_use(shape, slate);
    build_spire(shape, half, top + 0.45f, 17);
    build_finial(city, shape, top + 17.2f);
    // The portal.
    prom_solid_frame old = prom_solid_enter(shape, 0, 0, half, 0);
    // Three orders, each smaller and standing out less, and the doors before them.
    float outline[PROM_ARCH_POINTS_MAX][2];
    for (int i = 0; i < 4; i++) {
        float w = 1.5f - 0.2f * (float)i, z = 0.10f + 0.06f * (float)i;
        int n = prom_city_arch_outline(-w, 0, w, 2.5f, 10, true, outline);
        prom_solid_use(shape, i < 3 ? (i & 1 ? wall : trim)
                                    : prom_city_paint(city, PROM_CITY_WOOD, 0x5a3d2c, 1));
        prom_solid_extrude(shape, (const float(*)[2])outline, n, 0, z,
                           PROM_FACE_FRONT | PROM_FACE_SIDES);
    }
    prom_solid_use(shape, trim);
    prom_solid_box(shape, -2.2f, -0.1f, 0, 2.2f, 0.16f, 1.0f, PROM_FACE_NO_BACK);
    prom_solid_leave(shape, old);
}

static void build_church(prom_city *city, prom_solid *shape)
{
    prom_random random = prom_random_stream(city->options.seed, 421, 0);
    prom_paint wall = prom_city_paint(city, PROM_CITY_STONE, 0xd8cdb6, 2.4f);
    prom_paint trim = prom_city_paint(city, PROM_CITY_PLASTER, 0xe6decc, 3);
    prom_paint slate = prom_city_paint(city, PROM_CITY_SLATE, 0x7c848c, 2);
    build_church_tower(city, shape, wall, trim, slate);
    for (int i = 0; i < 2; i++) build_nave_side(city, shape, wall, trim, i);
    build_choir(city, shape, wall, trim, slate);
    float z = -TOWER_HALF, h = NAVE_HALF;
    prom_solid_use(shape, wall);
    prom_solid_quad(shape, (float[]){-h, -0.1f, z}, (float[]){h, -0.1f, z},
                    (float[]){h, NAVE_WALL, z}, (float[]){-h, NAVE_WALL, z});
    prom_solid_quad(
        shape, (float[]){h, -0.1f, z - NAVE_LENGTH}, (float[]){-h, -0.1f, z - NAVE_LENGTH},
        (float[]){-h, NAVE_WALL, z - NAVE_LENGTH}, (float[]){h, NAVE_WALL, z - NAVE_LENGTH});
    prom_roof roof = {
        .kind = PROM_ROOF_FRONT_GABLE,
        .width = 2 * NAVE_HALF,
        .depth = NAVE_LENGTH,
        .base = NAVE_WALL,
        .pitch = 1.25f,
        .side_overhang = 0.4f,
        .cover = slate,
        .wall = wall,
        .trim = trim,
        .brick = wall,
        .window = {.wall = wall, .trim = trim, .frame = trim, .detail = 1},
        .detail = (int)city->options.detail,
    };
    prom_solid_frame old = prom_solid_enter(shape, 0, 0, z, 0);
    prom_city_build_roof(city, shape, &roof, &random);
    prom_solid_leave(shape, old);
}

void prom_city_build_landmark(prom_city *city, const prom_city_prototype *which,
                              prom_solid *shape)
{
    if (which->kind == PROM_CITY_CHURCH)
        build_church(city, shape);
    else
        build_town_hall(city, shape);
}

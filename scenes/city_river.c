// The river in the city: quays with walls, railings and steps, bridges and boats.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f
#define BED (-4.2f) // walls go down to here
#define COPING 0.55f
#define STAIR_WIDTH 1.7f
#define STEPS 15
#define TREAD 0.31f
#define LANDING 2.6f
#define TREE_LINE 2.0f // from the quay road's edge
#define BENCH_LINE 5.3f

// ---- one stretch of quay, from line to line: x along it, the water at +z; z = 0 at the road

typedef enum quay_end { END_OPEN, END_BRIDGE, END_FOOT_BRIDGE, END_CITY } quay_end;

typedef struct quay {
    float x0, x1;       // of the ground
    float rail0, rail1; // of the railing
    quay_end ends[2];
    float stairs; // x where they begin; they go down in +x
} quay;

static quay measure_quay(float length, quay_end left, quay_end right)
{
    static const float trims[] = {0, PROM_CITY_BRIDGE_HALF, 0, -PROM_CITY_ROAD_WIDTH / 2};
    static const float gaps[] = {0, 0, 1.75f, 0.1f};
    quay q = {.x0 = -length / 2 + trims[left],
              .x1 = length / 2 - trims[right],
              .ends = {left, right}};
    q.rail0 = q.x0 + gaps[left];
    q.rail1 = q.x1 - gaps[right];
    q.stairs = (q.x0 + q.x1) / 2 - 4;
    return q;
}

static void build_railing(prom_city *city, prom_solid *shape, float x0, float x1, float z)
{
    int detail = (int)city->options.detail;
    float y = PROM_CITY_KERB, length = x1 - x0;
    int posts = (int)fmaxf(1, roundf(length / 2.2f));
    static const float knob[4][2] = {{0, 0.0f}, {0.055f, 0.05f}, {0.04f, 0.10f}, {0, 0.13f}};
    prom_solid_use(shape, prom_city_plain(city, 0x2f3b38));
    prom_solid_box(shape, x0, y + 0.98f, z - 0.035f, x1, y + 1.03f, z + 0.035f, PROM_FACE_ALL);
    prom_solid_box(shape, x0, y + 0.13f, z - 0.02f, x1, y + 0.17f, z + 0.02f, PROM_FACE_ALL);
    for (int i = 0; i <= posts; i++) {
        float x = x0 + 0.05f + (length - 0.1f) * (float)i / (float)posts;
        prom_solid_box(shape, x - 0.045f, y, z - 0.045f, x + 0.045f, y + 1.08f, z + 0.045f,
                       PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
        prom_solid_frame old = prom_solid_enter(shape, x, y + 1.06f, z, 0);
        prom_solid_lathe(shape, knob, 4, prom_city_sides(city, 6), false);
        prom_solid_leave(shape, old);
        int bars = i == posts ? 0 : detail < 2 ? 2 : detail == 2 ? 7 : 14;
        for (int k = 1; k <= bars; k++) {
            float bar = x + (length - 0.1f) / (float)posts * (float)k / (float)(bars + 1);
            prom_solid_box(shape, bar - 0.012f, y + 0.17f, z - 0.012f, bar + 0.012f, y + 0.98f,
                           z + 0.012f, PROM_FACE_SIDES);
        }
    }
}

// Steps along the wall, down to a landing just above the water.
static void build_stairs(prom_solid *shape, const quay *q)
{
    float z0 = PROM_CITY_QUAY, z1 = z0 + STAIR_WIDTH, x = q->stairs;
    float top = PROM_CITY_KERB, low = PROM_CITY_WATER_LEVEL + 0.4f;
    prom_solid_box(shape, x, BED, z0, x + 1.5f, top, z1, PROM_FACE_NO_BACK);
    x += 1.5f;
    for (int i = 0; i < STEPS; i++) {
        float y = top + (low - top) * (float)(i + 1) / (float)STEPS;
        prom_solid_box(shape, x, BED, z0, x + TREAD, y, z1,
                       PROM_FACE_TOP | PROM_FACE_FRONT | (i + 1 < STEPS ? PROM_FACE_RIGHT : 0));
        x += TREAD;
    }
    prom_solid_box(shape, x, BED, z0, x + LANDING, low, z1,
                   PROM_FACE_TOP | PROM_FACE_FRONT | PROM_FACE_RIGHT);
}

static void build_stair_rail(prom_city *city, prom_solid *shape, const quay *q)
{
    float z = PROM_CITY_QUAY + STAIR_WIDTH - 0.1f, x = q->stairs + 0.08f, y = PROM_CITY_KERB;
    float end = q->stairs + 1.5f + STEPS * TREAD, low = PROM_CITY_WATER_LEVEL + 0.4f;
    const float line[4][3] = {{x, y + 0.95f, z},
                              {q->stairs + 1.5f, y + 0.95f, z},
                              {end, low + 0.95f, z},
                              {end + 0.5f, low + 0.95f, z}};
    static const float radii[4] = {0.03f, 0.03f, 0.03f, 0.03f};
    prom_solid_use(shape, prom_city_plain(city, 0x2f3b38));
    prom_solid_tube(shape, line, radii, 4, prom_city_sides(city, 6));
    for (int i = 0; i < 6; i++) {
        float t = (float)i / 5, px = q->stairs + 1.5f + t * (end - q->stairs - 1.5f);
        float foot = y + t * (low - y);
        prom_solid_box(shape, px - 0.02f, foot - 0.2f, z - 0.02f, px + 0.02f, foot + 0.95f,
                       z + 0.02f, PROM_FACE_SIDES);
    }
    prom_solid_box(shape, x - 0.02f, y, z - 0.02f, x + 0.02f, y + 0.95f, z + 0.02f,
                   PROM_FACE_SIDES);
    prom_solid_box(shape, x - 0.03f, y + 0.92f, PROM_CITY_QUAY - 0.1f, x + 0.03f, y + 0.98f,
                   z + 0.03f, PROM_FACE_ALL);
}

static void build_quay_wall(prom_city *city, prom_solid *shape, const quay *q)
{
    float top = PROM_CITY_KERB, edge = PROM_CITY_QUAY;
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_STONE, 0xb9b0a0, 2.6f));
    int n = (int)fmaxf(1, roundf((q->x1 - q->x0) / 8));
    for (int i = 0; i < n; i++) {
        float a = q->x0 + (q->x1 - q->x0) * (float)i / (float)n;
        float b = q->x0 + (q->x1 - q->x0) * (float)(i + 1) / (float)n;
        prom_solid_quad(shape, (float[]){a, BED, edge}, (float[]){b, BED, edge},
                        (float[]){b, top - 0.3f, edge}, (float[]){a, top - 0.3f, edge});
    }
    build_stairs(shape, q);
    // Where the city ends, so does the quay.
    for (int i = 0; i < 2; i++) {
        if (q->ends[i] != END_CITY) continue;
        prom_solid_frame old = i ? prom_solid_enter(shape, q->x1, 0, edge, PI / 2)
                                 : prom_solid_enter(shape, q->x0, 0, 0, -PI / 2);
        prom_solid_quad(shape, (float[]){0, BED, 0}, (float[]){edge, BED, 0},
                        (float[]){edge, top, 0}, (float[]){0, top, 0});
        prom_solid_leave(shape, old);
    }
    // The coping stands out before the wall.
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xc6beae, 1.5f));
    prom_solid_box(shape, q->x0, top - 0.3f, edge - COPING, q->x1, top + 0.02f, edge + 0.09f,
                   PROM_FACE_FRONT | PROM_FACE_TOP | PROM_FACE_BOTTOM | PROM_FACE_BACK |
                       (q->ends[0] == END_CITY ? PROM_FACE_LEFT : 0) |
                       (q->ends[1] == END_CITY ? PROM_FACE_RIGHT : 0));
}

static void build_quay(prom_city *city, prom_solid *shape, const quay *q)
{
    const float kerb = 0.25f, y = PROM_CITY_KERB, low = -0.12f;
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xb0aca4, 2));
    prom_solid_floor(shape, q->x0, 0, q->x1, kerb, y, 6);
    prom_solid_quad(shape, (float[]){q->x1, low, 0}, (float[]){q->x0, low, 0},
                    (float[]){q->x0, y, 0}, (float[]){q->x1, y, 0});
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PAVING, 0xece4d8, 2.2f));
    prom_solid_floor(shape, q->x0, kerb, q->x1, PROM_CITY_QUAY - COPING, y, 4);
    build_quay_wall(city, shape, q);
    float z = PROM_CITY_QUAY - 0.25f;
    build_railing(city, shape, q->rail0, q->stairs, z);
    build_railing(city, shape, q->stairs + 1.45f, q->rail1, z);
    build_stair_rail(city, shape, q);
}

static uint32_t quay_mesh(prom_city *city, float length, quay_end left, quay_end right)
{
    int use = 200 + 4 * (int)left + (int)right;
    for (size_t i = 0; i < city->grounds.count; i++) {
        const prom_city_ground *g = &city->grounds.data[i];
        if (g->use == use && g->width == length) return g->mesh;
    }
    prom_solid shape;
    quay q = measure_quay(length, left, right);
    prom_solid_init(&shape);
    build_quay(city, &shape, &q);
    prom_city_ground g = {use, length, 0, prom_solid_write(&shape, city->glb, "quay")};
    prom_solid_finish(&shape);
    prom_array_push(&city->grounds, g);
    return g.mesh;
}

// ---- what stands on it

// `gate`: the middle, where people cross the road, is kept free.
static void furnish(prom_city *city, uint32_t node, const quay *q, bool gate,
                    prom_random *random)
{
    const float y = PROM_CITY_KERB, step = 8.6f;
    uint32_t n = (uint32_t)fmaxf(1, (q->x1 - q->x0 - 3) / step);
    for (uint32_t i = 0; i < n; i++) {
        float x = (q->x0 + q->x1) / 2 + step * ((float)i - (float)(n - 1) / 2);
        float between = x + step / 2;
        if (!gate || fabsf(x) > PROM_CITY_PASSAGE)
            prom_city_place_any(city, PROM_CITY_QUAY_TREE, node, x, y, TREE_LINE,
                                prom_random_between(random, 0, 2 * PI),
                                prom_random_between(random, 0.92f, 1.08f), random);
        if (i + 1 == n || (gate && fabsf(between) < PROM_CITY_PASSAGE)) continue;
        bool clear = between < q->stairs - 1.5f || between > q->stairs + 3;
        if (i % 2)
            prom_city_place_any(city, PROM_CITY_LAMP, node, between, y, TREE_LINE, 0, 1,
                                random);
        else if (clear)
            prom_city_place_any(city, PROM_CITY_BENCH, node, between, y, BENCH_LINE, 0, 1,
                                random);
        if (i % 3 == 1 && clear)
            prom_city_place_any(city, PROM_CITY_BIN, node, between + 1.8f, y, BENCH_LINE, 0, 1,
                                random);
        if (i % 4 == 2)
            prom_city_place_any(city, PROM_CITY_BICYCLE, node, between, y, 1.1f, 0, 1, random);
    }
}

static void park_along(prom_city *city, uint32_t node, float length, bool gate,
                       prom_random *random)
{
    float street = length - PROM_CITY_ROAD_WIDTH;
    for (uint32_t i = 0; i < prom_city_bays(street); i++)
        if (prom_random_unit(random) < 0.27f &&
            !(gate && fabsf(prom_city_bay(street, i)) < PROM_CITY_PASSAGE + PROM_CITY_BAY / 2))
            prom_city_park_car(city, node, prom_city_bay(street, i), -1.1f, 0, random);
}

// Boats lie along the wall; the large ones clear of the steps.
static void moor(prom_city *city, uint32_t node, const quay *q, prom_random *random)
{
    uint32_t first = city->first[PROM_CITY_BOAT];
    float y = PROM_CITY_WATER_LEVEL, wall = PROM_CITY_QUAY;
    uint32_t kind = prom_random_below(random, 3);
    float end = q->stairs + 1.5f + STEPS * TREAD;
    prom_city_place(city, first, node, end + 0.8f, y, wall + STAIR_WIDTH + 1.0f, PI / 2, 1);
    if (kind == 2) // two dinghies
        prom_city_place(city, first + 1, node, end + 5.6f, y, wall + 1.1f, -PI / 2, 1);
    else if (q->x1 - end > 20)
        prom_city_place(city, first + 2 + kind, node, q->x1 - 9.5f, y, wall + 2.5f, PI / 2, 1);
    if (q->stairs - q->x0 > 19 && prom_random_unit(random) < 0.6f)
        prom_city_place(city, first + 2 + prom_random_below(random, 2), node, q->x0 + 9.5f, y,
                        wall + 2.5f, -PI / 2, 1);
    else
        prom_city_place(city, first + 4, node, q->stairs - 6, y, wall + 1.6f, PI / 2, 1);
}

static quay_end end_at(const prom_city_plan *plan, uint32_t line)
{
    if (line == 0 || line == plan->columns) return END_CITY;
    prom_city_crossing c = prom_city_bridge_at(plan, line);
    return c == PROM_CITY_BRIDGE_FOR_CARS  ? END_BRIDGE
           : c == PROM_CITY_BRIDGE_ON_FOOT ? END_FOOT_BRIDGE
                                           : END_OPEN;
}

static void lay_quays(prom_city *city, const prom_city_plan *plan, uint32_t parent)
{
    for (uint32_t i = 0; i < plan->columns; i++) {
        float x0 = plan->street_x[i], x1 = plan->street_x[i + 1], length = x1 - x0;
        for (uint32_t bank = 0; bank < 2; bank++) {
            prom_random random =
                prom_random_stream(city->options.seed, 410, (uint64_t)i * 2 + bank);
            quay_end left = end_at(plan, i + bank), right = end_at(plan, i + 1 - bank);
            float half = PROM_CITY_ROAD_WIDTH / 2;
            float z = plan->street_z[plan->river + bank] + (bank ? -half : half);
            char *name = prom_format("quay_%s_%02u", bank ? "south" : "north", i);
            uint32_t node =
                prom_city_add_group(city, name, parent, (x0 + x1) / 2, z, bank ? PI : 0);
            prom_free(name);
            prom_city_add_mesh(city, "quay", node, quay_mesh(city, length, left, right), 0, 0,
                               0);
            quay q = measure_quay(length, left, right);
            bool gate = bank && plan->square % plan->columns == i;
            furnish(city, node, &q, gate, &random);
            park_along(city, node, length, gate, &random);
            moor(city, node, &q, &random);
        }
    }
}

static void lay_bridge(prom_city *city, uint32_t line, prom_city_crossing crossing, float x,
                       float z, uint32_t parent)
{
    bool stone = crossing == PROM_CITY_BRIDGE_FOR_CARS;
    char *name = prom_format("bridge_%02u", line);
    uint32_t node = prom_city_add_group(city, name, parent, x, z, 0);
    prom_free(name);
    prom_city_place(city, city->first[stone ? PROM_CITY_STONE_BRIDGE : PROM_CITY_FOOT_BRIDGE],
                    node, 0, 0, 0, 0, 1);
    if (!stone) return;
    // Lamps on the parapets over the piers and at both ends.
    static const float at[4] = {-16.1f, -6, 6, 16.1f};
    for (int i = 0; i < 8; i++) {
        float side = i & 1 ? 1.0f : -1.0f, along = at[i / 2];
        prom_city_place(city, city->first[PROM_CITY_LAMP], node, side * 7.2f,
                        prom_city_deck_height(along) + PROM_CITY_KERB + 1.25f, along, 0, 0.72f);
    }
}

void prom_city_lay_river(prom_city *city, const prom_city_plan *plan, uint32_t root)
{
    uint32_t node = prom_city_add_group(city, "river", root, 0, 0, 0);
    float middle = (plan->street_z[plan->river] + plan->street_z[plan->river + 1]) / 2;
    lay_quays(city, plan, node);
    for (uint32_t line = 0; line <= plan->columns; line++) {
        prom_city_crossing crossing = prom_city_bridge_at(plan, line);
        if (crossing != PROM_CITY_NO_BRIDGE)
            lay_bridge(city, line, crossing, plan->street_x[line], middle, node);
    }
}

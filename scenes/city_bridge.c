// Bridges: one of stone with three arches and a carriageway, one of steel for people on foot.
// The river flows along x below; the middle is at the origin, the carriageway's ends at y = 0.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f
#define BED (-4.2f)
#define HALF_LENGTH (PROM_CITY_WATER_WIDTH / 2 + PROM_CITY_QUAY)
#define HALF_ROAD (PROM_CITY_ROAD_WIDTH / 2)
#define PARAPET 0.35f
#define PARAPET_HEIGHT 0.95f
#define PARAPET_REACH 16.0f // where the parapets end
#define SPRING (-2.0f)      // where the arches begin
#define SECTIONS_MAX 512
#define PIERS 2

// ---- sections across the bridge, from -z to +z

typedef struct section {
    float z, deck, under; // heights of the carriageway and of the vault, BED where solid
} section;

typedef struct span {
    float z0, z1, crown;
} span;

static const span spans[3] = {{-15, -7, -0.22f}, {-5, 5, 0.42f}, {7, 15, -0.22f}};

static float vault(const span *s, float z)
{
    float t = (2 * z - s->z0 - s->z1) / (s->z1 - s->z0);
    return SPRING + (s->crown - SPRING) * sqrtf(fmaxf(0, 1 - t * t));
}

static int add_section(section *list, int n, float z, float under)
{
    list[n] = (section){z, prom_city_deck_height(z), under};
    return n + 1;
}

// In a span the sections stand closer towards its springs, where the vault is steep. At each
// border between solid and span there are two sections at one place.
static int make_sections(section *list, int points)
{
    int n = add_section(list, 0, -HALF_LENGTH, BED);
    n = add_section(list, n, -18, BED);
    n = add_section(list, n, -PROM_CITY_BRIDGE_REACH, BED);
    for (int s = 0; s < 3; s++) {
        n = add_section(list, n, spans[s].z0, BED);
        for (int i = 0; i <= points; i++) {
            float mid = (spans[s].z0 + spans[s].z1) / 2, half = (spans[s].z1 - spans[s].z0) / 2;
            float z =
                i == points ? spans[s].z1 : mid - half * cosf(PI * (float)i / (float)points);
            n = add_section(list, n, z, vault(&spans[s], z));
        }
        n = add_section(list, n, spans[s].z1, BED);
    }
    n = add_section(list, n, PROM_CITY_BRIDGE_REACH, BED);
    n = add_section(list, n, 18, BED);
    return add_section(list, n, HALF_LENGTH, BED);
}

// A strip along the bridge between two edges: x and a height above the deck or, where `under`,
// above the vault; from `a` (on its left as seen from the visible side, z rising) to `b`.
static void strip_quad(prom_solid *shape, const section *s, const section *t, float xa,
                       float ya, float xb, float yb)
{
    prom_solid_quad(shape, (float[]){xa, s->deck + ya, s->z}, (float[]){xa, t->deck + ya, t->z},
                    (float[]){xb, t->deck + yb, t->z}, (float[]){xb, s->deck + yb, s->z});
}

// ---- the way over it

static void build_carriageway(prom_city *city, prom_solid *shape, const section *list, int n)
{
    const float length = 2 * PROM_CITY_BAY;
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_LANE, 0xffffff, 8));
    for (int i = 0; i + 1 < n; i++) {
        const section *s = &list[i], *t = &list[i + 1];
        if (t->z - s->z < 1e-4f) continue;
        uint32_t first = 0;
        for (int k = 0; k < 6; k++) {
            const section *at = k < 3 ? s : t;
            float slope =
                (prom_city_deck_height(at->z + 0.1f) - prom_city_deck_height(at->z - 0.1f)) /
                0.2f;
            float l = sqrtf(1 + slope * slope), u = (float)(k % 3) / 2;
            uint32_t id =
                prom_solid_vertex(shape, (float[]){HALF_ROAD * (2 * u - 1), at->deck, at->z},
                                  (float[]){0, 1 / l, -slope / l}, u, at->z / length);
            if (!k) first = id;
        }
        for (uint32_t k = 0; k < 2; k++) {
            prom_solid_triangle(shape, first + k, first + k + 3, first + k + 4);
            prom_solid_triangle(shape, first + k, first + k + 4, first + k + 1);
        }
    }
}

static void build_pavements(prom_city *city, prom_solid *shape, const section *list, int n)
{
    const float kerb = 0.25f, up = PROM_CITY_KERB, edge = PROM_CITY_BRIDGE_HALF;
    for (int part = 0; part < 2; part++) {
        if (part)
            prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PAVING, 0xece4d8, 2.2f));
        else
            prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xb0aca4, 2));
        for (int i = 0; i + 1 < n; i++) {
            const section *s = &list[i], *t = &list[i + 1];
            if (t->z - s->z < 1e-4f) continue;
            float inner = HALF_ROAD + (part ? kerb : 0), outer = part ? edge : HALF_ROAD + kerb;
            strip_quad(shape, s, t, inner, up, outer, up);
            strip_quad(shape, s, t, -outer, up, -inner, up);
            if (part) continue;
            strip_quad(shape, s, t, HALF_ROAD, -0.1f, HALF_ROAD, up);
            // The mirrored face is seen from the other side.
            prom_solid_quad(shape, (float[]){-HALF_ROAD, t->deck - 0.1f, t->z},
                            (float[]){-HALF_ROAD, s->deck - 0.1f, s->z},
                            (float[]){-HALF_ROAD, s->deck + up, s->z},
                            (float[]){-HALF_ROAD, t->deck + up, t->z});
        }
    }
    // Kerbs towards the quay roads.
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xb0aca4, 2));
    for (int i = 0; i < 4; i++) {
        float x0 = i & 1 ? HALF_ROAD : -edge, x1 = i & 1 ? edge : -HALF_ROAD;
        prom_solid_box(shape, x0, -0.12f, i & 2 ? HALF_LENGTH - 0.1f : -HALF_LENGTH, x1, up,
                       i & 2 ? HALF_LENGTH : -HALF_LENGTH + 0.1f,
                       i & 2 ? PROM_FACE_FRONT : PROM_FACE_BACK);
    }
}

// ---- walls, one side: the frame's +z looks out from it, its +x runs along it

static void build_side(prom_city *city, prom_solid *shape, const section *list, int n,
                       bool right)
{
    const float top = PROM_CITY_KERB + PARAPET_HEIGHT;
    prom_solid_frame old =
        prom_solid_enter(shape, right ? PROM_CITY_BRIDGE_HALF : -PROM_CITY_BRIDGE_HALF, 0, 0,
                         right ? PI / 2 : -PI / 2);
    prom_paint stone = prom_city_paint(city, PROM_CITY_STONE, 0xd0c6b2, 2.4f);
    prom_paint trim = prom_city_paint(city, PROM_CITY_PLASTER, 0xc9c1b0, 1.5f);
    for (int i = 0; i + 1 < n; i++) {
        // From left to right as seen from outside.
        const section *s = right ? &list[n - 1 - i] : &list[i];
        const section *t = right ? &list[n - 2 - i] : &list[i + 1];
        float a = right ? -s->z : s->z, b = right ? -t->z : t->z;
        if (b - a < 1e-4f) continue;
        if (fmaxf(fabsf(a), fabsf(b)) > PARAPET_REACH + 0.6f) continue;
        prom_solid_use(shape, stone);
        prom_solid_quad(shape, (float[]){a, s->under, 0}, (float[]){b, t->under, 0},
                        (float[]){b, t->deck + top, 0}, (float[]){a, s->deck + top, 0});
        prom_solid_quad(shape, (float[]){b, t->deck, -PARAPET}, (float[]){a, s->deck, -PARAPET},
                        (float[]){a, s->deck + top, -PARAPET},
                        (float[]){b, t->deck + top, -PARAPET});
        // Rail on top and a string course at the deck's height.
        prom_solid_use(shape, trim);
        const float bars[2][4] = {{top, top + 0.14f, -PARAPET - 0.05f, 0.06f},
                                  {-0.12f, 0.10f, 0, 0.10f}};
        for (int k = 0; k < 2; k++) {
            float l = bars[k][0], h = bars[k][1], in = bars[k][2], out = bars[k][3];
            float sl = s->deck + l, sh = s->deck + h, tl = t->deck + l, th = t->deck + h;
            prom_solid_quad(shape, (float[]){a, sl, out}, (float[]){b, tl, out},
                            (float[]){b, th, out}, (float[]){a, sh, out});
            prom_solid_quad(shape, (float[]){a, sh, out}, (float[]){b, th, out},
                            (float[]){b, th, in}, (float[]){a, sh, in});
            prom_solid_quad(shape, (float[]){a, sl, in}, (float[]){b, tl, in},
                            (float[]){b, tl, out}, (float[]){a, sl, out});
            if (!k)
                prom_solid_quad(shape, (float[]){b, tl, in}, (float[]){a, sl, in},
                                (float[]){a, sh, in}, (float[]){b, th, in});
        }
        if (s->under <= BED || t->under <= BED) continue;
        // The arch's ring of stones.
        float sr = s->under + 0.5f, tr = t->under + 0.5f;
        prom_solid_quad(shape, (float[]){a, s->under, 0.07f}, (float[]){b, t->under, 0.07f},
                        (float[]){b, tr, 0.07f}, (float[]){a, sr, 0.07f});
        prom_solid_quad(shape, (float[]){a, sr, 0.07f}, (float[]){b, tr, 0.07f},
                        (float[]){b, tr, 0}, (float[]){a, sr, 0});
        prom_solid_quad(shape, (float[]){a, s->under, 0}, (float[]){b, t->under, 0},
                        (float[]){b, t->under, 0.07f}, (float[]){a, s->under, 0.07f});
    }
    prom_solid_leave(shape, old);
}

static void build_vaults(prom_city *city, prom_solid *shape, const section *list, int n)
{
    float x = PROM_CITY_BRIDGE_HALF;
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_STONE, 0xbab09e, 2.4f));
    for (int i = 0; i + 1 < n; i++) {
        const section *s = &list[i], *t = &list[i + 1];
        if (s->under <= BED && t->under <= BED) continue;
        // The vault from below, or the side of a pier.
        prom_solid_quad(shape, (float[]){-x, s->under, s->z}, (float[]){x, s->under, s->z},
                        (float[]){x, t->under, t->z}, (float[]){-x, t->under, t->z});
    }
}

// A pier's pointed end in the stream.
static void build_cutwater(prom_city *city, prom_solid *shape, float z, bool right)
{
    float x = PROM_CITY_BRIDGE_HALF, half = 1, out = 1.7f, top = -1.0f, peak = 0.1f;
    prom_solid_frame old =
        prom_solid_enter(shape, right ? x : -x, 0, z, right ? PI / 2 : -PI / 2);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_STONE, 0xc4baa6, 2.4f));
    const float *l = (float[]){-half, 0, 0}, *r = (float[]){half, 0, 0};
    prom_solid_quad(shape, (float[]){l[0], BED, 0}, (float[]){0, BED, out},
                    (float[]){0, top, out}, (float[]){l[0], top, 0});
    prom_solid_quad(shape, (float[]){0, BED, out}, (float[]){r[0], BED, 0},
                    (float[]){r[0], top, 0}, (float[]){0, top, out});
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xc9c1b0, 1.5f));
    prom_solid_flat_triangle(shape, (float[]){l[0], top, 0}, (float[]){0, top, out},
                             (float[]){0, peak, 0});
    prom_solid_flat_triangle(shape, (float[]){0, top, out}, (float[]){r[0], top, 0},
                             (float[]){0, peak, 0});
    prom_solid_leave(shape, old);
}

static void build_pedestals(prom_city *city, prom_solid *shape)
{
    static const float at[4] = {-16.1f, -6, 6, 16.1f};
    float x = PROM_CITY_BRIDGE_HALF - PARAPET / 2;
    for (int i = 0; i < 8; i++) {
        float cx = i & 1 ? x : -x, z = at[i / 2], y = prom_city_deck_height(z) + PROM_CITY_KERB;
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_STONE, 0xd6ccb8, 1.8f));
        prom_solid_box(shape, cx - 0.36f, y - 1.1f, z - 0.5f, cx + 0.36f, y + 1.13f, z + 0.5f,
                       PROM_FACE_SIDES | PROM_FACE_BOTTOM);
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xc9c1b0, 1.5f));
        prom_solid_box(shape, cx - 0.43f, y + 1.13f, z - 0.57f, cx + 0.43f, y + 1.26f,
                       z + 0.57f, PROM_FACE_ALL);
    }
}

static void build_stone_bridge(prom_city *city, prom_solid *shape)
{
    static const int points[5] = {0, 8, 14, 24, 40};
    section list[SECTIONS_MAX];
    int n = make_sections(list, points[city->options.detail]);
    build_carriageway(city, shape, list, n);
    build_pavements(city, shape, list, n);
    build_side(city, shape, list, n, true);
    build_side(city, shape, list, n, false);
    build_vaults(city, shape, list, n);
    for (int i = 0; i < 2 * PIERS; i++) build_cutwater(city, shape, i & 1 ? 6 : -6, i & 2);
    build_pedestals(city, shape);
}

// ---- on foot

#define FOOT_HALF 1.5f
#define FOOT_REACH (PROM_CITY_WATER_WIDTH / 2 + 0.5f)

static float foot_deck(float z)
{
    float t = z / FOOT_REACH;
    return PROM_CITY_KERB + 0.03f + 1.5f * (1 - t * t);
}

static float foot_arch(float z)
{
    float t = z / (PROM_CITY_WATER_WIDTH / 2 + 0.1f);
    return foot_deck(z) - 0.35f - 1.9f * t * t;
}

static void build_foot_sides(prom_city *city, prom_solid *shape, int segments)
{
    for (int side = -1; side <= 1; side += 2) {
        float x = (float)side * (FOOT_HALF - 0.08f), radii[65], line[3][65][3];
        for (int i = 0; i <= segments; i++) {
            float z = FOOT_REACH * (2 * (float)i / (float)segments - 1);
            radii[i] = 1;
            for (int k = 0; k < 3; k++) {
                line[k][i][0] = x;
                line[k][i][2] = z;
            }
            line[0][i][1] = foot_arch(z);
            line[1][i][1] = foot_deck(z) + 1.05f;
            line[2][i][1] = foot_deck(z) + 0.55f;
        }
        static const float thick[3] = {0.13f, 0.035f, 0.02f};
        prom_solid_use(shape, prom_city_plain(city, 0x3f6258));
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i <= segments; i++) radii[i] = thick[k];
            prom_solid_tube(shape, (const float(*)[3])line[k], radii, segments + 1,
                            prom_city_sides(city, 6));
        }
        for (int i = 0; i <= segments; i += 2) {
            float z = line[0][i][2], low = line[0][i][1], high = line[1][i][1];
            // Posts stand on the arch; beyond the wall they stand on the quay.
            low = fmaxf(low, fabsf(z) > PROM_CITY_WATER_WIDTH / 2 ? foot_deck(z) - 0.1f : -9);
            prom_solid_box(shape, x - 0.035f, low, z - 0.035f, x + 0.035f, high, z + 0.035f,
                           PROM_FACE_SIDES);
        }
    }
}

static void build_foot_bridge(prom_city *city, prom_solid *shape)
{
    int segments = city->options.detail < 2 ? 12 : city->options.detail < 4 ? 24 : 48;
    for (int i = 0; i < segments; i++) {
        float a = FOOT_REACH * (2 * (float)i / (float)segments - 1);
        float b = FOOT_REACH * (2 * (float)(i + 1) / (float)segments - 1);
        float ya = foot_deck(a), yb = foot_deck(b), x = FOOT_HALF, t = 0.16f;
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, 0xb49a7c, 1.6f));
        prom_solid_quad(shape, (float[]){-x, ya, a}, (float[]){-x, yb, b}, (float[]){x, yb, b},
                        (float[]){x, ya, a});
        prom_solid_use(shape, prom_city_plain(city, 0x3f6258));
        prom_solid_quad(shape, (float[]){-x, ya - t, a}, (float[]){x, ya - t, a},
                        (float[]){x, yb - t, b}, (float[]){-x, yb - t, b});
        prom_solid_quad(shape, (float[]){x, yb - t, b}, (float[]){x, ya - t, a},
                        (float[]){x, ya, a}, (float[]){x, yb, b});
        prom_solid_quad(shape, (float[]){-x, ya - t, a}, (float[]){-x, yb - t, b},
                        (float[]){-x, yb, b}, (float[]){-x, ya, a});
    }
    build_foot_sides(city, shape, segments);
    // Ties between the arches.
    for (int i = -3; i <= 3; i++) {
        float z = 4 * (float)i, y = foot_arch(z);
        prom_solid_box(shape, -FOOT_HALF + 0.1f, y - 0.06f, z - 0.06f, FOOT_HALF - 0.1f,
                       y + 0.06f, z + 0.06f, PROM_FACE_ALL);
    }
}

void prom_city_build_bridge(prom_city *city, const prom_city_prototype *which,
                            prom_solid *shape)
{
    if (which->kind == PROM_CITY_STONE_BRIDGE)
        build_stone_bridge(city, shape);
    else
        build_foot_bridge(city, shape);
}

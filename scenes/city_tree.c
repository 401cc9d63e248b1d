#include "scenes/city_parts.h"

#include <cglm/cglm.h>
#include <math.h>

#define PI 3.14159265f

typedef enum habit { BROAD, CONE, WEEPING } habit;

typedef struct species {
    const char *name;
    habit habit;
    float height, trunk; // metres; radius at the foot
    float crown[3];      // centre's height and half axes (across, up), as shares of height
    prom_city_texture leaves, bark;
    uint32_t tints[2];   // between which a tree's leaves are
    float card;          // size of a leaf card, metres
    int cards, branches; // at detail 2
    int lobes;           // round masses that the crown is made of; 0: one
} species;

#define LEAF PROM_CITY_LEAVES_BROAD
#define FINE PROM_CITY_LEAVES_SMALL
#define BARK PROM_CITY_BARK

// clang-format off
static const species park[] = {
    {"oak", BROAD, 12, 0.38f, {0.60f, 0.42f, 0.34f}, LEAF, BARK, {0xc8d8a8, 0xe0e8c0}, 1.15f, 430, 12, 9},
    {"poplar", BROAD, 17, 0.26f, {0.55f, 0.105f, 0.44f}, FINE, BARK, {0xb8d098, 0xcce0a8}, 0.95f, 430, 10, 0},
    {"birch", BROAD, 11, 0.16f, {0.60f, 0.21f, 0.36f}, FINE, PROM_CITY_BIRCH, {0xf4ffb8, 0xffffd0}, 0.80f, 340, 9, 6},
    {"linden", BROAD, 12, 0.28f, {0.60f, 0.29f, 0.37f}, LEAF, BARK, {0xe8f4b4, 0xd8ecb0}, 1.05f, 400, 10, 6},
    {"fir", CONE, 14, 0.24f, {0.26f, 0, 0.12f}, PROM_CITY_NEEDLES, BARK, {0xf0fff4, 0xe0f4f0}, 0, 300, 0, 0},
    {"beech", BROAD, 12, 0.32f, {0.58f, 0.37f, 0.38f}, PROM_CITY_LEAVES_RED, BARK, {0xffffff, 0xf0d8c8}, 1.05f, 400, 10, 7},
    {"apple", BROAD, 5.5f, 0.16f, {0.64f, 0.46f, 0.33f}, FINE, BARK, {0xe0f0c0, 0xf0f4c8}, 0.75f, 300, 8, 5},
    {"larch", CONE, 13, 0.20f, {0.19f, 0, 0.16f}, PROM_CITY_NEEDLES, BARK, {0xffffa8, 0xf4ffb0}, 0, 300, 0, 0},
};
static const species street[] = {
    {"linden", BROAD, 7.5f, 0.15f, {0.67f, 0.23f, 0.30f}, LEAF, BARK, {0xe8f4b4, 0xd8ecb0}, 0.84f, 240, 8, 5},
    {"maple", BROAD, 6.8f, 0.13f, {0.68f, 0.26f, 0.27f}, FINE, BARK, {0xf4f09a, 0xffffac}, 0.82f, 240, 8, 6},
    {"hornbeam", BROAD, 8, 0.14f, {0.62f, 0.16f, 0.34f}, LEAF, BARK, {0xc0d4a0, 0xccdcb0}, 0.82f, 240, 7, 0},
};
static const species quay[] = {
    {"plane", BROAD, 10.5f, 0.30f, {0.66f, 0.38f, 0.27f}, LEAF, PROM_CITY_PLANE_BARK, {0xf0f4b0, 0xe4ecb0}, 1.10f, 350, 11, 8},
};
static const species bank[] = {
    {"willow", WEEPING, 9, 0.34f, {0.62f, 0.44f, 0.30f}, PROM_CITY_LEAVES_HANGING, BARK, {0xe8f4d0, 0xf4ffc8}, 1.5f, 300, 9, 0},
};
static const species shrub[] = {
    {"box", BROAD, 1.3f, 0, {0.48f, 0.62f, 0.46f}, LEAF, BARK, {0xb8d0a0, 0xc8e0b0}, 0.55f, 120, 0, 0},
    {"privet", BROAD, 1.7f, 0, {0.48f, 0.55f, 0.46f}, FINE, BARK, {0xd8e8c0, 0xe8f0c8}, 0.55f, 140, 0, 3},
    {"barberry", BROAD, 1.2f, 0, {0.48f, 0.60f, 0.46f}, PROM_CITY_LEAVES_RED, BARK, {0xffffff, 0xfff0e0}, 0.50f, 120, 0, 0},
};
// clang-format on

#define COUNT(table) (sizeof(table) / sizeof *(table))

static const species *species_of(prom_city_kind kind, uint32_t number)
{
    switch (kind) {
    case PROM_CITY_STREET_TREE:
        return &street[number % COUNT(street)];
    case PROM_CITY_QUAY_TREE:
        return &quay[0];
    case PROM_CITY_WILLOW:
        return &bank[0];
    case PROM_CITY_SHRUB:
        return &shrub[number % COUNT(shrub)];
    case PROM_CITY_TREE:
    default:
        return &park[number % COUNT(park)];
    }
}

const char *prom_city_species(prom_city_kind kind, uint32_t number)
{
    return species_of(kind, number)->name;
}

// How many more pieces than at detail 2, and smaller in turn so that the crown stays as dense.
static float pieces(int detail)
{
    static const float factor[5] = {1, 0.28f, 1, 2.6f, 6.2f};
    return factor[detail];
}

static void random_direction(prom_random *random, vec3 out)
{
    float y = prom_random_between(random, -1, 1), a = prom_random_between(random, 0, 2 * PI);
    float r = sqrtf(1 - y * y);
    out[0] = r * cosf(a);
    out[1] = y;
    out[2] = r * sinf(a);
}

// ---- wood

// A limb from `from` to `to` that sags or rises by `bend` in its middle.
static void build_limb(prom_solid *shape, const float from[3], const float to[3], float bend,
                       float thick, int points, int sides)
{
    float line[8][3], radii[8];
    for (int i = 0; i < points; i++) {
        float t = (float)i / (float)(points - 1);
        glm_vec3_lerp((float *)from, (float *)to, t, line[i]);
        line[i][1] += 4 * bend * t * (1 - t);
        radii[i] = thick * (1 - 0.85f * t);
    }
    prom_solid_tube(shape, (const float(*)[3])line, radii, points, sides);
}

static void build_trunk(prom_solid *shape, const species *s, float height, int detail,
                        prom_random *random)
{
    float line[8][3], radii[8];
    int points = detail < 2 ? 4 : 7, sides = detail < 2    ? 5
                                             : detail == 2 ? 8
                                             : detail == 3 ? 12
                                                           : 20;
    float lean = prom_random_between(random, 0, 2 * PI), sway = 0.03f * height;
    for (int i = 0; i < points; i++) {
        float t = (float)i / (float)(points - 1), side = sway * t * t;
        line[i][0] = side * cosf(lean);
        line[i][1] = i ? t * height : -0.15f;
        line[i][2] = side * sinf(lean);
        radii[i] = s->trunk * (i ? 1 - 0.8f * t : 1.5f); // flared at the foot
    }
    prom_solid_tube(shape, (const float(*)[3])line, radii, points, sides);
}

static void build_branches(prom_solid *shape, const species *s, const float center[3],
                           const float half[3], int detail, prom_random *random)
{
    int count = (int)((float)s->branches * (detail < 2 ? 0.4f : detail == 2 ? 1 : 1.4f));
    int sides = detail < 3    ? 4
                : detail == 3 ? 6
                              : 9,
        points = detail < 2   ? 2
                 : detail < 4 ? 4
                              : 7;
    for (int i = 0; i < count; i++) {
        float turn = 2.39996f * (float)i, up = (float)i / (float)count; // golden angle
        vec3 from = {0, center[1] - half[1] * (0.95f - 0.9f * up), 0}, to;
        to[0] = center[0] + 0.72f * half[0] * cosf(turn) * (1 - 0.4f * up);
        to[1] = from[1] + half[1] * prom_random_between(random, 0.45f, 0.9f) * (1 - 0.3f * up);
        to[2] = center[2] + 0.72f * half[2] * sinf(turn) * (1 - 0.4f * up);
        build_limb(shape, from, to, 0.08f * half[1], s->trunk * 0.42f * (1 - 0.4f * up), points,
                   sides);
    }
}

// ---- leaves

static void build_card(prom_solid *shape, const float p[3], const float right[3],
                       const float up[3], const float normal[3])
{
    uint32_t first = 0;
    static const float corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int i = 0; i < 4; i++) {
        vec3 q;
        glm_vec3_copy((float *)p, q);
        glm_vec3_muladds((float *)right, corner[i][0], q);
        glm_vec3_muladds((float *)up, corner[i][1], q);
        uint32_t id = prom_solid_vertex(shape, q, normal, 0.5f + 0.5f * corner[i][0],
                                        0.5f - 0.5f * corner[i][1]);
        if (!i) first = id;
    }
    prom_solid_triangle(shape, first, first + 1, first + 2);
    prom_solid_triangle(shape, first, first + 2, first + 3);
}

typedef struct crown {
    float center[3], half[3];
    float card;
    bool hanging; // cards hang down
} crown;

static void add_card(prom_solid *shape, const crown *c, const float p[3], const float out[3],
                     const float normal[3], float size, prom_random *random)
{
    vec3 facing, right, up;
    float s = 0.5f * size * prom_random_between(random, 0.75f, 1.2f);
    if (c->hanging) {
        float a = prom_random_between(random, 0, 2 * PI);
        glm_vec3_copy((vec3){s * cosf(a), 0, s * sinf(a)}, right);
        glm_vec3_copy((vec3){0.15f * s * out[0], s, 0.15f * s * out[2]}, up);
    } else {
        random_direction(random, facing);
        glm_vec3_cross(facing, (vec3){0.1f, 1, 0.3f}, right);
        glm_vec3_normalize(right);
        glm_vec3_cross(facing, right, up);
        glm_vec3_scale(right, s, right);
        glm_vec3_scale(up, s, up);
    }
    build_card(shape, p, right, up, normal);
}

// Cards in the outer part of an ellipsoid, turned at random; lit as if they lay on the crown's
// surface, half on this part's, so that both look round.
static void build_mass(prom_solid *shape, const crown *whole, const float center[3],
                       const float half[3], int cards, prom_random *random)
{
    for (int i = 0; i < cards; i++) {
        vec3 out, p, normal, over;
        random_direction(random, out);
        float depth = 1 - 0.55f * prom_random_unit(random) * prom_random_unit(random);
        // Lumps: the surface is not an egg's.
        depth *= 0.88f + 0.12f * sinf(5 * out[0] + 1) * sinf(4 * out[1]) * sinf(5 * out[2] + 2);
        for (int k = 0; k < 3; k++) {
            p[k] = center[k] + out[k] * half[k] * depth;
            normal[k] = out[k] / half[k];
            over[k] = (p[k] - whole->center[k]) / (whole->half[k] * whole->half[k]);
        }
        glm_vec3_normalize(normal);
        if (glm_vec3_norm(over) > 1e-4f) {
            glm_vec3_normalize(over);
            glm_vec3_add(normal, over, normal);
            if (glm_vec3_norm(normal) < 0.1f) glm_vec3_copy(over, normal);
            glm_vec3_normalize(normal);
        }
        if (whole->hanging) p[1] -= 0.35f * half[1] * (1 - out[1]) * depth;
        add_card(shape, whole, p, out, normal, whole->card, random);
    }
}

static void build_crown(prom_solid *shape, const crown *c, int cards, int lobes,
                        prom_random *random)
{
    if (!lobes) {
        build_mass(shape, c, c->center, c->half, cards, random);
        return;
    }
    // A core, and lobes around it by the golden angle, the upper ones nearer to the axis.
    vec3 half, center;
    glm_vec3_scale((float *)c->half, 0.66f, half);
    build_mass(shape, c, c->center, half, cards / 4, random);
    for (int i = 0; i < lobes; i++) {
        float up = lobes > 1 ? (float)i / (float)(lobes - 1) : 0.5f;
        float turn = 2.39996f * (float)i + prom_random_between(random, -0.3f, 0.3f);
        float y = -0.45f + 1.05f * up, r = 0.60f * sqrtf(fmaxf(0.05f, 1 - y * y));
        float size = prom_random_between(random, 0.40f, 0.56f);
        center[0] = c->center[0] + c->half[0] * r * cosf(turn);
        center[1] = c->center[1] + c->half[1] * y;
        center[2] = c->center[2] + c->half[2] * r * sinf(turn);
        glm_vec3_scale((float *)c->half, size, half);
        half[1] = fmaxf(half[1], 0.75f * half[0]);
        build_mass(shape, c, center, half, (cards - cards / 4) / lobes, random);
    }
}

// Whorls of drooping branches, each a pair of needle cards crossed along the branch.
static void build_fir(prom_solid *shape, const species *s, float height, int detail,
                      prom_random *random)
{
    float density = sqrtf(pieces(detail));
    int tiers = (int)(15 * density), around = (int)(10 * density);
    for (int t = 0; t < tiers; t++) {
        float up = (float)t / (float)tiers;
        float y = height * (s->crown[2] + (0.98f - s->crown[2]) * up);
        float reach = s->crown[0] * height * (1 - up) + 0.35f;
        int count = around - (int)((float)around * 0.5f * up);
        for (int i = 0; i < count; i++) {
            float a = 2 * PI * ((float)i + 0.5f * (float)(t % 2)) / (float)count +
                      prom_random_between(random, -0.12f, 0.12f);
            float l = reach * prom_random_between(random, 0.85f, 1.1f),
                  droop = 0.32f - 0.5f * up;
            vec3 along = {cosf(a), -droop, sinf(a)}, side = {-sinf(a), 0, cosf(a)}, over, p,
                 normal;
            glm_vec3_normalize(along);
            glm_vec3_cross(side, along, over);
            glm_vec3_copy((vec3){0, y, 0}, p);
            glm_vec3_muladds(along, 0.5f * l, p);
            glm_vec3_copy((vec3){cosf(a), 0.7f, sinf(a)}, normal);
            glm_vec3_normalize(normal);
            glm_vec3_scale(along, 0.5f * l, along);
            glm_vec3_scale(side, 0.30f * l, side);
            glm_vec3_scale(over, 0.20f * l, over);
            build_card(shape, p, side, along, normal);
            if (detail > 1) build_card(shape, p, over, along, normal);
        }
    }
}

static uint32_t tint_of(const species *s, prom_random *random)
{
    // In few steps, so that trees share materials.
    uint32_t rgb = 0, step = prom_random_below(random, 3);
    for (int shift = 16; shift >= 0; shift -= 8) {
        uint32_t a = s->tints[0] >> shift & 255, b = s->tints[1] >> shift & 255;
        rgb |= (a * (2 - step) + b * step) / 2 << shift;
    }
    return rgb;
}

static void build_one(prom_city *city, prom_solid *shape, const species *s, float more,
                      int wood, prom_random *random)
{
    float height = s->height * prom_random_between(random, 0.85f, 1.15f);
    bool cone = s->habit == CONE;
    if (s->trunk > 0) {
        prom_solid_use(shape, prom_city_paint(city, s->bark, 0xffffff, 1));
        build_trunk(shape, s, cone ? height : height * (s->crown[0] + 0.2f), wood, random);
    }
    crown c = {.center = {0, s->crown[0] * height, 0},
               .half = {s->crown[1] * height, s->crown[2] * height, s->crown[1] * height},
               .card = s->card / sqrtf(sqrtf(more)),
               .hanging = s->habit == WEEPING};
    for (int k = 0; k < 3; k++) c.half[k] *= prom_random_between(random, 0.92f, 1.08f);
    if (s->branches) build_branches(shape, s, c.center, c.half, wood, random);
    prom_solid_use(shape, prom_city_paint(city, s->leaves, tint_of(s, random), 1));
    if (cone)
        build_fir(shape, s, height, wood, random);
    else
        build_crown(shape, &c, (int)((float)s->cards * more), s->lobes, random);
}

void prom_city_build_tree(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    const species *s = species_of(which->kind, which->number);
    prom_random random =
        prom_random_stream(city->options.seed, 200 + which->kind, which->number);
    int detail = (int)city->options.detail;
    build_one(city, shape, s, pieces(detail), detail, &random);
}

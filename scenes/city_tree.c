#include "scenes/city_parts.h"

#include <cglm/cglm.h>
#include <math.h>

#define PI 3.14159265f

typedef struct species {
    const char *name;
    float height, trunk; // metres; radius at the foot
    float crown[3];      // centre's height and half axes (across, up), as shares of height
    prom_city_texture leaves, bark;
    float card;          // size of a leaf card, metres
    int cards, branches; // at detail 2
} species;

static const species broad[] = {
    {"oak",
     11,
     0.34f,
     {0.62f, 0.42f, 0.34f},
     PROM_CITY_LEAVES_BROAD,
     PROM_CITY_BARK,
     1.15f,
     460,
     11},
    {"linden",
     12,
     0.28f,
     {0.60f, 0.30f, 0.38f},
     PROM_CITY_LEAVES_BROAD,
     PROM_CITY_BARK,
     1.05f,
     420,
     10},
    {"birch",
     10,
     0.17f,
     {0.62f, 0.24f, 0.36f},
     PROM_CITY_LEAVES_SMALL,
     PROM_CITY_BIRCH,
     0.85f,
     360,
     9},
    {"apple",
     5.5f,
     0.16f,
     {0.64f, 0.46f, 0.33f},
     PROM_CITY_LEAVES_SMALL,
     PROM_CITY_BARK,
     0.75f,
     330,
     8},
    {"poplar",
     14,
     0.24f,
     {0.56f, 0.14f, 0.43f},
     PROM_CITY_LEAVES_SMALL,
     PROM_CITY_BARK,
     0.95f,
     430,
     10},
    {"fir", 12, 0.22f, {0, 0, 0}, PROM_CITY_NEEDLES, PROM_CITY_BARK, 0, 300, 0},
};
static const species street[] = {
    {"linden",
     7.5f,
     0.15f,
     {0.67f, 0.23f, 0.30f},
     PROM_CITY_LEAVES_BROAD,
     PROM_CITY_BARK,
     0.80f,
     330,
     8},
    {"maple",
     6.8f,
     0.13f,
     {0.68f, 0.25f, 0.27f},
     PROM_CITY_LEAVES_SMALL,
     PROM_CITY_BARK,
     0.75f,
     330,
     8},
    {"hornbeam",
     8.0f,
     0.14f,
     {0.62f, 0.17f, 0.34f},
     PROM_CITY_LEAVES_BROAD,
     PROM_CITY_BARK,
     0.75f,
     330,
     7},
};
static const species shrub[] = {
    {"box",
     1.3f,
     0,
     {0.48f, 0.62f, 0.46f},
     PROM_CITY_LEAVES_BROAD,
     PROM_CITY_BARK,
     0.55f,
     130,
     0},
    {"privet",
     1.7f,
     0,
     {0.48f, 0.55f, 0.46f},
     PROM_CITY_LEAVES_SMALL,
     PROM_CITY_BARK,
     0.55f,
     150,
     0},
};

static const species *species_of(prom_city_kind kind, uint32_t number)
{
    if (kind == PROM_CITY_STREET_TREE)
        return &street[number % (sizeof street / sizeof *street)];
    if (kind == PROM_CITY_SHRUB) return &shrub[number % (sizeof shrub / sizeof *shrub)];
    return &broad[number % (sizeof broad / sizeof *broad)];
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

// Cards in the outer part of an ellipsoid, turned at random; lit as if they lay on its surface,
// so that the crown looks round.
static void build_crown(prom_solid *shape, const float center[3], const float half[3],
                        int cards, float size, prom_random *random)
{
    for (int i = 0; i < cards; i++) {
        vec3 out, p, normal, facing, right, up;
        random_direction(random, out);
        float depth = 1 - 0.55f * prom_random_unit(random) * prom_random_unit(random);
        // Lumps: the crown's surface is not an egg's.
        depth *= 0.88f + 0.12f * sinf(5 * out[0] + 1) * sinf(4 * out[1]) * sinf(5 * out[2] + 2);
        for (int k = 0; k < 3; k++) {
            p[k] = center[k] + out[k] * half[k] * depth;
            normal[k] = out[k] / half[k];
        }
        glm_vec3_normalize(normal);
        normal[1] += 0.25f;
        glm_vec3_normalize(normal);
        random_direction(random, facing);
        glm_vec3_muladds(out, 0.8f, facing);
        glm_vec3_normalize(facing);
        glm_vec3_cross(fabsf(facing[1]) < 0.9f ? (vec3){0, 1, 0} : (vec3){1, 0, 0}, facing,
                       right);
        glm_vec3_normalize(right);
        glm_vec3_cross(facing, right, up);
        float s = 0.5f * size * prom_random_between(random, 0.75f, 1.2f);
        glm_vec3_scale(right, s, right);
        glm_vec3_scale(up, s, up);
        build_card(shape, p, right, up, normal);
    }
}

// Whorls of drooping branches, each a pair of needle cards crossed along the branch.
static void build_fir(prom_solid *shape, float height, int detail, prom_random *random)
{
    float density = sqrtf(pieces(detail));
    int tiers = (int)(15 * density), around = (int)(10 * density);
    for (int t = 0; t < tiers; t++) {
        float up = (float)t / (float)tiers, y = height * (0.12f + 0.86f * up);
        float reach = 0.26f * height * (1 - up) + 0.35f;
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

void prom_city_build_tree(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    const species *s = species_of(which->kind, which->number);
    prom_random random =
        prom_random_stream(city->options.seed, 200 + which->kind, which->number);
    int detail = (int)city->options.detail;
    float height = s->height * prom_random_between(&random, 0.85f, 1.15f);
    static const uint32_t tints[] = {0xffffff, 0xe8f0c8, 0xd8e8d0, 0xf4e8b8};
    bool fir = s->leaves == PROM_CITY_NEEDLES;
    if (s->trunk > 0) {
        prom_solid_use(shape, prom_city_paint(city, s->bark, 0xffffff, 1));
        build_trunk(shape, s, fir ? height : height * (s->crown[0] + 0.2f), detail, &random);
    }
    float center[3] = {0, s->crown[0] * height, 0};
    float half[3] = {s->crown[1] * height, s->crown[2] * height, s->crown[1] * height};
    for (int k = 0; k < 3; k++) half[k] *= prom_random_between(&random, 0.92f, 1.08f);
    if (s->branches) build_branches(shape, s, center, half, detail, &random);
    prom_solid_use(shape,
                   prom_city_paint(city, s->leaves,
                                   fir ? 0xffffff : tints[prom_random_below(&random, 4)], 1));
    float more = pieces(detail);
    if (fir)
        build_fir(shape, height, detail, &random);
    else
        build_crown(shape, center, half, (int)((float)s->cards * more),
                    s->card / sqrtf(sqrtf(more)), &random);
}

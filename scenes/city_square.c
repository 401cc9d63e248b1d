// Blocks without rows of houses: the park, the square with its market, the churchyard.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f
#define TOWN_HALL_DEPTH 14.0f

static float turn(prom_city_site *s)
{
    return prom_random_between(s->random, 0, 2 * PI);
}

static void place_any(prom_city_site *s, prom_city_kind kind, float x, float z, float yaw,
                      float low, float high)
{
    prom_city_place_any(s->city, kind, s->node, x, PROM_CITY_KERB, z, yaw,
                        prom_random_between(s->random, low, high), s->random);
}

// ---- the park

void prom_city_fill_park(prom_city_site *s)
{
    float w = s->width, d = s->depth, o = PROM_CITY_PAVEMENT, step = 8.5f;
    place_any(s, PROM_CITY_FOUNTAIN, o + w / 2, o + d / 2, 0, 0.7f, 0.7f);
    for (float z = 4; z < d - 3; z += step) {
        for (float x = 4; x < w - 3; x += step) {
            float px = x + prom_random_between(s->random, -2.2f, 2.2f);
            float pz = z + prom_random_between(s->random, -2.2f, 2.2f);
            float path = fminf(fabsf(px - w / 2), fabsf(pz - d / 2));
            float lot = prom_random_unit(s->random);
            if (path < 3.2f || hypotf(px - w / 2, pz - d / 2) < 7 || lot < 0.15f) continue;
            place_any(s, lot < 0.35f ? PROM_CITY_SHRUB : PROM_CITY_TREE, o + px, o + pz,
                      turn(s), 0.8f, 1.15f);
        }
    }
    for (int i = 0; i < 8; i++) {
        // Along both paths, on both sides, looking at the path.
        float side = i & 1 ? 1.0f : -1.0f, at = i & 2 ? 0.3f : 0.7f;
        if (i & 4)
            place_any(s, PROM_CITY_BENCH, o + w / 2 + 2.1f * side, o + d * at, -side * PI / 2,
                      1, 1);
        else
            place_any(s, PROM_CITY_BENCH, o + w * at, o + d / 2 + 2.1f * side,
                      side > 0 ? PI : 0, 1, 1);
        if (i & 1) continue;
        float lx = i & 4 ? w / 2 + (i & 2 ? 2.0f : -2.0f) : w * (at + 0.12f);
        float lz = i & 4 ? d * (at + 0.12f) : d / 2 + (i & 2 ? 2.0f : -2.0f);
        place_any(s, PROM_CITY_LAMP, o + lx, o + lz, 0, 1, 1);
    }
}

// ---- the square: open to the north (smaller z), the town hall at its south end

static void fill_market(prom_city_site *s, float cx, float from, float to)
{
    // Two rows of stalls that face each other, to the west of the middle.
    for (float z = from; z <= to; z += 4.6f) {
        for (int k = 0; k < 2; k++) {
            if (prom_random_unit(s->random) < 0.12f) continue;
            place_any(s, PROM_CITY_STALL, cx - (k ? 16.5f : 9.5f), z, k ? PI / 2 : -PI / 2, 1,
                      1);
        }
    }
}

void prom_city_fill_square(prom_city_site *s, bool with_town_hall)
{
    float w = s->width, d = s->depth, o = PROM_CITY_PAVEMENT, cx = o + w / 2;
    float end = o + d - (with_town_hall ? TOWN_HALL_DEPTH + 3 : 0);
    float middle = (o + end) / 2;
    if (with_town_hall)
        prom_city_place(s->city, s->city->first[PROM_CITY_TOWN_HALL], s->node, cx,
                        PROM_CITY_KERB, o + d - TOWN_HALL_DEPTH - 0.5f, PI, 1);
    prom_city_place(s->city, s->city->first[PROM_CITY_MONUMENT] + !with_town_hall, s->node, cx,
                    PROM_CITY_KERB, end - 8.5f, PI, 1);
    place_any(s, PROM_CITY_FOUNTAIN, cx - 13, end - 6, 0, 1, 1);
    fill_market(s, cx, o + 9, end - 12);
    // A cafe's tables on the other side.
    for (int i = 0; i < 9; i++)
        place_any(s, PROM_CITY_CAFE, cx + 13.5f + 3.4f * (float)(i % 3),
                  middle - 4 + 3.6f * (float)(i / 3), turn(s), 1, 1);
    for (int i = 0; i < 6; i++) {
        float a = PI * ((float)i - 2.5f) / 6;
        place_any(s, PROM_CITY_BENCH, cx + 5.2f * sinf(a), end - 8.5f - 5.2f * cosf(a), -a, 1,
                  1);
    }
    for (float z = 4; z < end - o - 2; z += 8.2f)
        for (int k = 0; k < 2; k++)
            place_any(s, PROM_CITY_QUAY_TREE, o + (k ? w - 2.2f : 2.2f), o + z, turn(s), 0.8f,
                      0.95f);
    for (int i = 0; i < 4; i++)
        place_any(s, PROM_CITY_LAMP, cx + (i & 1 ? 7.5f : -7.5f), i & 2 ? o + 7 : end - 3.5f, 0,
                  1, 1);
    for (float x = 1.5f; x < w - 1; x += 2.4f)
        if (fabsf(x - w / 2) > 3) place_any(s, PROM_CITY_BOLLARD, o + x, o + 0.4f, 0, 1, 1);
}

// ---- the church among trees, its tower to the north

void prom_city_fill_church(prom_city_site *s)
{
    float w = s->width, d = s->depth, o = PROM_CITY_PAVEMENT, cx = o + w / 2;
    prom_city_place(s->city, s->city->first[PROM_CITY_CHURCH], s->node, cx, PROM_CITY_KERB,
                    o + 8, PI, 1);
    for (float z = 3; z < d - 1; z += 8)
        for (int k = 0; k < 4; k++) {
            float x = (k & 1 ? 1.0f : -1.0f) * (k & 2 ? w / 2 - 3 : w / 2 - 10.5f);
            if (prom_random_unit(s->random) < (k & 2 ? 0.2f : 0.6f)) continue;
            place_any(s, PROM_CITY_TREE, cx + x + prom_random_between(s->random, -1, 1), o + z,
                      turn(s), 0.7f, 0.95f);
        }
    for (int i = 0; i < 6; i++)
        place_any(s, PROM_CITY_SHRUB, cx + (i & 1 ? 8.3f : -8.3f), o + 14 + 6 * (float)(i / 2),
                  turn(s), 0.7f, 1);
    for (int i = 0; i < 2; i++) {
        float side = i ? 1.0f : -1.0f;
        place_any(s, PROM_CITY_BENCH, cx + 3 * side, o + 3.5f, -side * PI / 2, 1, 1);
        place_any(s, PROM_CITY_LAMP, cx + 2.4f * side, o + 5.6f, 0, 1, 1);
    }
}

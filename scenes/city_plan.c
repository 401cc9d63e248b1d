// Where the streets run, where the river, and what each block is for.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f

// Outer sizes of blocks, pavement included. Few of them, so that their grounds are shared.
static const float sizes[] = {51, 56, 61};

// ---- lines

// Centre lines of the streets around `count` intervals; interval `river` is the river.
static float *draw_lines(uint32_t count, uint32_t river, prom_random *random)
{
    float *lines = prom_alloc(count + 1, sizeof *lines), at = 0;
    for (uint32_t i = 0; i <= count; i++) {
        float between = i == river ? 2 * PROM_CITY_QUAY + PROM_CITY_WATER_WIDTH
                                   : sizes[prom_random_below(random, 3)];
        lines[i] = at;
        at += PROM_CITY_ROAD_WIDTH + between;
    }
    float middle = roundf(lines[count] / 2);
    for (uint32_t i = 0; i <= count; i++) lines[i] -= middle;
    return lines;
}

// ---- uses

static void mark(prom_city_plan *plan, uint32_t i, uint32_t j, prom_city_use use)
{
    plan->uses[j * plan->columns + i] = use;
}

// The square faces the river beside the first bridge; church and park are its neighbours. Far
// from them there is a park for about every tenth block, a square for every sixteenth and a
// church for every thirtieth.
static void draw_uses(prom_city_plan *plan, uint32_t blocks, prom_random *random)
{
    uint32_t cells = plan->columns * plan->rows, n = blocks * blocks;
    uint32_t south = plan->river + 1, m = plan->middle;
    plan->uses = prom_calloc(cells, sizeof *plan->uses);
    plan->square = PROM_GLB_NONE;
    if (plan->river == PROM_GLB_NONE) return;
    plan->square = south * plan->columns + m - 1;
    mark(plan, m - 1, south, PROM_CITY_USE_SQUARE);
    if (n < 9) return;
    mark(plan, m + 1 < plan->columns ? m + 1 : m, south, PROM_CITY_USE_CHURCH);
    mark(plan, m >= 2 ? m - 2 : 0, m >= 2 ? south : 0, PROM_CITY_USE_PARK);
    uint32_t parks = n / 10 - (n >= 10), squares = n / 16 - (n >= 16), churches = n / 30;
    for (uint32_t i = 0; i < parks + squares + churches;) {
        uint32_t at = prom_random_below(random, cells), row = at / plan->columns;
        bool near = row + 1 >= plan->river && row <= south && at % plan->columns + 1 >= m - 1 &&
                    at % plan->columns <= m + 1;
        if (plan->uses[at] != PROM_CITY_USE_HOUSES || row == plan->river || near) continue;
        plan->uses[at] = i < parks             ? PROM_CITY_USE_PARK
                         : i < parks + squares ? PROM_CITY_USE_SQUARE
                                               : PROM_CITY_USE_CHURCH;
        i++;
    }
}

void prom_city_plan_init(prom_city_plan *plan, const prom_city_options *options)
{
    prom_random random = prom_random_stream(options->seed, 400, 0);
    bool river = options->blocks >= 2;
    *plan = (prom_city_plan){
        .columns = options->blocks,
        .rows = options->blocks + river,
        .river = river ? (options->blocks + 1) / 2 : PROM_GLB_NONE,
        .middle = options->blocks / 2,
    };
    plan->street_x = draw_lines(plan->columns, PROM_GLB_NONE, &random);
    plan->street_z = draw_lines(plan->rows, plan->river, &random);
    draw_uses(plan, options->blocks, &random);
}

void prom_city_plan_finish(prom_city_plan *plan)
{
    prom_free(plan->street_x);
    prom_free(plan->street_z);
    prom_free(plan->uses);
    *plan = (prom_city_plan){0};
}

// ---- the river

prom_city_crossing prom_city_bridge_at(const prom_city_plan *plan, uint32_t line)
{
    if (plan->river == PROM_GLB_NONE || !line || line >= plan->columns)
        return PROM_CITY_NO_BRIDGE;
    uint32_t k = (line + 3 - plan->middle % 3) % 3; // every third line from the middle one
    return k == 0   ? PROM_CITY_BRIDGE_FOR_CARS
           : k == 1 ? PROM_CITY_BRIDGE_ON_FOOT
                    : PROM_CITY_NO_BRIDGE;
}

float prom_city_deck_height(float z)
{
    if (fabsf(z) >= PROM_CITY_BRIDGE_REACH) return 0;
    float c = cosf(PI / 2 * z / PROM_CITY_BRIDGE_REACH);
    return PROM_CITY_BRIDGE_RISE * c * c;
}

// ---- heights

// Where `at` lies among the lines: the interval, or the line whose street it is in.
static bool in_street(const float *lines, uint32_t count, float at, uint32_t *index)
{
    for (uint32_t i = 0; i <= count; i++) {
        if (fabsf(at - lines[i]) <= PROM_CITY_ROAD_WIDTH / 2) {
            *index = i;
            return true;
        }
        if (at < lines[i]) break;
        *index = i;
    }
    return false;
}

float prom_city_ground_height(const prom_city_plan *plan, float x, float z)
{
    uint32_t i = 0, j = 0;
    bool street_x = in_street(plan->street_x, plan->columns, x, &i);
    bool street_z = in_street(plan->street_z, plan->rows, z, &j);
    if (street_z) return 0;
    if (plan->river == PROM_GLB_NONE || j != plan->river) return street_x ? 0 : PROM_CITY_KERB;
    float middle = (plan->street_z[j] + plan->street_z[j + 1]) / 2;
    for (uint32_t line = 0; line <= plan->columns; line++) {
        if (prom_city_bridge_at(plan, line) != PROM_CITY_BRIDGE_FOR_CARS) continue;
        float side = fabsf(x - plan->street_x[line]);
        if (side > PROM_CITY_BRIDGE_HALF) continue;
        return prom_city_deck_height(z - middle) +
               (side > PROM_CITY_ROAD_WIDTH / 2 ? PROM_CITY_KERB : 0);
    }
    return PROM_CITY_KERB;
}

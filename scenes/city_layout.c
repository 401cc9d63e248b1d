#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f

// ---- blocks

static bool by_river(const prom_city_plan *plan, uint32_t i, uint32_t row)
{
    // Warehouses stand downstream, at the city's edge.
    return plan->river != PROM_GLB_NONE && row == plan->river && i + 1 == plan->columns;
}

static void fill_block(prom_city_site *site, prom_city_use use, bool with_town_hall)
{
    if (use == PROM_CITY_USE_PARK)
        prom_city_fill_park(site);
    else if (use == PROM_CITY_USE_SQUARE)
        prom_city_fill_square(site, with_town_hall);
    else if (use == PROM_CITY_USE_CHURCH)
        prom_city_fill_church(site);
    else
        prom_city_fill_houses(site);
    prom_city_fill_pavements(site);
}

static void lay_block(prom_city *city, const prom_city_plan *plan, uint32_t i, uint32_t j,
                      uint32_t root)
{
    float half = PROM_CITY_ROAD_WIDTH / 2;
    float x0 = plan->street_x[i] + half, x1 = plan->street_x[i + 1] - half;
    float z0 = plan->street_z[j] + half, z1 = plan->street_z[j + 1] - half;
    uint32_t at = j * plan->columns + i;
    prom_random random = prom_random_stream(city->options.seed, 402, (uint64_t)i << 32 | j);
    char *name = prom_format("block_%02u_%02u", i, j);
    uint32_t node = prom_city_add_group(city, name, root, x0, z0, 0);
    prom_free(name);
    prom_city_use use = plan->uses[at];
    prom_city_add_mesh(city, "ground", node,
                       prom_city_block_ground(city, use, x1 - x0, z1 - z0), 0, 0, 0);
    prom_city_site site = {
        .city = city,
        .node = node,
        .width = x1 - x0 - 2 * PROM_CITY_PAVEMENT,
        .depth = z1 - z0 - 2 * PROM_CITY_PAVEMENT,
        .random = &random,
        .gate = at == plan->square,
        .warehouses_to_south = by_river(plan, i, j + 1),
        .warehouses_to_north = j > 0 && by_river(plan, i, j - 1),
    };
    fill_block(&site, use, at == plan->square);
}

// ---- streets

static void lay_streets(prom_city *city, const prom_city_plan *plan, uint32_t root)
{
    uint32_t node = prom_city_add_group(city, "streets", root, 0, 0, 0);
    for (uint32_t j = 0; j <= plan->rows; j++) {
        for (uint32_t i = 0; i <= plan->columns; i++) {
            float x = plan->street_x[i], z = plan->street_z[j];
            prom_city_add_mesh(city, "crossing", node, prom_city_crossing_ground(city), x, z,
                               0);
            if (i < plan->columns) {
                float next = plan->street_x[i + 1], length = next - x - PROM_CITY_ROAD_WIDTH;
                bool passage = plan->square != PROM_GLB_NONE && j == plan->river + 1 &&
                               plan->square % plan->columns == i;
                prom_city_add_mesh(city, "street", node,
                                   prom_city_street_ground(city, length, passage),
                                   (x + next) / 2, z, PI / 2);
            }
            if (j < plan->rows && j != plan->river) {
                float next = plan->street_z[j + 1], length = next - z - PROM_CITY_ROAD_WIDTH;
                prom_city_add_mesh(city, "street", node,
                                   prom_city_street_ground(city, length, false), x,
                                   (z + next) / 2, 0);
            }
        }
    }
}

void prom_city_lay_out(prom_city *city, const prom_city_plan *plan)
{
    uint32_t root = prom_city_add_group(city, "city", PROM_GLB_NONE, 0, 0, 0);
    for (uint32_t j = 0; j < plan->rows; j++)
        for (uint32_t i = 0; i < plan->columns && !prom_glb_failed(city->glb); i++)
            if (j != plan->river) lay_block(city, plan, i, j, root);
    lay_streets(city, plan, root);
    if (plan->river != PROM_GLB_NONE) prom_city_lay_river(city, plan, root);
    prom_city_lay_land(city, plan, root);
}

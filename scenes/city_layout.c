#include "scenes/city_parts.h"

#include "metaobj/base/log.h"

#include <math.h>

// ---- the plan

// Outer sizes of blocks, pavement included. Few of them, so that their grounds are shared.
static const float sizes[] = {51, 56, 61};

static float *draw_lines(uint32_t blocks, prom_random *random)
{
    float *lines = prom_alloc(blocks + 1, sizeof *lines), at = 0;
    for (uint32_t i = 0; i <= blocks; i++) {
        lines[i] = at;
        at += PROM_CITY_ROAD_WIDTH + sizes[prom_random_below(random, 3)];
    }
    float middle = roundf(lines[blocks] / 2);
    for (uint32_t i = 0; i <= blocks; i++) lines[i] -= middle;
    return lines;
}

void prom_city_plan_init(prom_city_plan *plan, const prom_city_options *options)
{
    prom_random random = prom_random_stream(options->seed, 400, 0);
    plan->blocks = options->blocks;
    plan->street_x = draw_lines(options->blocks, &random);
    plan->street_z = draw_lines(options->blocks, &random);
}

void prom_city_plan_finish(prom_city_plan *plan)
{
    prom_free(plan->street_x);
    prom_free(plan->street_z);
    *plan = (prom_city_plan){0};
}

// ---- placing

static uint32_t prototype_mesh(prom_city *city, prom_city_prototype *p, const char *name)
{
    if (p->mesh != PROM_GLB_NONE) return p->mesh;
    prom_solid shape;
    prom_solid_init(&shape);
    if (p->kind == PROM_CITY_HOUSE)
        prom_city_build_house(city, p, &shape);
    else if (p->kind <= PROM_CITY_SHRUB)
        prom_city_build_tree(city, p, &shape);
    else
        prom_city_build_thing(city, p, &shape);
    prom_log(PROM_LOG_DEBUG, "%s: %u triangles", name, prom_solid_triangles(&shape));
    p->mesh = prom_solid_write(&shape, city->glb, name);
    prom_solid_finish(&shape);
    return p->mesh;
}

static char *prototype_name(const prom_city_prototype *p)
{
    static const char *const names[PROM_CITY_KIND_COUNT] = {
        "house", "tree", "tree", "shrub", "lamp", "bench", "car", "bin", "fountain", "stall"};
    if (p->kind == PROM_CITY_HOUSE) return prom_format("house_%02u", p->number);
    if (p->kind <= PROM_CITY_SHRUB)
        return prom_format("%s_%s_%u", names[p->kind], prom_city_species(p->kind, p->number),
                           p->number);
    return prom_format("%s_%u", names[p->kind], p->number);
}

void prom_city_place(prom_city *city, uint32_t prototype, uint32_t parent, float x, float y,
                     float z, float yaw, float scale)
{
    prom_city_prototype *p = &city->prototypes.data[prototype];
    char *name = prototype_name(p);
    prom_glb_node node = {.name = name,
                          .parent = parent,
                          .mesh = prototype_mesh(city, p, name),
                          .translation = {(double)x, (double)y, (double)z},
                          .yaw = (double)yaw,
                          .scale = (double)scale};
    prom_glb_add_node(city->glb, &node);
    p->uses++;
    prom_free(name);
}

static uint32_t add_group(prom_city *city, const char *name, uint32_t parent, float x, float z)
{
    return prom_glb_add_node(city->glb,
                             &(prom_glb_node){.name = name,
                                              .parent = parent,
                                              .mesh = PROM_GLB_NONE,
                                              .translation = {(double)x, 0, (double)z},
                                              .scale = 1});
}

static void add_ground(prom_city *city, const char *name, uint32_t parent, uint32_t mesh,
                       float x, float z, float yaw)
{
    prom_glb_add_node(city->glb, &(prom_glb_node){.name = name,
                                                  .parent = parent,
                                                  .mesh = mesh,
                                                  .translation = {(double)x, 0, (double)z},
                                                  .yaw = (double)yaw,
                                                  .scale = 1});
}

// ---- blocks and streets

// A park for about every tenth block and a square for every sixteenth, at least one of each in
// a city that is large enough to keep enough houses.
static prom_city_use *draw_uses(const prom_city *city, uint32_t blocks)
{
    uint32_t n = blocks * blocks, parks = n >= 4 ? (n + 9) / 10 : 0,
             squares = n >= 9 ? (n + 15) / 16 : 0;
    prom_city_use *uses = prom_calloc(n, sizeof *uses);
    prom_random random = prom_random_stream(city->options.seed, 401, 0);
    for (uint32_t i = 0; i < parks + squares;) {
        uint32_t at = prom_random_below(&random, n);
        if (uses[at] != PROM_CITY_USE_HOUSES) continue;
        uses[at] = i < parks ? PROM_CITY_USE_PARK : PROM_CITY_USE_SQUARE;
        i++;
    }
    return uses;
}

static void lay_block(prom_city *city, const prom_city_plan *plan, uint32_t i, uint32_t j,
                      prom_city_use use, uint32_t root)
{
    float half = PROM_CITY_ROAD_WIDTH / 2;
    float x0 = plan->street_x[i] + half, x1 = plan->street_x[i + 1] - half;
    float z0 = plan->street_z[j] + half, z1 = plan->street_z[j + 1] - half;
    prom_random random = prom_random_stream(city->options.seed, 402, (uint64_t)i << 32 | j);
    char *name = prom_format("block_%02u_%02u", i, j);
    uint32_t node = add_group(city, name, root, x0, z0);
    prom_free(name);
    add_ground(city, "ground", node, prom_city_block_ground(city, use, x1 - x0, z1 - z0), 0, 0,
               0);
    prom_city_fill_block(city, node, use, x1 - x0 - 2 * PROM_CITY_PAVEMENT,
                         z1 - z0 - 2 * PROM_CITY_PAVEMENT, &random);
}

static void lay_streets(prom_city *city, const prom_city_plan *plan, uint32_t root)
{
    uint32_t n = plan->blocks, node = add_group(city, "streets", root, 0, 0);
    for (uint32_t j = 0; j <= n; j++) {
        for (uint32_t i = 0; i <= n; i++) {
            float x = plan->street_x[i], z = plan->street_z[j];
            add_ground(city, "crossing", node, prom_city_crossing_ground(city), x, z, 0);
            if (i < n) {
                float next = plan->street_x[i + 1], length = next - x - PROM_CITY_ROAD_WIDTH;
                add_ground(city, "street", node, prom_city_street_ground(city, length),
                           (x + next) / 2, z, 1.57079633f);
            }
            if (j < n) {
                float next = plan->street_z[j + 1], length = next - z - PROM_CITY_ROAD_WIDTH;
                add_ground(city, "street", node, prom_city_street_ground(city, length), x,
                           (z + next) / 2, 0);
            }
        }
    }
}

void prom_city_lay_out(prom_city *city, const prom_city_plan *plan)
{
    uint32_t n = plan->blocks, root = add_group(city, "city", PROM_GLB_NONE, 0, 0);
    prom_city_use *uses = draw_uses(city, n);
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i < n && !prom_glb_failed(city->glb); i++)
            lay_block(city, plan, i, j, uses[j * n + i], root);
    prom_free(uses);
    lay_streets(city, plan, root);
    float half = PROM_CITY_ROAD_WIDTH / 2;
    prom_city_land(city, plan->street_x[0] - half, plan->street_z[0] - half,
                   plan->street_x[n] + half, plan->street_z[n] + half,
                   add_group(city, "land", root, 0, 0));
}

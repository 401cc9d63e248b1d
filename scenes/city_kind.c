// The kinds of things that a city is made of, and how one is placed.
#include "scenes/city_parts.h"

#include "metaobj/base/log.h"

typedef void (*builder)(prom_city *city, const prom_city_prototype *which, prom_solid *shape);

// How many different ones a city has: at least `least`, one for each `per` house styles
// (0: no more), so that no mesh is most of a large city.
static const struct {
    const char *name;
    builder build;
    uint32_t least, per;
} kinds[PROM_CITY_KIND_COUNT] = {
    [PROM_CITY_HOUSE] = {"house", prom_city_build_house, 3, 1},
    [PROM_CITY_VILLA] = {"villa", prom_city_build_house, 4, 8},
    [PROM_CITY_TREE] = {"tree", prom_city_build_tree, 8, 4},
    [PROM_CITY_STREET_TREE] = {"tree", prom_city_build_tree, 6, 4},
    [PROM_CITY_QUAY_TREE] = {"tree", prom_city_build_tree, 2, 12},
    [PROM_CITY_WILLOW] = {"tree", prom_city_build_tree, 1, 40},
    [PROM_CITY_SHRUB] = {"shrub", prom_city_build_tree, 3, 12},
    [PROM_CITY_GROVE] = {"wood", prom_city_build_wood, 4, 8},
    [PROM_CITY_LAMP] = {"lamp", prom_city_build_thing, 2, 0},
    [PROM_CITY_MAST] = {"mast", prom_city_build_thing, 1, 0},
    [PROM_CITY_BENCH] = {"bench", prom_city_build_thing, 3, 0},
    [PROM_CITY_BIN] = {"bin", prom_city_build_thing, 1, 0},
    [PROM_CITY_BOLLARD] = {"bollard", prom_city_build_thing, 1, 0},
    [PROM_CITY_SIGN] = {"sign", prom_city_build_thing, 3, 0},
    [PROM_CITY_COLUMN] = {"column", prom_city_build_thing, 1, 0},
    [PROM_CITY_STALL] = {"stall", prom_city_build_square_thing, 4, 0},
    [PROM_CITY_CAFE] = {"cafe", prom_city_build_square_thing, 2, 0},
    [PROM_CITY_FOUNTAIN] = {"fountain", prom_city_build_square_thing, 1, 0},
    [PROM_CITY_MONUMENT] = {"monument", prom_city_build_square_thing, 2, 0},
    [PROM_CITY_CAR] = {"car", prom_city_build_car, 10, 4},
    [PROM_CITY_BICYCLE] = {"bicycle", prom_city_build_bicycle, 3, 0},
    [PROM_CITY_BOAT] = {"boat", prom_city_build_boat, 5, 0},
    [PROM_CITY_TERRACE] = {"terrace", prom_city_build_terrace, 1, 0},
    [PROM_CITY_TOWN_HALL] = {"town_hall", prom_city_build_landmark, 1, 0},
    [PROM_CITY_CHURCH] = {"church", prom_city_build_landmark, 1, 0},
    [PROM_CITY_STONE_BRIDGE] = {"stone_bridge", prom_city_build_bridge, 1, 0},
    [PROM_CITY_FOOT_BRIDGE] = {"foot_bridge", prom_city_build_bridge, 1, 0},
};

void prom_city_list_prototypes(prom_city *city)
{
    for (prom_city_kind kind = 0; kind < PROM_CITY_KIND_COUNT; kind++) {
        uint32_t count = kinds[kind].per ? city->options.styles / kinds[kind].per : 0;
        if (count < kinds[kind].least) count = kinds[kind].least;
        city->first[kind] = (uint32_t)city->prototypes.count;
        for (uint32_t i = 0; i < count; i++) {
            prom_city_prototype p = {.kind = kind, .number = i, .mesh = PROM_GLB_NONE};
            if (kind == PROM_CITY_HOUSE) prom_city_measure_house(city, &p);
            prom_array_push(&city->prototypes, p);
        }
    }
    city->first[PROM_CITY_KIND_COUNT] = (uint32_t)city->prototypes.count;
}

static uint32_t prototype_mesh(prom_city *city, prom_city_prototype *p, const char *name)
{
    if (p->mesh != PROM_GLB_NONE) return p->mesh;
    prom_solid shape;
    prom_solid_init(&shape);
    kinds[p->kind].build(city, p, &shape);
    prom_log(PROM_LOG_DEBUG, "%s: %u triangles", name, prom_solid_triangles(&shape));
    p->mesh = prom_solid_write(&shape, city->glb, name);
    prom_solid_finish(&shape);
    return p->mesh;
}

static char *prototype_name(const prom_city_prototype *p)
{
    const char *kind = kinds[p->kind].name;
    if (p->kind <= PROM_CITY_VILLA) return prom_format("%s_%02u", kind, p->number);
    if (p->kind <= PROM_CITY_SHRUB)
        return prom_format("%s_%s_%u", kind, prom_city_species(p->kind, p->number), p->number);
    return prom_format("%s_%u", kind, p->number);
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

void prom_city_place_any(prom_city *city, prom_city_kind kind, uint32_t parent, float x,
                         float y, float z, float yaw, float scale, prom_random *random)
{
    uint32_t first = city->first[kind], count = city->first[kind + 1] - first;
    prom_city_place(city, first + prom_random_below(random, count), parent, x, y, z, yaw,
                    scale);
}

uint32_t prom_city_add_group(prom_city *city, const char *name, uint32_t parent, float x,
                             float z, float yaw)
{
    return prom_glb_add_node(city->glb,
                             &(prom_glb_node){.name = name,
                                              .parent = parent,
                                              .mesh = PROM_GLB_NONE,
                                              .translation = {(double)x, 0, (double)z},
                                              .yaw = (double)yaw,
                                              .scale = 1});
}

void prom_city_add_mesh(prom_city *city, const char *name, uint32_t parent, uint32_t mesh,
                        float x, float z, float yaw)
{
    prom_glb_add_node(city->glb, &(prom_glb_node){.name = name,
                                                  .parent = parent,
                                                  .mesh = mesh,
                                                  .translation = {(double)x, 0, (double)z},
                                                  .yaw = (double)yaw,
                                                  .scale = 1});
}

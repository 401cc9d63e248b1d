#include "scenes/gallery_parts.h"

static const struct {
    const char *name;
    prom_gallery_maker make;
    uint32_t fewest, most; // variants; more rooms have more
} things[PROM_GALLERY_THING_COUNT] = {
    [PROM_GALLERY_STATUE] = {"statue", prom_gallery_make_statue, 4, 16},
    [PROM_GALLERY_BUST] = {"bust", prom_gallery_make_bust, 6, 24},
    [PROM_GALLERY_ABSTRACT] = {"sculpture", prom_gallery_make_abstract, 6, 24},
    [PROM_GALLERY_MODEL] = {"figurine", prom_gallery_make_model, 4, 12},
    [PROM_GALLERY_VASE] = {"vase", prom_gallery_make_vase, 12, 32},
    [PROM_GALLERY_BOWL] = {"bowl", prom_gallery_make_bowl, 6, 16},
    [PROM_GALLERY_CRYSTAL] = {"crystals", prom_gallery_make_crystal, 5, 15},
    [PROM_GALLERY_SHELL] = {"shell", prom_gallery_make_shell, 5, 16},
    [PROM_GALLERY_COINS] = {"coins", prom_gallery_make_coins, 2, 6},
    [PROM_GALLERY_MASK] = {"mask", prom_gallery_make_mask, 4, 12},
    [PROM_GALLERY_PEDESTAL] = {"pedestal", prom_gallery_make_pedestal, 4, 4},
    [PROM_GALLERY_PLINTH] = {"plinth", prom_gallery_make_plinth, 3, 3},
    [PROM_GALLERY_TABLE_VITRINE] = {"table_vitrine", prom_gallery_make_table_vitrine, 4, 4},
    [PROM_GALLERY_TALL_VITRINE] = {"vitrine", prom_gallery_make_tall_vitrine, 2, 2},
    [PROM_GALLERY_BENCH] = {"bench", prom_gallery_make_bench, 4, 8},
    [PROM_GALLERY_CHAIR] = {"chair", prom_gallery_make_chair, 4, 8},
    [PROM_GALLERY_ARMCHAIR] = {"armchair", prom_gallery_make_armchair, 3, 5},
    [PROM_GALLERY_DESK] = {"desk", prom_gallery_make_desk, 2, 4},
    [PROM_GALLERY_TABLE] = {"table", prom_gallery_make_table, 2, 4},
    [PROM_GALLERY_CONSOLE] = {"console", prom_gallery_make_console, 2, 4},
    [PROM_GALLERY_BOOKCASE] = {"bookcase", prom_gallery_make_bookcase, 4, 12},
    [PROM_GALLERY_PLANT] = {"plant", prom_gallery_make_plant, 3, 6},
    [PROM_GALLERY_COLUMN] = {"column", prom_gallery_make_column, 1, 1},
    [PROM_GALLERY_ROPES] = {"ropes", prom_gallery_make_ropes, 1, 1},
    [PROM_GALLERY_LAMP] = {"lamp", prom_gallery_make_lamp, 3, 3},
    [PROM_GALLERY_RADIATOR] = {"radiator", prom_gallery_make_radiator, 1, 1},
    [PROM_GALLERY_RUG] = {"rug", prom_gallery_make_rug, 3, 3},
    [PROM_GALLERY_GLOBE] = {"globe", prom_gallery_make_globe, 1, 2},
    [PROM_GALLERY_CHANDELIER] = {"chandelier", prom_gallery_make_chandelier, 3, 6},
    [PROM_GALLERY_PENDANT] = {"pendant", prom_gallery_make_pendant, 2, 2},
    [PROM_GALLERY_SCONCE] = {"sconce", prom_gallery_make_sconce, 1, 1},
    [PROM_GALLERY_TREE] = {"tree", prom_gallery_make_tree, 5, 12},
    [PROM_GALLERY_HEDGE] = {"hedge", prom_gallery_make_hedge, 1, 1},
    [PROM_GALLERY_FOUNTAIN] = {"fountain", prom_gallery_make_fountain, 1, 1},
};

const char *prom_gallery_thing_name(prom_gallery_thing thing)
{
    return things[thing].name;
}

uint32_t prom_gallery_variants(const prom_gallery *g, prom_gallery_thing thing)
{
    uint32_t n = things[thing].fewest + g->options.rooms / 24;
    return n < things[thing].most ? n : things[thing].most;
}

// Made when it is placed first.
static uint32_t mesh_of(prom_gallery *g, prom_gallery_thing thing, uint32_t variant)
{
    uint32_t *mesh = &g->meshes[thing][variant];
    if (*mesh != PROM_GLB_NONE) return *mesh;
    prom_random random = prom_random_stream(g->options.seed, 100 + (uint64_t)thing, variant);
    char *name = prom_format("%s_%u", things[thing].name, variant);
    prom_solid s;
    prom_solid_init(&s);
    things[thing].make(g, &s, variant, &random);
    *mesh = prom_solid_write(&s, g->glb, name);
    prom_solid_finish(&s);
    prom_free(name);
    return *mesh;
}

void prom_gallery_place(prom_gallery *g, uint32_t parent, prom_gallery_thing thing,
                        uint32_t variant, const float at[3], float yaw, float scale)
{
    uint32_t mesh = mesh_of(g, thing, variant % prom_gallery_variants(g, thing));
    char *name = prom_format("%s_%u", things[thing].name, g->count++);
    prom_glb_add_node(g->glb, &(prom_glb_node){
                                  .name = name,
                                  .parent = parent,
                                  .mesh = mesh,
                                  .translation = {(double)at[0], (double)at[1], (double)at[2]},
                                  .yaw = (double)yaw,
                                  .scale = (double)scale,
                              });
    prom_free(name);
}

void prom_gallery_see(prom_gallery *g, uint32_t room, float x, float y, float z)
{
    prom_array_push(&g->sights, (prom_gallery_sight){{x, y, z}, room});
}

// Levels by the projected size, as OpenSceneGraph's PIXEL_SIZE_ON_SCREEN: a cluster opens, and
// an object gets more triangles, as its bounding sphere grows on the screen. No budget.
//
// OpenSceneGraph leaves the sizes at which levels change to whoever makes the scene; here they
// follow from the levels: the finest is taken that leaves each triangle a few pixels of the
// square around the sphere. Whether it is hidden, or looks well, does not count.
#include "traverse/rule.h"
#include "traverse/selectors.h"

// Diameter from which a cluster opens: up to it, impostors are measured in all directions.
#define CLUSTER_PX PROM_SIZE_MAX_PX
// Pixels of the square for each triangle. By taste: of a box seen from a corner about one in
// four of these is one that a triangle fills.
#define PX_PER_TRIANGLE 4.0f

static float seen_px(const prom_rule *rule, uint32_t node)
{
    return rule->eval.nodes[node].size_px * rule->scale;
}

static bool open_cluster(void *user, uint32_t node)
{
    return seen_px(user, node) > CLUSTER_PX;
}

// The first with few enough triangles, else the one with the fewest.
static uint32_t choose_level(void *user, uint32_t node)
{
    const prom_rule *rule = user;
    const prom_eval_node *n = &rule->eval.nodes[node];
    const prom_option *options = rule->eval.options;
    const prom_representation *reps = rule->eval.model->reps;
    float size = seen_px(rule, node);
    float allowed = size * size / PX_PER_TRIANGLE;
    uint32_t end = n->first_option + n->option_count, fewest = n->first_option;
    for (uint32_t i = n->first_option; i < end; i++) {
        uint32_t triangles = reps[options[i].rep].triangles;
        if ((float)triangles <= allowed) return i;
        if (triangles <= reps[options[fewest].rep].triangles) fewest = i;
    }
    return fewest;
}

static void select_pixels(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    prom_rule *rule = pointer;
    rule->scale = prom_rule_scale(selection);
    prom_rule_run(&rule->eval, selection, open_cluster, choose_level, rule, cut);
}

const prom_selector_class prom_select_pixels = {
    .name = "pixels",
    .summary = "levels by projected size, as OpenSceneGraph's; heeds no budget",
    .has_scale = true,
    .create = prom_rule_create,
    .destroy = prom_rule_destroy,
    .select = select_pixels,
};

#include "benefit/weights.h"

#include "metaobj/base/log.h"

#include <fnmatch.h>
#include <math.h>

float prom_weight_focus(float angle_deg)
{
    return 1.0f / (1.0f + angle_deg / PROM_FOCUS_HALF_DEG);
}

float prom_weight_motion(float speed_deg_s)
{
    return 1.0f / (1.0f + speed_deg_s / PROM_MOTION_HALF_DEG_S);
}

// ---- semantics

float prom_weight_of_name(prom_weight_rules *rules, const char *name, float otherwise)
{
    float weight = otherwise;
    for (uint32_t i = 0; i < rules->count; i++) {
        prom_weight_rule *rule = &rules->list[i];
        if (fnmatch(rule->pattern, name, 0) != 0) continue;
        rule->matched = true;
        weight = rule->weight;
    }
    return weight;
}

void prom_weight_rules_warn(const prom_weight_rules *rules)
{
    for (uint32_t i = 0; i < rules->count; i++)
        if (!rules->list[i].matched)
            prom_log(PROM_LOG_WARNING, "weights: nothing is named `%s`",
                     rules->list[i].pattern);
}

void prom_weights_apply(prom_weight_rules *rules, prom_model *model)
{
    const float unsaid = -1.0f;
    float *said = prom_alloc(model->node_count, sizeof *said);
    for (uint32_t n = 0; n < model->node_count; n++) {
        uint32_t parent = model->parent[n]; // stands before its children
        float above = parent == PROM_NONE ? unsaid : said[parent];
        said[n] = prom_weight_of_name(rules, model->names + model->name[n], above);
        if (said[n] != unsaid) model->weight[n] = said[n];
    }
    prom_free(said);
}

// What a leaf looks like from all around, in units of area.
static double look_of(const prom_model *m, uint32_t node)
{
    const uint16_t *coverage = m->coverage[m->prototype[node]];
    double sum = 0.0, r = (double)m->radius[node];
    for (uint32_t d = 0; d < PROM_DIRS; d++) sum += coverage[d];
    return sum / (65535.0 * PROM_DIRS) * r * r;
}

bool prom_weights_gather(const prom_model *m, float *weights)
{
    double *looks = prom_calloc(m->tree_count, sizeof *looks);
    double *worths = prom_calloc(m->tree_count, sizeof *worths);
    bool any = false;
    for (uint32_t n = m->tree_count; n-- > 0;) {
        if (!m->child_count[n]) {
            looks[n] = look_of(m, n) + 1e-30; // something, where nothing is to be seen
            worths[n] = looks[n] * (double)m->weight[n];
        }
        weights[n] = (float)(worths[n] / looks[n]);
        any = any || weights[n] != 1.0f;
        if (m->parent[n] == PROM_NONE) continue;
        looks[m->parent[n]] += looks[n];
        worths[m->parent[n]] += worths[n];
    }
    prom_free(looks);
    prom_free(worths);
    return any;
}

#include "builder/simplify/metric.h"

static const prom_collapse_metric_class *const classes[] = {
    &prom_collapse_attributes, &prom_collapse_qem, &prom_collapse_shortest};

const prom_collapse_metric_class *prom_collapse_metric_at(uint32_t index)
{
    return index < sizeof classes / sizeof *classes ? classes[index] : NULL;
}

const prom_collapse_metric_class *prom_collapse_metric_find(const char *name)
{
    const prom_collapse_metric_class *c = NULL;
    for (uint32_t i = 0; (c = prom_collapse_metric_at(i)); i++)
        if (!strcmp(c->name, name)) return c;
    return NULL;
}

// ---- shortest: no data but the mesh

struct prom_collapse_metric {
    const prom_collapse_mesh *mesh;
};

static prom_collapse_metric *create(const prom_collapse_mesh *mesh,
                                    const prom_metric_weights *weights)
{
    (void)weights;
    prom_collapse_metric *metric = prom_alloc(1, sizeof *metric);
    metric->mesh = mesh;
    return metric;
}

static void destroy(prom_collapse_metric *metric)
{
    prom_free(metric);
}

static void evaluate(prom_collapse_metric *metric, const prom_collapse *collapse,
                     prom_collapse_result *result)
{
    const float *a = metric->mesh->position[collapse->from];
    const float *b = metric->mesh->position[collapse->to];
    result->cost = result->error = 0;
    for (int k = 0; k < 3; k++) {
        const float d = b[k] - a[k];
        result->cost += d * d;
        result->place[k] = collapse->fixed ? b[k] : a[k] + 0.5f * d;
    }
    // No point moves by more than the edge.
    result->error = collapse->fixed ? result->cost : result->cost / 4;
}

static size_t bytes(const prom_collapse_metric *metric)
{
    return sizeof *metric;
}

const prom_collapse_metric_class prom_collapse_shortest = {
    .name = "shortest",
    .create = create,
    .destroy = destroy,
    .evaluate = evaluate,
    .bytes = bytes,
};

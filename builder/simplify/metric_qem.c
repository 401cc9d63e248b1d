#include "builder/simplify/point_quadrics.h"

struct prom_collapse_metric {
    prom_point_quadrics points;
};

static prom_collapse_metric *create(const prom_collapse_mesh *mesh,
                                    const prom_metric_weights *weights)
{
    prom_collapse_metric *metric = prom_alloc(1, sizeof *metric);
    prom_point_quadrics_init(&metric->points, mesh, weights);
    return metric;
}

static void destroy(prom_collapse_metric *metric)
{
    if (!metric) return;
    prom_point_quadrics_finish(&metric->points);
    prom_free(metric);
}

static void evaluate(prom_collapse_metric *metric, const prom_collapse *collapse,
                     prom_collapse_result *result)
{
    const prom_quadric sum = prom_point_quadrics_sum(&metric->points, collapse);
    prom_point_quadrics_choose(&metric->points, collapse, &sum, result);
}

static void merge(prom_collapse_metric *metric, const prom_collapse *collapse,
                  const float place[3], const uint32_t *vertices)
{
    (void)vertices;
    prom_point_quadrics_merge(&metric->points, collapse, place);
}

static size_t bytes(const prom_collapse_metric *metric)
{
    return sizeof *metric + metric->points.mesh->points * sizeof(prom_quadric);
}

const prom_collapse_metric_class prom_collapse_qem = {
    .name = "qem",
    .create = create,
    .destroy = destroy,
    .evaluate = evaluate,
    .merge = merge,
    .bytes = bytes,
};

#include "app/mesh_report.h"

#include "app/output.h"
#include "builder/simplify/mesh_volume.h"

#include <math.h>
#include <stdio.h>

void prom_mesh_facts_find(const prom_mesh *mesh, prom_mesh_facts *facts)
{
    prom_box box = prom_mesh_bounds(mesh);
    facts->triangles = mesh->index_count / 3;
    facts->vertices = mesh->vertex_count;
    facts->diagonal = (double)prom_box_diagonal(&box);
    facts->area = prom_mesh_area(mesh);
    facts->closed = prom_mesh_volume(mesh, &facts->volume);
}

static prom_looks sum_up(const prom_mesh_comparison *c, int metric)
{
    const bool squares = prom_metric_named(prom_look_metrics[metric])->squares;
    prom_looks looks = {.worst = -1};
    for (uint32_t v = 0; v < c->view_count; v++) {
        double all = c->views[v][metric].all.mean, object = c->views[v][metric].object.mean;
        looks.mean += squares ? all * all : all;
        looks.object_mean += squares ? object * object : object;
        if (all > looks.worst) looks.worst = all, looks.worst_view = v;
    }
    looks.mean /= c->view_count;
    looks.object_mean /= c->view_count;
    if (squares) {
        looks.mean = sqrt(looks.mean);
        looks.object_mean = sqrt(looks.object_mean);
    }
    return looks;
}

void prom_looks_sum_up(prom_mesh_comparison *c)
{
    for (int m = 0; c->view_count && m < PROM_LOOK_METRICS; m++) c->looks[m] = sum_up(c, m);
}

double prom_percent_of_diagonal(const prom_mesh_comparison *c, double value)
{
    double diagonal = c->facts[0].diagonal;
    return diagonal > 0 ? 100 * value / diagonal : value > 0 ? INFINITY : 0;
}

double prom_volume_difference_percent(const prom_mesh_comparison *c)
{
    const prom_mesh_facts *a = &c->facts[0], *b = &c->facts[1];
    if (!a->closed || !b->closed || a->volume == 0) return NAN;
    return 100 * (b->volume - a->volume) / fabs(a->volume);
}

// ---- text

static void print_facts(char letter, const prom_mesh_facts *f)
{
    printf("%c: %s: %u triangles, %u vertices, diagonal %.6g, area %.6g, ", letter, f->path,
           f->triangles, f->vertices, f->diagonal, f->area);
    if (f->closed)
        printf("volume %.6g\n", f->volume);
    else
        printf("open\n");
}

static void print_value(const prom_mesh_comparison *c, double value)
{
    printf("  %11.5g %9.5f %%", value, prom_percent_of_diagonal(c, value));
}

static void print_way(const prom_mesh_comparison *c, const char *name, const prom_one_way *way)
{
    printf("%-9s", name);
    print_value(c, way->mean);
    print_value(c, way->rms);
    print_value(c, way->max);
    printf("  %9.3f  %9llu\n", way->normal_rms_degrees, (unsigned long long)way->samples);
}

static void print_distances(const prom_mesh_comparison *c)
{
    printf("\n%-9s  %23s  %23s  %23s  %9s  %9s\n", "distance", "mean, of A's diagonal", "RMS",
           "maximum", "normals", "samples");
    print_way(c, "A to B", &c->distances.ab);
    print_way(c, "B to A", &c->distances.ba);
    printf("%-9s  %23s", "greater", "");
    print_value(c, c->distances.rms);
    print_value(c, c->distances.hausdorff);
    printf("\n");
}

static void print_looks(const prom_mesh_comparison *c)
{
    printf("\n%u views of %ux%u pixels, %.2f per degree\n%-9s %9s %9s %9s  from\n",
           c->view_count, c->size_px, c->size_px, c->ppd, "metric", "mean", "object", "worst");
    for (int m = 0; m < PROM_LOOK_METRICS; m++) {
        const prom_looks *l = &c->looks[m];
        float d[3];
        prom_cube_view_direction(l->worst_view, d);
        printf("%-9s %9.6f %9.6f %9.6f  %.2f %.2f %.2f\n", prom_look_metrics[m], l->mean,
               l->object_mean, l->worst, (double)d[0], (double)d[1], (double)d[2]);
    }
}

void prom_mesh_comparison_print(const prom_mesh_comparison *c)
{
    print_facts('A', &c->facts[0]);
    print_facts('B', &c->facts[1]);
    double percent = prom_volume_difference_percent(c);
    if (isfinite(percent)) printf("volume of B against A: %+.4f %%\n", percent);
    print_distances(c);
    if (c->view_count) print_looks(c);
}

// ---- JSON

static json_t *facts_json(const prom_mesh_facts *f)
{
    return json_pack("{s:o, s:I, s:I, s:o, s:o, s:b, s:o}", "path", prom_json_text(f->path),
                     "triangles", (json_int_t)f->triangles, "vertices", (json_int_t)f->vertices,
                     "diagonal_units", prom_json_number(f->diagonal), "area_square_units",
                     prom_json_number(f->area), "closed", f->closed, "volume_cubic_units",
                     prom_json_number(f->closed ? f->volume : NAN));
}

static json_t *point_json(const prom_mesh_comparison *c, const double p[3])
{
    json_t *json = json_array();
    for (int k = 0; k < 3; k++)
        json_array_append_new(json, prom_json_number(c->origin[k] + p[k]));
    return json;
}

// A distance, in units and in percent.
static void set_distance(json_t *to, const prom_mesh_comparison *c, const char *name,
                         double value)
{
    char key[64];
    snprintf(key, sizeof key, "%s_units", name);
    json_object_set_new(to, key, prom_json_number(value));
    snprintf(key, sizeof key, "%s_percent", name);
    json_object_set_new(to, key, prom_json_number(prom_percent_of_diagonal(c, value)));
}

static json_t *way_json(const prom_mesh_comparison *c, const prom_one_way *way)
{
    json_t *json = json_object();
    set_distance(json, c, "mean", way->mean);
    set_distance(json, c, "rms", way->rms);
    set_distance(json, c, "max", way->max);
    json_object_set_new(json, "max_from", point_json(c, way->from));
    json_object_set_new(json, "max_to", point_json(c, way->to));
    json_object_set_new(json, "normal_rms_degrees", prom_json_number(way->normal_rms_degrees));
    json_object_set_new(json, "samples", json_integer((json_int_t)way->samples));
    return json;
}

static json_t *look_json(const prom_mesh_comparison *c, int metric)
{
    const prom_looks *l = &c->looks[metric];
    json_t *views = json_array();
    for (uint32_t v = 0; v < c->view_count; v++)
        json_array_append_new(views, prom_json_number(c->views[v][metric].all.mean));
    float d[3];
    prom_cube_view_direction(l->worst_view, d);
    return json_pack("{s:s, s:o, s:o, s:o, s:[f, f, f], s:o}", "metric",
                     prom_look_metrics[metric], "mean", prom_json_number(l->mean),
                     "object_mean", prom_json_number(l->object_mean), "worst",
                     prom_json_number(l->worst), "worst_direction", (double)d[0], (double)d[1],
                     (double)d[2], "views", views);
}

json_t *prom_mesh_comparison_json(const prom_mesh_comparison *c)
{
    json_t *json = json_object();
    json_object_set_new(json, "a", facts_json(&c->facts[0]));
    json_object_set_new(json, "b", facts_json(&c->facts[1]));
    json_object_set_new(json, "volume_difference_percent",
                        prom_json_number(prom_volume_difference_percent(c)));
    json_object_set_new(json, "a_to_b", way_json(c, &c->distances.ab));
    json_object_set_new(json, "b_to_a", way_json(c, &c->distances.ba));
    set_distance(json, c, "rms", c->distances.rms);
    set_distance(json, c, "hausdorff", c->distances.hausdorff);
    json_t *looks = json_array();
    for (int m = 0; c->view_count && m < PROM_LOOK_METRICS; m++)
        json_array_append_new(looks, look_json(c, m));
    json_object_set_new(json, "views", json_integer(c->view_count));
    json_object_set_new(json, "size_px", json_integer(c->size_px));
    json_object_set_new(json, "ppd", prom_json_number(c->ppd));
    json_object_set_new(json, "looks", looks);
    return json;
}

#include "app/info_report.h"

#include "app/output.h"
#include "builder/simplify/repair.h"

#include <inttypes.h>
#include <stdio.h>
#include <sys/stat.h>

static void add_stage(void *user, const char *name, uint64_t content_hash, double ms)
{
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, content_hash);
    json_t *stage = json_pack("{s:o, s:o, s:s}", "name", prom_json_text(name), "ms",
                              prom_json_number(ms), "content", hash);
    json_array_append_new(user, stage);
}

prom_status prom_info_gather(prom_info_facts *f, const char *path, prom_container *container,
                             const prom_model *model, prom_error *error)
{
    *f = (prom_info_facts){.path = path,
                           .container = container,
                           .measured = model->measured,
                           .stages = json_array()};
    prom_view_cells cells;
    prom_status status = prom_container_read_view_cells(container, model, &cells, error);
    if (!status) prom_model_facts_of(model, &cells, &f->model);
    f->cells = cells.cell_count;
    f->cell_bytes = prom_container_view_cell_bytes(container);
    prom_view_cells_finish(&cells);
    if (!status) status = prom_container_content_hash(container, &f->content_hash, error);
    if (!status) status = prom_container_stages(container, add_stage, f->stages, error);
    struct stat st = {0};
    stat(path, &st);
    f->file_bytes = (uint64_t)st.st_size;
    return status;
}

void prom_info_finish(prom_info_facts *f)
{
    json_decref(f->stages);
    *f = (prom_info_facts){0};
}

// ---- JSON

static void set(json_t *object, const char *key, json_t *value)
{
    json_object_set_new(object, key, value);
}

static void set_count(json_t *object, const char *key, uint64_t count)
{
    set(object, key, json_integer((json_int_t)count));
}

// The builder's counts under a key, {} if the file has none.
static json_t *counts_json(const prom_info_facts *f, const char *meta)
{
    const char *text = prom_container_meta(f->container, meta);
    json_t *counts = text ? json_loads(text, 0, NULL) : NULL;
    if (!json_is_object(counts)) {
        json_decref(counts);
        counts = json_object();
    }
    return counts;
}

static json_t *meta_json(const prom_info_facts *f, const char *key)
{
    const char *text = prom_container_meta(f->container, key);
    return text ? prom_json_text(text) : json_null();
}

static json_t *nodes_json(const prom_model_facts *m)
{
    json_t *nodes = json_object(), *levels = json_array();
    for (uint32_t l = 0; l < m->levels; l++)
        json_array_append_new(levels, json_integer(m->nodes_by_level[l]));
    set_count(nodes, "leaves", m->leaves);
    set_count(nodes, "objects", m->object_leaves);
    set_count(nodes, "chunks", m->surface_leaves);
    set_count(nodes, "blended", m->blended_leaves);
    set_count(nodes, "clusters", m->clusters);
    set_count(nodes, "backdrops", m->backdrops);
    set_count(nodes, "most_children", m->most_children);
    set(nodes, "by_level", levels);
    return nodes;
}

static json_t *prototypes_json(const prom_model_facts *m)
{
    json_t *json = json_object();
    set_count(json, "leaves", m->leaf_prototypes);
    set_count(json, "clusters", m->cluster_prototypes);
    set_count(json, "placed_twice_or_more", m->shared_prototypes);
    return json;
}

static json_t *reps_json(const prom_model_facts *m)
{
    json_t *json = json_object();
    for (uint32_t k = 0; k < PROM_REP_KIND_COUNT; k++) {
        json_t *kind = json_object();
        set_count(kind, "leaf", m->reps[k].leaf);
        set_count(kind, "cluster", m->reps[k].cluster);
        set_count(kind, "triangles", m->reps[k].triangles);
        set(json, prom_rep_kind_name(k), kind);
    }
    return json;
}

static json_t *textures_json(const prom_model_facts *m)
{
    json_t *json = json_object();
    for (uint32_t k = 0; k < PROM_TEXTURE_KIND_COUNT; k++) {
        json_t *kind = json_object();
        set_count(kind, "count", m->textures[k].count);
        set_count(kind, "bytes", m->textures[k].bytes);
        set(json, prom_texture_kind_name(k), kind);
    }
    return json;
}

static json_t *measured_json(const prom_measured *m)
{
    json_t *json = json_object();
    set(json, "metric", prom_json_text(m->metric));
    set(json, "ppd", prom_json_number(m->ppd));
    set(json, "backgrounds",
        json_pack("[o, o]", prom_json_number(m->background[0]),
                  prom_json_number(m->background[1])));
    set(json, "veto_percentile", prom_json_number(m->veto_percentile));
    set(json, "veto_error", prom_json_number(m->veto_error));
    return json;
}

static json_t *cells_json(const prom_info_facts *f)
{
    json_t *json = json_object();
    set_count(json, "count", f->cells);
    set(json, "size", prom_json_number(f->model.cell_size));
    set_count(json, "bytes", f->cell_bytes);
    set(json, "mean_shown", prom_json_number(f->model.cell_shows));
    return json;
}

static json_t *tables_json(const prom_model_facts *m)
{
    json_t *json = json_object();
    for (int t = 0; t < PROM_FACT_TABLES; t++) {
        json_t *table = json_object();
        set_count(table, "rows", m->tables[t].rows);
        set_count(table, "bytes", m->tables[t].bytes);
        set(json, m->tables[t].name, table);
    }
    return json;
}

json_t *prom_info_json(const prom_info_facts *f)
{
    const prom_model_facts *m = &f->model;
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, f->content_hash);
    json_t *json = json_object();
    set(json, "model", prom_json_text(f->path));
    set_count(json, "file_bytes", f->file_bytes);
    set(json, "content", json_string(hash));
    set(json, "source", meta_json(f, "source"));
    set(json, "settings", meta_json(f, "settings"));
    set(json, "device", meta_json(f, "device"));
    set(json, "found", counts_json(f, "found"));
    set(json, "repair", counts_json(f, "repair"));
    set_count(json, "triangles", m->triangles);
    set(json, "size",
        json_pack("[o, o, o]", prom_json_number(m->size[0]), prom_json_number(m->size[1]),
                  prom_json_number(m->size[2])));
    set(json, "nodes", nodes_json(m));
    set(json, "prototypes", prototypes_json(m));
    set(json, "representations", reps_json(m));
    set(json, "textures", textures_json(m));
    set_count(json, "materials", m->materials);
    set(json, "measured", measured_json(&f->measured));
    set(json, "view_cells", cells_json(f));
    set(json, "tables", tables_json(m));
    set(json, "stages", json_incref(f->stages));
    return json;
}

// ---- text

static double mib(uint64_t bytes)
{
    return (double)bytes / (1 << 20);
}

// Texts of the file without what could steer a terminal; free it.
static char *plain(const char *text)
{
    char *copy = prom_strdup(text ? text : "");
    prom_text_make_plain(copy);
    return copy;
}

static void print_meta(const prom_info_facts *f, const char *label, const char *key)
{
    const char *text = prom_container_meta(f->container, key);
    char *value = plain(text);
    if (text) printf("%-16s %s\n", label, value);
    prom_free(value);
}

static void print_found(const prom_info_facts *f)
{
    json_t *found = counts_json(f, "found"), *value;
    const char *key, *comma = "";
    if (json_object_size(found)) printf("%-16s ", "import found");
    json_object_foreach(found, key, value)
    {
        if (!json_is_integer(value)) continue;
        printf("%s%s %" JSON_INTEGER_FORMAT, comma, key, json_integer_value(value));
        comma = ", ";
    }
    if (*comma) putchar('\n');
    json_decref(found);
}

static void print_repair(const prom_info_facts *f)
{
    json_t *counts = counts_json(f, "repair"), *value;
    prom_repair_report report = {0};
    const char *key;
    json_object_foreach(counts, key, value) if (json_integer_value(value) > 0)
        prom_repair_set(&report, key, (uint64_t)json_integer_value(value));
    char *text = prom_repair_text(&report);
    if (json_object_size(counts)) printf("%-16s %s\n", "repair", *text ? text : "nothing");
    prom_free(text);
    json_decref(counts);
}

static void print_tree(const prom_model_facts *m)
{
    printf("%-16s %" PRIu64 " (every instance counted)\n", "triangles", m->triangles);
    printf("%-16s %g x %g x %g\n", "size", m->size[0], m->size[1], m->size[2]);
    printf("%-16s %u leaves (%u objects, %u surface chunks, %u blended), %u clusters, "
           "%u backdrops\n",
           "nodes", m->leaves, m->object_leaves, m->surface_leaves, m->blended_leaves,
           m->clusters, m->backdrops);
    printf("%-16s", "nodes by level");
    for (uint32_t l = 0; l < m->levels; l++) printf(" %u", m->nodes_by_level[l]);
    printf("\n%-16s %u\n", "most children", m->most_children);
    printf("%-16s %u of leaves, %u of clusters; %u placed twice or more\n", "prototypes",
           m->leaf_prototypes, m->cluster_prototypes, m->shared_prototypes);
}

static void print_measured(const prom_measured *m)
{
    char *metric = plain(m->metric);
    printf("%-16s by %s, %.4g pixels per degree, over luminances of %.3g and %.3g\n",
           "accuracy", metric, (double)m->ppd, (double)m->background[0],
           (double)m->background[1]);
    prom_free(metric);
    if (m->veto_error < 1)
        printf("%-16s 0 where the error's %g %% quantile is above %.3g\n", "",
               100 * (double)m->veto_percentile, (double)m->veto_error);
}

static void print_cells(const prom_info_facts *f)
{
    if (f->cells)
        printf("%-16s %u of size %g, %.2f MiB; one shows %.0f %% of %u leaves on average\n",
               "view cells", f->cells, f->model.cell_size, mib(f->cell_bytes),
               100 * f->model.cell_shows, f->model.leaves);
    else
        printf("%-16s none\n", "view cells");
}

static void print_bulk(const prom_model_facts *m)
{
    printf("\n%-16s %10s %10s %12s\n", "representation", "of leaves", "clusters", "triangles");
    for (uint32_t k = 0; k < PROM_REP_KIND_COUNT; k++)
        printf("%-16s %10u %10u %12" PRIu64 "\n", prom_rep_kind_name(k), m->reps[k].leaf,
               m->reps[k].cluster, m->reps[k].triangles);
    printf("\n%-16s %10s %10s\n", "textures", "count", "MiB");
    for (uint32_t k = 0; k < PROM_TEXTURE_KIND_COUNT; k++)
        printf("%-16s %10u %10.2f\n", prom_texture_kind_name(k), m->textures[k].count,
               mib(m->textures[k].bytes));
    printf("\n%-16s %10s %10s\n", "table", "rows", "MiB loaded");
    for (int t = 0; t < PROM_FACT_TABLES; t++)
        printf("%-16s %10" PRIu64 " %10.2f\n", m->tables[t].name, m->tables[t].rows,
               mib(m->tables[t].bytes));
}

static void print_stages(const json_t *stages)
{
    size_t i;
    json_t *stage;
    double all = 0;
    printf("\n%-16s %10s\n", "stage", "seconds");
    json_array_foreach(stages, i, stage)
    {
        double ms = json_number_value(json_object_get(stage, "ms"));
        all += ms;
        char *name = plain(json_string_value(json_object_get(stage, "name")));
        printf("%-16s %10.2f\n", name, ms / 1000);
        prom_free(name);
    }
    printf("%-16s %10.2f\n", "all", all / 1000);
}

void prom_info_print(const prom_info_facts *f)
{
    printf("%-16s %s, %.2f MiB\n", "model", f->path, mib(f->file_bytes));
    printf("%-16s %016" PRIx64 "\n", "content", f->content_hash);
    print_meta(f, "source", "source");
    print_meta(f, "settings", "settings");
    print_meta(f, "device", "device");
    print_found(f);
    print_repair(f);
    print_tree(&f->model);
    print_measured(&f->measured);
    print_cells(f);
    print_bulk(&f->model);
    print_stages(f->stages);
}

#include "builder/pipeline.h"

#include "builder/build.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/hash.h"
#include "metaobj/base/log.h"

#include <inttypes.h>
#include <stdio.h>
#include <sys/stat.h>

static prom_status stage_import(prom_build_state *b, const char *path, prom_error *error)
{
    return prom_source_import(path, &b->options->import, &b->source, error);
}

static prom_status stage_objects(prom_build_state *b, prom_error *error)
{
    return prom_objects_find(&b->source, &b->options->objects, &b->objects, error);
}

static prom_status stage_tree(prom_build_state *b, prom_error *error)
{
    (void)error;
    prom_tree_build(&b->objects, &b->options->tree, &b->tree);
    size_t prototypes = b->objects.shapes.count + b->tree.clusters.count;
    b->prototypes = prom_calloc(prototypes, sizeof *b->prototypes);
    b->coverage = prom_calloc(prototypes, sizeof *b->coverage);
    return PROM_OK;
}

static prom_status open_device(prom_build_state *b, prom_error *error)
{
    b->context = prom_context_create_headless(error);
    if (!b->context) return error->status;
    b->renderer = prom_renderer_create(b->context, error);
    if (!b->renderer) return error->status;
    b->baker = prom_baker_create(b->renderer, error);
    if (!b->baker) return error->status;
    prom_views_init(&b->truth, true);
    prom_views_init(&b->views, false);
    return PROM_OK;
}

static prom_status stage_leaves(prom_build_state *b, prom_error *error)
{
    b->measure = prom_measure_create(b->mean_luminance);
    return prom_stage_leaves(b, error);
}

// What the stages so far have made, as one number.
static uint64_t content_so_far(const prom_build_state *b)
{
    uint64_t h = b->source.content_hash;
    for (size_t i = 0; i < b->objects.objects.count; i++) { // by field: structs have padding
        const prom_object *o = &b->objects.objects.data[i];
        h = prom_hash(&o->shape, sizeof o->shape, h);
        h = prom_hash(o->placement.origin, sizeof o->placement.origin, h);
        h = prom_hash(o->placement.basis, sizeof o->placement.basis, h);
    }
    for (size_t i = 0; i < b->tree.nodes.count; i++)
        h = prom_hash(&b->tree.nodes.data[i].first_child, sizeof(uint32_t), h);
    for (size_t i = 0; b->shapes && i < b->objects.shapes.count; i++)
        for (uint32_t l = 0; l < b->shapes[i].level_count; l++)
            h = prom_mesh_hash(&b->shapes[i].levels[l], h);
    for (size_t i = 0; b->clusters && i < b->tree.clusters.count; i++)
        for (uint32_t l = 0; l < b->clusters[i].level_count; l++)
            h = prom_mesh_hash(&b->clusters[i].levels[l], h);
    if (b->accuracy.count)
        h = prom_hash(b->accuracy.data, b->accuracy.count * sizeof *b->accuracy.data, h);
    return h;
}

static prom_status record_settings(prom_build_state *b, const char *scene, prom_error *error)
{
    const prom_build_options *o = b->options;
    char text[512];
    snprintf(
        text, sizeof text,
        "max-triangles %u, min-triangles %u, chunk-size %g, octree %s, divisions %u,%u,%u, "
        "group-radius %g, max-texture-px %u, texture-mb %u",
        o->objects.max_triangles, o->objects.min_triangles, o->objects.chunk_size,
        o->tree.octree == PROM_OCTREE_STRICT ? "strict" : "loose", o->tree.divisions[0],
        o->tree.divisions[1], o->tree.divisions[2], o->tree.group_radius,
        o->import.max_texture_px, o->texture_mb);
    const char *slash = strrchr(scene, '/');
    prom_status status =
        prom_writer_set_meta(b->writer, "source", slash ? slash + 1 : scene, error);
    if (!status) status = prom_writer_set_meta(b->writer, "settings", text, error);
    if (!status)
        status =
            prom_writer_set_meta(b->writer, "device", prom_context_renderer(b->context), error);
    snprintf(text, sizeof text, "%.6f", b->mean_luminance);
    if (!status) status = prom_writer_set_meta(b->writer, "mean_luminance", text, error);
    snprintf(text, sizeof text,
             "{\"split\":%u,\"gathered\":%u,\"chunks\":%u,\"backdrops\":%u,\"blended\":%u,"
             "\"instanced\":%u}",
             b->objects.split, b->objects.gathered, b->objects.chunks, b->objects.backdrops,
             b->objects.blended, b->objects.instanced);
    if (!status) status = prom_writer_set_meta(b->writer, "found", text, error);
    return status;
}

static prom_status run_stages(prom_build_state *b, const char *scene, prom_error *error)
{
    struct {
        const char *name;
        prom_status (*run)(prom_build_state *, prom_error *);
    } stages[] = {
        {"import", NULL}, // takes the path
        {"objects", stage_objects},
        {"tree", stage_tree},
        {"textures", prom_stage_textures},
        {"levels", prom_stage_levels},
        {"leaves", stage_leaves},
        {"clusters", prom_stage_clusters},
        {"model", prom_stage_model},
    };
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++) {
        double start = prom_clock_ms();
        prom_status status =
            stages[i].run ? stages[i].run(b, error) : stage_import(b, scene, error);
        // The device comes after import: the import child must not inherit it.
        if (!status && !stages[i].run) status = open_device(b, error);
        if (status) return status;
        double ms = prom_clock_ms() - start;
        prom_log(PROM_LOG_DEBUG, "stage %s: %.0f ms", stages[i].name, ms);
        status = prom_writer_add_stage(b->writer, stages[i].name, content_so_far(b), ms, error);
        if (status) return status;
    }
    prom_log(PROM_LOG_INFO, "meshes left out because they leave gaps: %u; kept: %zu",
             b->open_reps, b->reps.count);
    return record_settings(b, scene, error);
}

static void fill_report(const prom_build_state *b, const char *path, prom_build_report *report)
{
    const prom_model *m = &b->model;
    *report = (prom_build_report){
        .source_triangles = b->prototypes[m->prototype[0]].triangles,
        .objects = (uint32_t)b->objects.objects.count,
        .prototypes = m->prototype_count,
        .nodes = m->node_count,
        .representations = m->rep_count,
        .content_hash = content_so_far(b),
    };
    for (uint32_t i = 0; i < m->tree_count; i++)
        if (m->child_count[i] > report->max_children) report->max_children = m->child_count[i];
    for (uint32_t i = m->tree_count; i < m->node_count; i++)
        report->source_triangles += b->prototypes[m->prototype[i]].triangles;
    struct stat st;
    if (stat(path, &st) == 0) report->file_bytes = (uint64_t)st.st_size;
    FILE *f = fopen("/proc/self/status", "r");
    char line[128];
    unsigned long long kib;
    while (f && fgets(line, sizeof line, f))
        if (sscanf(line, "VmHWM: %llu kB", &kib) == 1) report->peak_bytes = kib * 1024;
    if (f) fclose(f);
}

static void finish_state(prom_build_state *b)
{
    prom_views_finish(&b->truth);
    prom_views_finish(&b->views);
    prom_measure_destroy(b->measure);
    prom_baker_destroy(b->baker);
    prom_renderer_destroy(b->renderer);
    prom_context_destroy(b->context);
    prom_writer_destroy(b->writer);
    for (size_t i = 0; b->shapes && i < b->objects.shapes.count; i++) {
        for (uint32_t l = 0; l < b->shapes[i].level_count; l++)
            prom_mesh_finish(&b->shapes[i].levels[l]);
        prom_mesh_finish(&b->shapes[i].merge);
    }
    for (size_t i = 0; b->clusters && i < b->tree.clusters.count; i++)
        for (uint32_t l = 0; l < b->clusters[i].level_count; l++)
            prom_mesh_finish(&b->clusters[i].levels[l]);
    for (size_t i = 0; b->textures && i < b->source.images.count; i++)
        prom_texture_finish(&b->textures[i]);
    prom_free(b->shapes);
    prom_free(b->clusters);
    prom_free(b->textures);
    prom_free(b->boxed);
    prom_free(b->prototypes);
    prom_free(b->coverage);
    prom_array_finish(&b->reps);
    prom_array_finish(&b->accuracy);
    prom_array_finish(&b->shares);
    prom_array_finish(&b->mesh_infos);
    prom_array_finish(&b->texture_infos);
    prom_arena_finish(&b->model.arena);
    prom_tree_finish(&b->tree);
    prom_objects_finish(&b->objects);
    prom_source_finish(&b->source);
}

prom_status prom_build(const char *scene_path, const char *out_path,
                       const prom_build_options *options, prom_build_report *report,
                       prom_error *error)
{
    prom_build_state b = {.options = options};
    prom_error local;
    if (!error) error = &local;
    prom_status status = PROM_OK;
    b.writer = prom_writer_create(out_path, error);
    if (!b.writer) status = error->status;
    if (!status) status = run_stages(&b, scene_path, error);
    if (!status) status = prom_writer_finish(b.writer, error);
    if (!status && report) fill_report(&b, out_path, report);
    finish_state(&b);
    return status;
}

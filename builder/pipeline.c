#include "builder/pipeline.h"

#include "builder/build.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/hash.h"
#include "metaobj/base/log.h"
#include "metaobj/base/stop.h"
#include "traverse/cost.h"

#include <stdio.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

uint64_t prom_build_spare_memory(const prom_build_state *b, uint64_t least)
{
    uint64_t mapped, used, limit = (uint64_t)b->options->memory_mb << 20;
    if (!limit) return UINT64_MAX;
    prom_memory_use(&mapped, &used);
    return used + least < limit ? limit - used : least;
}

void prom_build_keep(prom_build_state *b, prom_unit_kind kind, uint64_t key,
                     const prom_pack *pack)
{
    prom_error error = {0};
    if (!prom_store_put(b->store, kind, key, pack, &error)) return;
    pthread_mutex_lock(&b->lock);
    if (!b->failure.status) b->failure = error;
    pthread_mutex_unlock(&b->lock);
}

prom_status prom_build_goes_on(prom_build_state *b, prom_error *error)
{
    pthread_mutex_lock(&b->lock);
    prom_status status = b->failure.status;
    if (status && error) *error = b->failure;
    pthread_mutex_unlock(&b->lock);
    if (!status && prom_stop_requested()) status = PROM_ERR_STOPPED; // see stopped()
    return status;
}

void prom_build_end_progress(prom_build_state *b, prom_progress *progress)
{
    b->units += (uint32_t)progress->done;
    b->units_taken += (uint32_t)progress->reused;
    prom_progress_end(progress);
}

static prom_status stage_import(prom_build_state *b, prom_error *error)
{
    return prom_source_import(b->scene_path, &b->options->import, &b->source, error);
}

static prom_status stage_objects(prom_build_state *b, prom_error *error)
{
    prom_status status =
        prom_objects_find(&b->source, &b->options->objects, &b->objects, error);
    for (size_t i = 0; i < b->source.meshes.count; i++) { // the objects hold it all now
        prom_mesh_finish(&b->source.meshes.data[i]);
    }
    return status;
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

static prom_status open_store(prom_build_state *b, prom_error *error)
{
    static const prom_unit_kind redo[] = {
        [PROM_BUILD_FROM_NOWHERE] = PROM_UNIT_COUNT,
        [PROM_BUILD_FROM_START] = PROM_UNIT_LEVELS,
        [PROM_BUILD_FROM_LEAVES] = PROM_UNIT_LEAF_VIEWS,
        [PROM_BUILD_FROM_CLUSTERS] = PROM_UNIT_MERGE,
        [PROM_BUILD_FROM_VIEW_CELLS] = PROM_UNIT_VIEW_CELL,
    };
    b->program_key = prom_key_of_program();
    b->store = prom_store_open(b->out_path, redo[b->options->from], error);
    return b->store ? PROM_OK : error->status;
}

// After import: its child must not inherit a device, and a scene that cannot be read leaves no
// store.
static prom_status open_tools(prom_build_state *b, prom_error *error)
{
    prom_status status = open_store(b, error);
    if (status) return status;
    b->context = prom_context_create_headless(error);
    if (!b->context) return error->status;
    b->renderer = prom_renderer_create(b->context, error);
    if (!b->renderer) return error->status;
    b->baker = prom_baker_create(b->renderer, error);
    if (!b->baker) return error->status;
    b->device_key = prom_key_of_device(b->context, b->program_key);
    return PROM_OK;
}

// ---- what a stage has made, as one number; chained from the stage before

static uint64_t hash_import(const prom_build_state *b, uint64_t h)
{
    return prom_hash(&b->source.content_hash, sizeof b->source.content_hash, h);
}

// By field: the structs have padding.
static uint64_t hash_objects(const prom_build_state *b, uint64_t h)
{
    for (size_t i = 0; i < b->objects.shapes.count; i++) {
        const prom_shape *s = &b->objects.shapes.data[i];
        h = prom_mesh_hash(&s->mesh, h + (uint64_t)s->layer);
        for (uint32_t l = 0; l < s->level_count; l++) h = prom_mesh_hash(&s->levels[l].mesh, h);
    }
    for (size_t i = 0; i < b->objects.objects.count; i++) {
        const prom_object *o = &b->objects.objects.data[i];
        const uint32_t numbers[] = {o->shape, o->name, o->group};
        h = prom_hash(numbers, sizeof numbers, h);
        h = prom_hash(o->placement.origin, sizeof o->placement.origin, h);
        h = prom_hash(o->placement.basis, sizeof o->placement.basis, h);
    }
    return b->objects.names.count ? prom_hash(b->objects.names.data, b->objects.names.count, h)
                                  : h;
}

static uint64_t hash_tree(const prom_build_state *b, uint64_t h)
{
    for (size_t i = 0; i < b->tree.nodes.count; i++) {
        const prom_tree_node *n = &b->tree.nodes.data[i];
        const uint32_t numbers[] = {n->parent, n->first_child, n->child_count,
                                    n->object, n->cluster,     (uint32_t)n->layer};
        h = prom_hash(numbers, sizeof numbers, h);
        h = prom_hash(n->origin, sizeof n->origin, h);
    }
    return h;
}

static uint64_t hash_textures(const prom_build_state *b, uint64_t h)
{
    for (size_t i = 0; i < b->source.images.count; i++)
        h = prom_texture_hash(&b->textures[i], h);
    return h;
}

static uint64_t hash_levels(const prom_build_state *b, uint64_t h)
{
    for (size_t i = 0; i < b->objects.shapes.count; i++)
        h = prom_hash(&b->shapes[i].hash, sizeof b->shapes[i].hash, h);
    return h;
}

// Representations and tables of all prototypes so far.
static uint64_t hash_reps(const prom_build_state *b, uint64_t h)
{
    size_t prototypes = b->objects.shapes.count + b->tree.clusters.count;
    h = prom_hash(b->coverage, prototypes * sizeof *b->coverage, h);
    if (b->shares.count)
        h = prom_hash(b->shares.data, b->shares.count * sizeof *b->shares.data, h);
    if (!b->reps.count) return h;
    h = prom_hash(b->reps.data, b->reps.count * sizeof *b->reps.data, h);
    return prom_hash(b->accuracy.data, b->accuracy.count * sizeof *b->accuracy.data, h);
}
_Static_assert(sizeof(prom_representation) == 14 * 4, "hash_reps hashes no padding");

static uint64_t hash_clusters(const prom_build_state *b, uint64_t h)
{
    for (size_t i = 0; i < b->tree.clusters.count; i++)
        h = prom_hash(&b->clusters[i].hash, sizeof b->clusters[i].hash, h);
    return hash_reps(b, h);
}

static uint64_t hash_model(const prom_build_state *b, uint64_t h)
{
    return prom_hash(b->model.weight, b->model.node_count * sizeof *b->model.weight, h);
}

// ---- the order of work

// The profile names the device whose costs the model is meant for; it is part of the content.
static prom_status record_profile(prom_build_state *b, prom_error *error)
{
    if (!b->options->profile) return PROM_OK;
    prom_cost_model cost;
    prom_status status = prom_cost_load(b->options->profile, &cost, error);
    if (status) return status;
    char *text = prom_format("%s: %.9g ms a frame, %.9g a draw, %.9g a vertex, %.9g a triangle",
                             cost.renderer, cost.fixed_ms, cost.draw_ms, cost.vertex_ms,
                             cost.triangle_ms);
    status = prom_writer_set_meta(b->writer, "cost_profile", text, error);
    prom_free(text);
    return status;
}

static prom_status record_settings(prom_build_state *b, const char *scene, prom_error *error)
{
    static const char *const up_names[] = {
        [PROM_UP_FROM_FILE] = "file", [PROM_UP_Y] = "y", [PROM_UP_Z] = "z"};
    const prom_build_options *o = b->options;
    char text[512];
    snprintf(
        text, sizeof text,
        "max-triangles %u, min-triangles %u, chunk-size %g, octree %s, divisions %u,%u,%u, "
        "group-radius %g, max-children %u, max-texture-px %u, up-axis %s, unit-m %g, "
        "texture-mb %u, metric %s, ppd %g",
        o->objects.max_triangles, o->objects.min_triangles, o->objects.chunk_size,
        o->tree.octree == PROM_OCTREE_STRICT ? "strict" : "loose", o->tree.divisions[0],
        o->tree.divisions[1], o->tree.divisions[2], o->tree.group_radius, o->tree.max_children,
        o->import.max_texture_px, up_names[o->import.up], o->import.unit_m, o->texture_mb,
        o->measure.metric, (double)o->measure.ppd);
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
    char *repair = prom_repair_json(&b->repair);
    if (!status) status = prom_writer_set_meta(b->writer, "repair", repair, error);
    prom_free(repair);
    return status;
}

static prom_status run_stages(prom_build_state *b, const char *scene, prom_error *error)
{
    static const struct {
        const char *name;
        prom_status (*run)(prom_build_state *, prom_error *);
        uint64_t (*hash)(const prom_build_state *, uint64_t);
    } stages[] = {
        {"import", stage_import, hash_import},
        {"device", open_tools, NULL},
        {"objects", stage_objects, hash_objects},
        {"tree", stage_tree, hash_tree},
        {"textures", prom_stage_textures, hash_textures},
        {"levels", prom_stage_levels, hash_levels},
        {"leaves", prom_stage_leaves, hash_reps},
        {"clusters", prom_stage_clusters, hash_clusters},
        {"model", prom_stage_model, hash_model},
    };
    uint64_t hash = 0;
    b->scene_path = scene;
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++) {
        double start = prom_clock_ms();
        prom_status status = prom_build_goes_on(b, error);
        if (!status) status = stages[i].run(b, error);
        if (status) return status;
        if (stages[i].hash) hash = stages[i].hash(b, hash);
        double ms = prom_clock_ms() - start;
        prom_log(PROM_LOG_DEBUG, "stage %s: %.0f ms", stages[i].name, ms);
        status = prom_writer_add_stage(b->writer, stages[i].name, hash, ms, error);
        if (status) return status;
    }
    prom_log(PROM_LOG_INFO, "meshes left out because they leave gaps: %u; kept: %zu",
             b->gap_meshes, b->reps.count);
    prom_status status = record_profile(b, error);
    return status ? status : record_settings(b, scene, error);
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
        .units = b->units,
        .units_taken = b->units_taken,
        .views_taken = b->views_taken,
        .views = b->views,
        .views_compared = b->views_compared,
    };
    for (uint32_t i = 0; i < m->tree_count; i++)
        if (m->child_count[i] > report->max_children) report->max_children = m->child_count[i];
    for (uint32_t i = m->tree_count; i < m->node_count; i++)
        report->source_triangles += b->prototypes[m->prototype[i]].triangles;
    struct stat st;
    if (stat(path, &st) == 0) report->file_bytes = (uint64_t)st.st_size;
    char *work = prom_store_path(path);
    if (stat(work, &st) == 0) report->work_bytes = (uint64_t)st.st_size;
    prom_free(work);
    FILE *f = fopen("/proc/self/status", "r");
    char line[128];
    unsigned long long kib;
    while (f && fgets(line, sizeof line, f))
        if (sscanf(line, "VmHWM: %llu kB", &kib) == 1) report->peak_bytes = kib * 1024;
    if (f) fclose(f);
    struct rusage import; // the loader's own memory counts
    if (getrusage(RUSAGE_CHILDREN, &import) == 0 &&
        (uint64_t)import.ru_maxrss * 1024 > report->peak_bytes)
        report->peak_bytes = (uint64_t)import.ru_maxrss * 1024;
}

// The options with every default put in, so that the model records what was done.
static prom_build_options resolved(const prom_build_options *options)
{
    prom_build_options o = *options;
    if (!o.import.max_texture_px) o.import.max_texture_px = 1024;
    o.objects = prom_object_options_resolved(o.objects);
    if (!o.tree.max_children) o.tree.max_children = 16;
    if (!o.measure.metric) o.measure.metric = PROM_MEASURE_METRIC;
    if (!(o.measure.ppd > 0.0f)) o.measure.ppd = PROM_MEASURE_PPD;
    if (!o.texture_mb) o.texture_mb = 256;
    return o;
}

static void finish_state(prom_build_state *b)
{
    pthread_mutex_destroy(&b->lock);
    prom_pool_destroy(b->pool);
    prom_measure_destroy(b->measure);
    prom_baker_destroy(b->baker);
    prom_renderer_destroy(b->renderer);
    prom_context_destroy(b->context);
    prom_writer_destroy(b->writer);
    for (size_t i = 0; b->shapes && i < b->objects.shapes.count; i++) {
        for (uint32_t l = 0; l < b->shapes[i].level_count; l++)
            prom_mesh_finish(&b->shapes[i].levels[l].mesh);
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
    prom_free(b->atlased);
    prom_array_finish(&b->atlas_materials);
    prom_free(b->material_keys);
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

static void warn_of_memory(const prom_build_options *o, const prom_build_report *report)
{
    if (o->memory_mb && report->peak_bytes >> 20 > o->memory_mb)
        prom_log(PROM_LOG_WARNING,
                 "%llu MiB were needed where --memory-mb allows %u: the scene itself and the "
                 "device's driver took it",
                 (unsigned long long)(report->peak_bytes >> 20), o->memory_mb);
}

// Whatever a stage said: a loader that was stopped too may have been taken for a crash.
static prom_status stopped(const prom_build_state *b, prom_error *error)
{
    if (!b->store) return prom_fail(error, PROM_ERR_STOPPED, "stopped; nothing was done yet");
    return prom_fail(error, PROM_ERR_STOPPED,
                     "stopped; what was done is kept in %s.work, and the next build goes on "
                     "from there",
                     b->out_path);
}

// After the model: until that is in place, its units are still needed.
static void drop_work(const char *out_path)
{
    prom_error error = {0};
    if (prom_store_delete(out_path, &error)) prom_log(PROM_LOG_WARNING, "%s", error.text);
}

prom_status prom_build(const char *scene_path, const char *out_path,
                       const prom_build_options *options, prom_build_report *report,
                       prom_error *error)
{
    const prom_build_options all = resolved(options);
    prom_build_state b = {
        .options = &all, .out_path = out_path, .lock = PTHREAD_MUTEX_INITIALIZER};
    prom_error local;
    if (!error) error = &local;
    prom_status status = PROM_OK;
    b.writer = prom_writer_create(out_path, error); // and with it the lock
    if (!b.writer) status = error->status;
    if (!status) status = run_stages(&b, scene_path, error);
    if (status && prom_stop_requested()) status = stopped(&b, error);
    prom_unit_kind end = all.view_cells_follow ? PROM_UNIT_VIEW_CELL : PROM_UNIT_COUNT;
    if (!status) status = prom_store_prune(b.store, PROM_UNIT_LEVELS, end, error);
    prom_store_close(b.store);
    if (!status) status = prom_writer_finish(b.writer, error);
    if (!status && all.drop_work) drop_work(out_path);
    if (!status) {
        prom_build_report made;
        fill_report(&b, out_path, &made);
        warn_of_memory(&all, &made);
        if (report) *report = made;
    }
    finish_state(&b);
    return status;
}

#include "builder/view_cells.h"

#include "builder/build.h"
#include "builder/cell_view.h"
#include "builder/panorama.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/hash.h"
#include "metaobj/base/stop.h"

#include <stdio.h>
#include <sys/stat.h>

// Panoramas under way: one is drawn while others are counted, which is quick.
#define SLOTS 3u
// A panorama on its way into its cell.
typedef struct slot {
    struct work *work;
    prom_panorama panorama;
    double *solid, *footprint;
    float *shares;
    prom_loop loop;
} slot;

// An eye that has to be looked from.
typedef struct look {
    uint32_t cell, eye;
    bool last; // of its cell
} look;

typedef struct work {
    const char *model_path;
    const prom_view_cells_options *options;
    const double (*eyes)[3];
    uint32_t face_px;
    prom_writer *writer;
    prom_container *container;
    prom_model model;
    prom_store *store;
    prom_context *context;
    prom_renderer *renderer;
    prom_panorama_camera *camera;
    prom_pool *pool;
    float *angles;
    prom_eye_cells cells;
    prom_cell_view *views; // one for each cell,
    uint64_t *keys;        // and its unit's key
    uint32_t taken;
    PROM_ARRAY(look) looks;
    float *shares; // of the present cell's eyes so far
} work;

static prom_status open_all(work *w, prom_error *error)
{
    w->writer = prom_writer_reopen(w->model_path, error); // and with it the lock
    if (!w->writer) return error->status;
    w->container = prom_container_open(w->model_path, error);
    if (!w->container) return error->status;
    prom_status status = prom_container_load_model(w->container, &w->model, error);
    if (status) return status;
    prom_unit_kind redo = w->options->anew ? PROM_UNIT_VIEW_CELL : PROM_UNIT_COUNT;
    w->store = prom_store_open(w->model_path, redo, error);
    if (!w->store) return error->status;
    w->context = prom_context_create_headless(error);
    if (!w->context) return error->status;
    w->renderer = prom_renderer_create(w->context, error);
    if (!w->renderer) return error->status;
    status = prom_renderer_load(w->renderer, w->container, &w->model, error);
    if (status) return status;
    w->camera = prom_panorama_camera_create(w->renderer, &w->model, w->face_px, error);
    return w->camera ? PROM_OK : error->status;
}

static void close_all(work *w)
{
    for (size_t i = 0; w->views && i < w->cells.cells.count; i++)
        prom_cell_view_finish(&w->views[i]);
    prom_free(w->views);
    prom_free(w->keys);
    prom_free(w->shares);
    prom_free(w->angles);
    prom_array_finish(&w->looks);
    prom_eye_cells_finish(&w->cells);
    prom_pool_destroy(w->pool);
    prom_panorama_camera_destroy(w->camera);
    prom_renderer_destroy(w->renderer);
    prom_context_destroy(w->context);
    prom_store_close(w->store);
    prom_model_finish(&w->model);
    prom_container_close(w->container);
    prom_writer_destroy(w->writer);
}

// ---- units of work

// Of the cell's unit: all that what it shows depends on.
static uint64_t key_of(const work *w, const prom_eye_cell *cell, uint64_t base)
{
    uint64_t h = prom_hash(&w->face_px, sizeof w->face_px, base);
    for (uint32_t i = 0; i < cell->eye_count; i++)
        h = prom_hash(w->eyes[cell->eyes[i]], sizeof *w->eyes, h);
    return h;
}

// Takes what is known already and lists the eyes of all other cells.
static prom_status find_work(work *w, prom_error *error)
{
    uint64_t content;
    prom_status status = prom_container_content_hash(w->container, &content, error);
    if (status) return status;
    uint64_t base = prom_key_of_device(w->context, prom_key_of_program());
    base = prom_hash(&content, sizeof content, base);
    prom_pack pack = {0};
    w->views = prom_calloc(w->cells.cells.count, sizeof *w->views);
    w->keys = prom_alloc(w->cells.cells.count, sizeof *w->keys);
    for (uint32_t c = 0; c < w->cells.cells.count; c++) {
        const prom_eye_cell *cell = &w->cells.cells.data[c];
        w->keys[c] = key_of(w, cell, base);
        bool known = prom_store_get(w->store, PROM_UNIT_VIEW_CELL, w->keys[c], &pack) &&
                     prom_cell_view_unpack(&w->views[c], &w->model, &pack);
        w->taken += known;
        for (uint32_t i = 0; i < cell->eye_count && !known; i++)
            prom_array_push(&w->looks, (look){c, cell->eyes[i], i + 1 == cell->eye_count});
    }
    prom_array_finish(&pack);
    return PROM_OK;
}

// ---- looking

static void count_slot(void *user, size_t i, unsigned thread)
{
    (void)i, (void)thread;
    slot *s = user;
    prom_panorama_shares(&s->panorama, &s->work->model, s->work->angles, s->solid, s->footprint,
                         s->shares);
}

static void begin_look(slot *s, const double eye[3])
{
    memcpy(s->panorama.eye, eye, sizeof s->panorama.eye);
    prom_panorama_take(s->work->camera, &s->panorama);
    s->loop = (prom_loop){.body = count_slot, .user = s, .count = 1};
    prom_pool_start(s->work->pool, &s->loop);
}

// All eyes of the cell have been looked from.
static prom_status end_cell(work *w, uint32_t cell, prom_error *error)
{
    prom_cell_view *v = &w->views[cell];
    prom_cell_view_set(v, &w->model, w->shares);
    memset(w->shares, 0, w->model.tree_count * sizeof *w->shares);
    prom_pack pack = {0};
    prom_cell_view_pack(v, &pack);
    prom_status status =
        prom_store_put(w->store, PROM_UNIT_VIEW_CELL, w->keys[cell], &pack, error);
    prom_array_finish(&pack);
    return status;
}

static prom_status end_look(slot *s, const look *at, prom_progress *progress, prom_error *error)
{
    work *w = s->work;
    prom_pool_wait(w->pool, &s->loop);
    for (uint32_t n = 0; n < w->model.tree_count; n++)
        w->shares[n] = fmaxf(w->shares[n], s->shares[n]);
    if (!at->last) return PROM_OK;
    prom_progress_step(progress, 1);
    return end_cell(w, at->cell, error);
}

static void init_slot(slot *s, work *w)
{
    s->work = w;
    prom_panorama_init(&s->panorama, w->face_px);
    s->solid = prom_alloc(w->model.tree_count, sizeof *s->solid);
    s->footprint = prom_alloc(w->model.tree_count, sizeof *s->footprint);
    s->shares = prom_alloc(w->model.tree_count, sizeof *s->shares);
}

static void finish_slot(slot *s)
{
    prom_panorama_finish(&s->panorama);
    prom_free(s->solid);
    prom_free(s->footprint);
    prom_free(s->shares);
}

static prom_status stopped(const work *w, prom_error *error)
{
    return prom_fail(error, PROM_ERR_STOPPED,
                     "stopped; the model is there without view cells, what was done of them is "
                     "kept in %s.work, and the next build goes on from there",
                     w->model_path);
}

// In order: looks are begun, as long as there is room, and ended.
static prom_status look_around(work *w, prom_progress *progress, prom_error *error)
{
    slot slots[SLOTS] = {0};
    size_t begun = 0, ended = 0, count = w->looks.count;
    prom_status status = PROM_OK;
    for (uint32_t i = 0; i < SLOTS; i++) init_slot(&slots[i], w);
    while (ended < count && !status) {
        if (prom_stop_requested()) {
            status = stopped(w, error);
        } else if (begun < count && begun - ended < SLOTS) {
            begin_look(&slots[begun % SLOTS], w->eyes[w->looks.data[begun].eye]);
            begun++;
        } else {
            status = end_look(&slots[ended % SLOTS], &w->looks.data[ended], progress, error);
            ended++;
        }
    }
    for (; ended < begun; ended++) prom_pool_wait(w->pool, &slots[ended % SLOTS].loop);
    for (uint32_t i = 0; i < SLOTS; i++) finish_slot(&slots[i]);
    return status;
}

static prom_status bake(work *w, prom_error *error)
{
    prom_progress progress;
    prom_status status = find_work(w, error);
    if (status) return status;
    w->pool = prom_pool_create();
    w->angles = prom_panorama_angles(w->face_px);
    w->shares = prom_calloc(w->model.tree_count, sizeof *w->shares);
    prom_progress_begin(&progress, "view cells", w->cells.cells.count);
    prom_progress_reused(&progress, w->taken);
    prom_progress_step(&progress, w->taken);
    status = look_around(w, &progress, error);
    prom_progress_end(&progress);
    return status;
}

// ---- the end

static prom_status write_cells(work *w, const prom_view_cells *cells, double start_ms,
                               prom_error *error)
{
    char text[128];
    snprintf(text, sizeof text, "size %g, face-px %u, eyes %llu", cells->size, w->face_px,
             (unsigned long long)w->cells.eye_count);
    prom_status status = prom_writer_put_view_cells(w->writer, cells, error);
    if (!status) status = prom_writer_set_meta(w->writer, "view_cells", text, error);
    if (!status)
        status = prom_writer_add_stage(w->writer, "view cells", prom_view_cells_hash(cells, 0),
                                       prom_clock_ms() - start_ms, error);
    if (!status)
        status = prom_store_prune(w->store, PROM_UNIT_VIEW_CELL, PROM_UNIT_COUNT, error);
    prom_store_close(w->store);
    w->store = NULL;
    if (!status) status = prom_writer_finish(w->writer, error);
    return status;
}

static uint64_t bytes_of(const char *path)
{
    struct stat st;
    return stat(path, &st) ? 0 : (uint64_t)st.st_size;
}

static uint32_t count_leaves(const prom_model *model)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < model->tree_count; n++) count += !model->child_count[n];
    return count;
}

// Of the cells, read back from the finished model.
static prom_status stored_bytes(const work *w, uint64_t *bytes, prom_error *error)
{
    prom_view_cells cells = {0};
    prom_container *container = prom_container_open(w->model_path, error);
    if (!container) return error->status;
    prom_status status = prom_container_read_view_cells(container, &w->model, &cells, error);
    if (!status) *bytes = prom_container_view_cell_bytes(container);
    prom_view_cells_finish(&cells);
    prom_container_close(container);
    return status;
}

static void fill_report(const work *w, const prom_view_cells *cells, double start_ms,
                        prom_view_cells_report *report)
{
    char *store = prom_store_path(w->model_path);
    *report = (prom_view_cells_report){
        .cell_size = cells->size,
        .cells = cells->cell_count,
        .cells_taken = w->taken,
        .eyes = w->cells.eye_count,
        .mean_share = (double)cells->entry_count /
                      ((double)cells->cell_count * fmax(count_leaves(&w->model), 1)),
        .seconds = (prom_clock_ms() - start_ms) / 1000,
        .file_bytes = bytes_of(w->model_path),
        .work_bytes = bytes_of(store),
    };
    prom_free(store);
}

static prom_status build(work *w, size_t count, prom_view_cells_report *report,
                         prom_error *error)
{
    double start = prom_clock_ms();
    prom_view_cells cells = {0};
    prom_status status =
        prom_eye_cells_gather(w->eyes, count, w->options->cell_size, &w->cells, error);
    if (!status) status = open_all(w, error);
    if (status) return status;
    prom_log(PROM_LOG_INFO, "view cells: %zu of %.3g m around %llu eyes", w->cells.cells.count,
             w->cells.grid.size, (unsigned long long)w->cells.eye_count);
    status = bake(w, error);
    if (status) return status;
    prom_cell_views_join(w->views, &w->cells, &w->model, &cells);
    status = write_cells(w, &cells, start, error);
    prom_error kept = {0}; // the model is in place all the same
    if (!status && w->options->drop_work && prom_store_delete(w->model_path, &kept))
        prom_log(PROM_LOG_WARNING, "%s", kept.text);
    if (!status && report) {
        fill_report(w, &cells, start, report);
        status = stored_bytes(w, &report->bytes, error);
    }
    prom_view_cells_finish(&cells);
    return status;
}

prom_status prom_view_cells_build(const char *model_path, const double (*eyes)[3], size_t count,
                                  const prom_view_cells_options *options,
                                  prom_view_cells_report *report, prom_error *error)
{
    prom_error local;
    work w = {.model_path = model_path,
              .options = options,
              .eyes = eyes,
              .face_px = options->face_px ? options->face_px : PROM_VIEW_CELL_FACE_PX};
    prom_status status = build(&w, count, report, error ? error : &local);
    close_all(&w);
    return status;
}

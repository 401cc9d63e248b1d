// The tree and its tables from the container. What SQLite's types and the table hashes leave
// open, prom_model_check closes at the end.
#include "metaobj/container_reader.h"

#include "metaobj/base/log.h"

#include <assert.h>
#include <stdlib.h>

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "blobs are little-endian");

typedef uint16_t share_row[PROM_DIRS];

typedef struct loader {
    prom_container *container;
    prom_model *model;
    uint32_t *kept;        // per stored representation: its index in the model, or PROM_NONE
    uint32_t rep_rows;     // stored representations
    uint32_t unknown_kind; // the last one
    PROM_ARRAY(char) names;
    uint32_t last_name;
    PROM_ARRAY(share_row) shares;
} loader;

// More bulk data than the file can hold: refused here, before anybody adds the counts up. What
// all rows claim counts together, as rows that share their chunks would be a bomb too.
static void bound_raw_bytes(prom_row_in *row, uint64_t least_bytes)
{
    prom_container *c = row->container;
    if (row->failed) return;
    if (least_bytes > c->file_bytes || c->bulk_bytes > c->file_bytes - least_bytes)
        prom_row_refuse(row, "it claims more data than the file holds");
    else
        c->bulk_bytes += least_bytes;
}

static void take_mesh(void *user, prom_row_in *row)
{
    loader *l = user;
    prom_mesh_info *info = &l->model->meshes[row->id];
    info->vertex_count = prom_take_u32(row);
    info->index_count = prom_take_u32(row);
    info->submesh_count = prom_take_u32(row);
    prom_bulk_ref *ref = &l->container->meshes[row->id];
    ref->content_hash = (uint64_t)prom_take_int(row, INT64_MIN, INT64_MAX);
    ref->first_chunk = (uint64_t)prom_take_int(row, 0, INT64_MAX / 2);
    prom_stream streams[PROM_MESH_STREAMS];
    prom_mesh_streams(info, streams);
    for (int s = 0; s < PROM_MESH_STREAMS; s++)
        bound_raw_bytes(row, prom_codec_least_bytes(streams[s].codec,
                                                    streams[s].count * streams[s].stride));
}

static void take_texture(void *user, prom_row_in *row)
{
    loader *l = user;
    prom_texture_info *info = &l->model->textures[row->id];
    info->kind = prom_take_u32(row);
    info->width = prom_take_u32(row);
    info->height = prom_take_u32(row);
    info->layers = prom_take_u32(row);
    info->levels = prom_take_u32(row);
    prom_bulk_ref *ref = &l->container->textures[row->id];
    ref->content_hash = (uint64_t)prom_take_int(row, INT64_MIN, INT64_MAX);
    ref->first_chunk = (uint64_t)prom_take_int(row, 0, INT64_MAX / 2);
    prom_texture t = {info->kind, info->width, info->height, info->layers, info->levels, NULL};
    size_t bytes = row->failed ? 1 : prom_texture_bytes(&t);
    if (!bytes) prom_row_refuse(row, "its kind or size is out of range");
    bound_raw_bytes(row, prom_codec_least_bytes(PROM_CODEC_ZSTD, bytes));
}

static void take_material(void *user, prom_row_in *row)
{
    prom_material *m = &((loader *)user)->model->materials[row->id];
    prom_take_floats(row, m->base_color, 4);
    m->texture = prom_take_index(row);
    m->alpha_mode = prom_take_u32(row);
    prom_take_floats(row, &m->alpha_cutoff, 1);
    m->double_sided = prom_take_u32(row);
}

static void give_to_owner(loader *l, prom_row_in *row, uint32_t owner)
{
    prom_prototype *p = &l->model->prototypes[owner];
    if (!p->rep_count) p->first_rep = l->model->rep_count;
    if (p->first_rep + p->rep_count != l->model->rep_count)
        prom_row_refuse(row, "its prototype's representations do not stand together");
    p->rep_count++;
}

static void take_rep(void *user, prom_row_in *row)
{
    loader *l = user;
    prom_model *m = l->model;
    uint32_t owner = (uint32_t)prom_take_int(row, 0, (int64_t)m->prototype_count - 1);
    prom_representation r = {.kind = prom_take_u32(row)};
    if (!row->failed && r.kind >= PROM_REP_KIND_COUNT) {
        l->kept[row->id] = PROM_NONE;
        l->unknown_kind = r.kind;
        return;
    }
    r.mesh = prom_take_u32(row);
    r.texture = prom_take_index(row);
    r.flags = prom_take_u32(row);
    r.shading = prom_take_u32(row);
    r.level = prom_take_u32(row);
    prom_take_floats(row, &r.error, 1);
    r.max_size_px = prom_take_limit(row);
    prom_take_floats(row, &r.near_k, 1);
    r.switch_distance = prom_take_limit(row);
    r.draws = prom_take_u32(row);
    r.vertices = prom_take_u32(row);
    r.triangles = prom_take_u32(row);
    prom_take_floats(row, &r.layers, 1);
    if (row->failed) return;
    give_to_owner(l, row, owner);
    l->kept[row->id] = m->rep_count;
    m->reps[m->rep_count++] = r;
}

static void take_accuracy(void *user, prom_row_in *row)
{
    loader *l = user;
    if (row->id >= l->rep_rows) {
        prom_row_refuse(row, "there is no such representation");
        return;
    }
    const void *value = prom_take_blob(row, sizeof *l->model->accuracy);
    if (value && l->kept[row->id] != PROM_NONE)
        memcpy(&l->model->accuracy[l->kept[row->id]], value, sizeof *l->model->accuracy);
}

static void take_prototype(void *user, prom_row_in *row)
{
    loader *l = user;
    prom_prototype *p = &l->model->prototypes[row->id];
    p->flags = prom_take_u32(row);
    p->child_count = prom_take_u32(row);
    prom_take_floats(row, p->center, 3);
    prom_take_floats(row, p->half, 3);
    prom_take_floats(row, &p->radius, 1);
    p->triangles = (uint64_t)prom_take_int(row, 0, INT64_MAX);
    const void *coverage = prom_take_blob(row, sizeof *l->model->coverage);
    if (coverage) memcpy(l->model->coverage[row->id], coverage, sizeof *l->model->coverage);
    uint64_t bytes = (uint64_t)p->child_count * sizeof *l->model->shares;
    const void *shares = prom_take_blob(row, bytes);
    p->first_share = PROM_NONE;
    if (!shares) return;
    if (l->shares.count + p->child_count >= PROM_NONE) {
        prom_row_refuse(row, "there are too many shares");
        return;
    }
    p->first_share = (uint32_t)l->shares.count;
    memcpy(prom_array_extend(&l->shares, p->child_count), shares, bytes);
}

// Instances share a name more often than not: a repeated one is kept once.
static uint32_t keep_name(loader *l, prom_row_in *row, const char *name)
{
    if (!*name) return 0;
    if (!strcmp(l->names.data + l->last_name, name)) return l->last_name;
    size_t bytes = strlen(name) + 1;
    if (l->names.count + bytes >= UINT32_MAX) {
        prom_row_refuse(row, "there are too many names");
        return 0;
    }
    l->last_name = (uint32_t)l->names.count;
    memcpy(prom_array_extend(&l->names, bytes), name, bytes);
    return l->last_name;
}

static void take_node(void *user, prom_row_in *row)
{
    loader *l = user;
    prom_model *m = l->model;
    uint32_t n = row->id;
    m->parent[n] = prom_take_index(row);
    m->first_child[n] = prom_take_index(row);
    m->child_count[n] = prom_take_u32(row);
    m->prototype[n] = prom_take_u32(row);
    bool background = prom_take_int(row, 0, 1);
    if (background && m->tree_count == m->node_count) m->tree_count = n;
    if (!background && m->tree_count < n)
        prom_row_refuse(row, "it stands after the background");
    m->name[n] = keep_name(l, row, prom_take_text(row));
    prom_take_reals(row, m->placement[n].origin, 3);
    prom_take_floats(row, m->placement[n].basis, 9);
    prom_take_reals(row, m->center[n], 3);
    prom_take_floats(row, m->half[n], 3);
    prom_take_floats(row, &m->radius[n], 1);
    prom_take_floats(row, &m->weight[n], 1);
}

static float meta_float(prom_container *c, const char *key)
{
    const char *text = prom_container_meta(c, key);
    char *end = NULL;
    float value = text ? strtof(text, &end) : NAN;
    return text && end != text && !*end ? value : NAN;
}

// What is missing or wrong here is found by prom_model_check.
static void take_measured(loader *l)
{
    prom_container *c = l->container;
    prom_measured *m = &l->model->measured;
    const char *metric = prom_container_meta(c, PROM_META_METRIC);
    if (metric && strlen(metric) < sizeof m->metric) strcpy(m->metric, metric);
    m->ppd = meta_float(c, PROM_META_PPD);
    m->background[0] = meta_float(c, PROM_META_BACKGROUND_1);
    m->background[1] = meta_float(c, PROM_META_BACKGROUND_2);
    m->veto_percentile = meta_float(c, PROM_META_VETO_PERCENTILE);
    m->veto_error = meta_float(c, PROM_META_VETO_ERROR);
}

static void *keep_array(prom_arena *arena, const void *data, size_t count, size_t size)
{
    void *copy = prom_arena_alloc(arena, count, size);
    if (count) memcpy(copy, data, count * size);
    return copy;
}

static void allocate(loader *l)
{
    prom_container *c = l->container;
    prom_model *m = l->model;
    prom_arena *a = &m->arena;
    uint32_t n = m->node_count = m->tree_count = (uint32_t)c->rows[PROM_TABLE_NODE];
    m->parent = prom_arena_alloc(a, n, sizeof *m->parent);
    m->first_child = prom_arena_alloc(a, n, sizeof *m->first_child);
    m->child_count = prom_arena_alloc(a, n, sizeof *m->child_count);
    m->prototype = prom_arena_alloc(a, n, sizeof *m->prototype);
    m->name = prom_arena_alloc(a, n, sizeof *m->name);
    m->placement = prom_arena_alloc(a, n, sizeof *m->placement);
    m->center = prom_arena_alloc(a, n, sizeof *m->center);
    m->half = prom_arena_alloc(a, n, sizeof *m->half);
    m->radius = prom_arena_alloc(a, n, sizeof *m->radius);
    m->weight = prom_arena_alloc(a, n, sizeof *m->weight);
    m->prototype_count = (uint32_t)c->rows[PROM_TABLE_PROTOTYPE];
    m->prototypes = prom_arena_alloc(a, m->prototype_count, sizeof *m->prototypes);
    m->coverage = prom_arena_alloc(a, m->prototype_count, sizeof *m->coverage);
    l->rep_rows = (uint32_t)c->rows[PROM_TABLE_REPRESENTATION];
    m->reps = prom_arena_alloc(a, l->rep_rows, sizeof *m->reps);
    m->accuracy = prom_arena_alloc(a, l->rep_rows, sizeof *m->accuracy);
    l->kept = prom_alloc(l->rep_rows, sizeof *l->kept);
    m->material_count = (uint32_t)c->rows[PROM_TABLE_MATERIAL];
    m->materials = prom_arena_alloc(a, m->material_count, sizeof *m->materials);
    m->mesh_count = c->mesh_count = (uint32_t)c->rows[PROM_TABLE_MESH];
    m->meshes = prom_arena_alloc(a, m->mesh_count, sizeof *m->meshes);
    m->texture_count = c->texture_count = (uint32_t)c->rows[PROM_TABLE_TEXTURE];
    m->textures = prom_arena_alloc(a, m->texture_count, sizeof *m->textures);
    c->bulk_bytes = 0;
    prom_free(c->meshes);
    prom_free(c->textures);
    c->meshes = prom_calloc(m->mesh_count, sizeof *c->meshes);
    c->textures = prom_calloc(m->texture_count, sizeof *c->textures);
    prom_array_push(&l->names, '\0');
}

static prom_status scan_tables(loader *l, prom_error *error)
{
    static const struct {
        prom_table table;
        void (*take)(void *user, prom_row_in *row);
    } order[] = {
        {PROM_TABLE_MESH, take_mesh},         {PROM_TABLE_TEXTURE, take_texture},
        {PROM_TABLE_MATERIAL, take_material}, {PROM_TABLE_REPRESENTATION, take_rep},
        {PROM_TABLE_ACCURACY, take_accuracy}, {PROM_TABLE_PROTOTYPE, take_prototype},
        {PROM_TABLE_NODE, take_node},
    };
    prom_container *c = l->container;
    if (c->rows[PROM_TABLE_ACCURACY] != c->rows[PROM_TABLE_REPRESENTATION])
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: table accuracy has %llu rows for %u representations; the file is "
                         "damaged: build it again",
                         c->path, (unsigned long long)c->rows[PROM_TABLE_ACCURACY],
                         l->rep_rows);
    prom_status status = PROM_OK;
    for (size_t i = 0; i < sizeof order / sizeof *order && !status; i++)
        status = prom_container_scan(c, order[i].table, order[i].take, l, error);
    return status;
}

static prom_status load(loader *l, prom_error *error)
{
    prom_model *m = l->model;
    allocate(l);
    take_measured(l);
    prom_status status = scan_tables(l, error);
    if (status) return status;
    m->share_count = (uint32_t)l->shares.count;
    m->shares = keep_array(&m->arena, l->shares.data, l->shares.count, sizeof *m->shares);
    m->names_bytes = (uint32_t)l->names.count;
    m->names = keep_array(&m->arena, l->names.data, l->names.count, 1);
    if (m->rep_count < l->rep_rows)
        prom_log(
            PROM_LOG_WARNING,
            "%s: %u representations of an unknown kind (%u) are left out; a newer promenade "
            "may draw them",
            l->container->path, l->rep_rows - m->rep_count, l->unknown_kind);
    uint64_t row;
    const char *wrong = prom_model_check(m, &row);
    if (wrong)
        status = prom_fail(error, PROM_ERR_INPUT,
                           "%s: %s (row %llu); the file is damaged: build it again",
                           l->container->path, wrong, (unsigned long long)row);
    return status;
}

prom_status prom_container_load_model(prom_container *container, prom_model *model,
                                      prom_error *error)
{
    *model = (prom_model){0};
    loader l = {.container = container, .model = model};
    prom_status status = load(&l, error);
    if (status) prom_model_finish(model);
    prom_free(l.kept);
    prom_array_finish(&l.names);
    prom_array_finish(&l.shares);
    return status;
}

// Mesh levels of the shapes: by simplification and by the scene's artist, on all cores.
#include "builder/build.h"

#include "builder/cluster_mesh.h"
#include "builder/simplify/repair.h"
#include "builder/simplify/simplify.h"
#include "builder/simplify/work.h"
#include "metaobj/base/log.h"

#include <pthread.h>

#define MERGE_TRIANGLES 2048u // of the level that goes into cluster meshes
#define SHEET_FLATNESS 0.05f  // thinner than this part of its length and width
// What simplifying takes beyond the mesh itself, measured on a scan of 200 thousand
// triangles.
#define WORK_BYTES_PER_TRIANGLE 900u

typedef struct levels_job {
    prom_build_state *b;
    prom_progress progress;
    pthread_mutex_t lock;
    pthread_cond_t less;
    uint64_t room, taken; // bytes of memory
} levels_job;

// A pavement, a stretch of road, a wall: flat, and likely to meet others at its border, which
// no level may move then.
static bool is_sheet(const prom_box *bounds)
{
    float half[3];
    prom_box_half(bounds, half);
    for (int a = 0; a < 3; a++)
        if (half[a] < SHEET_FLATNESS * fminf(half[(a + 1) % 3], half[(a + 2) % 3])) return true;
    return false;
}

static void pack_levels(const prom_shape_build *s, prom_pack *pack)
{
    prom_pack_bytes(pack, &s->level_count, sizeof s->level_count);
    for (uint32_t l = 0; l < s->level_count; l++) {
        const prom_level *level = &s->levels[l];
        uint32_t artist = level->artist;
        prom_pack_bytes(pack, &artist, sizeof artist);
        prom_pack_bytes(pack, &level->error, sizeof level->error);
        prom_pack_bytes(pack, &level->switch_distance, sizeof level->switch_distance);
        prom_pack_mesh(pack, &level->mesh);
    }
    prom_pack_mesh(pack, &s->merge);
    prom_pack_bytes(pack, &s->merge_error, sizeof s->merge_error);
    prom_pack_bytes(pack, &s->repair, sizeof s->repair);
}

static void finish_meshes(prom_shape_build *s)
{
    for (uint32_t l = 0; l < s->level_count; l++) {
        prom_mesh_finish(&s->levels[l].mesh);
        s->levels[l] = (prom_level){0};
    }
    prom_mesh_finish(&s->merge);
    s->repair = (prom_repair_report){0};
    s->level_count = 0;
}

static bool unpack_levels(prom_shape_build *s, const prom_pack *pack, uint32_t materials)
{
    prom_unpack in = {.at = pack->data, .left = pack->count};
    s->level_count = prom_unpack_u32(&in, PROM_LEVELS_MAX);
    for (uint32_t l = 0; l < s->level_count; l++) {
        prom_level *level = &s->levels[l];
        level->artist = prom_unpack_u32(&in, 1);
        prom_unpack_bytes(&in, &level->error, sizeof level->error);
        prom_unpack_bytes(&in, &level->switch_distance, sizeof level->switch_distance);
        prom_unpack_mesh(&in, materials, &level->mesh);
    }
    prom_unpack_mesh(&in, 0, &s->merge);
    prom_unpack_bytes(&in, &s->merge_error, sizeof s->merge_error);
    prom_unpack_bytes(&in, &s->repair, sizeof s->repair);
    if (prom_unpack_end(&in) && s->level_count) return true;
    finish_meshes(s);
    return false;
}

static bool load_levels(const prom_build_state *b, prom_shape_build *s)
{
    prom_pack pack = {0};
    bool known = prom_store_get(b->store, PROM_UNIT_LEVELS, s->levels_key, &pack) &&
                 unpack_levels(s, &pack, (uint32_t)b->source.materials.count);
    prom_array_finish(&pack);
    return known;
}

static void keep_levels(prom_build_state *b, const prom_shape_build *s)
{
    prom_pack pack = {0};
    pack_levels(s, &pack);
    prom_build_keep(b, PROM_UNIT_LEVELS, s->levels_key, &pack);
    prom_array_finish(&pack);
}

// Mends, but leaves a mesh without any area as it is: it shows nothing, and does no harm.
static void mend(prom_mesh *mesh, const prom_repair_options *options, prom_repair_report *sum)
{
    prom_mesh mended;
    prom_repair_report report;
    prom_mesh_copy(&mended, mesh);
    prom_mesh_repair(&mended, options, &report);
    if (!mended.index_count) {
        prom_mesh_finish(&mended);
        return;
    }
    prom_repair_report_add(sum, &report);
    prom_mesh_finish(mesh);
    *mesh = mended;
}

// Puts a level where its triangles belong, behind the object itself.
static void insert(prom_shape_build *s, prom_level level)
{
    uint32_t at = s->level_count++;
    while (at > 1 && s->levels[at - 1].mesh.index_count < level.mesh.index_count) {
        s->levels[at] = s->levels[at - 1];
        at--;
    }
    s->levels[at] = level;
}

static void add_artists_levels(prom_shape_build *s, prom_shape *shape,
                               const prom_repair_options *options)
{
    s->levels[0].switch_distance = shape->level_count ? shape->until : INFINITY;
    for (uint32_t l = 0; l < shape->level_count && s->level_count < PROM_LEVELS_MAX; l++) {
        prom_level level = {.mesh = shape->levels[l].mesh,
                            .artist = true,
                            .switch_distance = shape->levels[l].until};
        shape->levels[l].mesh = (prom_mesh){0};
        mend(&level.mesh, options, &s->repair);
        prom_mesh_optimize(&level.mesh);
        level.error = prom_mesh_deviation(&s->levels[0].mesh, &level.mesh);
        insert(s, level);
    }
}

// A locked border must stay where the neighbour's is. Backdrops may be seen from within, with
// normals that say otherwise.
static prom_repair_options how_to_mend(const prom_shape *shape, bool lock)
{
    bool backdrop = shape->layer == PROM_LAYER_BACKDROP;
    return (prom_repair_options){.tolerance = lock ? -1.0f : PROM_REPAIR_TOLERANCE,
                                 .orient = backdrop ? PROM_ORIENT_NOT : PROM_ORIENT_BY_NORMALS};
}

static void make_levels(prom_build_state *b, prom_shape *shape, prom_shape_build *s)
{
    bool fixed = shape->layer == PROM_LAYER_BACKDROP || shape->layer == PROM_LAYER_BLENDED;
    bool lock = shape->lock_border || is_sheet(&shape->bounds);
    prom_repair_options mending = how_to_mend(shape, lock);
    mend(&shape->mesh, &mending, &s->repair);
    prom_mesh meshes[PROM_OWN_LEVELS_MAX];
    float errors[PROM_OWN_LEVELS_MAX];
    uint32_t count = prom_simplify_levels(&shape->mesh, lock, PROM_LEVEL_MIN_TRIANGLES,
                                          fixed ? 1 : PROM_OWN_LEVELS_MAX, meshes, errors);
    if (!count) { // nothing in it has an area
        meshes[0] = shape->mesh;
        errors[0] = 0;
        count = 1;
        shape->mesh = (prom_mesh){0};
    }
    for (uint32_t l = 0; l < count; l++)
        s->levels[l] =
            (prom_level){.mesh = meshes[l], .error = errors[l], .switch_distance = INFINITY};
    s->level_count = count;
    uint32_t merge = 0;
    while (merge + 1 < count && meshes[merge].index_count / 3 > MERGE_TRIANGLES) merge++;
    if (!fixed)
        prom_mesh_bake_colors(&meshes[merge], b->source.materials.data, b->textures, &s->merge);
    s->merge_error = errors[merge];
    add_artists_levels(s, shape, &mending);
}

// Waits until there is room; one shape at a time always goes on.
static uint64_t take_room(levels_job *job, const prom_shape *shape)
{
    uint64_t bytes = (uint64_t)shape->mesh.index_count / 3 * WORK_BYTES_PER_TRIANGLE;
    pthread_mutex_lock(&job->lock);
    while (job->taken && job->taken + bytes > job->room)
        pthread_cond_wait(&job->less, &job->lock);
    job->taken += bytes;
    pthread_mutex_unlock(&job->lock);
    return bytes;
}

static void give_room(levels_job *job, uint64_t bytes)
{
    pthread_mutex_lock(&job->lock);
    job->taken -= bytes;
    pthread_cond_broadcast(&job->less);
    pthread_mutex_unlock(&job->lock);
}

static void levels_of_shape(void *user, size_t i, unsigned thread)
{
    (void)thread;
    levels_job *job = user;
    prom_shape *shape = &job->b->objects.shapes.data[i];
    prom_shape_build *s = &job->b->shapes[i];
    if (prom_build_goes_on(job->b, NULL)) return;
    s->levels_key = prom_key_of_levels(job->b, (uint32_t)i);
    if (load_levels(job->b, s)) {
        prom_progress_reused(&job->progress, 1);
    } else {
        uint64_t bytes = take_room(job, shape);
        make_levels(job->b, shape, s);
        give_room(job, bytes);
        keep_levels(job->b, s);
    }
    for (uint32_t l = 0; l < s->level_count; l++)
        s->hash = prom_mesh_hash(&s->levels[l].mesh, s->hash);
    // The levels hold it all now.
    prom_mesh_finish(&shape->mesh);
    for (uint32_t l = 0; l < shape->level_count; l++) prom_mesh_finish(&shape->levels[l].mesh);
    prom_progress_step(&job->progress, 1);
}

// Area-weighted mean luminance of what clusters will merge: the scene's own background.
static float mean_luminance(const prom_build_state *b)
{
    double sum = 0, area = 0;
    for (size_t i = 0; i < b->objects.shapes.count; i++) {
        const prom_mesh *m = &b->shapes[i].merge;
        double weight = b->objects.shapes.data[i].instances;
        for (uint32_t t = 0; t + 2 < m->index_count; t += 3) {
            const prom_vertex *v[3];
            for (int k = 0; k < 3; k++) v[k] = &m->vertices[m->indices[t + k]];
            vec3 e1, e2, n;
            glm_vec3_sub((float *)v[1]->position, (float *)v[0]->position, e1);
            glm_vec3_sub((float *)v[2]->position, (float *)v[0]->position, e2);
            glm_vec3_cross(e1, e2, n);
            double a = weight * glm_vec3_norm(n);
            const uint8_t *c = v[0]->color;
            sum += a * (0.2126f * prom_srgb8_to_linear(c[0]) +
                        0.7152f * prom_srgb8_to_linear(c[1]) +
                        0.0722f * prom_srgb8_to_linear(c[2]));
            area += a;
        }
    }
    return area > 0 ? (float)(sum / area) : 0.2f;
}

// To one of 32 steps as the eye sees them: a small change of the scene is no other background,
// and what was measured before it stays right.
static float in_steps(float luminance)
{
    return prom_srgb_to_linear(roundf(prom_linear_to_srgb(luminance) * 32.0f) / 32.0f);
}

static void sum_up_repair(prom_build_state *b)
{
    prom_repair_report *r = &b->repair;
    for (size_t i = 0; i < b->objects.shapes.count; i++)
        prom_repair_report_add(r, &b->shapes[i].repair);
    if (!prom_repair_mended(r)) return;
    char *text = prom_repair_text(r);
    prom_log(PROM_LOG_INFO, "repair: %s", text);
    prom_free(text);
}

prom_status prom_stage_levels(prom_build_state *b, prom_error *error)
{
    size_t count = b->objects.shapes.count;
    b->shapes = prom_calloc(count, sizeof *b->shapes);
    levels_job job = {.b = b, .room = prom_build_spare_memory(b, 0)};
    pthread_mutex_init(&job.lock, NULL);
    pthread_cond_init(&job.less, NULL);
    prom_progress_begin(&job.progress, "levels", count);
    prom_parallel_for(count, levels_of_shape, &job);
    pthread_cond_destroy(&job.less);
    pthread_mutex_destroy(&job.lock);
    prom_status status = prom_build_goes_on(b, error);
    if (status) return status;
    prom_build_end_progress(b, &job.progress);
    sum_up_repair(b);
    b->mean_luminance = in_steps(mean_luminance(b));
    for (size_t i = 0; i < b->source.images.count; i++) // needed for the baked colours
        prom_texture_finish(&b->textures[i]);
    return PROM_OK;
}

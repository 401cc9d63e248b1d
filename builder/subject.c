#include "builder/subject.h"

#include "benefit/accuracy.h"
#include "metaobj/base/log.h"

#include <assert.h>

// A mesh with gaps may be shown up to the size at which they cover this many pixels: few enough
// that all of a frame's gaps stay under half a percent of it (by taste, then seen on the
// scenes).
#define GAPS_SHOWN_PX 64.0f
// One whose gaps allow less than this is of no use.
#define LEAST_SIZE_PX 16.0f
// More than this is a speck that is hardly seen.
#define MOST_LAYERS 64.0

// By taste: so much more accurate, in the mean over its bins, a mesh with an atlas must be than
// one without; and a level than the next, at some size.
#define ATLAS_GAIN 0.02f
#define LEVEL_GAIN 0.01f

// ---- drawing

prom_draw_item prom_item_around(uint32_t device_mesh, const float center[3])
{
    return (prom_draw_item){.mesh = device_mesh,
                            .texture = PROM_NONE,
                            .origin = {-center[0], -center[1], -center[2]},
                            .basis = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
}

prom_candidate *prom_subject_add(prom_subject *s, const prom_mesh *mesh,
                                 const prom_representation *rep, prom_admission admission)
{
    assert(s->count < PROM_CANDIDATES_MAX);
    prom_candidate *c = &s->candidates[s->count++];
    prom_views views = c->views;
    prom_views_clear(&views);
    *c = (prom_candidate){.mesh = mesh, .admission = admission, .views = views, .rep = *rep};
    return c;
}

prom_made *prom_subject_make(prom_subject *s)
{
    if (s->first_made > s->count) s->first_made = s->count;
    assert(s->count - s->first_made < PROM_MADE_MAX);
    return &s->made[s->count - s->first_made];
}

void prom_subject_unmake(prom_subject *s)
{
    for (int i = 0; i < PROM_MADE_MAX; i++) {
        prom_mesh_finish(&s->made[i].mesh);
        prom_texture_finish(&s->made[i].picture);
    }
    s->first_made = PROM_CANDIDATES_MAX;
}

static float radius_of(const prom_subject *s)
{
    return s->build->prototypes[s->prototype].radius;
}

static bool is_measured_mesh(const prom_candidate *c)
{
    return c->admission == PROM_ADMIT_MEASURED && c->rep.kind == PROM_REP_MESH;
}

void prom_subject_take_truth(prom_subject *s)
{
    prom_baker *baker = s->build->baker;
    bool large = false;
    for (uint32_t i = 0; i < s->count; i++) large |= is_measured_mesh(&s->candidates[i]);
    prom_baker_set_subject(baker, s->items.data, s->items.count);
    prom_baker_draw_views(baker, radius_of(s));
    if (s->child_count) prom_baker_read_shares(baker, s->child_count, s->shares);
    if (large && s->large_items.count)
        prom_baker_set_subject(baker, s->large_items.data, s->large_items.count);
    if (large) prom_baker_draw_large_views(baker, radius_of(s));
    prom_baker_read_views(baker, &s->truth);
    for (uint32_t d = 0; d < PROM_DIRS; d++) s->coverage[d] = prom_views_coverage(&s->truth, d);
}

static void add_comparison(prom_subject *s, prom_candidate *c)
{
    c->result.views = &c->views;
    s->comparisons[s->comparison_count++] = &c->result;
}

// On the device, behind the scene's materials, for as long as the views are taken.
static uint32_t add_with_atlas(prom_build_state *b, const prom_candidate *c, uint32_t texture)
{
    prom_submesh submesh;
    uint32_t count = (uint32_t)b->source.materials.count;
    prom_mesh placed = prom_mesh_with_material(c->mesh, count, &submesh);
    prom_array_push(&b->source.materials, prom_atlas_material(&c->rep, texture));
    prom_renderer_set_materials(b->renderer, b->source.materials.data, count + 1);
    b->source.materials.count = count;
    return prom_renderer_add_mesh(b->renderer, &placed);
}

prom_status prom_subject_take_views(prom_subject *s, uint32_t i, uint32_t device_id,
                                    prom_error *error)
{
    prom_build_state *b = s->build;
    prom_candidate *c = &s->candidates[i];
    uint32_t meshes = prom_renderer_mesh_count(b->renderer);
    uint32_t textures = prom_renderer_texture_count(b->renderer);
    uint32_t picture = PROM_NONE;
    if (c->picture) {
        picture = prom_renderer_add_texture(b->renderer, c->picture);
        if (picture == PROM_NONE) return prom_build_device_full("textures", error);
    }
    if (prom_candidate_has_atlas(c))
        device_id = add_with_atlas(b, c, picture);
    else if (device_id == PROM_NONE)
        device_id = prom_renderer_add_mesh(b->renderer, c->mesh);
    if (device_id == PROM_NONE) return prom_build_device_full("meshes", error);
    prom_draw_item item = prom_item_around(device_id, b->prototypes[s->prototype].center);
    item.flags = c->rep.flags;
    if (!prom_candidate_has_atlas(c)) item.texture = picture;
    prom_baker_set_subject(b->baker, &item, 1);
    prom_baker_take_views(b->baker, radius_of(s), is_measured_mesh(c), &c->views);
    add_comparison(s, c);
    prom_renderer_truncate(b->renderer, meshes, textures);
    return PROM_OK;
}

// ---- measuring

static void measure_step(void *user, size_t step, unsigned thread)
{
    prom_subject *s = user;
    prom_measure_step(s->build->measure, thread, &s->measuring, step);
}

static void start_measuring(prom_subject *s)
{
    prom_measuring_init(&s->measuring, &s->truth, s->comparisons, s->comparison_count);
    s->loop = (prom_loop){.body = measure_step, .user = s};
    if (s->comparison_count) s->loop.count = PROM_MEASURE_STEPS;
    prom_pool_start(s->build->pool, &s->loop);
}

static void wait_for_measures(prom_subject *s)
{
    prom_pool_wait(s->build->pool, &s->loop);
    prom_measure_end(&s->measuring);
}

// ---- settling: what the measurements make of the candidates

// The shading of most of a mesh's triangles.
static uint32_t main_shading(const prom_build_state *b, const prom_mesh *mesh)
{
    uint64_t triangles[PROM_SHADE_COUNT] = {0};
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        uint32_t shading = PROM_SHADE_PLAIN, m = mesh->submeshes[s].material;
        if (m != PROM_NONE) {
            const prom_material *material = &b->source.materials.data[m];
            if (material->alpha_mode == PROM_ALPHA_BLEND)
                shading = PROM_SHADE_BLENDED;
            else if (material->texture != PROM_NONE)
                shading = material->alpha_mode == PROM_ALPHA_MASK ? PROM_SHADE_MASKED
                                                                  : PROM_SHADE_TEXTURED;
        }
        triangles[shading] += mesh->submeshes[s].index_count / 3;
    }
    uint32_t most = 0;
    for (uint32_t k = 1; k < PROM_SHADE_COUNT; k++)
        if (triangles[k] > triangles[most]) most = k;
    return most;
}

// Over the directions that were looked from at a size.
static float mean_of_size(const prom_accuracy_row *row, uint32_t size)
{
    const bool large = size >= PROM_SIZES;
    const uint32_t dirs = large ? PROM_DIRS_LARGE : PROM_DIRS;
    float sum = 0.0f;
    for (uint32_t d = 0; d < dirs; d++)
        sum += prom_accuracy_of_byte(large ? row->large[d][size - PROM_SIZES]
                                           : row->bins[d][size]);
    return sum / (float)dirs;
}

// The near-field function through the rows of a mesh. What is measured along the axes alone
// counts by how much lower it is than there at the largest of the other sizes.
static float fit_near(const prom_accuracy_row *row, float error, float radius)
{
    enum { SIZES = PROM_SIZES + PROM_SIZES_LARGE };
    float e_px[SIZES], mean[SIZES], axes = 0.0f;
    for (uint32_t s = 0; s < SIZES; s++) mean[s] = mean_of_size(row, s);
    for (uint32_t d = 0; d < PROM_DIRS_LARGE; d++)
        axes += prom_accuracy_of_byte(row->bins[d][PROM_SIZES - 1]) / PROM_DIRS_LARGE;
    for (uint32_t s = 0; s < SIZES; s++) {
        e_px[s] = error * prom_size_of_bin(s) / (2.0f * radius);
        if (s >= PROM_SIZES) mean[s] = mean[PROM_SIZES - 1] - fmaxf(axes - mean[s], 0.0f);
    }
    for (uint32_t s = 0; s < SIZES; s++) mean[s] = fmaxf(mean[s], 0.0f);
    return prom_accuracy_fit_near(e_px, mean, SIZES);
}

// Area that the triangles of a mesh fill, seen from afar: mean over all directions. A triangle
// shows a quarter of its area on each side (Cauchy 1832).
static double mean_filled_area(const prom_build_state *b, const prom_mesh *mesh)
{
    double area = 0.0;
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const prom_submesh *submesh = &mesh->submeshes[s];
        bool both = submesh->material != PROM_NONE &&
                    b->source.materials.data[submesh->material].double_sided;
        const uint32_t *corners = mesh->indices + submesh->first_index;
        for (uint32_t i = 0; i + 2 < submesh->index_count; i += 3) {
            vec3 u, v, normal;
            const float *p = mesh->vertices[corners[i]].position;
            glm_vec3_sub((float *)mesh->vertices[corners[i + 1]].position, (float *)p, u);
            glm_vec3_sub((float *)mesh->vertices[corners[i + 2]].position, (float *)p, v);
            glm_vec3_cross(u, v, normal);
            area += (both ? 0.25 : 0.125) * (double)glm_vec3_norm(normal);
        }
    }
    return area;
}

static float layers_of(const prom_subject *s, const prom_mesh *mesh)
{
    double covered = 0.0, disc = GLM_PI * (double)radius_of(s) * (double)radius_of(s);
    for (uint32_t d = 0; d < PROM_DIRS; d++) covered += s->coverage[d] / (65535.0 * PROM_DIRS);
    double layers = covered > 0.0 ? mean_filled_area(s->build, mesh) / (covered * disc) : 1.0;
    return (float)fmin(fmax(layers, 1.0), MOST_LAYERS);
}

static void settle(prom_subject *s, prom_candidate *c)
{
    prom_representation *rep = &c->rep;
    bool mesh = rep->kind == PROM_REP_MESH;
    if (!prom_candidate_has_atlas(c)) // which has its own
        rep->shading = c->picture ? PROM_SHADE_IMPOSTOR : main_shading(s->build, c->mesh);
    rep->max_size_px = mesh ? INFINITY : PROM_SIZE_MAX_PX;
    rep->draws = c->mesh->submesh_count;
    rep->vertices = c->mesh->vertex_count;
    rep->triangles = c->mesh->index_count / 3;
    rep->layers = mesh ? layers_of(s, c->mesh) : 1.0f;
    c->kept = true;
    c->outdone = false;
    if (c->admission != PROM_ADMIT_MEASURED) {
        memset(&c->result.accuracy, 255, sizeof c->result.accuracy);
        return;
    }
    uint32_t gaps = 0;
    for (uint32_t d = 0; d < PROM_DIRS; d++) {
        if (c->result.gaps[d] > gaps) gaps = c->result.gaps[d];
        s->build->views_compared += c->result.compared[d];
    }
    s->build->views += PROM_DIRS;
    if (mesh && rep->error > 0)
        rep->near_k = fit_near(&c->result.accuracy, rep->error, radius_of(s));
    if (mesh && gaps > 0) rep->max_size_px = PROM_GAP_PX * sqrtf(GAPS_SHOWN_PX / (float)gaps);
    c->kept = rep->max_size_px >= LEAST_SIZE_PX;
}

// What its bins promise; where it spoils its surroundings it is not shown.
static float mean_accuracy(const prom_candidate *c)
{
    const prom_accuracy_row *row = &c->result.accuracy;
    float sum = 0;
    for (uint32_t d = 0; d < PROM_DIRS; d++)
        for (uint32_t s = 0; s < PROM_SIZES; s++)
            sum += fmaxf(prom_accuracy_of_byte(row->bins[d][s]), 0);
    return sum / (PROM_DIRS * PROM_SIZES);
}

// Of a mesh and the same with an atlas one is kept.
static void choose(prom_subject *s)
{
    for (uint32_t i = s->first_made; i < s->count; i++) {
        prom_candidate *made = &s->candidates[i];
        if (!prom_candidate_has_atlas(made) || !made->kept) continue;
        prom_candidate *plain = &s->candidates[made->rep.level];
        if (!plain->kept) continue;
        bool better = mean_accuracy(made) >= mean_accuracy(plain) + ATLAS_GAIN;
        prom_candidate *loser = better ? plain : made;
        loser->outdone = true;
        loser->kept = false;
    }
}

static bool shows_as_well(const prom_candidate *c, const prom_candidate *other)
{
    for (uint32_t s = 0; s < PROM_SIZES + PROM_SIZES_LARGE; s++)
        if (mean_of_size(&c->result.accuracy, s) + LEVEL_GAIN <
            mean_of_size(&other->result.accuracy, s))
            return false;
    return c->rep.max_size_px >= other->rep.max_size_px;
}

// A level of ours is of no use where the next, which costs less, shows as well.
static void thin_levels(prom_subject *s)
{
    const prom_candidate *next = NULL;
    for (uint32_t i = s->count < s->first_made ? s->count : s->first_made; i-- > 0;) {
        prom_candidate *c = &s->candidates[i];
        if (!c->kept) continue;
        c->outdone = next && is_measured_mesh(c) && !(c->rep.flags & PROM_REP_ARTIST) &&
                     shows_as_well(next, c);
        c->kept = !c->outdone;
        if (c->kept) next = c;
    }
}

static prom_status measure_and_settle(prom_subject *s, const prom_subject_class *class,
                                      uint32_t index, prom_error *error)
{
    wait_for_measures(s);
    for (uint32_t i = 0; i < s->count; i++) settle(s, &s->candidates[i]);
    choose(s);
    thin_levels(s);
    uint32_t settled = s->count;
    s->comparison_count = 0;
    prom_status status = class->amend ? class->amend(s, index, error) : PROM_OK;
    if (status || !s->comparison_count) return status;
    start_measuring(s);
    wait_for_measures(s);
    for (uint32_t i = settled; i < s->count; i++) settle(s, &s->candidates[i]);
    return PROM_OK;
}

// ---- the run

static void clear(prom_subject *s)
{
    prom_subject_unmake(s);
    prom_free(s->shares);
    s->shares = NULL;
    s->count = s->comparison_count = s->child_count = 0;
    s->items.count = s->large_items.count = s->item_spheres.count = 0;
    prom_views_clear(&s->truth);
    s->loop = (prom_loop){0};
    s->known = s->views_known = false;
    memset(s->coverage, 0, sizeof s->coverage);
}

static void finish_slot(prom_subject *s)
{
    clear(s);
    prom_array_finish(&s->items);
    prom_array_finish(&s->large_items);
    prom_array_finish(&s->item_spheres);
    prom_views_finish(&s->truth);
    for (int i = 0; i < PROM_CANDIDATES_MAX; i++) prom_views_finish(&s->candidates[i].views);
}

static void take_known_views(prom_subject *s)
{
    for (uint32_t i = 0; i < s->count; i++)
        if (s->candidates[i].admission == PROM_ADMIT_MEASURED)
            add_comparison(s, &s->candidates[i]);
    s->build->views_taken++;
}

static prom_status begin(prom_subject *s, const prom_subject_class *class, uint32_t index,
                         prom_error *error)
{
    clear(s);
    prom_status status = class->begin(s, index, error);
    if (status) return status;
    prom_store *store = s->build->store;
    prom_pack pack = {0};
    s->known =
        prom_store_get(store, class->kind, s->key, &pack) && prom_subject_unpack(s, &pack);
    if (s->known) {
        if (s->build->options->keep_views)
            prom_store_touch(store, class->views_kind, s->views_key);
    } else {
        s->views_known = prom_store_get(store, class->views_kind, s->views_key, &pack) &&
                         prom_subject_unpack_views(s, &pack);
        if (s->views_known)
            take_known_views(s);
        else
            status = class->draw(s, index, error);
        if (!status) start_measuring(s);
    }
    prom_array_finish(&pack);
    return status;
}

static prom_status keep(prom_subject *s, const prom_subject_class *class, prom_error *error)
{
    prom_store *store = s->build->store;
    prom_pack pack = {0};
    prom_subject_pack(s, &pack);
    prom_status status = prom_store_put(store, class->kind, s->key, &pack, error);
    if (!status && s->build->options->keep_views && !s->views_known && s->truth.count) {
        pack.count = 0;
        prom_subject_pack_views(s, &pack);
        status = prom_store_put(store, class->views_kind, s->views_key, &pack, error);
    }
    prom_array_finish(&pack);
    return status;
}

static prom_status end(prom_subject *s, const prom_subject_class *class, uint32_t index,
                       prom_progress *progress, prom_error *error)
{
    prom_status status = PROM_OK;
    if (s->known) {
        prom_progress_reused(progress, 1);
    } else {
        status = measure_and_settle(s, class, index, error);
        if (!status) status = keep(s, class, error);
    }
    if (!status) status = prom_subject_write(s, error);
    if (!status && class->settled) class->settled(s, index);
    prom_progress_step(progress, 1);
    return status;
}

// One subject under way for each core and one more to draw, as memory allows. The views take
// most of it: about eight of a subject with the large ones, of which what is covered, less than
// a half, is kept.
static uint32_t slot_count(const prom_build_state *b)
{
    const uint64_t view_pixels =
        PROM_DIRS * PROM_VIEW_PIXELS + PROM_DIRS_LARGE * PROM_VIEW_LARGE_PIXELS;
    const uint64_t bytes = 8 * view_pixels / 2 * sizeof(prom_rgba);
    uint64_t fit = prom_build_spare_memory(b, bytes) / bytes;
    uint32_t wanted = prom_thread_count() + 1;
    return fit < wanted ? (uint32_t)fit : wanted;
}

prom_status prom_subjects_run(prom_build_state *b, const prom_subject_class *class,
                              const uint32_t *index_of, uint32_t count, prom_progress *progress,
                              prom_error *error)
{
    uint32_t slots = slot_count(b), begun = 0, ended = 0;
    if (slots > count) slots = count;
    prom_subject *subjects = prom_calloc(slots, sizeof *subjects);
    for (uint32_t i = 0; i < slots; i++) subjects[i].build = b;
    prom_status status = PROM_OK;
    while (ended < count && !status) {
        status = prom_build_goes_on(b, error);
        if (status) break;
        bool full = begun - ended == slots;
        uint32_t next = full || begun == count ? ended : begun;
        uint32_t index = index_of ? index_of[next] : next;
        prom_subject *s = &subjects[next % slots];
        if (next == ended && next < begun) {
            status = end(s, class, index, progress, error);
            ended++;
        } else {
            status = begin(s, class, index, error);
            if (!status) begun++; // else it is not measured, and not to be waited for
        }
    }
    // After a failure some may still be measured.
    for (; ended < begun; ended++) prom_pool_wait(b->pool, &subjects[ended % slots].loop);
    for (uint32_t i = 0; i < slots; i++) finish_slot(&subjects[i]);
    prom_free(subjects);
    return status;
}

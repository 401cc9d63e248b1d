#include "builder/subject.h"

#include "metaobj/base/log.h"

#include <assert.h>

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

void prom_subject_take_truth(prom_subject *s)
{
    prom_baker *baker = s->build->baker;
    bool large = false;
    for (uint32_t i = 0; i < s->count; i++)
        large |= prom_candidate_is_measured_mesh(&s->candidates[i]);
    prom_baker_set_subject(baker, s->items.data, s->items.count);
    prom_baker_draw_views(baker, prom_subject_radius(s));
    if (s->child_count) prom_baker_read_shares(baker, s->child_count, s->shares);
    if (large && s->large_items.count)
        prom_baker_set_subject(baker, s->large_items.data, s->large_items.count);
    if (large) prom_baker_draw_large_views(baker, prom_subject_radius(s));
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
    prom_baker_take_views(b->baker, prom_subject_radius(s), prom_candidate_is_measured_mesh(c),
                          &c->views);
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

static prom_status measure_and_settle(prom_subject *s, const prom_subject_class *class,
                                      uint32_t index, prom_error *error)
{
    wait_for_measures(s);
    prom_subject_settle(s, 0);
    prom_subject_choose(s);
    uint32_t settled = s->count;
    s->comparison_count = 0;
    prom_status status = class->amend ? class->amend(s, index, error) : PROM_OK;
    if (status || !s->comparison_count) return status;
    start_measuring(s);
    wait_for_measures(s);
    prom_subject_settle(s, settled);
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

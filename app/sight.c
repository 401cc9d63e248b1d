#include "app/sight.h"

#include "metaobj/base/log.h"

// Ids take 4 to 9 % of a frame on a software rasteriser (measured). So of a steady walk every
// third frame is counted, or the next one once the camera has come COUNT_WAY
// (prom_visibility_way: counts hold for a little more). After a jump the next COUNT_ALL are.
#define COUNT_EVERY 3
#define COUNT_WAY 0.1
#define JUMP_WAY 0.2
#define COUNT_ALL 6
// Of so many frames counted on a steady walk, in one what is blended is counted, in the others
// what is not: a pixel has room for one of them.
#define BLENDED_EVERY 4

// Which nodes hold something see-through: leaves by themselves, the others by their children.
static void find_glass(prom_glass_count *glass, const prom_model *m)
{
    for (uint32_t n = m->tree_count; n-- > 0;) {
        if (m->prototypes[m->prototype[n]].flags & PROM_PROTO_BLENDED) glass[n].is = true;
        if (glass[n].is && m->parent[n] != PROM_NONE) glass[m->parent[n]].is = true;
    }
}

prom_status prom_sight_init(prom_sight *sight, prom_session *session, prom_error *error)
{
    const prom_model *model = &session->model;
    prom_visibility_mode mode = session->visibility;
    *sight = (prom_sight){.session = session, .in_a_row = COUNT_ALL};
    if (mode == PROM_SEE_NONE) return PROM_OK;
    if (mode & PROM_SEE_FRAME) {
        sight->counter = prom_id_counter_create(model->tree_count, error);
        if (!sight->counter) return error->status;
        sight->px = prom_calloc(model->tree_count, sizeof *sight->px);
        sight->glass = prom_calloc(model->tree_count, sizeof *sight->glass);
        find_glass(sight->glass, model);
    }
    sight->visibility =
        prom_visibility_create(model, mode & PROM_SEE_CELLS ? &session->cells : NULL);
    return PROM_OK;
}

void prom_sight_finish(prom_sight *sight)
{
    prom_visibility_destroy(sight->visibility);
    prom_id_counter_destroy(sight->counter);
    prom_free(sight->px);
    prom_free(sight->glass);
    for (int i = 0; i < PROM_ID_RING; i++) prom_array_finish(&sight->sightings[i].counts);
    *sight = (prom_sight){0};
}

// Visible pixels of an entry after a counting of one kind of pixels; below 0: not known. A node
// with glass needs both kinds, the other from not long ago.
static float visible_px(prom_sight *s, uint32_t node, bool blended, uint64_t counting)
{
    prom_glass_count *glass = &s->glass[node];
    if (!glass->is) return blended ? -1.0f : s->px[node];
    uint32_t now = (uint32_t)counting + 1;
    glass->px[blended] = s->px[node];
    glass->at[blended] = now;
    bool known = glass->at[!blended] && now - glass->at[!blended] <= 2 * BLENDED_EVERY;
    return known ? glass->px[0] + glass->px[1] : -1.0f;
}

static void feed(prom_sight *s, const prom_id_counts *seen)
{
    prom_sighting *sighting = &s->sightings[seen->frame % PROM_ID_RING];
    prom_visible_count *counts = sighting->counts.data;
    bool blended = sighting->ids == PROM_IDS_BLENDED;
    for (size_t i = 0; i < seen->count; i++)
        s->px[seen->counts[i].id] = sighting->scale * seen->counts[i].px;
    for (size_t i = 0; i < sighting->counts.count; i++)
        counts[i].px = visible_px(s, counts[i].entry.node, blended, seen->frame);
    for (size_t i = 0; i < seen->count; i++) s->px[seen->counts[i].id] = 0.0f;
    prom_visibility_feed(s->visibility, &sighting->camera, counts, sighting->counts.count);
}

void prom_sight_begin(prom_sight *sight, const prom_camera *camera)
{
    prom_id_counts seen;
    bool wait = sight->session->frozen;
    while (sight->counter && prom_id_counter_take(sight->counter, wait, &seen))
        feed(sight, &seen);
    if (sight->visibility) prom_visibility_begin(sight->visibility, camera);
}

static bool has_glass(const prom_sight *s, const prom_cut *cut)
{
    for (size_t i = 0; i < cut->entries.count; i++)
        if (s->glass[cut->entries.data[i].node].is) return true;
    return false;
}

// A picture may be drawn smaller than the camera's.
static float scale_of(const prom_camera *camera, const prom_frame_options *options)
{
    const uint32_t *size = options->size_px;
    if (!size[0]) return 1.0f;
    return (float)camera->width * (float)camera->height / ((float)size[0] * (float)size[1]);
}

static void note(prom_sight *s, const prom_cut *cut, const prom_camera *camera, prom_ids ids,
                 float scale)
{
    prom_sighting *sighting = &s->sightings[s->counted % PROM_ID_RING];
    sighting->frame = s->counted;
    sighting->camera = *camera;
    sighting->ids = ids;
    sighting->scale = scale;
    sighting->counts.count = 0;
    prom_array_reserve(&sighting->counts, cut->entries.count);
    for (size_t i = 0; i < cut->entries.count; i++)
        sighting->counts.data[i].entry = cut->entries.data[i];
    sighting->counts.count = cut->entries.count;
}

static bool is_far(const prom_sight *s)
{
    return prom_visibility_way(s->visibility) - s->way > COUNT_WAY;
}

bool prom_sight_counts(const prom_sight *s)
{
    return s->counter && (s->in_a_row || s->uncounted + 1 >= COUNT_EVERY || is_far(s));
}

// Whose ids the next frame shall write.
static prom_ids due_ids(const prom_sight *s, const prom_cut *cut)
{
    if (!prom_sight_counts(s)) return PROM_IDS_NONE;
    bool far = is_far(s);
    bool turn = s->counted % BLENDED_EVERY == BLENDED_EVERY - 1;
    bool blended = turn && !far && has_glass(s, cut);
    return blended ? PROM_IDS_BLENDED : PROM_IDS_OPAQUE;
}

static void count(prom_sight *s, const prom_cut *cut, const prom_camera *camera, prom_ids ids,
                  float scale)
{
    // The ring is never full here: frames are waited for, and their counts taken.
    if (!prom_id_counter_start(s->counter, s->session->target, s->counted)) {
        prom_log(PROM_LOG_WARNING, "the device has no memory to count pixels with: what is "
                                   "hidden is not found out any more");
        prom_id_counter_destroy(s->counter);
        s->counter = NULL;
        return;
    }
    note(s, cut, camera, ids, scale);
    double way = prom_visibility_way(s->visibility);
    if (way - s->way > JUMP_WAY)
        s->in_a_row = COUNT_ALL;
    else if (s->in_a_row)
        s->in_a_row--;
    s->way = way;
    s->counted++;
    s->uncounted = 0;
}

void prom_sight_draw(prom_sight *sight, const prom_cut *cut, const prom_camera *camera,
                     const prom_frame_options *options)
{
    prom_session *s = sight->session;
    prom_frame_options with_ids = *options;
    with_ids.ids = due_ids(sight, cut);
    prom_session_submit(s, cut, camera, &with_ids);
    sight->uncounted++;
    if (with_ids.ids != PROM_IDS_NONE)
        count(sight, cut, camera, with_ids.ids, scale_of(camera, options));
    prom_renderer_finish(s->renderer);
}

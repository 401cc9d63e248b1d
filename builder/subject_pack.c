// A settled subject as bytes, and back. Mesh candidates other than boxes are not in it: they
// come from a unit of their own.
#include "builder/subject.h"

_Static_assert(sizeof(prom_representation) == 14 * 4, "packed without padding");

static void pack_candidate(const prom_candidate *c, prom_pack *pack)
{
    uint32_t marks[3] = {c->kept, c->outdone, c->picture != NULL};
    prom_representation rep = c->rep;
    rep.mesh = rep.texture = PROM_NONE; // of this build only
    prom_pack_bytes(pack, marks, sizeof marks);
    prom_pack_bytes(pack, &rep, sizeof rep);
    prom_pack_bytes(pack, &c->result.accuracy, sizeof c->result.accuracy);
}

void prom_subject_pack(const prom_subject *s, prom_pack *pack)
{
    uint32_t meshes = s->first_made < s->count ? s->first_made : s->count;
    uint32_t counts[3] = {meshes, s->count - meshes, s->child_count};
    prom_pack_bytes(pack, counts, sizeof counts);
    prom_pack_bytes(pack, s->coverage, sizeof s->coverage);
    prom_pack_bytes(pack, s->shares, s->child_count * sizeof *s->shares);
    for (uint32_t i = 0; i < s->count; i++) {
        pack_candidate(&s->candidates[i], pack);
        if (i < meshes) continue;
        prom_pack_mesh(pack, s->candidates[i].mesh);
        if (s->candidates[i].picture) prom_pack_texture(pack, s->candidates[i].picture);
    }
}

static bool sound(const prom_representation *r)
{
    return r->kind < PROM_REP_KIND_COUNT && r->shading < PROM_SHADE_COUNT && r->error >= 0 &&
           r->max_size_px > 0 && r->near_k >= 0 && r->switch_distance > 0 && r->layers >= 1;
}

// made: NULL for a mesh that is there already.
static void unpack_candidate(prom_candidate *c, prom_made *made, uint32_t levels,
                             prom_unpack *in)
{
    c->kept = prom_unpack_u32(in, 1);
    c->outdone = prom_unpack_u32(in, 1);
    bool pictured = prom_unpack_u32(in, made != NULL);
    prom_unpack_bytes(in, &c->rep, sizeof c->rep);
    prom_unpack_bytes(in, &c->result.accuracy, sizeof c->result.accuracy);
    if (!in->failed && !sound(&c->rep)) in->failed = true;
    if (made) prom_unpack_mesh(in, 0, &made->mesh);
    if (!pictured) return;
    prom_unpack_texture(in, &made->picture);
    c->picture = &made->picture;
    // An atlas belongs to the one submesh of a mesh that stands for a level.
    if (c->rep.kind == PROM_REP_MESH &&
        (made->mesh.submesh_count != 1 || c->rep.level >= levels))
        in->failed = true;
}

// Takes the results from the beginning of what is left.
static void unpack_results(prom_subject *s, prom_unpack *in)
{
    uint32_t meshes = prom_unpack_u32(in, PROM_LEVELS_MAX);
    uint32_t made = prom_unpack_u32(in, PROM_MADE_MAX);
    uint32_t children = prom_unpack_u32(in, UINT32_MAX);
    const uint32_t added = s->count;
    if (meshes != added || children != s->child_count) in->failed = true;
    prom_unpack_bytes(in, s->coverage, sizeof s->coverage);
    if (!in->failed && children) prom_unpack_bytes(in, s->shares, children * sizeof *s->shares);
    for (uint32_t i = 0; i < meshes + made && !in->failed; i++) {
        prom_representation none = {0};
        prom_made *own = i < meshes ? NULL : prom_subject_make(s);
        if (own) prom_subject_add(s, &own->mesh, &none, PROM_ADMIT_MEASURED);
        unpack_candidate(&s->candidates[i], own, meshes, in);
    }
}

// As if there had been nothing but the `added` mesh candidates.
static void forget(prom_subject *s, uint32_t added)
{
    prom_subject_unmake(s);
    prom_views_clear(&s->truth);
    s->count = added;
}

bool prom_subject_unpack(prom_subject *s, const prom_pack *pack)
{
    prom_unpack in = {.at = pack->data, .left = pack->count};
    const uint32_t added = s->count;
    unpack_results(s, &in);
    if (prom_unpack_end(&in)) return true;
    forget(s, added);
    return false;
}

// ---- views: after the results, of which boxes, coverage and shares hold for other results too

void prom_subject_pack_views(const prom_subject *s, prom_pack *pack)
{
    prom_subject_pack(s, pack);
    prom_views_pack(&s->truth, pack);
    for (uint32_t i = 0; i < s->count; i++)
        if (s->candidates[i].admission == PROM_ADMIT_MEASURED)
            prom_views_pack(&s->candidates[i].views, pack);
}

static void unpack_views(prom_subject *s, prom_unpack *in)
{
    prom_views_unpack(in, &s->truth);
    if (s->truth.count < PROM_DIRS) in->failed = true;
    for (uint32_t i = 0; i < s->count && !in->failed; i++) {
        const prom_candidate *c = &s->candidates[i];
        if (c->admission != PROM_ADMIT_MEASURED) continue;
        prom_views_unpack(in, &s->candidates[i].views);
        bool large = c->rep.kind == PROM_REP_MESH;
        if (c->views.count != (large ? PROM_VIEWS : PROM_DIRS) ||
            c->views.count > s->truth.count)
            in->failed = true;
    }
}

bool prom_subject_unpack_views(prom_subject *s, const prom_pack *pack)
{
    prom_unpack in = {.at = pack->data, .left = pack->count};
    const uint32_t added = s->count;
    unpack_results(s, &in);
    if (!in.failed) unpack_views(s, &in);
    if (prom_unpack_end(&in)) return true;
    forget(s, added);
    return false;
}

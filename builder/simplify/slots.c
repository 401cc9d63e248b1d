#include "builder/simplify/slots.h"

#include <math.h>

// More vertices at two points than these are left alone until they are fewer: what follows is
// quadratic in them.
enum { MOST = 96 };

void prom_slots_finish(prom_slots *slots)
{
    prom_array_finish(&slots->entries);
    prom_array_finish(&slots->pairs);
    prom_array_finish(&slots->vertices);
    prom_array_finish(&slots->slots);
    prom_array_finish(&slots->kept);
    prom_array_finish(&slots->owners);
}

// How badly a vertex can stand for another: all attributes alike, by taste.
static float misfit_of(const prom_collapse_mesh *mesh, uint32_t v, uint32_t w)
{
    const prom_vertex *a = &mesh->vertices.data[v], *b = &mesh->vertices.data[w];
    float sum = 0;
    for (int k = 0; k < 3; k++) {
        const float d = (float)(a->normal[k] - b->normal[k]) / 127;
        sum += d * d;
    }
    for (int k = 0; k < 4; k++) {
        const float d = (float)(a->color[k] - b->color[k]) / 255;
        sum += d * d;
    }
    for (int k = 0; k < 2; k++) {
        const float d = a->uv[k] - b->uv[k];
        sum += isfinite(d) ? d * d : 0;
    }
    return sum;
}

static uint32_t entry_of(prom_slots *s, uint32_t first, uint32_t vertex)
{
    for (uint32_t i = first; i < s->entries.count; i++)
        if (s->entries.data[i].vertex == vertex) return i;
    prom_array_push(&s->entries, (prom_slot_entry){vertex, PROM_NONE, false});
    return (uint32_t)s->entries.count - 1;
}

// The corner of the same triangle at another point, PROM_NONE: none.
static uint32_t corner_at(const prom_collapse_mesh *mesh, uint32_t corner, uint32_t point)
{
    const uint32_t after = prom_corner_after(corner), before = prom_corner_before(corner);
    if (prom_corner_point(mesh, after) == point) return after;
    return prom_corner_point(mesh, before) == point ? before : PROM_NONE;
}

static bool gather(prom_slots *s, const prom_collapse_mesh *mesh, uint32_t point,
                   uint32_t other)
{
    const uint32_t first = (uint32_t)s->entries.count;
    for (uint32_t c = mesh->first_corner[point]; c != PROM_NONE; c = mesh->next_corner[c]) {
        const uint32_t entry = entry_of(s, first, mesh->corners[c]);
        if (s->entries.count > MOST) return false;
        const uint32_t across = corner_at(mesh, c, other);
        if (across == PROM_NONE)
            s->entries.data[entry].stays = true;
        else if (first) // of `from`: those of `to` are known
            prom_array_push(
                &s->pairs,
                (prom_slot_pair){entry, entry_of(s, 0, mesh->corners[across]),
                                 misfit_of(mesh, mesh->corners[c], mesh->corners[across])});
    }
    return true;
}

// One to one, the best fits first; several of `from` may share one of `to` if `shared`.
static void match(prom_slots *s, bool shared)
{
    for (size_t done = 0; done < s->pairs.count; done++) {
        prom_slot_pair *best = &s->pairs.data[done];
        for (size_t i = done + 1; i < s->pairs.count; i++)
            if (s->pairs.data[i].misfit < best->misfit) best = &s->pairs.data[i];
        const prom_slot_pair pair = *best;
        *best = s->pairs.data[done];
        prom_slot_entry *from = &s->entries.data[pair.from], *to = &s->entries.data[pair.to];
        if (from->partner != PROM_NONE || (to->partner != PROM_NONE && !shared)) continue;
        from->partner = pair.to;
        if (to->partner == PROM_NONE || s->entries.data[to->partner].stays == false)
            to->partner = pair.from;
    }
}

static void give_slot(prom_slots *s, uint32_t entry, bool kept)
{
    s->slots.data[entry] = (uint32_t)s->owners.count;
    prom_array_push(&s->owners, entry);
    prom_array_push(&s->kept, kept ? s->entries.data[entry].vertex : PROM_NONE);
}

// The entry before `end` in the vertex's group that fits best.
static uint32_t best_fit(const prom_slots *s, const prom_collapse_mesh *mesh, uint32_t vertex,
                         uint32_t end)
{
    uint32_t best = PROM_NONE;
    float least = INFINITY;
    for (uint32_t i = 0; i < end; i++) {
        const uint32_t other = s->entries.data[i].vertex;
        if (mesh->group.data[other] != mesh->group.data[vertex]) continue;
        const float misfit = misfit_of(mesh, vertex, other);
        if (misfit < least) least = misfit, best = i;
    }
    return best;
}

static bool place_from(prom_slots *s, const prom_collapse_mesh *mesh, uint32_t entry,
                       uint32_t of_to, bool half_edge)
{
    const prom_slot_entry *e = &s->entries.data[entry];
    if (e->partner != PROM_NONE) {
        s->slots.data[entry] = s->slots.data[e->partner];
    } else if (e->stays && half_edge) {
        const uint32_t fit = best_fit(s, mesh, e->vertex, of_to);
        if (fit == PROM_NONE) return false;
        if (s->slots.data[fit] == PROM_NONE) give_slot(s, fit, true);
        s->slots.data[entry] = s->slots.data[fit];
    } else if (e->stays) {
        give_slot(s, entry, false);
    }
    return true;
}

// Vertices of one point whose triangles all go. Where the texture goes on beside them their
// normals and colours count on; a chart that vanishes is not missed by its coordinates, which
// say nothing to others, but by the quadrics along its seams.
static void fold(prom_slots *s, const prom_collapse_mesh *mesh, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++) {
        if (s->slots.data[i] != PROM_NONE) continue;
        const uint32_t vertex = s->entries.data[i].vertex;
        const float *uv = mesh->vertices.data[vertex].uv;
        float least = INFINITY;
        for (uint32_t k = first; k < end; k++) {
            const uint32_t other = s->entries.data[k].vertex;
            if (k == i || s->slots.data[k] == PROM_NONE ||
                mesh->group.data[other] != mesh->group.data[vertex] ||
                memcmp(uv, mesh->vertices.data[other].uv, 2 * sizeof *uv))
                continue;
            const float misfit = misfit_of(mesh, vertex, other);
            if (!(misfit < least)) continue;
            least = misfit;
            s->slots.data[i] = s->slots.data[k];
        }
    }
}

static bool place_all(prom_slots *s, const prom_collapse_mesh *mesh, uint32_t of_to, bool keep,
                      bool half_edge)
{
    const uint32_t n = (uint32_t)s->entries.count;
    for (uint32_t i = 0; i < n; i++) s->slots.data[i] = PROM_NONE;
    for (uint32_t i = 0; i < of_to; i++) {
        const prom_slot_entry *e = &s->entries.data[i];
        if (e->stays || (e->partner != PROM_NONE && s->entries.data[e->partner].stays))
            give_slot(s, i, keep);
    }
    for (uint32_t i = of_to; i < n; i++)
        if (!place_from(s, mesh, i, of_to, half_edge)) return false;
    fold(s, mesh, 0, of_to);
    fold(s, mesh, of_to, n);
    return true;
}

static void reset(prom_slots *s)
{
    s->entries.count = s->pairs.count = s->vertices.count = 0;
    s->slots.count = s->kept.count = s->owners.count = 0;
}

static void point_at(const prom_slots *s, prom_collapse *collapse)
{
    collapse->count = (uint32_t)s->vertices.count;
    collapse->vertices = s->vertices.data;
    collapse->slots = s->slots.data;
    collapse->slot_count = (uint32_t)s->kept.count;
    collapse->kept = s->kept.data;
}

bool prom_slots_find(prom_slots *s, const prom_collapse_mesh *mesh, prom_collapse *collapse,
                     bool keep, bool half_edge, bool single)
{
    reset(s);
    if (single) {
        const uint32_t to = mesh->corners[mesh->first_corner[collapse->to]];
        prom_array_push(&s->vertices, to);
        prom_array_push(&s->vertices, mesh->corners[mesh->first_corner[collapse->from]]);
        prom_array_push(&s->slots, 0);
        prom_array_push(&s->slots, 0);
        prom_array_push(&s->kept, keep ? to : PROM_NONE);
        point_at(s, collapse);
        return true;
    }
    if (!gather(s, mesh, collapse->to, collapse->from)) return false;
    const uint32_t of_to = (uint32_t)s->entries.count;
    if (!gather(s, mesh, collapse->from, collapse->to)) return false;
    match(s, half_edge);
    (void)prom_array_extend(&s->slots, s->entries.count);
    if (!place_all(s, mesh, of_to, keep, half_edge)) return false;
    for (size_t i = 0; i < s->entries.count; i++)
        prom_array_push(&s->vertices, s->entries.data[i].vertex);
    point_at(s, collapse);
    return true;
}

#include "builder/simplify/engine_step.h"

#include <math.h>

static bool find_slots(prom_collapser *c, prom_collapse *collapse)
{
    const uint32_t flags = c->points[collapse->from].flags | c->points[collapse->to].flags;
    const bool single = !(flags & PROM_POINT_MULTIPLE) && !prom_pairs_any(&c->pairs);
    return prom_slots_find(&c->slots, c->mesh, collapse, collapse->fixed, c->options.half_edge,
                           single);
}

bool prom_step_evaluate(prom_collapser *c, uint32_t from, uint32_t to, bool fixed,
                        prom_step *step)
{
    fixed |= c->options.half_edge || (c->points[to].flags & PROM_POINT_LOCKED);
    step->collapse = (prom_collapse){.from = from, .to = to, .fixed = fixed};
    // A half edge must be known to be possible whatever the metric looks at.
    if ((c->options.metric->uses_vertices || c->options.half_edge) &&
        !find_slots(c, &step->collapse))
        return false;
    c->options.metric->evaluate(c->metric, &step->collapse, &step->result);
    const float *place = step->result.place;
    return isfinite(step->result.cost) && isfinite(step->result.error) && isfinite(place[0]) &&
           isfinite(place[1]) && isfinite(place[2]);
}

prom_verdict prom_step_judge(prom_collapser *c, const prom_step *step, float limit)
{
    const uint32_t from = step->collapse.from, to = step->collapse.to;
    const bool borders = c->points[from].flags & c->points[to].flags & PROM_POINT_BORDER;
    prom_verdict verdict = prom_guard_link(c->mesh, &c->marks, from, to, borders);
    if (verdict ? c->options.loose : prom_guard_last(c->mesh, from, to))
        verdict =
            prom_guard_small(c->mesh, from, to, limit) ? PROM_VERDICT_GOOD : PROM_VERDICT_LINK;
    return verdict ? verdict : prom_guard_faces(c->mesh, from, to, step->result.place);
}

// ---- vertices

static float along_edge(const prom_collapse_mesh *mesh, const prom_collapse *collapse,
                        const float place[3])
{
    const float *to = mesh->position[collapse->to], *from = mesh->position[collapse->from];
    float edge[3], way[3];
    for (int k = 0; k < 3; k++) edge[k] = from[k] - to[k], way[k] = place[k] - to[k];
    const float squared = glm_vec3_norm2(edge);
    return squared > 0 ? glm_clamp(glm_vec3_dot(edge, way) / squared, 0, 1) : 0;
}

static void interpolate(const prom_vertex *a, const prom_vertex *b, float t, prom_vertex *out)
{
    float normal[3], length = 0;
    for (int k = 0; k < 3; k++) {
        normal[k] = (float)a->normal[k] * (1 - t) + (float)b->normal[k] * t;
        length += normal[k] * normal[k];
    }
    if (length > 1) prom_pack_normal(normal, out->normal);
    for (int k = 0; k < 4; k++)
        out->color[k] = (uint8_t)lroundf((float)a->color[k] * (1 - t) + (float)b->color[k] * t);
    for (int k = 0; k < 2; k++) out->uv[k] = a->uv[k] * (1 - t) + b->uv[k] * t;
}

// A slot's vertex with what is between its first of `to` and its first of `from`.
static prom_vertex made_between(const prom_collapse_mesh *mesh, const prom_collapse *collapse,
                                uint32_t slot, const float place[3])
{
    uint32_t of[2] = {PROM_NONE, PROM_NONE}; // to, from
    for (uint32_t i = 0; i < collapse->count; i++) {
        const uint32_t vertex = collapse->vertices[i];
        uint32_t *first = &of[mesh->point.data[vertex] == collapse->from];
        if (collapse->slots[i] == slot && *first == PROM_NONE) *first = vertex;
    }
    prom_vertex out = mesh->vertices.data[of[0] != PROM_NONE ? of[0] : of[1]];
    if (of[0] != PROM_NONE && of[1] != PROM_NONE)
        interpolate(&mesh->vertices.data[of[0]], &mesh->vertices.data[of[1]],
                    along_edge(mesh, collapse, place), &out);
    memcpy(out.position, place, sizeof out.position);
    return out;
}

static uint32_t group_of_slot(const prom_collapse_mesh *mesh, const prom_collapse *collapse,
                              uint32_t slot)
{
    for (uint32_t i = 0; i < collapse->count; i++)
        if (collapse->slots[i] == slot) return mesh->group.data[collapse->vertices[i]];
    return 0;
}

// Fills `survivors`.
static void make_vertices(prom_collapser *c, const prom_collapse *collapse,
                          const float place[3])
{
    prom_collapse_mesh *mesh = c->mesh;
    c->made.count = c->survivors.count = 0;
    for (uint32_t slot = 0; slot < collapse->slot_count; slot++)
        prom_array_push(&c->made, made_between(mesh, collapse, slot, place));
    if (c->options.metric->attributes)
        c->options.metric->attributes(c->metric, collapse, place, c->made.data);
    for (uint32_t slot = 0; slot < collapse->slot_count; slot++) {
        uint32_t vertex = collapse->kept[slot];
        if (vertex == PROM_NONE) {
            const uint32_t group = group_of_slot(mesh, collapse, slot);
            vertex = (uint32_t)mesh->vertices.count;
            prom_array_push(&mesh->vertices, c->made.data[slot]);
            prom_array_push(&mesh->point, collapse->to);
            prom_array_push(&mesh->group, group);
        }
        prom_array_push(&c->survivors, vertex);
    }
}

static uint32_t survivor_of(const prom_collapser *c, const prom_collapse *collapse,
                            uint32_t vertex)
{
    uint32_t i = 0;
    while (collapse->vertices[i] != vertex) i++;
    return c->survivors.data[collapse->slots[i]];
}

// ---- corners

static void touch_star(prom_collapser *c, uint32_t point)
{
    const prom_collapse_mesh *mesh = c->mesh;
    for (uint32_t i = mesh->first_corner[point]; i != PROM_NONE; i = mesh->next_corner[i])
        prom_records_touch(c->options.records, i / 3);
}

static void unlink_corner(prom_collapse_mesh *mesh, uint32_t corner)
{
    uint32_t *at = &mesh->first_corner[prom_corner_point(mesh, corner)];
    while (*at != corner) at = &mesh->next_corner[*at];
    *at = mesh->next_corner[corner];
}

// A removed triangle's third point may keep others, of which none is in the star (sheets that
// meet in a point). Who moves that point later depends on this: records.h.
static void touch_third(prom_collapser *c, uint32_t third)
{
    const prom_collapse_mesh *mesh = c->mesh;
    const uint32_t first = mesh->first_corner[third];
    for (uint32_t i = first; i != PROM_NONE; i = mesh->next_corner[i])
        if (prom_records_touched(c->options.records, i / 3)) return;
    if (first != PROM_NONE) prom_records_touch(c->options.records, first / 3);
}

static void lose_point(prom_collapser *c, uint32_t point)
{
    c->points[point].stamp = PROM_STAMP_GONE;
    c->mesh->points_left--;
}

// Triangles with both points go; their corners stay in the lists of both until these are
// rewired.
static void remove_edge_triangles(prom_collapser *c, uint32_t from, uint32_t to)
{
    prom_collapse_mesh *mesh = c->mesh;
    for (uint32_t i = mesh->first_corner[from]; i != PROM_NONE; i = mesh->next_corner[i]) {
        const uint32_t after = prom_corner_after(i), before = prom_corner_before(i);
        const uint32_t a = prom_corner_point(mesh, after), b = prom_corner_point(mesh, before);
        if (a != to && b != to) continue;
        uint32_t *corners = mesh->corners + i / 3 * (size_t)3;
        if (c->options.records) prom_records_remove(c->options.records, i / 3, corners);
        unlink_corner(mesh, a == to ? before : after);
        const uint32_t third = a == to ? b : a;
        if (mesh->first_corner[third] == PROM_NONE) lose_point(c, third);
        if (c->options.records) touch_third(c, third);
        for (int k = 0; k < 3; k++) corners[k] = PROM_NONE;
        mesh->triangles--;
    }
}

// Whether the point has a triangle with these two after it.
static bool has_triangle(const prom_collapse_mesh *mesh, uint32_t point, uint32_t a, uint32_t b)
{
    for (uint32_t i = mesh->first_corner[point]; i != PROM_NONE; i = mesh->next_corner[i])
        if (mesh->corners[i] != PROM_NONE &&
            prom_corner_point(mesh, prom_corner_after(i)) == a &&
            prom_corner_point(mesh, prom_corner_before(i)) == b)
            return true;
    return false;
}

// Where connections may change, triangles of `from` may be those of `to` again; the back sides
// of one another stay. After those with both points are gone.
static void remove_repeated(prom_collapser *c, uint32_t from, uint32_t to)
{
    prom_collapse_mesh *mesh = c->mesh;
    for (uint32_t i = mesh->first_corner[from]; i != PROM_NONE; i = mesh->next_corner[i]) {
        if (mesh->corners[i] == PROM_NONE) continue;
        const uint32_t after = prom_corner_after(i), before = prom_corner_before(i);
        if (!has_triangle(mesh, to, prom_corner_point(mesh, after),
                          prom_corner_point(mesh, before)))
            continue;
        unlink_corner(mesh, after);
        unlink_corner(mesh, before);
        for (uint32_t k = 0; k < 3; k++) mesh->corners[i / 3 * (size_t)3 + k] = PROM_NONE;
        mesh->triangles--;
    }
}

// Gives the corners of a list their new vertices and puts them in front of `rest`.
static uint32_t rewire(prom_collapser *c, const prom_collapse *collapse, uint32_t first,
                       uint32_t rest)
{
    prom_collapse_mesh *mesh = c->mesh;
    uint32_t head = rest;
    for (uint32_t i = first, next; i != PROM_NONE; i = next) {
        next = mesh->next_corner[i];
        const uint32_t old = mesh->corners[i];
        if (old == PROM_NONE) continue;
        const uint32_t now = survivor_of(c, collapse, old);
        if (c->options.records && now != old)
            prom_records_change(c->options.records, i, old, now);
        mesh->corners[i] = now;
        mesh->next_corner[i] = head;
        head = i;
    }
    return head;
}

void prom_step_apply(prom_collapser *c, const prom_step *step)
{
    prom_collapse_mesh *mesh = c->mesh;
    prom_records *records = c->options.records;
    prom_collapse collapse = step->collapse;
    const float *place = step->result.place;
    const uint32_t from = collapse.from, to = collapse.to;
    if (!collapse.slot_count) find_slots(c, &collapse);
    if (records) {
        prom_records_begin(records, from, to, (uint32_t)mesh->vertices.count);
        touch_star(c, from);
        touch_star(c, to);
    }
    make_vertices(c, &collapse, place);
    if (c->options.metric->merge)
        c->options.metric->merge(c->metric, &collapse, place, c->survivors.data);
    remove_edge_triangles(c, from, to);
    if (c->options.loose) remove_repeated(c, from, to);
    const uint32_t rest = rewire(c, &collapse, mesh->first_corner[to], PROM_NONE);
    mesh->first_corner[to] = rewire(c, &collapse, mesh->first_corner[from], rest);
    mesh->first_corner[from] = PROM_NONE;
    memcpy(mesh->position[to], place, sizeof *mesh->position);
    if (prom_pairs_any(&c->pairs)) prom_pairs_merge(&c->pairs, from, to);

    c->greatest_error = fmaxf(c->greatest_error, step->result.error);
    if (records)
        prom_records_end(records, sqrtf(step->result.error), (uint32_t)mesh->vertices.count);
    prom_point_state *merged = &c->points[to];
    merged->stamp++;
    merged->flags |= c->points[from].flags;
    if (collapse.slot_count > 1)
        merged->flags |= PROM_POINT_MULTIPLE;
    else
        merged->flags &= ~(uint32_t)PROM_POINT_MULTIPLE;
    lose_point(c, from);
    if (mesh->first_corner[to] == PROM_NONE) lose_point(c, to);
    c->stats.collapses++;
}

#include "builder/simplify_cards.h"

#include <math.h>
#include <stdlib.h>

// By taste: what counts as a leaf card.
enum { CARD_TRIANGLES = 4, MIN_CARDS = 12 };
#define CARD_EXTENT 0.35f // of the mesh's diagonal
#define GROWN_EXTENT 0.5f // to which a card may grow

static uint32_t root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static void join(uint32_t *parent, uint32_t i, uint32_t j)
{
    uint32_t a = root(parent, i), b = root(parent, j);
    if (a < b) parent[b] = a;
    if (b < a) parent[a] = b;
}

static void add_triangle(prom_component *c, const prom_work *work, const uint32_t *t)
{
    const prom_vertex *v = work->vertices.data;
    float cross[3];
    prom_triangle_cross(v[t[0]].position, v[t[1]].position, v[t[2]].position, cross);
    float area = glm_vec3_norm(cross) / 2;
    c->submesh = work->owners.data[t[0]] >> 1;
    c->triangles++;
    c->area += area;
    for (int k = 0; k < 3; k++) {
        const float *p = v[t[k]].position;
        prom_box_add_point(&c->box, p);
        for (int a = 0; a < 3; a++) c->center[a] += p[a] * area / 3;
    }
}

uint32_t prom_work_components(const prom_work *work, const prom_index_array *faces,
                              uint32_t *of, prom_component **components)
{
    uint32_t triangles = (uint32_t)(faces->count / 3), count = 0;
    const uint32_t *place = work->place.data;
    uint32_t *parent = prom_alloc(work->place.count, sizeof *parent);
    uint32_t *number = prom_alloc(work->place.count, sizeof *number);
    for (uint32_t i = 0; i < work->place.count; i++) parent[i] = i;
    memset(number, 0xff, work->place.count * sizeof *number);
    for (size_t i = 0; i < faces->count; i += 3)
        for (int k = 1; k < 3; k++)
            join(parent, place[faces->data[i]], place[faces->data[i + k]]);
    for (uint32_t t = 0; t < triangles; t++) {
        uint32_t r = root(parent, place[faces->data[t * 3]]);
        if (number[r] == PROM_NONE) number[r] = count++;
        of[t] = number[r];
    }
    prom_component *c = prom_calloc(count, sizeof *c);
    for (uint32_t i = 0; i < count; i++) c[i].box = PROM_BOX_EMPTY;
    for (uint32_t t = 0; t < triangles; t++) add_triangle(&c[of[t]], work, faces->data + t * 3);
    for (uint32_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++)
            c[i].center[a] = c[i].area > 0 ? c[i].center[a] / c[i].area : c[i].box.min[a];
    *components = c;
    prom_free(number);
    prom_free(parent);
    return count;
}

static bool is_card(const prom_component *c, float diagonal)
{
    return c->triangles <= CARD_TRIANGLES &&
           prom_box_diagonal(&c->box) <= CARD_EXTENT * diagonal;
}

typedef struct tally {
    uint32_t triangles, components, cards;
} tally;

void prom_work_split_cards(const prom_work *work, bool mostly, prom_index_array *solid,
                           prom_index_array *cards)
{
    const prom_index_array *faces = &work->indices;
    prom_component *components;
    uint32_t *of = prom_alloc(faces->count / 3, sizeof *of);
    uint32_t count = prom_work_components(work, faces, of, &components);
    tally *tallies = prom_calloc(work->submesh_count, sizeof *tallies);
    for (uint32_t i = 0; i < count; i++) {
        tally *t = &tallies[components[i].submesh];
        t->triangles += components[i].triangles;
        t->components++;
        t->cards += is_card(&components[i], work->diagonal);
    }
    for (size_t i = 0; i < faces->count; i++) {
        const prom_component *c = &components[of[i / 3]];
        const tally *t = &tallies[c->submesh];
        bool foliage = t->cards >= MIN_CARDS &&
                       (!mostly || t->triangles <= t->components * CARD_TRIANGLES);
        if (foliage && is_card(c, work->diagonal))
            prom_array_push(cards, faces->data[i]);
        else
            prom_array_push(solid, faces->data[i]);
    }
    prom_free(tallies);
    prom_free(components);
    prom_free(of);
}

typedef struct ranked {
    uint64_t key;
    uint32_t component;
} ranked;

static int by_key(const void *a, const void *b)
{
    const ranked *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return x->component < y->component ? -1 : x->component > y->component;
}

// Bits of a 10-bit value, two zeros between them.
static uint32_t spread(uint32_t v)
{
    uint32_t out = 0;
    for (int b = 0; b < 10; b++) out |= ((v >> b) & 1u) << (3 * b);
    return out;
}

static uint32_t morton(const float p[3], const prom_box *box)
{
    uint32_t code = 0;
    for (int a = 0; a < 3; a++) {
        float width = box->max[a] - box->min[a];
        float f = width > 0 ? (p[a] - box->min[a]) / width : 0;
        code |= spread((uint32_t)glm_clamp(f * 1023.0f, 0, 1023)) << a;
    }
    return code;
}

// Submesh by submesh along a space-filling curve, so that every k-th is spread evenly.
static ranked *order_evenly(const prom_component *components, uint32_t count)
{
    prom_box box = PROM_BOX_EMPTY;
    for (uint32_t i = 0; i < count; i++) prom_box_add_point(&box, components[i].center);
    ranked *order = prom_alloc(count, sizeof *order);
    for (uint32_t i = 0; i < count; i++)
        order[i] = (ranked){
            (uint64_t)components[i].submesh << 32 | morton(components[i].center, &box), i};
    qsort(order, count, sizeof *order, by_key);
    return order;
}

// growth[c]: 0 for a card that goes, else the factor that keeps its submesh's area.
static void choose_kept(const prom_component *components, uint32_t count, float share,
                        float *growth)
{
    ranked *order = order_evenly(components, count);
    for (uint32_t i = 0, end; i < count; i = end) {
        uint32_t submesh = components[order[i].component].submesh;
        float wanted = 0, kept = 0, area = 0, kept_area = 0;
        for (end = i; end < count; end++) {
            const prom_component *c = &components[order[end].component];
            if (c->submesh != submesh) break;
            float n = (float)c->triangles;
            wanted += n * share;
            area += c->area;
            bool keep = kept + n / 2 <= wanted;
            growth[order[end].component] = keep;
            if (keep) kept += n, kept_area += c->area;
        }
        if (kept_area <= 0) {
            // The share is less than half a card: the middle one stands for all.
            uint32_t middle = order[i + (end - i) / 2].component;
            growth[middle] = 1;
            kept_area = components[middle].area;
        }
        float factor = kept_area > 0 ? sqrtf(area / kept_area) : 1;
        for (uint32_t j = i; j < end; j++) growth[order[j].component] *= factor;
    }
    prom_free(order);
}

static uint32_t grown_vertex(prom_work *work, uint32_t vertex, const prom_component *c,
                             float factor)
{
    prom_vertex v = work->vertices.data[vertex];
    for (int a = 0; a < 3; a++)
        v.position[a] = c->center[a] + (v.position[a] - c->center[a]) * factor;
    uint32_t owner = work->owners.data[vertex], id = (uint32_t)work->vertices.count;
    prom_array_push(&work->vertices, v);
    prom_array_push(&work->owners, owner);
    prom_array_push(&work->place, id);
    return id;
}

void prom_work_thin_cards(prom_work *work, const prom_index_array *cards, uint32_t target,
                          prom_index_array *out)
{
    out->count = 0;
    if (!cards->count) return;
    prom_component *components;
    uint32_t *of = prom_alloc(cards->count / 3, sizeof *of);
    uint32_t count = prom_work_components(work, cards, of, &components);
    float *growth = prom_calloc(count, sizeof *growth);
    float share = fminf(1, (float)target * 3 / (float)cards->count);
    choose_kept(components, count, share, growth);
    uint32_t *grown = prom_alloc(work->base_count, sizeof *grown);
    memset(grown, 0xff, work->base_count * sizeof *grown);
    for (size_t i = 0; i < cards->count; i++) {
        const prom_component *c = &components[of[i / 3]];
        float factor = growth[of[i / 3]];
        if (factor <= 0) continue;
        float extent = prom_box_diagonal(&c->box);
        if (extent > 0)
            factor = fmaxf(1, fminf(factor, GROWN_EXTENT * work->diagonal / extent));
        uint32_t v = cards->data[i];
        if (factor > 1 && grown[v] == PROM_NONE) grown[v] = grown_vertex(work, v, c, factor);
        prom_array_push(out, factor > 1 ? grown[v] : v);
    }
    prom_free(grown);
    prom_free(growth);
    prom_free(components);
    prom_free(of);
}

void prom_work_drop_specks(const prom_work *work, uint32_t target, float max_extent,
                           prom_index_array *faces)
{
    size_t left = faces->count / 3, n = 0;
    if (left <= target) return;
    prom_component *components;
    uint32_t *of = prom_alloc(left, sizeof *of);
    uint32_t count = prom_work_components(work, faces, of, &components);
    ranked *order = prom_alloc(count, sizeof *order);
    for (uint32_t i = 0; i < count; i++) {
        // Non-negative floats order like their bits.
        float extent = prom_box_diagonal(&components[i].box);
        uint32_t bits;
        memcpy(&bits, &extent, sizeof bits);
        order[i] = (ranked){bits, i};
    }
    qsort(order, count, sizeof *order, by_key);
    for (uint32_t i = 0; i < count && left > target; i++) {
        prom_component *c = &components[order[i].component];
        if (prom_box_diagonal(&c->box) >= max_extent) break;
        left -= c->triangles;
        c->triangles = 0; // gone
    }
    for (size_t i = 0; i < faces->count; i++)
        if (components[of[i / 3]].triangles) faces->data[n++] = faces->data[i];
    faces->count = n;
    prom_free(order);
    prom_free(components);
    prom_free(of);
}

#include "builder/simplify/cards.h"

#include <math.h>
#include <stdlib.h>

// By taste: what counts as a leaf card.
enum { CARD_TRIANGLES = 16, MIN_CARDS = 12 };
#define CARD_VOLUME 0.002f // against the area to the power 1.5: flat
#define CARD_FACING 0.05f  // length of the summed area vectors against the area: open
#define CARD_EXTENT 0.35f  // of the mesh's diagonal
#define GROWN_EXTENT 0.7f  // to which a card may grow

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
    float area = glm_vec3_norm(cross) / 2, from[3];
    if (!c->triangles) memcpy(c->origin, v[t[0]].position, sizeof c->origin);
    glm_vec3_sub((float *)v[t[0]].position, c->origin, from);
    c->volume += glm_vec3_dot(from, cross) / 6;
    c->submesh = prom_owner_submesh(work->owners.data[t[0]]);
    c->triangles++;
    c->area += area;
    for (int a = 0; a < 3; a++) c->facing[a] += cross[a] / 2;
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
    if (c->triangles > CARD_TRIANGLES) return false;
    if (prom_box_diagonal(&c->box) > CARD_EXTENT * diagonal) return false;
    bool open = glm_vec3_norm((float *)c->facing) >= CARD_FACING * c->area;
    return open || fabsf(c->volume) <= CARD_VOLUME * c->area * sqrtf(c->area);
}

typedef struct tally {
    uint32_t triangles, cards, card_triangles;
} tally;

float prom_work_split_cards(const prom_work *work, bool mostly, prom_index_array *solid,
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
        if (!is_card(&components[i], work->diagonal)) continue;
        t->cards++;
        t->card_triangles += components[i].triangles;
    }
    double extents = 0;
    for (size_t i = 0; i < faces->count; i++) {
        const prom_component *c = &components[of[i / 3]];
        const tally *t = &tallies[c->submesh];
        bool foliage =
            t->cards >= MIN_CARDS && (!mostly || t->card_triangles * 2 >= t->triangles);
        if (foliage && is_card(c, work->diagonal)) {
            prom_array_push(cards, faces->data[i]);
            extents += prom_box_diagonal(&c->box);
        } else {
            prom_array_push(solid, faces->data[i]);
        }
    }
    float mean = cards->count ? (float)(extents / (double)cards->count) : 0;
    prom_free(tallies);
    prom_free(components);
    prom_free(of);
    return mean;
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

// Whether two cards lie in one another: the sides of a leaf, the halves of a cross. They go or
// stay together, since one alone shows its back.
static bool coincide(const prom_component *a, const prom_component *b)
{
    float near = 0.05f * (prom_box_diagonal(&a->box) + prom_box_diagonal(&b->box));
    return a->submesh == b->submesh &&
           glm_vec3_distance((float *)a->center, (float *)b->center) <= near;
}

// Keeps an even share of the cards of one submesh, order[0..count). growth[c]: 0 for a card
// that goes, else the factor that keeps the area.
static void choose_in_submesh(const prom_component *components, const ranked *order,
                              uint32_t count, float share, float *growth)
{
    float wanted = 0, kept = 0, area = 0, kept_area = 0;
    for (uint32_t i = 0, end; i < count; i = end) {
        const prom_component *first = &components[order[i].component];
        float n = 0, unit_area = 0;
        for (end = i; end < count && coincide(first, &components[order[end].component]);
             end++) {
            n += (float)components[order[end].component].triangles;
            unit_area += components[order[end].component].area;
        }
        wanted += n * share;
        area += unit_area;
        if (kept + n / 2 > wanted) continue;
        kept += n;
        kept_area += unit_area;
        for (uint32_t j = i; j < end; j++) growth[order[j].component] = 1;
    }
    if (kept_area <= 0) {
        // The share is less than half a card: the middle one stands for all.
        uint32_t middle = order[count / 2].component;
        growth[middle] = 1;
        kept_area = components[middle].area;
    }
    float factor = kept_area > 0 ? sqrtf(area / kept_area) : 1;
    for (uint32_t i = 0; i < count; i++) growth[order[i].component] *= factor;
}

static void choose_kept(const prom_component *components, uint32_t count, float share,
                        float *growth)
{
    ranked *order = order_evenly(components, count);
    for (uint32_t i = 0, end; i < count; i = end) {
        uint32_t submesh = components[order[i].component].submesh;
        for (end = i; end < count; end++)
            if (components[order[end].component].submesh != submesh) break;
        choose_in_submesh(components, order + i, end - i, share, growth);
    }
    prom_free(order);
}

// A card that grows: by how much, and where its centre goes so that it stays within the bounds
// of all cards.
typedef struct growing {
    float factor;
    float from[3], to[3];
} growing;

static growing grow(const prom_component *c, float factor, const prom_box *bounds,
                    float max_extent)
{
    float extent = prom_box_diagonal(&c->box);
    growing g = {.factor = factor};
    if (extent > 0) g.factor = fmaxf(1, fminf(factor, max_extent / extent));
    for (int a = 0; a < 3; a++) {
        float low = c->center[a] + (c->box.min[a] - c->center[a]) * g.factor;
        float high = c->center[a] + (c->box.max[a] - c->center[a]) * g.factor;
        float shift = 0;
        if (low < bounds->min[a]) shift = bounds->min[a] - low;
        if (high > bounds->max[a]) shift = bounds->max[a] - high;
        if (high - low > bounds->max[a] - bounds->min[a])
            shift = (bounds->min[a] + bounds->max[a] - low - high) / 2;
        g.from[a] = c->center[a];
        g.to[a] = c->center[a] + shift;
    }
    return g;
}

static uint32_t grown_vertex(prom_work *work, uint32_t vertex, const growing *g)
{
    prom_vertex v = work->vertices.data[vertex];
    for (int a = 0; a < 3; a++)
        v.position[a] = g->to[a] + (v.position[a] - g->from[a]) * g->factor;
    return prom_work_append(work, &v, work->owners.data[vertex]);
}

void prom_work_thin_cards(prom_work *work, const prom_index_array *cards, uint32_t target,
                          float growth, prom_index_array *out)
{
    out->count = 0;
    if (!cards->count) return;
    prom_component *components;
    uint32_t *of = prom_alloc(cards->count / 3, sizeof *of);
    uint32_t count = prom_work_components(work, cards, of, &components);
    float *factors = prom_calloc(count, sizeof *factors);
    float share = fminf(1, (float)target * 3 / (float)cards->count);
    choose_kept(components, count, share, factors);
    prom_box bounds = PROM_BOX_EMPTY;
    for (uint32_t i = 0; i < count; i++) prom_box_add_box(&bounds, &components[i].box);
    const size_t vertices = work->vertices.count;
    uint32_t *grown = prom_alloc(vertices, sizeof *grown);
    memset(grown, 0xff, vertices * sizeof *grown);
    for (size_t i = 0; i < cards->count; i++) {
        const prom_component *c = &components[of[i / 3]];
        float factor = factors[of[i / 3]] * sqrtf(growth);
        if (factor <= 0) continue;
        growing g = grow(c, factor, &bounds, GROWN_EXTENT * work->diagonal);
        uint32_t v = cards->data[i];
        if (g.factor > 1 && grown[v] == PROM_NONE) grown[v] = grown_vertex(work, v, &g);
        prom_array_push(out, g.factor > 1 ? grown[v] : v);
    }
    prom_free(grown);
    prom_free(factors);
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

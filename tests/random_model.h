// Random models and cameras for property tests: valid trees of any shape, with shared, turned,
// scaled and mirrored instances, clusters with and without pictures, and random tables.
#ifndef PROM_TESTS_RANDOM_MODEL_H
#define PROM_TESTS_RANDOM_MODEL_H

#include "metaobj/camera.h"
#include "metaobj/model.h"
#include "metaobj/texture.h"
#include "traverse/cost.h"

#include <math.h>
#include <string.h>

// splitmix64 (Steele et al. 2014).
static inline uint64_t random_u64(uint64_t *seed)
{
    uint64_t z = *seed += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static inline uint32_t random_below(uint64_t *seed, uint32_t n)
{
    return (uint32_t)(random_u64(seed) % n);
}

static inline float random_unit(uint64_t *seed)
{
    return (float)(random_u64(seed) >> 40) / 16777216.0f;
}

static inline float random_between(uint64_t *seed, float low, float high)
{
    return low + (high - low) * random_unit(seed);
}

typedef struct random_model_options {
    uint32_t leaves; // about
    uint32_t max_children;
    float extent;        // half edge of the world
    float bare_clusters; // part of the clusters without representations
    float artists;       // part of the objects whose artist gave levels
    bool correlated;     // four meshes each, whose costs go with what they show
} random_model_options;

enum { RANDOM_REPS_MAX = 11 };

static inline void random_rotation(uint64_t *seed, float scale, bool mirror, float basis[9])
{
    float q[4], length = 0.0f;
    for (int i = 0; i < 4; i++) q[i] = random_between(seed, -1, 1), length += q[i] * q[i];
    length = sqrtf(length) + 1e-6f;
    float x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
    const float r[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y + z * w),     2 * (x * z - y * w),
        2 * (x * y - z * w),     1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
        2 * (x * z + y * w),     2 * (y * z - x * w),     1 - 2 * (x * x + y * y)};
    for (int i = 0; i < 9; i++) basis[i] = r[i] * scale * (mirror && i < 3 ? -1.0f : 1.0f);
}

// As prom_byte_of_accuracy, for tests that link no benefit.
static inline uint8_t random_accuracy_byte(float accuracy)
{
    return (uint8_t)(255.0f * (1.0f - sqrtf((1.0f - fminf(accuracy, 1.0f)) / 4.0f)));
}

// Appends one representation; accuracies fall with `quality`, vary by direction and size.
static inline void random_add_rep(prom_model *m, uint64_t *seed, prom_rep_kind kind,
                                  uint32_t level, float error, uint32_t triangles,
                                  float quality)
{
    uint32_t r = m->rep_count++;
    m->reps[r] = (prom_representation){
        .kind = kind,
        .mesh = r,
        .texture = kind == PROM_REP_TEXTURED_BOX ? 0 : PROM_NONE,
        .flags = kind == PROM_REP_TEXTURED_BOX ? PROM_REP_UNLIT : 0,
        .shading = kind == PROM_REP_TEXTURED_BOX ? PROM_SHADE_IMPOSTOR
                                                 : random_below(seed, PROM_SHADE_COUNT),
        .level = level,
        .error = error,
        .max_size_px = kind == PROM_REP_MESH ? INFINITY : PROM_SIZE_MAX_PX,
        .switch_distance = INFINITY,
        .near_k = error > 0.0f ? random_between(seed, 0.05f, 1.0f) : 0.0f,
        .draws = 1 + random_below(seed, 2),
        .vertices = triangles,
        .triangles = triangles,
        .layers = 1.0f + (float)(triangles % 4),
    };
    m->meshes[r] = (prom_mesh_info){triangles, 3 * triangles, 1};
    for (uint32_t d = 0; d < PROM_DIRS; d++)
        for (uint32_t s = 0; s < PROM_SIZES; s++)
            m->accuracy[r].bins[d][s] = random_accuracy_byte(
                quality >= 1.0f ? 1.0f : quality * random_between(seed, 0.8f, 1));
    for (uint32_t d = 0; d < PROM_DIRS_LARGE && kind == PROM_REP_MESH; d++)
        for (uint32_t s = 0; s < PROM_SIZES_LARGE; s++)
            m->accuracy[r].large[d][s] = random_accuracy_byte(
                quality >= 1.0f ? 1.0f : quality * 0.8f / (1.2f + 0.2f * (float)s));
}

static inline void random_prototype(prom_model *m, uint64_t *seed, uint32_t children)
{
    prom_prototype *p = &m->prototypes[m->prototype_count];
    *p = (prom_prototype){.first_rep = m->rep_count,
                          .first_share = PROM_NONE,
                          .child_count = children,
                          .flags = children ? PROM_PROTO_CLUSTER : 0};
    for (int k = 0; k < 3; k++) {
        p->center[k] = random_between(seed, -0.5f, 0.5f);
        p->half[k] = random_between(seed, 0.1f, 1.5f);
        p->radius += p->half[k] * p->half[k];
    }
    p->radius = sqrtf(p->radius);
    for (uint32_t d = 0; d < PROM_DIRS; d++)
        m->coverage[m->prototype_count][d] = (uint16_t)random_between(seed, 5000, 60000);
    if (children) {
        p->first_share = m->share_count;
        for (uint32_t c = 0; c < children; c++, m->share_count++)
            for (uint32_t d = 0; d < PROM_DIRS; d++)
                m->shares[m->share_count][d] =
                    (uint16_t)(random_below(seed, 4) == 0 ? 0 : random_below(seed, 65536));
    }
    m->prototype_count++;
}

// Appends a level by an artist, which may have more triangles than the level before it.
static inline void random_add_artist_level(prom_model *m, uint64_t *seed, uint32_t level,
                                           float error, uint32_t triangles, float quality)
{
    float until = m->reps[m->rep_count - 1].switch_distance;
    for (uint32_t r = m->rep_count; !isfinite(until);) until = m->reps[--r].switch_distance;
    random_add_rep(m, seed, PROM_REP_MESH, level, error,
                   triangles / 2 + random_below(seed, triangles), quality);
    prom_representation *r = &m->reps[m->rep_count - 1];
    r->flags |= PROM_REP_ARTIST;
    r->switch_distance = until * random_between(seed, 1.2f, 4.0f);
    if (!random_below(seed, 4)) r->max_size_px = random_between(seed, 16, 400);
}

static inline void random_reps(prom_model *m, uint64_t *seed, bool cluster, bool artist)
{
    prom_prototype *p = &m->prototypes[m->prototype_count - 1];
    uint32_t triangles = 40 + random_below(seed, 4000), levels = 1 + random_below(seed, 4);
    float error = cluster ? 0.05f * p->radius : 0.0f, quality = cluster ? 0.9f : 1.0f;
    for (uint32_t l = 0; l < levels; l++) {
        random_add_rep(m, seed, PROM_REP_MESH, l, error, triangles, quality);
        if (artist && !l) m->reps[p->first_rep].switch_distance = random_between(seed, 2, 200);
        triangles = triangles / (2 + random_below(seed, 3)) + 4;
        error = (error + 0.01f * p->radius) * 1.7f;
        quality *= random_between(seed, 0.85f, 0.99f);
        if (artist && random_below(seed, 3))
            random_add_artist_level(m, seed, l + 1, error, triangles, quality);
    }
    if (random_below(seed, 3))
        random_add_rep(m, seed, PROM_REP_TEXTURED_BOX, 0, 0.3f * p->radius, 12, 0.8f * quality);
    if (random_below(seed, 3))
        random_add_rep(m, seed, PROM_REP_AVERAGE_BOX, 0, 0.3f * p->radius, 12, 0.4f * quality);
    p->rep_count = m->rep_count - p->first_rep;
}

// Four meshes; each has more triangles, the more it shows. A cluster's cheapest is cheaper than
// anything below it.
static inline void random_correlated_reps(prom_model *m, uint64_t *seed, bool cluster)
{
    prom_prototype *p = &m->prototypes[m->prototype_count - 1];
    float quality = cluster ? random_between(seed, 0.6f, 0.95f) : 1.0f;
    float triangles = random_between(seed, cluster ? 200 : 400, cluster ? 1500 : 4000);
    for (uint32_t l = 0; l < 4; l++) {
        float share = quality * quality * random_between(seed, 0.7f, 1.0f);
        uint32_t count = (uint32_t)(triangles * share * share) + 20;
        if (l == 3) count = cluster ? 4 : 20;
        random_add_rep(m, seed, PROM_REP_MESH, l, l ? 0.01f * (float)l : 0.0f, count, quality);
        m->reps[m->rep_count - 1].draws = 1;
        m->reps[m->rep_count - 1].layers = 1.0f;
        m->reps[m->rep_count - 1].shading = PROM_SHADE_PLAIN;
        quality *= random_between(seed, 0.5f, 0.95f);
    }
    p->rep_count = 4;
}

static inline void random_allocate(prom_model *m, uint32_t nodes, uint32_t prototypes)
{
    prom_arena *a = &m->arena;
    size_t reps = (size_t)prototypes * RANDOM_REPS_MAX;
    m->parent = prom_arena_alloc(a, nodes, sizeof *m->parent);
    m->first_child = prom_arena_alloc(a, nodes, sizeof *m->first_child);
    m->child_count = prom_arena_alloc(a, nodes, sizeof *m->child_count);
    m->prototype = prom_arena_alloc(a, nodes, sizeof *m->prototype);
    m->name = prom_arena_alloc(a, nodes, sizeof *m->name);
    m->placement = prom_arena_alloc(a, nodes, sizeof *m->placement);
    m->center = prom_arena_alloc(a, nodes, sizeof *m->center);
    m->half = prom_arena_alloc(a, nodes, sizeof *m->half);
    m->radius = prom_arena_alloc(a, nodes, sizeof *m->radius);
    m->weight = prom_arena_alloc(a, nodes, sizeof *m->weight);
    for (uint32_t n = 0; n < nodes; n++) m->weight[n] = 1.0f;
    m->measured = (prom_measured){"flip", 22.34f, {0.2f, 0.8f}, 1.0f, 1.0f};
    m->prototypes = prom_arena_alloc(a, prototypes, sizeof *m->prototypes);
    m->coverage = prom_arena_alloc(a, prototypes, sizeof *m->coverage);
    m->reps = prom_arena_alloc(a, reps, sizeof *m->reps);
    m->accuracy = prom_arena_alloc(a, reps, sizeof *m->accuracy);
    m->meshes = prom_arena_alloc(a, reps, sizeof *m->meshes);
    m->shares = prom_arena_alloc(a, nodes, sizeof *m->shares);
    m->textures = prom_arena_alloc(a, 1, sizeof *m->textures);
    m->textures[0] = (prom_texture_info){PROM_TEXTURE_IMPOSTOR_LIT, 4, 4, 6, 3};
    m->texture_count = 1;
    m->names = prom_arena_alloc(a, 1, 1);
    m->names_bytes = 1;
}

// Gives every node its place: children stand around a point near their parent's.
static inline void random_place(prom_model *m, uint64_t *seed, uint32_t node, float spread)
{
    prom_placement *p = &m->placement[node];
    *p = prom_placement_identity;
    for (int k = 0; k < 3; k++) {
        double around = node ? m->placement[m->parent[node]].origin[k] : 0.0;
        p->origin[k] = around + random_between(seed, -spread, spread) * (k == 1 ? 0.2f : 1.0f);
    }
    if (!m->child_count[node])
        random_rotation(seed, random_between(seed, 0.5f, 2.0f), !random_below(seed, 4),
                        p->basis);
}

// Fills *m; free with prom_model_finish. The same seed gives the same model.
static inline void random_model(prom_model *m, uint64_t seed, const random_model_options *o)
{
    *m = (prom_model){0};
    uint32_t capacity = 8 * o->leaves + o->max_children + 8, shared = 1 + o->leaves / 4;
    random_allocate(m, capacity, capacity + shared);
    for (uint32_t i = 0; i < shared; i++) {
        random_prototype(m, &seed, 0);
        bool artist = o->artists > 0.0f && random_unit(&seed) < o->artists;
        if (o->correlated)
            random_correlated_reps(m, &seed, false);
        else
            random_reps(m, &seed, false, artist);
    }
    uint32_t count = 1, open = 1, leaves = 0; // nodes numbered, without a role yet, leaves
    m->parent[0] = PROM_NONE;
    for (uint32_t n = 0; n < count; n++, open--) {
        // A node becomes a cluster while leaves are wanting; the last open one has to.
        bool wanting = leaves + open < o->leaves && count + o->max_children <= capacity;
        bool cluster = wanting && (open == 1 || random_below(&seed, 3) > 0);
        leaves += !cluster;
        m->first_child[n] = PROM_NONE;
        float depth = 0.0f;
        for (uint32_t p = n; p; p = m->parent[p]) depth += 1.0f;
        if (cluster) {
            uint32_t children = 1 + random_below(&seed, o->max_children);
            m->first_child[n] = count;
            m->child_count[n] = children;
            for (uint32_t c = 0; c < children; c++) m->parent[count++] = n;
            open += children;
            m->prototype[n] = m->prototype_count;
            random_prototype(m, &seed, children);
            bool bare = random_unit(&seed) < o->bare_clusters;
            if (!bare && o->correlated)
                random_correlated_reps(m, &seed, true);
            else if (!bare)
                random_reps(m, &seed, true, false);
        } else {
            m->prototype[n] = random_below(&seed, shared);
            m->child_count[n] = 0;
        }
        random_place(m, &seed, n, o->extent * powf(0.5f, depth));
    }
    m->node_count = m->tree_count = count;
    m->mesh_count = m->rep_count;
    prom_model_update_bounds(m);
    // A cluster's picture has the size of what it stands for.
    for (uint32_t n = 0; n < count; n++)
        if (m->child_count[n]) m->prototypes[m->prototype[n]].radius = m->radius[n];
}

// A camera somewhere in or around the model; one in three inside a random node.
static inline void random_camera(const prom_model *m, uint64_t *seed, prom_camera *camera)
{
    *camera = (prom_camera){.fov_y = random_between(seed, 0.5f, 1.6f),
                            .z_near = random_between(seed, 0.01f, 0.3f),
                            .width = 64 + random_below(seed, 1300),
                            .height = 64 + random_below(seed, 800)};
    uint32_t node = random_below(seed, m->tree_count);
    bool inside = !random_below(seed, 3);
    double target[3];
    uint32_t look = random_below(seed, m->tree_count);
    for (int k = 0; k < 3; k++) {
        float reach = inside ? m->half[node][k] : m->half[0][k] * random_between(seed, 1, 3);
        camera->eye[k] = m->center[inside ? node : 0][k] + random_between(seed, -reach, reach);
        target[k] = m->center[look][k] + random_between(seed, -1, 1);
    }
    prom_camera_look_at(camera, target);
}

// A camera outside that has all of the model in view.
static inline void random_camera_outside(const prom_model *m, uint64_t *seed,
                                         prom_camera *camera)
{
    *camera = (prom_camera){.fov_y = 1.0f, .z_near = 0.01f, .width = 1280, .height = 1280};
    float direction[3], length = 0.0f;
    for (int k = 0; k < 3; k++) {
        direction[k] = random_between(seed, -1, 1);
        length += direction[k] * direction[k];
    }
    float reach = m->radius[0] * random_between(seed, 2.2f, 4.0f) / sqrtf(length + 1e-6f);
    for (int k = 0; k < 3; k++)
        camera->eye[k] = m->center[0][k] + (double)(direction[k] * reach);
    prom_camera_look_at(camera, m->center[0]);
}

// Costs of the order of a software rasteriser's.
static inline prom_cost_model random_cost(uint64_t *seed)
{
    prom_cost_model cost = {.fixed_ms = random_between(seed, 0.1f, 1),
                            .draw_ms = random_between(seed, 0, 2e-3f),
                            .vertex_ms = random_between(seed, 0, 1e-4f),
                            .triangle_ms = random_between(seed, 1e-5f, 2e-4f),
                            .edge_ms = random_between(seed, 0, 2e-5f),
                            .hidden_edge_ms = random_between(seed, 0, 5e-6f),
                            .hidden_pixel_ms = random_between(seed, 0, 1e-6f)};
    for (int k = 0; k < PROM_COST_KINDS; k++) cost.pixel_ms[k] = random_between(seed, 0, 2e-5f);
    return cost;
}

#endif

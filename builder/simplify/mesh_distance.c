#include "builder/simplify/mesh_distance.h"

#include "builder/simplify/distance.h"
#include "metaobj/base/threads.h"

#include <float.h>

#define CHUNK 4096u // samples that a thread takes at a time

// Sums over the samples of a chunk. They are added up in the chunks' order, whoever ran them.
typedef struct tally {
    double sum, sum2, normal_sum2, max;
    double from[3], to[3];
} tally;

typedef struct sampling {
    const prom_surface *from, *to;
    const double *area_before; // per triangle of `from`, and the whole
    uint64_t samples;
    const uint32_t *vertices; // used ones, in the triangles' order
    uint32_t vertex_count;
    uint64_t surface_chunks; // vertices' chunks follow
    double resolution;       // distances up to here are 0
    tally *tallies;          // per chunk
} sampling;

// A point of a surface.
typedef struct place {
    double position[3];
    const uint32_t *triangle;
    double weights[3]; // barycentric
} place;

// ---- vectors

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        out[k] = a[i] * b[j] - a[j] * b[i];
    }
}

static void edge(const prom_vertex *v, uint32_t from, uint32_t to, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (double)v[to].position[k] - (double)v[from].position[k];
}

static void place_at(const prom_vertex *v, const uint32_t *triangle, const double weights[3],
                     place *out)
{
    out->triangle = triangle;
    for (int k = 0; k < 3; k++) {
        out->weights[k] = weights[k];
        out->position[k] = 0;
        for (int c = 0; c < 3; c++) out->position[k] += weights[c] * v[triangle[c]].position[k];
    }
}

static double area(const prom_vertex *v, const uint32_t *triangle)
{
    double e[3], f[3], n[3];
    edge(v, triangle[0], triangle[1], e);
    edge(v, triangle[0], triangle[2], f);
    cross(e, f, n);
    return sqrt(dot(n, n)) / 2;
}

static double distance(const place *a, const place *b)
{
    double d[3];
    for (int k = 0; k < 3; k++) d[k] = a->position[k] - b->position[k];
    return sqrt(dot(d, d));
}

// ---- the nearest point of a triangle

// Barycentric weights of a point's projection; false outside the triangle.
static bool project(const prom_vertex *v, const uint32_t *t, const double to[3],
                    double weights[3])
{
    double e[3], f[3], n[3], c[3];
    edge(v, t[0], t[1], e);
    edge(v, t[0], t[2], f);
    cross(e, f, n);
    double square = dot(n, n);
    if (!(square > 0)) return false;
    cross(to, f, c);
    weights[1] = dot(c, n) / square;
    cross(e, to, c);
    weights[2] = dot(c, n) / square;
    weights[0] = 1 - weights[1] - weights[2];
    return weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0;
}

static void keep_nearer(const prom_vertex *v, const uint32_t *t, const double weights[3],
                        const place *point, double *best, place *nearest)
{
    place candidate;
    place_at(v, t, weights, &candidate);
    double d = distance(point, &candidate);
    if (!(d < *best)) return;
    *best = d;
    *nearest = candidate;
}

// In doubles: what the search's floats say of thin triangles may be off by their width. Every
// candidate lies on the triangle, so that a bad one only loses.
static double nearest_of_triangle(const prom_vertex *v, const uint32_t *t, const place *point,
                                  place *nearest)
{
    double best = INFINITY, weights[3];
    for (int c = 0; c < 3; c++) {
        int next = (c + 1) % 3;
        double along[3], to[3];
        edge(v, t[c], t[next], along);
        for (int k = 0; k < 3; k++) to[k] = point->position[k] - (double)v[t[c]].position[k];
        double square = dot(along, along);
        double at = square > 0 ? fmin(fmax(dot(to, along) / square, 0), 1) : 0;
        weights[c] = 1 - at, weights[next] = at, weights[(c + 2) % 3] = 0;
        keep_nearer(v, t, weights, point, &best, nearest);
    }
    double to[3];
    for (int k = 0; k < 3; k++) to[k] = point->position[k] - (double)v[t[0]].position[k];
    if (project(v, t, to, weights)) keep_nearer(v, t, weights, point, &best, nearest);
    return best;
}

// ---- a sample

static void shading_normal(const prom_vertex *v, const place *at, double normal[3])
{
    for (int k = 0; k < 3; k++) {
        normal[k] = 0;
        for (int c = 0; c < 3; c++) normal[k] += at->weights[c] * v[at->triangle[c]].normal[k];
    }
}

// Radians; a back side in the place of its front is no turn.
static double turn_between(const sampling *s, const place *from, const place *to)
{
    double a[3], b[3], c[3];
    shading_normal(s->from->vertices, from, a);
    shading_normal(s->to->vertices, to, b);
    cross(a, b, c);
    return atan2(sqrt(dot(c, c)), fabs(dot(a, b)));
}

// hint: the slot of the last nearest triangle, and then of this one.
static void measure(const sampling *s, const place *from, uint32_t *hint, bool counts,
                    tally *out)
{
    const float point[3] = {(float)from->position[0], (float)from->position[1],
                            (float)from->position[2]};
    prom_nearest found = prom_surface_nearest(s->to, point, 0, *hint);
    place to;
    double d = nearest_of_triangle(s->to->vertices, found.triangle, from, &to);
    *hint = found.slot;
    if (d <= s->resolution) d = 0;
    if (d > out->max) {
        out->max = d;
        memcpy(out->from, from->position, sizeof out->from);
        memcpy(out->to, to.position, sizeof out->to);
    }
    if (!counts) return;
    double turn = turn_between(s, from, &to);
    out->sum += d;
    out->sum2 += d * d;
    out->normal_sum2 += turn * turn;
}

// ---- chunks

// The triangle in which `area` lies.
static uint32_t triangle_at(const sampling *s, double at)
{
    uint32_t low = 0, high = s->from->triangles - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (s->area_before[middle + 1] <= at)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// R2: multiples of the powers of 1/g, where g^3 = g + 1.
static void point_in_triangle(uint64_t k, double weights[3])
{
    double u = 0.5 + 0.7548776662466927 * (double)k, v = 0.5 + 0.5698402909980532 * (double)k;
    u -= floor(u);
    v -= floor(v);
    if (u + v > 1) u = 1 - u, v = 1 - v; // the square's other half
    weights[0] = 1 - u - v, weights[1] = u, weights[2] = v;
}

static void measure_surface(const sampling *s, uint64_t first, tally *out)
{
    const double whole = s->area_before[s->from->triangles];
    uint32_t hint = PROM_NONE, last = s->from->triangles - 1;
    double step = whole / (double)s->samples;
    uint32_t t = triangle_at(s, ((double)first + 0.5) * step);
    for (uint64_t k = first; k < first + CHUNK && k < s->samples; k++) {
        double at = ((double)k + 0.5) * step, weights[3];
        while (t < last && s->area_before[t + 1] <= at) t++;
        place from;
        point_in_triangle(k, weights);
        place_at(s->from->vertices, s->from->indices + (size_t)t * 3, weights, &from);
        measure(s, &from, &hint, true, out);
    }
}

static void measure_vertices(const sampling *s, uint64_t first, tally *out)
{
    uint32_t hint = PROM_NONE;
    for (uint64_t i = first; i < first + CHUNK && i < s->vertex_count; i++) {
        static const double corner[3] = {1, 0, 0};
        const uint32_t triangle[3] = {s->vertices[i], s->vertices[i], s->vertices[i]};
        place from;
        place_at(s->from->vertices, triangle, corner, &from);
        measure(s, &from, &hint, !s->samples, out);
    }
}

static void measure_chunk(void *user, size_t i, unsigned thread)
{
    (void)thread;
    const sampling *s = user;
    if (i < s->surface_chunks)
        measure_surface(s, (uint64_t)i * CHUNK, &s->tallies[i]);
    else
        measure_vertices(s, (i - s->surface_chunks) * (uint64_t)CHUNK, &s->tallies[i]);
}

// ---- one way

static double *areas(const prom_surface *s)
{
    double *before = prom_alloc((size_t)s->triangles + 1, sizeof *before);
    before[0] = 0;
    for (uint32_t t = 0; t < s->triangles; t++)
        before[t + 1] = before[t] + area(s->vertices, s->indices + (size_t)t * 3);
    return before;
}

static uint32_t *used_vertices(const prom_surface *s, uint32_t vertex_count, uint32_t *count)
{
    uint32_t *used = prom_alloc(vertex_count, sizeof *used);
    uint8_t *seen = prom_calloc(vertex_count, sizeof *seen);
    *count = 0;
    for (size_t i = 0; i < (size_t)s->triangles * 3; i++) {
        if (seen[s->indices[i]]) continue;
        seen[s->indices[i]] = 1;
        used[(*count)++] = s->indices[i];
    }
    prom_free(seen);
    return used;
}

static prom_one_way sum_up(const sampling *s, size_t chunks)
{
    tally all = {0};
    for (size_t i = 0; i < chunks; i++) {
        const tally *t = &s->tallies[i];
        all.sum += t->sum;
        all.sum2 += t->sum2;
        all.normal_sum2 += t->normal_sum2;
        if (t->max <= all.max && i) continue;
        all.max = t->max;
        memcpy(all.from, t->from, sizeof all.from);
        memcpy(all.to, t->to, sizeof all.to);
    }
    double count = (double)(s->samples ? s->samples : s->vertex_count);
    prom_one_way way = {.mean = all.sum / count,
                        .rms = sqrt(all.sum2 / count),
                        .max = all.max,
                        .normal_rms_degrees = sqrt(all.normal_sum2 / count) * 180 / GLM_PI,
                        .samples = s->samples};
    memcpy(way.from, all.from, sizeof way.from);
    memcpy(way.to, all.to, sizeof way.to);
    return way;
}

static prom_one_way measure_way(const prom_surface *from, uint32_t vertex_count,
                                const prom_surface *to, uint64_t samples, double resolution)
{
    sampling s = {.from = from, .to = to, .samples = samples, .resolution = resolution};
    double *before = areas(from);
    s.area_before = before;
    if (!(before[from->triangles] > 0)) s.samples = 0;
    uint32_t *vertices = used_vertices(from, vertex_count, &s.vertex_count);
    s.vertices = vertices;
    s.surface_chunks = (s.samples + CHUNK - 1) / CHUNK;
    size_t chunks = s.surface_chunks + (s.vertex_count + CHUNK - 1) / CHUNK;
    s.tallies = prom_calloc(chunks, sizeof *s.tallies);
    prom_parallel_for(chunks, measure_chunk, &s);
    prom_one_way way = sum_up(&s, chunks);
    prom_free(s.tallies);
    prom_free(vertices);
    prom_free(before);
    return way;
}

// ---- both ways

static uint64_t samples_of(const prom_mesh *mesh, uint64_t samples)
{
    if (samples) return samples;
    uint64_t n = (uint64_t)mesh->index_count / 3 * PROM_DISTANCE_SAMPLES_PER_FACE;
    if (n < PROM_DISTANCE_SAMPLES) n = PROM_DISTANCE_SAMPLES;
    return n < PROM_DISTANCE_SAMPLES_MOST ? n : PROM_DISTANCE_SAMPLES_MOST;
}

// A few steps of the floats of the farthest coordinate.
static double resolution_of(const prom_mesh *a, const prom_mesh *b)
{
    prom_box box = prom_mesh_bounds(a), other = prom_mesh_bounds(b);
    prom_box_add_box(&box, &other);
    float farthest = 0;
    for (int k = 0; k < 3; k++)
        farthest = fmaxf(farthest, fmaxf(fabsf(box.min[k]), fabsf(box.max[k])));
    return 4.0 * (double)FLT_EPSILON * (double)farthest;
}

void prom_mesh_distances_measure(const prom_mesh *a, const prom_mesh *b, uint64_t samples,
                                 prom_mesh_distances *distances)
{
    if (a->index_count < 3 || b->index_count < 3) {
        const prom_one_way far = {.mean = INFINITY, .rms = INFINITY, .max = INFINITY};
        *distances = (prom_mesh_distances){far, far, INFINITY, INFINITY};
        return;
    }
    prom_surface of[2];
    prom_surface_init(&of[0], a->vertices, a->vertex_count, a->indices, a->index_count);
    prom_surface_init(&of[1], b->vertices, b->vertex_count, b->indices, b->index_count);
    double resolution = resolution_of(a, b);
    prom_mesh_distances *d = distances;
    d->ab = measure_way(&of[0], a->vertex_count, &of[1], samples_of(a, samples), resolution);
    d->ba = measure_way(&of[1], b->vertex_count, &of[0], samples_of(b, samples), resolution);
    d->rms = fmax(d->ab.rms, d->ba.rms);
    d->hausdorff = fmax(d->ab.max, d->ba.max);
    prom_surface_finish(&of[0]);
    prom_surface_finish(&of[1]);
}

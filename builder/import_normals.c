#include "builder/import_parts.h"

#include <meshoptimizer.h>

// Beyond this many corners at one vertex the crease is not looked for: the search is quadratic.
#define MAX_VALENCE 256u

typedef struct corners {
    double (*face)[3]; // unit normal per triangle
    float *weight;     // angle per corner
    uint32_t *vertex;  // welded vertex per corner
    uint32_t *first;   // per welded vertex, into list
    uint32_t *list;    // corners, by welded vertex
} corners;

static void face_of(const float a[3], const float b[3], const float c[3], double n[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)b[k] - a[k];
        v[k] = (double)c[k] - a[k];
    }
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) n[k] = length > 0 ? n[k] / length : 0;
}

static float angle_at(const float a[3], const float b[3], const float c[3])
{
    double uv = 0, uu = 0, vv = 0;
    for (int k = 0; k < 3; k++) {
        double u = (double)b[k] - a[k], v = (double)c[k] - a[k];
        uv += u * v;
        uu += u * u;
        vv += v * v;
    }
    double cosine = uv / sqrt(uu * vv);
    return (float)acos(fmin(fmax(cosine, -1.0), 1.0));
}

static void corners_init(corners *c, const float (*positions)[3], uint32_t vertex_count,
                         const uint32_t *indices, uint32_t index_count)
{
    *c = (corners){
        .face = prom_alloc(index_count / 3, sizeof *c->face),
        .weight = prom_alloc(index_count, sizeof *c->weight),
        .vertex = prom_alloc(index_count, sizeof *c->vertex),
        .first = prom_calloc((size_t)vertex_count + 1, sizeof *c->first),
        .list = prom_alloc(index_count, sizeof *c->list),
    };
    uint32_t *welded = prom_alloc(vertex_count, sizeof *welded);
    meshopt_generateVertexRemap(welded, indices, index_count, positions, vertex_count,
                                sizeof *positions);
    for (uint32_t i = 0; i < index_count; i++) {
        uint32_t t = i - i % 3, j = t + (i + 1) % 3, k = t + (i + 2) % 3;
        if (i == t)
            face_of(positions[indices[t]], positions[indices[t + 1]], positions[indices[t + 2]],
                    c->face[t / 3]);
        c->weight[i] =
            angle_at(positions[indices[i]], positions[indices[j]], positions[indices[k]]);
        c->vertex[i] = welded[indices[i]];
        c->first[c->vertex[i] + 1]++;
    }
    prom_free(welded);
    for (uint32_t v = 0; v < vertex_count; v++) c->first[v + 1] += c->first[v];
    uint32_t *next = prom_alloc(vertex_count, sizeof *next);
    memcpy(next, c->first, vertex_count * sizeof *next);
    for (uint32_t i = 0; i < index_count; i++) c->list[next[c->vertex[i]]++] = i;
    prom_free(next);
}

static void corners_finish(corners *c)
{
    prom_free(c->face);
    prom_free(c->weight);
    prom_free(c->vertex);
    prom_free(c->first);
    prom_free(c->list);
}

// The weighted sum around corner i of the faces whose normals are within the crease of its own.
static void corner_normal(const corners *c, uint32_t i, double crease_cos, float out[3])
{
    const double *own = c->face[i / 3];
    double sum[3] = {0};
    for (uint32_t k = c->first[c->vertex[i]]; k < c->first[c->vertex[i] + 1]; k++) {
        const double *n = c->face[c->list[k] / 3];
        if (own[0] * n[0] + own[1] * n[1] + own[2] * n[2] < crease_cos) continue;
        for (int a = 0; a < 3; a++) sum[a] += n[a] * (double)c->weight[c->list[k]];
    }
    double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (int a = 0; a < 3; a++) out[a] = (float)(length > 1e-9 ? sum[a] / length : own[a]);
}

void prom_import_normals(const float (*positions)[3], uint32_t vertex_count,
                         const uint32_t *indices, uint32_t index_count, double crease_cos,
                         float (*normals)[3])
{
    corners c;
    corners_init(&c, positions, vertex_count, indices, index_count);
    for (uint32_t i = 0; i < index_count; i++) {
        uint32_t v = c.vertex[i], begin = c.first[v];
        bool crowded = c.first[v + 1] - begin > MAX_VALENCE;
        if (crowded && c.list[begin] != i)
            memcpy(normals[i], normals[c.list[begin]], sizeof *normals); // done before
        else
            corner_normal(&c, i, crowded ? -2.0 : crease_cos, normals[i]);
    }
    corners_finish(&c);
}

// Cutting: surfaces into chunks on a grid, large pieces into halves. No triangle is clipped: it
// belongs where its centroid is.
#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"

#include <stdlib.h>

// A chunk's edge as a share of the layout's diagonal where the user gives none; where triangles
// are fewer than a multiple of the least of an object it may be this much longer; where they
// are too many it is halved at most so often (choices).
#define CHUNK_SHARE (1.0 / 24)
enum { LONGER = 4, ROOMY_FACTOR = 4, MOST_HALVINGS = 8 };

typedef struct spot {
    prom_face face;
    double at[3]; // centroid
    double size;  // longest extent
    uint32_t order, octant;
} spot;

static spot *find_spots(const prom_finder *finder, const prom_face *faces, size_t count)
{
    spot *spots = prom_alloc(count, sizeof *spots);
    for (size_t i = 0; i < count; i++) {
        spots[i].face = faces[i];
        spots[i].order = (uint32_t)i;
        prom_face_centroid(finder, faces[i], spots[i].at);
        prom_wbox box = prom_faces_bounds(finder, &faces[i], 1);
        int axis = prom_wbox_longest_axis(&box);
        spots[i].size = box.max[axis] - box.min[axis];
    }
    return spots;
}

static void add_span(const prom_finder *finder, prom_face *faces, size_t count,
                     prom_spans *spans)
{
    prom_wbox bounds = prom_faces_bounds(finder, faces, count);
    prom_array_push(spans, (prom_span){faces, count, bounds});
}

typedef struct chunker {
    const prom_finder *finder;
    spot *temp;
    prom_face *faces; // where the next chunk goes
    prom_spans *chunks;
    double base;      // edge aimed at
    size_t few, many; // triangles of a chunk
} chunker;

static void emit(chunker *c, const spot *spots, size_t count)
{
    for (size_t i = 0; i < count; i++) c->faces[i] = spots[i].face;
    add_span(c->finder, c->faces, count, c->chunks);
    c->faces += count;
}

// Sorts the spots of a cell by octant; start[o]..start[o + 1] is octant o's share, the ninth
// that of triangles far larger than any chunk should be, which would spoil those of their
// neighbours.
static void sort_octants(chunker *c, spot *spots, size_t count, const double middle[3],
                         double edge, size_t start[10])
{
    memset(start, 0, 10 * sizeof *start);
    for (size_t i = 0; i < count; i++) {
        const double *p = spots[i].at;
        unsigned o = (p[0] >= middle[0]) + 2u * (p[1] >= middle[1]) + 4u * (p[2] >= middle[2]);
        if (spots[i].size > fmax(edge, LONGER * c->base)) o = 8;
        spots[i].octant = o;
        start[o + 1]++;
    }
    for (int o = 0; o < 9; o++) start[o + 1] += start[o];
    size_t at[9];
    memcpy(at, start, sizeof at);
    for (size_t i = 0; i < count; i++) c->temp[at[spots[i].octant]++] = spots[i];
    memcpy(spots, c->temp, count * sizeof *spots);
}

static void chunk_cell(chunker *c, spot *spots, size_t count, const double corner[3],
                       double edge);

// Small octants of few triangles are put together, which keeps chunks from becoming specks.
static void chunk_octants(chunker *c, spot *spots, size_t count, const double corner[3],
                          double edge)
{
    double half = edge / 2, middle[3];
    for (int k = 0; k < 3; k++) middle[k] = corner[k] + half;
    size_t start[10], rest = 0;
    sort_octants(c, spots, count, middle, edge, start);
    spot *left = prom_alloc(count, sizeof *left);
    for (int o = 0; o < 8; o++) {
        size_t n = start[o + 1] - start[o];
        double low[3] = {corner[0] + (o & 1 ? half : 0), corner[1] + (o & 2 ? half : 0),
                         corner[2] + (o & 4 ? half : 0)};
        if (n < c->few && half <= LONGER * c->base) {
            memcpy(left + rest, spots + start[o], n * sizeof *left);
            rest += n;
        } else if (n) {
            chunk_cell(c, spots + start[o], n, low, half);
        }
    }
    if (rest) emit(c, left, rest);
    if (start[9] > start[8]) emit(c, spots + start[8], start[9] - start[8]);
    prom_free(left);
}

static void chunk_cell(chunker *c, spot *spots, size_t count, const double corner[3],
                       double edge)
{
    bool far_too_long = edge > LONGER * c->base && count >= c->few;
    bool too_long = edge > c->base && (count > ROOMY_FACTOR * c->few || c->few == 0);
    bool crowded = count > c->many && edge > ldexp(c->base, -MOST_HALVINGS);
    if (far_too_long || too_long || crowded)
        chunk_octants(c, spots, count, corner, edge);
    else
        emit(c, spots, count);
}

void prom_cut_chunks(const prom_finder *finder, prom_face *faces, size_t count,
                     prom_spans *chunks)
{
    if (!count) return;
    spot *spots = find_spots(finder, faces, count);
    prom_wbox box = PROM_WBOX_EMPTY;
    for (size_t i = 0; i < count; i++) prom_wbox_add_point(&box, spots[i].at);
    double longest = 0, corner[3], edge;
    for (int k = 0; k < 3; k++) longest = fmax(longest, box.max[k] - box.min[k]);
    bool chosen = finder->options.chunk_size > 0;
    double base =
        chosen ? finder->options.chunk_size : CHUNK_SHARE * finder->scope->layout.diagonal;
    base = fmax(base, longest * 1e-6); // so that doubles can tell cells apart
    for (int k = 0; k < 3; k++) corner[k] = floor(box.min[k] / base) * base;
    for (edge = base; edge < longest + base;) edge *= 2;
    chunker c = {.finder = finder,
                 .temp = prom_alloc(count, sizeof *c.temp),
                 .faces = faces,
                 .chunks = chunks,
                 .base = base,
                 .few = chosen ? 0 : finder->options.min_triangles, // all cells alike
                 .many = finder->options.max_triangles};
    chunk_cell(&c, spots, count, corner, edge);
    prom_free(c.temp);
    prom_free(spots);
}

static int by_first_coordinate(const void *pa, const void *pb)
{
    const spot *a = pa, *b = pb;
    if (a->at[0] != b->at[0]) return a->at[0] < b->at[0] ? -1 : 1;
    return a->order < b->order ? -1 : a->order > b->order;
}

static void halve(const prom_finder *finder, spot *spots, size_t count, prom_face **faces,
                  prom_spans *pieces)
{
    if (count <= finder->options.max_triangles) {
        for (size_t i = 0; i < count; i++) (*faces)[i] = spots[i].face;
        add_span(finder, *faces, count, pieces);
        *faces += count;
        return;
    }
    prom_wbox box = PROM_WBOX_EMPTY;
    for (size_t i = 0; i < count; i++) prom_wbox_add_point(&box, spots[i].at);
    int axis = prom_wbox_longest_axis(&box);
    for (size_t i = 0; i < count; i++) {
        double swap = spots[i].at[0];
        spots[i].at[0] = spots[i].at[axis];
        spots[i].at[axis] = swap;
    }
    qsort(spots, count, sizeof *spots, by_first_coordinate);
    for (size_t i = 0; i < count; i++) {
        double swap = spots[i].at[0];
        spots[i].at[0] = spots[i].at[axis];
        spots[i].at[axis] = swap;
    }
    halve(finder, spots, count / 2, faces, pieces);
    halve(finder, spots + count / 2, count - count / 2, faces, pieces);
}

void prom_cut_halves(const prom_finder *finder, prom_face *faces, size_t count,
                     prom_spans *pieces)
{
    if (!count) return;
    spot *spots = find_spots(finder, faces, count);
    halve(finder, spots, count, &faces, pieces);
    prom_free(spots);
}

// Welding: equal vertices, and positions within a tolerance.
#include "builder/simplify/simplify.h"

#include "builder/simplify/weld.h"
#include "builder/simplify/work.h"

#include <math.h>

// Cells are this many tolerances wide, so that few points are near a cell's border.
#define CELL_WIDTH 8.0f

typedef struct snapper {
    const prom_vertex *vertices;
    const uint32_t *first; // result so far
    uint32_t *table;       // heads of chains, index + 1
    uint32_t *next;
    uint32_t size;
    float tolerance;
    bool by_normal;
} snapper;

static uint32_t cell_hash(const int64_t cell[3])
{
    uint64_t h = (uint64_t)cell[0] * 0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 29)) + (uint64_t)cell[1] * 0xC2B2AE3D27D4EB4Fu;
    h = (h ^ (h >> 31)) + (uint64_t)cell[2] * 0x165667B19E3779F9u;
    return (uint32_t)(h ^ (h >> 32));
}

static bool matches(const snapper *s, uint32_t a, uint32_t b)
{
    const prom_vertex *v = &s->vertices[a], *w = &s->vertices[b];
    for (int k = 0; k < 3; k++)
        if (fabsf(v->position[k] - w->position[k]) > s->tolerance) return false;
    int dot = 0;
    for (int k = 0; k < 3; k++) dot += v->normal[k] * w->normal[k];
    return !s->by_normal || dot > 0;
}

static uint32_t find_in_cell(const snapper *s, const int64_t cell[3], uint32_t vertex)
{
    uint32_t found = PROM_NONE;
    for (uint32_t i = s->table[cell_hash(cell) & (s->size - 1)]; i; i = s->next[i - 1])
        if (i - 1 < found && matches(s, i - 1, vertex)) found = i - 1;
    return found;
}

static int64_t cell_of(float value, float width)
{
    double c = floor((double)value / width);
    return (int64_t)fmax(-4e18, fmin(4e18, c));
}

// The earliest kept vertex near `vertex`, or PROM_NONE. Looks into the cells that the tolerance
// touches: one, mostly.
static uint32_t find_near(const snapper *s, uint32_t vertex)
{
    const float *p = s->vertices[vertex].position;
    float width = s->tolerance * CELL_WIDTH;
    int64_t low[3], high[3], cell[3];
    for (int k = 0; k < 3; k++) {
        low[k] = cell_of(p[k] - s->tolerance, width);
        high[k] = cell_of(p[k] + s->tolerance, width);
    }
    uint32_t best = PROM_NONE;
    for (cell[0] = low[0]; cell[0] <= high[0]; cell[0]++)
        for (cell[1] = low[1]; cell[1] <= high[1]; cell[1]++)
            for (cell[2] = low[2]; cell[2] <= high[2]; cell[2]++) {
                uint32_t found = find_in_cell(s, cell, vertex);
                if (found < best) best = found;
            }
    return best;
}

void prom_first_near(const prom_vertex *vertices, uint32_t count, float tolerance,
                     bool by_normal, uint32_t *first)
{
    snapper s = {.vertices = vertices, .tolerance = tolerance, .by_normal = by_normal};
    s.size = 16;
    while (s.size < count * 2) s.size *= 2;
    s.table = prom_calloc(s.size, sizeof *s.table);
    s.next = prom_calloc(count, sizeof *s.next);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t near = find_near(&s, i);
        first[i] = near == PROM_NONE ? i : near;
        if (near != PROM_NONE) continue;
        int64_t cell[3];
        for (int k = 0; k < 3; k++)
            cell[k] = cell_of(vertices[i].position[k], tolerance * CELL_WIDTH);
        uint32_t *head = &s.table[cell_hash(cell) & (s.size - 1)];
        s.next[i] = *head;
        *head = i + 1;
    }
    prom_free(s.table);
    prom_free(s.next);
}

// Below this share of the greatest coordinate a float cannot tell positions apart anyway, and
// cells would outrun their integers.
#define LEAST_TOLERANCE 1e-7f

bool prom_mesh_snap(prom_mesh *mesh, float tolerance, uint32_t *moved)
{
    *moved = 0;
    float greatest = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            if (!isfinite(mesh->vertices[i].position[k])) return false;
            greatest = fmaxf(greatest, fabsf(mesh->vertices[i].position[k]));
        }
    tolerance = fmaxf(tolerance, greatest * LEAST_TOLERANCE);
    if (!(tolerance > 0)) return false;
    uint32_t *first = prom_alloc(mesh->vertex_count, sizeof *first);
    prom_first_near(mesh->vertices, mesh->vertex_count, tolerance, false, first);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        float *to = mesh->vertices[i].position;
        const float *from = mesh->vertices[first[i]].position;
        *moved += to[0] != from[0] || to[1] != from[1] || to[2] != from[2];
        memcpy(to, from, 3 * sizeof *to);
    }
    prom_free(first);
    return true;
}

void prom_mesh_weld(prom_mesh *mesh, float position_tolerance)
{
    uint32_t moved;
    if (position_tolerance > 0) prom_mesh_snap(mesh, position_tolerance, &moved);
    prom_work work;
    prom_work_init(&work, mesh);
    prom_mesh welded;
    prom_work_emit(&work, &work.indices, &welded);
    prom_work_finish(&work);
    prom_mesh_finish(mesh);
    *mesh = welded;
}

void prom_mesh_weld_surface(prom_mesh *mesh, float position_tolerance)
{
    uint32_t moved;
    if (!(position_tolerance > 0) || !prom_mesh_snap(mesh, position_tolerance, &moved)) return;
    uint32_t *first = prom_alloc(mesh->vertex_count, sizeof *first);
    prom_first_near(mesh->vertices, mesh->vertex_count, position_tolerance, true, first);
    for (uint32_t i = 0; i < mesh->index_count; i++) mesh->indices[i] = first[mesh->indices[i]];
    prom_free(first);
}

#include "builder/simplify/collapse_mesh.h"

#include "builder/simplify/work.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

typedef struct vertex_key {
    prom_vertex vertex;
    uint32_t group;
} vertex_key;

// Byte equality must mean equality: no negative zeros, nothing in the unused byte.
static prom_vertex normalised(const prom_vertex *v)
{
    prom_vertex n = *v;
    for (int k = 0; k < 3; k++) n.position[k] += 0.0f;
    for (int k = 0; k < 2; k++) n.uv[k] += 0.0f;
    n.normal[3] = 0;
    return n;
}

static void find_points(prom_collapse_mesh *mesh)
{
    const uint32_t n = mesh->base_vertices;
    float(*places)[3] = prom_alloc(n, sizeof *places);
    for (uint32_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) places[i][k] = mesh->vertices.data[i].position[k] + 0.0f;
    if (n) (void)prom_array_extend(&mesh->point, n);
    uint32_t *point = mesh->point.data;
    prom_first_equal(places, n, sizeof *places, point);
    prom_free(places);
    for (uint32_t i = 0; i < n; i++)
        point[i] = point[i] == i ? mesh->points++ : point[point[i]];
    mesh->position = prom_alloc(mesh->points, sizeof *mesh->position);
    for (uint32_t i = 0; i < n; i++)
        memcpy(mesh->position[point[i]], mesh->vertices.data[i].position,
               sizeof *mesh->position);
}

// first[i]: the first vertex that is the same in everything.
static void find_same(const prom_collapse_mesh *mesh, uint32_t *first)
{
    const uint32_t n = mesh->base_vertices;
    vertex_key *keys = prom_alloc(n, sizeof *keys);
    for (uint32_t i = 0; i < n; i++)
        keys[i] = (vertex_key){normalised(&mesh->vertices.data[i]), mesh->group.data[i]};
    prom_first_equal(keys, n, sizeof *keys, first);
    prom_free(keys);
}

static bool usable(const prom_collapse_mesh *mesh, const uint32_t t[3])
{
    const prom_vertex *v = mesh->vertices.data;
    const uint32_t *point = mesh->point.data;
    if (point[t[0]] == point[t[1]] || point[t[1]] == point[t[2]] || point[t[2]] == point[t[0]])
        return false;
    float cross[3];
    prom_triangle_cross(v[t[0]].position, v[t[1]].position, v[t[2]].position, cross);
    const float area = glm_vec3_norm(cross);
    return isfinite(area) && area > 0;
}

// Leaves repeated triangles out, which would be edges of too many.
static void drop_repeated(prom_collapse_mesh *mesh)
{
    const uint32_t n = mesh->triangle_slots;
    uint32_t(*keys)[3] = prom_alloc(n, sizeof *keys), kept = 0;
    for (uint32_t t = 0; t < n; t++) {
        uint32_t p[3], least = 0;
        for (uint32_t k = 0; k < 3; k++) p[k] = prom_corner_point(mesh, 3 * t + k);
        for (uint32_t k = 1; k < 3; k++) least = p[k] < p[least] ? k : least;
        for (uint32_t k = 0; k < 3; k++) keys[t][k] = p[(least + k) % 3];
    }
    uint32_t *first = prom_alloc(n, sizeof *first);
    prom_first_equal(keys, n, sizeof *keys, first);
    for (uint32_t t = 0; t < n; t++)
        if (first[t] == t) {
            memmove(mesh->corners + 3 * (size_t)kept, mesh->corners + 3 * (size_t)t,
                    3 * sizeof *mesh->corners);
            kept++;
        }
    prom_free(first);
    prom_free(keys);
    mesh->triangle_slots = mesh->triangles = kept;
}

static void gather_triangles(prom_collapse_mesh *mesh, const uint32_t *indices, size_t count)
{
    uint32_t *same = prom_alloc(mesh->base_vertices, sizeof *same);
    find_same(mesh, same);
    mesh->corners = prom_alloc(count, sizeof *mesh->corners);
    for (size_t i = 0; i + 2 < count; i += 3) {
        for (int k = 0; k < 3; k++) assert(indices[i + k] < mesh->base_vertices);
        if (!usable(mesh, indices + i)) continue;
        uint32_t *corner = mesh->corners + 3 * (size_t)mesh->triangle_slots++;
        for (int k = 0; k < 3; k++) corner[k] = same[indices[i + k]];
    }
    prom_free(same);
    drop_repeated(mesh);
}

// In ascending order at each point.
static void list_corners(prom_collapse_mesh *mesh)
{
    const uint32_t corners = 3 * mesh->triangle_slots;
    mesh->next_corner = prom_alloc(corners, sizeof *mesh->next_corner);
    mesh->first_corner = prom_alloc(mesh->points, sizeof *mesh->first_corner);
    memset(mesh->first_corner, 0xff, mesh->points * sizeof *mesh->first_corner);
    for (uint32_t c = corners; c-- > 0;) {
        uint32_t *first = &mesh->first_corner[prom_corner_point(mesh, c)];
        mesh->points_left += *first == PROM_NONE;
        mesh->next_corner[c] = *first;
        *first = c;
    }
}

void prom_collapse_mesh_init(prom_collapse_mesh *mesh, const prom_vertex *vertices,
                             uint32_t vertex_count, const uint32_t *groups,
                             const uint32_t *indices, size_t index_count)
{
    memset(mesh, 0, sizeof *mesh);
    if (!vertices || !indices) vertex_count = 0, index_count = 0;
    assert(index_count / 3 < UINT32_MAX / 3);
    mesh->base_vertices = vertex_count;
    if (vertex_count) {
        (void)prom_array_extend(&mesh->vertices, vertex_count);
        (void)prom_array_extend(&mesh->group, vertex_count);
        memcpy(mesh->vertices.data, vertices, vertex_count * sizeof *vertices);
        for (uint32_t i = 0; i < vertex_count; i++)
            for (int k = 0; k < 2; k++)
                if (!isfinite(vertices[i].uv[k])) mesh->vertices.data[i].uv[k] = 0;
        if (groups) memcpy(mesh->group.data, groups, vertex_count * sizeof *groups);
    }
    find_points(mesh);
    gather_triangles(mesh, indices, index_count);
    list_corners(mesh);
}

void prom_collapse_mesh_finish(prom_collapse_mesh *mesh)
{
    prom_array_finish(&mesh->vertices);
    prom_array_finish(&mesh->point);
    prom_array_finish(&mesh->group);
    prom_free(mesh->corners);
    prom_free(mesh->next_corner);
    prom_free(mesh->first_corner);
    prom_free(mesh->position);
    memset(mesh, 0, sizeof *mesh);
}

size_t prom_collapse_mesh_bytes(const prom_collapse_mesh *mesh)
{
    return mesh->vertices.capacity * sizeof *mesh->vertices.data +
           (mesh->point.capacity + mesh->group.capacity) * sizeof(uint32_t) +
           6 * (size_t)mesh->triangle_slots * sizeof(uint32_t) +
           mesh->points * (sizeof *mesh->first_corner + sizeof *mesh->position);
}

static int by_group(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static uint32_t triangle_group(const prom_collapse_mesh *mesh, uint32_t t)
{
    const uint32_t vertex = mesh->corners[3 * (size_t)t];
    return vertex == PROM_NONE ? PROM_NONE : mesh->group.data[vertex];
}

static uint32_t find_group(const uint32_t *groups, size_t count, uint32_t group)
{
    const uint32_t *found = bsearch(&group, groups, count, sizeof *groups, by_group);
    return (uint32_t)(found - groups);
}

// The groups that have triangles, ascending, to be freed.
static uint32_t *used_groups(const prom_collapse_mesh *mesh, uint32_t *count)
{
    uint32_t *groups = prom_alloc(mesh->triangles, sizeof *groups), n = 0, kept = 0;
    for (uint32_t t = 0; t < mesh->triangle_slots; t++)
        if (mesh->corners[3 * (size_t)t] != PROM_NONE) groups[n++] = triangle_group(mesh, t);
    qsort(groups, n, sizeof *groups, by_group);
    for (uint32_t i = 0; i < n; i++)
        if (!i || groups[i] != groups[i - 1]) groups[kept++] = groups[i];
    *count = kept;
    return groups;
}

void prom_collapse_mesh_emit(const prom_collapse_mesh *mesh, prom_mesh *out)
{
    uint32_t count = 0, used = 0, at = 0;
    uint32_t *groups = used_groups(mesh, &count);
    uint32_t *number = prom_alloc(mesh->vertices.count, sizeof *number);
    memset(number, 0xff, mesh->vertices.count * sizeof *number);
    for (size_t c = 0; c < 3 * (size_t)mesh->triangle_slots; c++)
        if (mesh->corners[c] != PROM_NONE) number[mesh->corners[c]] = 0;
    for (size_t i = 0; i < mesh->vertices.count; i++)
        if (number[i] != PROM_NONE) number[i] = used++;
    prom_mesh_init(out, used, 3 * mesh->triangles, count);
    for (size_t i = 0; i < mesh->vertices.count; i++)
        if (number[i] != PROM_NONE) out->vertices[number[i]] = mesh->vertices.data[i];

    for (uint32_t t = 0; t < mesh->triangle_slots; t++)
        if (mesh->corners[3 * (size_t)t] != PROM_NONE)
            out->submeshes[find_group(groups, count, triangle_group(mesh, t))].index_count += 3;
    for (uint32_t s = 0; s < count; s++) {
        out->submeshes[s].first_index = at;
        out->submeshes[s].material = groups[s];
        at += out->submeshes[s].index_count;
        out->submeshes[s].index_count = 0;
    }
    for (uint32_t t = 0; t < mesh->triangle_slots; t++) {
        if (mesh->corners[3 * (size_t)t] == PROM_NONE) continue;
        prom_submesh *sub = &out->submeshes[find_group(groups, count, triangle_group(mesh, t))];
        for (size_t k = 0; k < 3; k++)
            out->indices[sub->first_index + sub->index_count++] =
                number[mesh->corners[3 * (size_t)t + k]];
    }
    prom_free(number);
    prom_free(groups);
}

#include "builder/simplify/work.h"

#include "builder/simplify/sides.h"

#include <assert.h>
#include <math.h>
#include <meshoptimizer.h>

typedef struct corner_key {
    prom_vertex vertex;
    uint32_t owner;
} corner_key;

typedef struct place_key {
    float position[3];
    uint32_t owner;
} place_key;

void prom_triangle_cross(const float a[3], const float b[3], const float c[3], float cross[3])
{
    float e[3], f[3];
    for (int k = 0; k < 3; k++) e[k] = b[k] - a[k], f[k] = c[k] - a[k];
    glm_vec3_cross(e, f, cross);
}

void prom_first_equal(const void *items, uint32_t count, size_t size, uint32_t *first)
{
    if (!count) return;
    uint32_t *remap = prom_alloc(count, sizeof *remap);
    uint32_t *seen = prom_alloc(count, sizeof *seen);
    meshopt_generateVertexRemap(remap, NULL, count, items, count, size);
    memset(seen, 0xff, (size_t)count * sizeof *seen);
    for (uint32_t i = 0; i < count; i++) {
        if (seen[remap[i]] == PROM_NONE) seen[remap[i]] = i;
        first[i] = seen[remap[i]];
    }
    prom_free(seen);
    prom_free(remap);
}

// Byte equality must mean equality: no negative zeros, nothing in the unused byte.
static prom_vertex normalised(const prom_vertex *v)
{
    prom_vertex n = *v;
    for (int k = 0; k < 3; k++) n.position[k] += 0.0f;
    for (int k = 0; k < 2; k++) n.uv[k] = isfinite(n.uv[k]) ? n.uv[k] + 0.0f : 0.0f;
    n.normal[3] = 0;
    return n;
}

static bool usable(const float a[3], const float b[3], const float c[3])
{
    float cross[3];
    prom_triangle_cross(a, b, c, cross);
    float area = glm_vec3_norm(cross);
    // An infinite coordinate gives an infinite or undefined area.
    return isfinite(area) && area > 0;
}

// All corners of usable triangles.
static void gather_corners(const prom_mesh *mesh, corner_key **keys, uint32_t *count)
{
    corner_key *out = prom_alloc(mesh->index_count, sizeof *out);
    uint32_t n = 0;
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const prom_submesh *sub = &mesh->submeshes[s];
        for (uint32_t i = 0; i + 2 < sub->index_count; i += 3) {
            const uint32_t *t = mesh->indices + sub->first_index + i;
            assert(t[0] < mesh->vertex_count && t[1] < mesh->vertex_count &&
                   t[2] < mesh->vertex_count);
            const prom_vertex *v = mesh->vertices;
            if (!usable(v[t[0]].position, v[t[1]].position, v[t[2]].position)) continue;
            for (int k = 0; k < 3; k++)
                out[n++] = (corner_key){normalised(&v[t[k]]), s * PROM_OWNERS};
        }
    }
    *keys = out;
    *count = n;
}

static void weld_corners(prom_work *work, const corner_key *keys, uint32_t count)
{
    uint32_t *first = prom_alloc(count, sizeof *first);
    prom_first_equal(keys, count, sizeof *keys, first);
    prom_array_reserve(&work->indices, count);
    for (uint32_t i = 0; i < count; i++) {
        if (first[i] == i) {
            prom_array_push(&work->vertices, keys[i].vertex);
            prom_array_push(&work->owners, keys[i].owner);
            first[i] = (uint32_t)work->vertices.count - 1;
        } else {
            first[i] = first[first[i]];
        }
        prom_array_push(&work->indices, first[i]);
    }
    prom_free(first);
}

void prom_work_find_places(prom_work *work)
{
    uint32_t n = (uint32_t)work->vertices.count;
    place_key *keys = prom_alloc(n, sizeof *keys);
    for (uint32_t i = 0; i < n; i++) {
        memcpy(keys[i].position, work->vertices.data[i].position, sizeof keys[i].position);
        keys[i].owner = prom_owner_submesh(work->owners.data[i]);
    }
    prom_array_reserve(&work->place, n);
    work->place.count = n;
    prom_first_equal(keys, n, sizeof *keys, work->place.data);
    prom_free(keys);
}

uint32_t prom_work_append(prom_work *work, const prom_vertex *vertex, uint32_t owner)
{
    const uint32_t id = (uint32_t)work->vertices.count;
    const prom_vertex copy = *vertex; // which may be one of the work's
    prom_array_push(&work->vertices, copy);
    prom_array_push(&work->owners, owner);
    prom_array_push(&work->place, id);
    return id;
}

// The vertex for triangles with the given bits of an owner: itself, or a copy made once.
static uint32_t clone_for(prom_work *work, uint32_t *clones, uint32_t vertex, uint32_t bits)
{
    if (!bits) return vertex;
    uint32_t *clone = &clones[(size_t)vertex * PROM_OWNERS + bits];
    if (*clone != PROM_NONE) return *clone;
    *clone =
        prom_work_append(work, &work->vertices.data[vertex], work->owners.data[vertex] | bits);
    work->place.data[*clone] = work->place.data[vertex];
    return *clone;
}

// Gives triangles with a back side vertices of their own and removes the dropped ones.
static void apply_marks(prom_work *work, const uint8_t *marks)
{
    static const uint32_t bits_of[] = {
        [PROM_SIDE_KEEP] = 0,
        [PROM_SIDE_DOUBLE] = PROM_OWNER_BACK,
        [PROM_SIDE_DOUBLE_LIKE] = PROM_OWNER_BACK | PROM_OWNER_LIKE,
    };
    size_t slots = work->vertices.count * PROM_OWNERS, n = 0;
    uint32_t triangles = (uint32_t)(work->indices.count / 3);
    uint32_t *clones = prom_alloc(slots, sizeof *clones);
    memset(clones, 0xff, slots * sizeof *clones);
    work->triangles = 0;
    for (uint32_t t = 0; t < triangles; t++) {
        if (marks[t] == PROM_SIDE_DROP) continue;
        work->triangles += marks[t] == PROM_SIDE_KEEP ? 1 : 2;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = work->indices.data[t * 3 + k];
            work->indices.data[n++] = clone_for(work, clones, v, bits_of[marks[t]]);
        }
    }
    work->indices.count = n;
    prom_free(clones);
}

void prom_work_init(prom_work *work, const prom_mesh *mesh)
{
    *work = (prom_work){.submesh_count = mesh->submesh_count};
    work->materials = prom_alloc(mesh->submesh_count, sizeof *work->materials);
    for (uint32_t s = 0; s < mesh->submesh_count; s++)
        work->materials[s] = mesh->submeshes[s].material;
    corner_key *keys;
    uint32_t count;
    gather_corners(mesh, &keys, &count);
    weld_corners(work, keys, count);
    prom_free(keys);
    prom_work_find_places(work);
    uint8_t *marks = prom_calloc(count / 3, 1);
    prom_work_mark_sides(work, marks);
    apply_marks(work, marks);
    prom_free(marks);
    work->base_count = (uint32_t)work->vertices.count;
    prom_box box = PROM_BOX_EMPTY;
    for (uint32_t i = 0; i < work->base_count; i++)
        prom_box_add_point(&box, work->vertices.data[i].position);
    work->diagonal = prom_box_diagonal(&box);
}

void prom_work_finish(prom_work *work)
{
    prom_array_finish(&work->vertices);
    prom_array_finish(&work->owners);
    prom_array_finish(&work->place);
    prom_array_finish(&work->indices);
    prom_free(work->materials);
    *work = (prom_work){0};
}

void prom_work_reset(prom_work *work)
{
    work->vertices.count = work->owners.count = work->place.count = work->base_count;
}

uint32_t prom_work_count(const prom_work *work, const prom_index_array *faces)
{
    uint32_t n = 0;
    for (size_t i = 0; i < faces->count; i += 3)
        n += 1 + (work->owners.data[faces->data[i]] & PROM_OWNER_BACK);
    return n;
}

typedef struct emitter {
    const prom_work *work;
    prom_mesh *out;
    uint32_t *ids; // per vertex and side
} emitter;

static uint32_t emit_vertex(emitter *e, uint32_t vertex, bool back)
{
    if (e->work->owners.data[vertex] & PROM_OWNER_LIKE) back = false;
    uint32_t *id = &e->ids[(size_t)vertex * 2 + back];
    if (*id != PROM_NONE) return *id;
    *id = e->out->vertex_count++;
    prom_vertex *v = &e->out->vertices[*id];
    *v = e->work->vertices.data[vertex];
    for (int k = 0; back && k < 3; k++)
        v->normal[k] = (int8_t)(v->normal[k] == -128 ? 127 : -v->normal[k]);
    return *id;
}

void prom_work_emit(const prom_work *work, const prom_index_array *faces, prom_mesh *out)
{
    uint32_t triangles = prom_work_count(work, faces);
    size_t slots = work->vertices.count * 2;
    emitter e = {work, out, prom_alloc(slots, sizeof *e.ids)};
    memset(e.ids, 0xff, slots * sizeof *e.ids);
    // At most three vertices a triangle; trimmed when the vertices are put in order.
    prom_mesh_init(out, triangles * 3, triangles * 3, work->submesh_count);
    out->vertex_count = out->index_count = out->submesh_count = 0;
    for (uint32_t s = 0; s < work->submesh_count; s++) {
        uint32_t first = out->index_count;
        for (size_t i = 0; i < faces->count; i += 3) {
            const uint32_t *t = faces->data + i;
            if (prom_owner_submesh(work->owners.data[t[0]]) != s) continue;
            for (int k = 0; k < 3; k++)
                out->indices[out->index_count++] = emit_vertex(&e, t[k], false);
            if (!(work->owners.data[t[0]] & PROM_OWNER_BACK)) continue;
            for (int k = 2; k >= 0; k--)
                out->indices[out->index_count++] = emit_vertex(&e, t[k], true);
        }
        if (out->index_count > first)
            out->submeshes[out->submesh_count++] =
                (prom_submesh){first, out->index_count - first, work->materials[s]};
    }
    prom_free(e.ids);
    prom_mesh_optimize(out);
}

void prom_mesh_optimize(prom_mesh *mesh)
{
    if (!mesh->index_count) {
        mesh->vertex_count = 0;
        return;
    }
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        uint32_t *range = mesh->indices + mesh->submeshes[s].first_index;
        size_t count = mesh->submeshes[s].index_count;
        meshopt_optimizeVertexCache(range, range, count, mesh->vertex_count);
        // 5 % more vertex work is allowed for less overdraw: meshoptimizer's usual value.
        meshopt_optimizeOverdraw(range, range, count, mesh->vertices[0].position,
                                 mesh->vertex_count, sizeof *mesh->vertices, 1.05f);
    }
    prom_vertex *ordered = prom_alloc(mesh->vertex_count, sizeof *ordered);
    size_t used =
        meshopt_optimizeVertexFetch(ordered, mesh->indices, mesh->index_count, mesh->vertices,
                                    mesh->vertex_count, sizeof *ordered);
    prom_free(mesh->vertices);
    mesh->vertices = prom_realloc(ordered, used, sizeof *ordered);
    mesh->vertex_count = (uint32_t)used;
}

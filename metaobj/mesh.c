#include "metaobj/mesh.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/hash.h"

#include <assert.h>

static_assert(sizeof(prom_vertex) == 28, "the layout that the GPU draws");
static_assert(sizeof(prom_submesh) == 12, "hashed and stored without padding");

void prom_mesh_init(prom_mesh *mesh, uint32_t vertices, uint32_t indices, uint32_t submeshes)
{
    *mesh = (prom_mesh){
        .vertices = prom_calloc(vertices, sizeof *mesh->vertices),
        .indices = prom_calloc(indices, sizeof *mesh->indices),
        .submeshes = prom_calloc(submeshes, sizeof *mesh->submeshes),
        .vertex_count = vertices,
        .index_count = indices,
        .submesh_count = submeshes,
    };
}

void prom_mesh_finish(prom_mesh *mesh)
{
    prom_free(mesh->vertices);
    prom_free(mesh->indices);
    prom_free(mesh->submeshes);
    *mesh = (prom_mesh){0};
}

static void copy_array(void *out, const void *in, size_t count, size_t size)
{
    if (count) memcpy(out, in, count * size);
}

void prom_mesh_copy(prom_mesh *out, const prom_mesh *mesh)
{
    prom_mesh_init(out, mesh->vertex_count, mesh->index_count, mesh->submesh_count);
    copy_array(out->vertices, mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    copy_array(out->indices, mesh->indices, mesh->index_count, sizeof *mesh->indices);
    copy_array(out->submeshes, mesh->submeshes, mesh->submesh_count, sizeof *mesh->submeshes);
}

prom_box prom_mesh_bounds(const prom_mesh *mesh)
{
    prom_box box = PROM_BOX_EMPTY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        prom_box_add_point(&box, mesh->vertices[v].position);
    return box;
}

static const char *check_submeshes(const prom_mesh *mesh, uint32_t material_count)
{
    uint64_t next = 0;
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const prom_submesh *m = &mesh->submeshes[s];
        if (m->first_index != next) return "submeshes leave gaps or overlap";
        if (m->index_count % 3) return "a submesh's index count is no multiple of 3";
        if (m->material != PROM_NONE && m->material >= material_count)
            return "a submesh names a material that does not exist";
        next += m->index_count;
    }
    return next == mesh->index_count ? NULL : "submeshes do not cover the indices";
}

const char *prom_mesh_check(const prom_mesh *mesh, uint32_t material_count)
{
    if (mesh->index_count % 3) return "the index count is no multiple of 3";
    for (uint32_t i = 0; i < mesh->index_count; i++)
        if (mesh->indices[i] >= mesh->vertex_count) return "an index is out of range";
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const prom_vertex *p = &mesh->vertices[v];
        if (!isfinite(p->position[0]) || !isfinite(p->position[1]) || !isfinite(p->position[2]))
            return "a position is not finite";
        if (!isfinite(p->uv[0]) || !isfinite(p->uv[1]))
            return "a texture coordinate is not finite";
    }
    return check_submeshes(mesh, material_count);
}

// The rotation of a triangle that comes first in lexicographic order.
static void first_rotation(const uint32_t in[3], uint32_t out[3])
{
    int best = 0;
    for (int r = 1; r < 3; r++)
        for (int k = 0; k < 3; k++) {
            uint32_t a = in[(r + k) % 3], b = in[(best + k) % 3];
            if (a < b) best = r;
            if (a != b) break;
        }
    for (int k = 0; k < 3; k++) out[k] = in[(best + k) % 3];
}

uint64_t prom_mesh_hash(const prom_mesh *mesh, uint64_t seed)
{
    uint32_t counts[3] = {mesh->vertex_count, mesh->index_count, mesh->submesh_count};
    uint64_t h = prom_hash(counts, sizeof counts, seed);
    h = prom_hash(mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices, h);
    h = prom_hash(mesh->submeshes, mesh->submesh_count * sizeof *mesh->submeshes, h);
    uint32_t batch[3 * 1024];
    for (uint32_t i = 0; i < mesh->index_count;) {
        uint32_t n = 0;
        for (; n < 3 * 1024 && mesh->index_count - i >= 3; n += 3, i += 3)
            first_rotation(mesh->indices + i, batch + n);
        if (mesh->index_count - i < 3) // leftovers of a list that is no triangle list
            for (; n < 3 * 1024 && i < mesh->index_count;) batch[n++] = mesh->indices[i++];
        h = prom_hash(batch, n * sizeof *batch, h);
    }
    return h;
}

void prom_box_face_axes(int face, float right[3], float up[3], float out[3])
{
    static const int8_t axes[6][3][3] = {
        {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
        {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
    };
    assert(face >= 0 && face < 6);
    for (int a = 0; a < 3; a++) {
        right[a] = axes[face][0][a];
        up[a] = axes[face][1][a];
        out[a] = axes[face][2][a];
    }
}

static void fill_face(prom_vertex vertices[4], int face, const float center[3],
                      const float half[3], const uint8_t color[4])
{
    // Bottom left, bottom right, top right, top left as the face's camera sees them.
    static const float corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    float right[3], up[3], out[3];
    prom_box_face_axes(face, right, up, out);
    for (int k = 0; k < 4; k++) {
        prom_vertex *v = &vertices[k];
        for (int a = 0; a < 3; a++)
            v->position[a] =
                center[a] + half[a] * (right[a] * corner[k][0] + up[a] * corner[k][1] + out[a]);
        prom_pack_normal(out, v->normal);
        v->normal[3] = (int8_t)face;
        memcpy(v->color, color, 4);
        v->uv[0] = corner[k][0] * 0.5f + 0.5f;
        v->uv[1] = 0.5f - corner[k][1] * 0.5f;
    }
}

void prom_mesh_init_box(prom_mesh *mesh, const float center[3], const float half[3],
                        const uint8_t colors[6][4])
{
    static const uint8_t white[4] = {255, 255, 255, 255};
    static const uint8_t order[6] = {0, 1, 2, 0, 2, 3};
    prom_mesh_init(mesh, 24, 36, 1);
    for (int face = 0; face < 6; face++) {
        fill_face(mesh->vertices + 4 * face, face, center, half, colors ? colors[face] : white);
        for (int k = 0; k < 6; k++)
            mesh->indices[6 * face + k] = (uint32_t)(4 * face + order[k]);
    }
    mesh->submeshes[0] = (prom_submesh){0, 36, PROM_NONE};
}

void prom_pack_normal(const float normal[3], int8_t packed[4])
{
    double x = normal[0], y = normal[1], z = normal[2];
    double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0) || !isfinite(length)) {
        x = z = 0;
        y = length = 1;
    }
    packed[0] = (int8_t)lround(x / length * 127);
    packed[1] = (int8_t)lround(y / length * 127);
    packed[2] = (int8_t)lround(z / length * 127);
    packed[3] = 0;
}

void prom_turn_normal(const float matrix[9], const int8_t packed[4], int8_t turned[4])
{
    float n[3] = {packed[0], packed[1], packed[2]}, w[3];
    prom_basis_apply(matrix, n, w);
    prom_pack_normal(w, turned);
}

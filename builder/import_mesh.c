#include "builder/import_parts.h"

#include <meshoptimizer.h>

// Coordinates beyond this overflow when they are squared and summed as floats.
#define POSITION_LIMIT 1e15f
// Edges sharper than 60 degrees stay sharp when a file has no normals (by taste).
#define CREASE_COS 0.5

static bool usable(const struct aiVector3D *v)
{
    return fabsf(v->x) < POSITION_LIMIT && fabsf(v->y) < POSITION_LIMIT &&
           fabsf(v->z) < POSITION_LIMIT; // false for NaN
}

static bool same(const struct aiVector3D *a, const struct aiVector3D *b)
{
    return a->x == b->x && a->y == b->y && a->z == b->z;
}

// The indices of all triangles that have an area to show. Points and lines are left out.
static uint32_t collect(const struct aiMesh *mesh, uint32_t *indices, uint64_t *dropped)
{
    uint32_t n = 0;
    for (uint32_t f = 0; f < mesh->mNumFaces; f++) {
        const struct aiFace *face = &mesh->mFaces[f];
        if (face->mNumIndices != 3) continue;
        const struct aiVector3D *p[3];
        bool good = true;
        for (int k = 0; k < 3; k++) {
            p[k] = &mesh->mVertices[face->mIndices[k]];
            good = good && usable(p[k]);
        }
        if (!good) ++*dropped;
        if (!good || same(p[0], p[1]) || same(p[1], p[2]) || same(p[2], p[0])) continue;
        for (int k = 0; k < 3; k++) indices[n++] = face->mIndices[k];
    }
    return n;
}

static uint8_t unit8(float v)
{
    return v >= 1 ? 255 : v > 0 ? (uint8_t)(v * 255.0f + 0.5f) : 0; // 0 for NaN
}

static void pack_color(const struct aiColor4D *c, bool linear, uint8_t out[4])
{
    const float rgb[3] = {c->r, c->g, c->b};
    for (int k = 0; k < 3; k++)
        out[k] =
            linear ? prom_linear_to_srgb8(fminf(fmaxf(rgb[k], 0.0f), 1.0f)) : unit8(rgb[k]);
    out[3] = unit8(c->a);
}

// Everything but the normal. A zero is added so that -0 and 0 are one value to the weld.
static void pack_vertex(const struct aiMesh *mesh, uint32_t i,
                        const prom_import_mesh_options *options, prom_vertex *out)
{
    const struct aiVector3D *p = &mesh->mVertices[i];
    *out = (prom_vertex){.position = {p->x + 0.0f, p->y + 0.0f, p->z + 0.0f},
                         .color = {255, 255, 255, 255}};
    if (mesh->mColors[0]) pack_color(&mesh->mColors[0][i], options->linear_colors, out->color);
    uint32_t channel =
        options->uv_channel < AI_MAX_NUMBER_OF_TEXTURECOORDS ? options->uv_channel : 0;
    const struct aiVector3D *uv = mesh->mTextureCoords[channel];
    if (!uv) uv = mesh->mTextureCoords[0];
    if (!uv) return;
    // assimp's v runs upwards for every format.
    if (isfinite(uv[i].x)) out->uv[0] = uv[i].x + 0.0f;
    if (isfinite(uv[i].y)) out->uv[1] = 1.0f - uv[i].y;
}

static bool normal_usable(const struct aiVector3D *n)
{
    double length = (double)n->x * n->x + (double)n->y * n->y + (double)n->z * n->z;
    return length > 1e-12 && length < 1e12; // false for NaN
}

static bool normals_usable(const struct aiMesh *mesh, const uint32_t *indices, uint32_t count)
{
    if (!mesh->mNormals) return false;
    for (uint32_t i = 0; i < count; i++)
        if (!normal_usable(&mesh->mNormals[indices[i]])) return false;
    return true;
}

// A vertex per corner, with normals made where the file has none.
static void unfold(const struct aiMesh *mesh, const prom_import_mesh_options *options,
                   const uint32_t *indices, uint32_t count, prom_vertex *out)
{
    float(*positions)[3] = prom_alloc(mesh->mNumVertices, sizeof *positions);
    for (uint32_t v = 0; v < mesh->mNumVertices; v++) {
        const struct aiVector3D *p = &mesh->mVertices[v];
        positions[v][0] = p->x + 0.0f;
        positions[v][1] = p->y + 0.0f;
        positions[v][2] = p->z + 0.0f;
    }
    float(*made)[3] = prom_alloc(count, sizeof *made);
    prom_import_normals(positions, mesh->mNumVertices, indices, count, CREASE_COS, made);
    for (uint32_t i = 0; i < count; i++) {
        pack_vertex(mesh, indices[i], options, &out[i]);
        const struct aiVector3D *n = mesh->mNormals ? &mesh->mNormals[indices[i]] : NULL;
        bool given = n && normal_usable(n);
        prom_pack_normal(given ? (float[3]){n->x, n->y, n->z} : made[i], out[i].normal);
    }
    prom_free(positions);
    prom_free(made);
}

static void keep(const struct aiMesh *mesh, const prom_import_mesh_options *options,
                 prom_vertex *out)
{
    for (uint32_t v = 0; v < mesh->mNumVertices; v++) {
        pack_vertex(mesh, v, options, &out[v]);
        const struct aiVector3D *n = &mesh->mNormals[v];
        prom_pack_normal(normal_usable(n) ? (float[3]){n->x, n->y, n->z} : (float[3]){0},
                         out[v].normal);
    }
}

bool prom_import_mesh_read(const struct aiMesh *mesh, const prom_import_mesh_options *options,
                           prom_mesh *out, uint64_t *dropped)
{
    *out = (prom_mesh){0};
    if (mesh->mNumFaces > UINT32_MAX / 3) return false;
    uint32_t *indices = prom_alloc((size_t)mesh->mNumFaces * 3, sizeof *indices);
    uint32_t count = collect(mesh, indices, dropped);
    if (!count) {
        prom_free(indices);
        return false;
    }
    bool indexed = normals_usable(mesh, indices, count);
    uint32_t loose = indexed ? mesh->mNumVertices : count;
    prom_vertex *vertices = prom_alloc(loose, sizeof *vertices);
    if (indexed)
        keep(mesh, options, vertices);
    else
        unfold(mesh, options, indices, count, vertices);
    // Equal vertices become one, unused ones go. Exact, so that tiny models survive.
    const uint32_t *source = indexed ? indices : NULL;
    uint32_t *remap = prom_alloc(loose, sizeof *remap);
    size_t unique =
        meshopt_generateVertexRemap(remap, source, count, vertices, loose, sizeof *vertices);
    prom_mesh_init(out, (uint32_t)unique, count, 1);
    meshopt_remapVertexBuffer(out->vertices, vertices, loose, sizeof *vertices, remap);
    meshopt_remapIndexBuffer(out->indices, source, count, remap);
    out->submeshes[0] = (prom_submesh){0, count, options->material};
    prom_free(remap);
    prom_free(vertices);
    prom_free(indices);
    return true;
}

void prom_import_mesh_transform(prom_mesh *mesh, const double m[16])
{
    float normal[9]; // cofactors: good for flattened matrices too
    double det = 0;
    for (int i = 0; i < 3; i++) {
        double c[3];
        for (int r = 0; r < 3; r++) {
            const double *a = m + 4 * ((i + 1) % 3), *b = m + 4 * ((i + 2) % 3);
            c[r] = a[(r + 1) % 3] * b[(r + 2) % 3] - a[(r + 2) % 3] * b[(r + 1) % 3];
        }
        if (!i) det = m[0] * c[0] + m[1] * c[1] + m[2] * c[2];
        for (int r = 0; r < 3; r++) normal[3 * i + r] = (float)(det < 0 ? -c[r] : c[r]);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        prom_vertex *out = &mesh->vertices[v];
        double p[3] = {out->position[0], out->position[1], out->position[2]};
        float n[3] = {out->normal[0], out->normal[1], out->normal[2]}, turned[3];
        for (int r = 0; r < 3; r++)
            out->position[r] =
                (float)(m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
        prom_basis_apply(normal, n, turned);
        prom_pack_normal(turned, out->normal);
    }
    for (uint32_t i = 0; det < 0 && i < mesh->index_count; i += 3) {
        uint32_t second = mesh->indices[i + 1];
        mesh->indices[i + 1] = mesh->indices[i + 2];
        mesh->indices[i + 2] = second;
    }
}

// PLY, "The Stanford triangle format", Greg Turk 1994. Names of properties and the comment that
// names a picture are those that MeshLab and Blender use.
#include "builder/mesh_write_parts.h"

#include "metaobj/base/log.h"

#include <math.h>

// Little-endian, and so is every machine that this program runs on.
typedef struct row {
    float position[3], normal[3], st[2];
    uint8_t color[4];
} row;

// The picture that all of the mesh shows, else PROM_NONE; *left_out: whether others are lost.
static uint32_t shared_picture(const prom_mesh_file *file, bool *left_out)
{
    const prom_mesh *mesh = &file->mesh;
    uint32_t first = prom_write_material(file, mesh->submeshes[0].material).texture;
    bool shared = true, any = first != PROM_NONE;
    for (uint32_t s = 1; s < mesh->submesh_count; s++) {
        uint32_t texture = prom_write_material(file, mesh->submeshes[s].material).texture;
        shared = shared && texture == first;
        any = any || texture != PROM_NONE;
    }
    *left_out = any && !shared;
    return shared ? first : PROM_NONE;
}

static bool has_colors(const prom_mesh_file *file)
{
    for (uint32_t s = 0; s < file->mesh.submesh_count; s++) {
        const prom_material m = prom_write_material(file, file->mesh.submeshes[s].material);
        for (int k = 0; k < 4; k++)
            if (m.base_color[k] < 1) return true;
    }
    return prom_write_has_colors(&file->mesh);
}

static void write_header(FILE *out, const prom_mesh *mesh, const char *picture, bool colored)
{
    fputs("ply\nformat binary_little_endian 1.0\ncomment promenade\n", out);
    if (picture) fprintf(out, "comment TextureFile %s\n", picture);
    fprintf(out,
            "element vertex %u\nproperty float x\nproperty float y\nproperty float z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "property float s\nproperty float t\n",
            mesh->vertex_count);
    if (colored)
        fputs("property uchar red\nproperty uchar green\nproperty uchar blue\n"
              "property uchar alpha\n",
              out);
    fprintf(out, "element face %u\nproperty list uchar int vertex_indices\nend_header\n",
            mesh->index_count / 3);
}

static void write_vertices(FILE *out, const prom_mesh_file *file, bool colored)
{
    const prom_mesh *mesh = &file->mesh;
    uint32_t *materials = prom_alloc(mesh->vertex_count, sizeof *materials);
    memset(materials, 0xff, mesh->vertex_count * sizeof *materials); // PROM_NONE
    for (uint32_t s = 0; s < mesh->submesh_count; s++)
        for (uint32_t i = 0; i < mesh->submeshes[s].index_count; i++)
            materials[mesh->indices[mesh->submeshes[s].first_index + i]] =
                mesh->submeshes[s].material;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const prom_vertex *v = &mesh->vertices[i];
        const prom_material material = prom_write_material(file, materials[i]);
        row r = {.st = {v->uv[0], 1 - v->uv[1]}};
        for (int k = 0; k < 3; k++) r.position[k] = (float)(file->origin[k] + v->position[k]);
        prom_write_normal(v, r.normal);
        prom_write_color(v, &material, r.color);
        fwrite(&r, colored ? sizeof r : offsetof(row, color), 1, out);
    }
    prom_free(materials);
}

static void write_faces(FILE *out, const prom_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        uint8_t face[13] = {3};
        memcpy(face + 1, mesh->indices + i, 12);
        fwrite(face, sizeof face, 1, out);
    }
}

static prom_status write_all(const char *path, const prom_mesh_file *file,
                             prom_picture_writer *pictures, prom_error *error)
{
    bool left_out;
    prom_material all = {.texture = shared_picture(file, &left_out),
                         .alpha_mode = PROM_ALPHA_MASK};
    if (left_out)
        prom_log(PROM_LOG_WARNING,
                 "%s: PLY can name one picture only, so none is; write .obj or .glb to keep "
                 "them",
                 path);
    prom_picture_names names = {0};
    prom_status status = PROM_OK;
    if (all.texture != PROM_NONE) status = prom_picture_name(pictures, &all, &names, error);
    FILE *out = status ? NULL : prom_staged_open(pictures->staged, path, error);
    if (out) {
        const bool colored = has_colors(file);
        write_header(out, &file->mesh, names.color, colored);
        write_vertices(out, file, colored);
        write_faces(out, &file->mesh);
    }
    prom_picture_names_finish(&names);
    return out ? PROM_OK : error->status;
}

prom_status prom_mesh_write_ply(const char *path, const prom_mesh_file *file, const char *scene,
                                prom_error *error)
{
    prom_staged_files staged = {0};
    prom_picture_writer pictures = {
        .path = path, .scene = scene, .source = &file->source, .staged = &staged};
    prom_status status = write_all(path, file, &pictures, error);
    prom_picture_writer_finish(&pictures);
    return prom_staged_finish(&staged, status, error);
}

// Wavefront OBJ and MTL, "Advanced Visualizer Manual", appendix B, Wavefront 1993; colours
// behind positions as MeshLab and others write them.
#include "builder/mesh_write_parts.h"

#include <errno.h>

// The first line of an MTL, by which the next run knows that it may replace it.
static const char signature[] = "# promenade materials\n";

static char *library_path(const char *path)
{
    return prom_format("%.*s.mtl", (int)(strrchr(path, '.') - path), path);
}

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// It may be the scene's own, or anybody's.
static prom_status check_library(const char *library, prom_error *error)
{
    FILE *in = fopen(library, "rb");
    if (!in && errno == ENOENT) return PROM_OK;
    char text[sizeof signature] = "";
    bool ours = in && fgets(text, sizeof text, in) && !strcmp(text, signature);
    if (in) fclose(in);
    if (ours) return PROM_OK;
    return prom_fail(error, PROM_ERR_USAGE,
                     "%s: is there already and not from here; give the mesh another name, or "
                     "move this file away",
                     library);
}

static void write_material(FILE *out, uint32_t number, const prom_material *m, bool colored,
                           const prom_picture_names *names)
{
    fprintf(out, "\nnewmtl material%u\n", number);
    double c[3];
    for (int k = 0; k < 3; k++)
        c[k] = colored ? 1 : (double)prom_linear_to_srgb(m->base_color[k]);
    fprintf(out, "Kd %.9g %.9g %.9g\n", c[0], c[1], c[2]);
    if (m->alpha_mode == PROM_ALPHA_BLEND) fprintf(out, "d %.9g\n", (double)m->base_color[3]);
    if (names->color) fprintf(out, "map_Kd %s\n", names->color);
    if (names->mask) fprintf(out, "map_d %s\n", names->mask);
}

static prom_status write_library(const char *library, const prom_mesh_file *file,
                                 prom_picture_writer *pictures, bool colored, prom_error *error)
{
    const uint32_t count = file->mesh.submesh_count;
    prom_picture_names *names = prom_calloc(count, sizeof *names);
    prom_status status = PROM_OK;
    for (uint32_t s = 0; s < count && !status; s++) {
        const prom_material m = prom_write_material(file, file->mesh.submeshes[s].material);
        if (m.texture != PROM_NONE) status = prom_picture_name(pictures, &m, &names[s], error);
    }
    FILE *out = status ? NULL : prom_staged_open(pictures->staged, library, error);
    if (out) fputs(signature, out);
    for (uint32_t s = 0; s < count; s++) {
        const prom_material m = prom_write_material(file, file->mesh.submeshes[s].material);
        if (out) write_material(out, s, &m, colored, &names[s]);
        prom_picture_names_finish(&names[s]);
    }
    prom_free(names);
    return out ? PROM_OK : error->status;
}

static void write_vertex(FILE *out, const prom_vertex *v, const double origin[3])
{
    fputc('v', out);
    for (int k = 0; k < 3; k++) fprintf(out, " %.9g", origin[k] + (double)v->position[k]);
}

static void write_vertices(FILE *out, const prom_mesh_file *file, const prom_submesh *sub,
                           bool colored, uint32_t *numbers, uint32_t *next)
{
    const prom_material material = prom_write_material(file, sub->material);
    for (uint32_t i = 0; i < sub->index_count; i++) {
        const uint32_t index = file->mesh.indices[sub->first_index + i];
        if (numbers[index]) continue;
        numbers[index] = ++*next;
        const prom_vertex *v = &file->mesh.vertices[index];
        write_vertex(out, v, file->origin);
        uint8_t c[4];
        float n[3];
        prom_write_color(v, &material, c);
        prom_write_normal(v, n);
        if (colored) fprintf(out, " %.4g %.4g %.4g", c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
        fprintf(out, "\nvt %.9g %.9g\nvn %.5g %.5g %.5g\n", (double)v->uv[0],
                1 - (double)v->uv[1], (double)n[0], (double)n[1], (double)n[2]);
    }
}

static void write_faces(FILE *out, const prom_mesh *mesh, const prom_submesh *sub,
                        const uint32_t *numbers)
{
    for (uint32_t i = 0; i < sub->index_count; i += 3) {
        const uint32_t *t = mesh->indices + sub->first_index + i;
        const uint32_t a = numbers[t[0]], b = numbers[t[1]], c = numbers[t[2]];
        fprintf(out, "f %u/%u/%u %u/%u/%u %u/%u/%u\n", a, a, a, b, b, b, c, c, c);
    }
}

static void write_mesh(FILE *out, const prom_mesh_file *file, const char *library, bool colored)
{
    const prom_mesh *mesh = &file->mesh;
    uint32_t *numbers = prom_calloc(mesh->vertex_count, sizeof *numbers), next = 0;
    fprintf(out, "# promenade\nmtllib %s\n", name_of(library));
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        write_vertices(out, file, &mesh->submeshes[s], colored, numbers, &next);
        fprintf(out, "usemtl material%u\n", s);
        write_faces(out, mesh, &mesh->submeshes[s], numbers);
    }
    prom_free(numbers);
}

prom_status prom_mesh_write_obj(const char *path, const prom_mesh_file *file, const char *scene,
                                prom_error *error)
{
    prom_staged_files staged = {0};
    prom_picture_writer pictures = {.path = path,
                                    .scene = scene,
                                    .source = &file->source,
                                    .masks = true,
                                    .staged = &staged};
    const bool colored = prom_write_has_colors(&file->mesh);
    char *library = library_path(path);
    prom_status status = check_library(library, error);
    if (!status) status = write_library(library, file, &pictures, colored, error);
    FILE *out = status ? NULL : prom_staged_open(&staged, path, error);
    if (out)
        write_mesh(out, file, library, colored);
    else
        status = error->status;
    prom_free(library);
    prom_picture_writer_finish(&pictures);
    return prom_staged_finish(&staged, status, error);
}

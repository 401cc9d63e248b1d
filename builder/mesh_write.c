#include "builder/glb_writer.h"
#include "builder/image_io.h"
#include "builder/mesh_write_parts.h"

#include <assert.h>
#include <math.h>
#include <strings.h>

enum { FORMAT_UNKNOWN, FORMAT_OBJ, FORMAT_PLY, FORMAT_GLB };

static int format_of(const char *path)
{
    static const char *const endings[] = {".obj", ".ply", ".glb"};
    const char *dot = strrchr(path, '.');
    for (int i = 0; dot && i < 3; i++)
        if (!strcasecmp(dot, endings[i])) return FORMAT_OBJ + i;
    return FORMAT_UNKNOWN;
}

bool prom_mesh_write_known(const char *path)
{
    return format_of(path) != FORMAT_UNKNOWN;
}

prom_status prom_mesh_write(const char *path, const prom_mesh_file *file, const char *scene,
                            prom_error *error)
{
    switch (format_of(path)) {
    case FORMAT_OBJ:
        return prom_mesh_write_obj(path, file, scene, error);
    case FORMAT_PLY:
        return prom_mesh_write_ply(path, file, scene, error);
    case FORMAT_GLB:
        return prom_mesh_write_glb(path, file, error);
    default:
        return prom_fail(error, PROM_ERR_USAGE, "%s: the name must end with .obj, .ply or .glb",
                         path);
    }
}

// ---- what the formats share

prom_material prom_write_material(const prom_mesh_file *file, uint32_t material)
{
    static const prom_material white = {.base_color = {1, 1, 1, 1}, .texture = PROM_NONE};
    return material == PROM_NONE ? white : file->source.materials.data[material];
}

void prom_write_normal(const prom_vertex *vertex, float normal[3])
{
    for (int k = 0; k < 3; k++) normal[k] = vertex->normal[k];
    if (glm_vec3_norm2(normal) <= 0) normal[1] = 1;
    glm_vec3_normalize(normal);
}

bool prom_write_has_colors(const prom_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 4; k++)
            if (mesh->vertices[i].color[k] != 255) return true;
    return false;
}

void prom_write_color(const prom_vertex *vertex, const prom_material *material,
                      uint8_t color[4])
{
    for (int k = 0; k < 3; k++)
        color[k] = prom_linear_to_srgb8(prom_srgb8_to_linear(vertex->color[k]) *
                                        material->base_color[k]);
    color[3] = (uint8_t)lroundf((float)vertex->color[3] * material->base_color[3]);
}

prom_status prom_write_png(const prom_source_image *image, bool opaque, uint8_t **png,
                           size_t *bytes, prom_error *error)
{
    const size_t pixels = (size_t)image->width * image->height;
    bool seen_through = false;
    for (size_t i = 0; !opaque && i < pixels; i++)
        seen_through = seen_through || image->rgba[4 * i + 3] != 255;
    if (seen_through)
        return prom_image_encode_png(image->width, image->height, 4, image->rgba, png, bytes,
                                     error);
    uint8_t *rgb = prom_alloc(pixels, 3);
    for (size_t i = 0; i < pixels; i++) memcpy(rgb + 3 * i, image->rgba + 4 * i, 3);
    prom_status status =
        prom_image_encode_png(image->width, image->height, 3, rgb, png, bytes, error);
    prom_free(rgb);
    return status;
}

// ---- GLB

static prom_status add_images(prom_glb *glb, const prom_mesh_file *file, uint32_t *numbers,
                              prom_error *error)
{
    for (size_t i = 0; i < file->source.images.count; i++) numbers[i] = PROM_GLB_NONE;
    for (uint32_t s = 0; s < file->mesh.submesh_count; s++) {
        const prom_material m = prom_write_material(file, file->mesh.submeshes[s].material);
        if (m.texture == PROM_NONE || numbers[m.texture] != PROM_GLB_NONE) continue;
        const prom_source_image *image = &file->source.images.data[m.texture];
        uint8_t *png;
        size_t bytes;
        prom_status status = prom_write_png(image, false, &png, &bytes, error);
        if (status) return status;
        numbers[m.texture] = prom_glb_add_png(glb, image->name, png, bytes);
        prom_free(png);
    }
    return PROM_OK;
}

static uint32_t add_material(prom_glb *glb, const prom_material *m, uint32_t number,
                             const uint32_t *images)
{
    static const prom_glb_alpha alphas[] = {[PROM_ALPHA_OPAQUE] = PROM_GLB_OPAQUE,
                                            [PROM_ALPHA_MASK] = PROM_GLB_MASK,
                                            [PROM_ALPHA_BLEND] = PROM_GLB_BLEND};
    char *name = prom_format("material%u", number);
    prom_glb_material to = {.name = name,
                            .image =
                                m->texture == PROM_NONE ? PROM_GLB_NONE : images[m->texture],
                            .alpha = alphas[m->alpha_mode],
                            .alpha_cutoff = m->alpha_cutoff,
                            .double_sided = m->double_sided};
    memcpy(to.base_color, m->base_color, sizeof to.base_color);
    uint32_t id = prom_glb_add_material(glb, &to);
    prom_free(name);
    return id;
}

// The arrays of a part, which it points to.
typedef struct part_data {
    prom_glb_vertex *vertices;
    uint16_t (*colors)[4];
    uint32_t *indices;
} part_data;

static void put_vertex(const prom_vertex *from, uint32_t to, part_data *data)
{
    prom_glb_vertex *v = &data->vertices[to];
    memcpy(v->position, from->position, sizeof v->position);
    memcpy(v->uv, from->uv, sizeof v->uv);
    prom_write_normal(from, v->normal);
    if (!data->colors) return;
    for (int k = 0; k < 3; k++)
        data->colors[to][k] = (uint16_t)lroundf(prom_srgb8_to_linear(from->color[k]) * 65535);
    data->colors[to][3] = (uint16_t)(from->color[3] * 257);
}

// numbers: per vertex, all PROM_NONE; gets those of the part.
static uint32_t fill_part(const prom_mesh *mesh, const prom_submesh *sub, uint32_t *numbers,
                          part_data *data)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < sub->index_count; i++) {
        const uint32_t v = mesh->indices[sub->first_index + i];
        if (numbers[v] == PROM_NONE) {
            put_vertex(&mesh->vertices[v], count, data);
            numbers[v] = count++;
        }
        data->indices[i] = numbers[v];
    }
    return count;
}

static void add_mesh(prom_glb *glb, const prom_mesh_file *file, const uint32_t *images)
{
    const prom_mesh *mesh = &file->mesh;
    const bool colored = prom_write_has_colors(mesh);
    prom_glb_part *parts = prom_calloc(mesh->submesh_count, sizeof *parts);
    part_data *data = prom_calloc(mesh->submesh_count, sizeof *data);
    uint32_t *numbers = prom_alloc(mesh->vertex_count, sizeof *numbers);
    memset(numbers, 0xff, mesh->vertex_count * sizeof *numbers);
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const prom_submesh *sub = &mesh->submeshes[s];
        const prom_material m = prom_write_material(file, sub->material);
        part_data *d = &data[s];
        d->vertices = prom_alloc(sub->index_count, sizeof *d->vertices);
        d->indices = prom_alloc(sub->index_count, sizeof *d->indices);
        d->colors = colored ? prom_alloc(sub->index_count, sizeof *d->colors) : NULL;
        parts[s] = (prom_glb_part){.material = add_material(glb, &m, s, images),
                                   .vertices = d->vertices,
                                   .colors = (const uint16_t(*)[4])d->colors,
                                   .indices = d->indices,
                                   .vertex_count = fill_part(mesh, sub, numbers, d),
                                   .index_count = sub->index_count};
    }
    prom_glb_node node = {.name = "mesh", .parent = PROM_GLB_NONE, .scale = 1};
    node.mesh = prom_glb_add_mesh(glb, "mesh", parts, mesh->submesh_count);
    memcpy(node.translation, file->origin, sizeof node.translation);
    prom_glb_add_node(glb, &node);
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        prom_free(data[s].vertices);
        prom_free(data[s].indices);
        prom_free(data[s].colors);
    }
    prom_free(numbers);
    prom_free(data);
    prom_free(parts);
}

prom_status prom_mesh_write_glb(const char *path, const prom_mesh_file *file, prom_error *error)
{
    prom_glb *glb = prom_glb_create(path);
    uint32_t *images = prom_alloc(file->source.images.count, sizeof *images);
    prom_status status = add_images(glb, file, images, error);
    if (!status) {
        add_mesh(glb, file, images);
        status = prom_glb_finish(glb, "promenade", error);
    }
    prom_free(images);
    prom_glb_destroy(glb);
    return status;
}

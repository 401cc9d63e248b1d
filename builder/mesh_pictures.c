#include "builder/mesh_pictures.h"

#include "builder/orthographic.h"
#include "builder/textures.h"
#include "metaobj/base/alloc.h"
#include "render/renderer.h"

#include <assert.h>

const char *const prom_look_metrics[PROM_LOOK_METRICS] = {"rmse", "sobel", "flip"};

// Behind the meshes, alpha 0: light enough for dark things, dark enough for light ones.
static const uint8_t backdrop[4] = {128, 128, 128, 0};

struct prom_mesh_pictures {
    prom_context *context;
    prom_renderer *renderer;
    prom_target *target;
    prom_draw_list *lists[2];
    float radius;
    uint32_t size_px;
    size_t pixels;
    prom_metric *metrics[PROM_LOOK_METRICS];
    float *features[2];
    uint8_t (*rgba[2])[4];
    uint8_t *differs, *footprint;
    float *map; // of the last metric, flip
};

// ---- views

void prom_cube_view_direction(uint32_t view, float direction[3])
{
    static const int8_t views[PROM_CUBE_VIEWS][3] = {
        {1, 0, 0},   {-1, 0, 0}, {0, 1, 0},   {0, -1, 0},  {0, 0, 1},   {0, 0, -1}, {1, 1, 0},
        {1, -1, 0},  {-1, 1, 0}, {-1, -1, 0}, {1, 0, 1},   {1, 0, -1},  {-1, 0, 1}, {-1, 0, -1},
        {0, 1, 1},   {0, 1, -1}, {0, -1, 1},  {0, -1, -1}, {1, 1, 1},   {1, 1, -1}, {1, -1, 1},
        {1, -1, -1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}, {-1, -1, -1}};
    assert(view < PROM_CUBE_VIEWS);
    for (int k = 0; k < 3; k++) direction[k] = views[view][k];
    glm_vec3_normalize(direction);
}

// ---- the device

// Textures first: materials name them by their numbers on the device.
static bool add_textures(prom_renderer *renderer, const prom_source *source)
{
    size_t count = source->images.count;
    prom_texture *textures = prom_calloc(count, sizeof *textures);
    prom_textures_make(source, textures);
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        good = good && prom_renderer_add_texture(renderer, &textures[i]) != PROM_NONE;
        prom_texture_finish(&textures[i]);
    }
    prom_free(textures);
    return good;
}

static void add_materials(const prom_source *source, uint32_t first_texture,
                          prom_material *materials)
{
    for (size_t i = 0; i < source->materials.count; i++) {
        materials[i] = source->materials.data[i];
        if (materials[i].texture != PROM_NONE) materials[i].texture += first_texture;
    }
}

static bool add_mesh(prom_mesh_pictures *p, int which, const prom_mesh *mesh,
                     uint32_t first_material, const float center[3])
{
    prom_mesh shown = *mesh;
    shown.submeshes = prom_alloc(mesh->submesh_count, sizeof *shown.submeshes);
    for (uint32_t i = 0; i < mesh->submesh_count; i++) {
        shown.submeshes[i] = mesh->submeshes[i];
        if (shown.submeshes[i].material != PROM_NONE)
            shown.submeshes[i].material += first_material;
    }
    prom_draw_item item = {.mesh = prom_renderer_add_mesh(p->renderer, &shown),
                           .texture = PROM_NONE};
    prom_free(shown.submeshes);
    if (item.mesh == PROM_NONE) return false;
    glm_vec3_negate_to((float *)center, item.origin);
    memcpy(item.basis, prom_placement_identity.basis, sizeof item.basis);
    p->lists[which] = prom_draw_list_create(p->renderer);
    prom_draw_list_add(p->lists[which], &item);
    return true;
}

static bool add_files(prom_mesh_pictures *p, const prom_mesh_file *const files[2],
                      const float center[3])
{
    uint32_t counts[2] = {(uint32_t)files[0]->source.materials.count,
                          (uint32_t)files[1]->source.materials.count};
    prom_material *materials = prom_alloc((size_t)counts[0] + counts[1], sizeof *materials);
    bool good = true;
    for (int i = 0; i < 2; i++) {
        add_materials(&files[i]->source, prom_renderer_texture_count(p->renderer),
                      materials + (i ? counts[0] : 0));
        good = good && add_textures(p->renderer, &files[i]->source);
        good = good && add_mesh(p, i, &files[i]->mesh, i ? counts[0] : 0, center);
    }
    prom_renderer_set_materials(p->renderer, materials, counts[0] + counts[1]);
    for (int i = 0; good && i < 2; i++) prom_draw_list_prepare(p->lists[i]);
    prom_free(materials);
    return good;
}

static float radius_around(const prom_mesh *mesh, const float center[3])
{
    float square = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        square = fmaxf(square, glm_vec3_distance2(mesh->vertices[v].position, (float *)center));
    return sqrtf(square);
}

static prom_status open_device(prom_mesh_pictures *p, const prom_mesh_file *const files[2],
                               prom_error *error)
{
    p->context = prom_context_create_headless(error);
    if (p->context) p->renderer = prom_renderer_create(p->context, error);
    if (p->renderer) p->target = prom_target_create(p->size_px, p->size_px, false, error);
    if (!p->target) return error->status;
    prom_box box = prom_mesh_bounds(&files[0]->mesh);
    float center[3];
    prom_box_center(&box, center);
    p->radius = radius_around(&files[0]->mesh, center);
    if (!(p->radius > 0)) p->radius = 1; // a point; nothing of it shows
    if (add_files(p, files, center)) return PROM_OK;
    return prom_fail(error, PROM_ERR_UNSUPPORTED,
                     "the device has no memory for both meshes and their pictures");
}

// ---- comparing

static void make_room(prom_mesh_pictures *p, double ppd)
{
    p->pixels = (size_t)p->size_px * p->size_px;
    size_t floats = 0;
    for (int m = 0; m < PROM_LOOK_METRICS; m++) {
        p->metrics[m] = prom_metric_create(prom_look_metrics[m], ppd, p->size_px, p->pixels, 0);
        size_t more = prom_metric_feature_floats(p->metrics[m], p->size_px, p->size_px);
        if (more > floats) floats = more;
    }
    for (int i = 0; i < 2; i++) {
        p->features[i] = prom_alloc(floats, sizeof *p->features[i]);
        p->rgba[i] = prom_alloc(p->pixels, sizeof *p->rgba[i]);
    }
    p->differs = prom_alloc(p->pixels, 1);
    p->footprint = prom_alloc(p->pixels, 1);
    p->map = prom_alloc(p->pixels, sizeof *p->map);
}

prom_mesh_pictures *prom_mesh_pictures_create(const prom_mesh_file *a, const prom_mesh_file *b,
                                              uint32_t size_px, double ppd, prom_error *error)
{
    prom_mesh_pictures *p = prom_calloc(1, sizeof *p);
    p->size_px = size_px;
    if (open_device(p, (const prom_mesh_file *[2]){a, b}, error)) {
        prom_mesh_pictures_destroy(p);
        return NULL;
    }
    make_room(p, ppd);
    return p;
}

void prom_mesh_pictures_destroy(prom_mesh_pictures *p)
{
    if (!p) return;
    for (int i = 0; i < 2; i++) {
        if (p->lists[i]) prom_draw_list_destroy(p->lists[i]);
        prom_free(p->features[i]);
        prom_free(p->rgba[i]);
    }
    for (int m = 0; m < PROM_LOOK_METRICS; m++) prom_metric_destroy(p->metrics[m]);
    prom_free(p->differs);
    prom_free(p->footprint);
    prom_free(p->map);
    prom_target_destroy(p->target);
    if (p->renderer) prom_renderer_destroy(p->renderer);
    prom_context_destroy(p->context);
    prom_free(p);
}

static void draw(prom_mesh_pictures *p, int which, uint32_t view)
{
    prom_pass pass = {.width = p->size_px, .height = p->size_px, .output = PROM_OUTPUT_LIT};
    float out[3], right[3], up[3];
    prom_cube_view_direction(view, out);
    prom_frame_of_direction(out, right, up);
    prom_orthographic(right, up, out, p->radius, p->radius, 2.0f * p->radius, pass.projection);
    prom_target_clear(p->target, backdrop);
    prom_draw_list_submit(p->lists[which], p->target, &pass);
    prom_target_read_rgba(p->target, 0, 0, p->size_px, p->size_px, p->rgba[which][0]);
}

static void compare_by(prom_mesh_pictures *p, int m, const prom_picture pictures[2],
                       prom_look_difference *difference)
{
    prom_metric *metric = p->metrics[m];
    const prom_metric_class *class = prom_metric_class_of(metric);
    for (int i = 0; i < 2; i++) prom_metric_features(metric, &pictures[i], p->features[i]);
    prom_metric_compare(metric, p->features[0], p->features[1], p->size_px, p->size_px, p->map);
    prom_errors_pool(class, p->map, p->pixels, NULL, p->differs, &difference->all);
    prom_errors_pool(class, p->map, p->pixels, p->footprint, p->differs, &difference->object);
}

void prom_mesh_pictures_compare(prom_mesh_pictures *p, uint32_t view,
                                prom_look_difference differences[PROM_LOOK_METRICS])
{
    prom_picture pictures[2];
    for (int i = 0; i < 2; i++) {
        draw(p, i, view);
        pictures[i] = (prom_picture){
            .width = p->size_px, .height = p->size_px, .channels = 4, .pixels = p->rgba[i]};
    }
    prom_picture_differs(&pictures[0], &pictures[1], p->differs);
    for (size_t i = 0; i < p->pixels; i++)
        p->footprint[i] = p->rgba[0][i][3] | p->rgba[1][i][3];
    for (int m = 0; m < PROM_LOOK_METRICS; m++) compare_by(p, m, pictures, &differences[m]);
}

const uint8_t (*prom_mesh_pictures_rgba(const prom_mesh_pictures *p, int mesh))[4]
{
    return (const uint8_t(*)[4])p->rgba[mesh];
}

const float *prom_mesh_pictures_flip(const prom_mesh_pictures *p)
{
    return p->map;
}

#include "builder/bake.h"

#include "metaobj/base/alloc.h"

_Static_assert(PROM_ATLAS_COLUMNS >= 6, "the six faces stand in a row of the atlas");

struct prom_baker {
    prom_target *target;
    prom_draw_list *list;
};

static const uint8_t nothing[4] = {0, 0, 0, 0};

void prom_views_init(prom_views *views, bool with_ids)
{
    views->rgba = prom_alloc(PROM_ATLAS_PIXELS, sizeof *views->rgba);
    views->ids = with_ids ? prom_alloc(PROM_ATLAS_PIXELS, sizeof *views->ids) : NULL;
}

void prom_views_finish(prom_views *views)
{
    prom_free(views->rgba);
    prom_free(views->ids);
    *views = (prom_views){0};
}

prom_baker *prom_baker_create(prom_renderer *renderer, prom_error *error)
{
    prom_baker *baker = prom_calloc(1, sizeof *baker);
    baker->target = prom_target_create(PROM_ATLAS_WIDTH, PROM_ATLAS_HEIGHT, true, error);
    if (!baker->target) {
        prom_baker_destroy(baker);
        return NULL;
    }
    baker->list = prom_draw_list_create(renderer);
    return baker;
}

void prom_baker_destroy(prom_baker *baker)
{
    if (!baker) return;
    prom_target_destroy(baker->target);
    prom_draw_list_destroy(baker->list);
    prom_free(baker);
}

void prom_baker_set_subject(prom_baker *baker, const prom_draw_item *items, size_t count)
{
    prom_draw_list_reset(baker->list);
    for (size_t i = 0; i < count; i++) prom_draw_list_add(baker->list, &items[i]);
    prom_draw_list_prepare(baker->list);
}

// Clip coordinates from a frame: x and y over the half extents, z from 0 (far) to 1 (near).
static void orthographic(const float right[3], const float up[3], const float out[3],
                         float half_width, float half_height, float half_depth, mat4 m)
{
    glm_mat4_zero(m);
    for (int c = 0; c < 3; c++) {
        m[c][0] = right[c] / half_width;
        m[c][1] = up[c] / half_height;
        m[c][2] = 0.5f * out[c] / half_depth;
    }
    m[3][2] = 0.5f;
    m[3][3] = 1.0f;
}

static void frame_of_direction(const float out[3], float right[3], float up[3])
{
    vec3 world_up = {0.0f, 1.0f, 0.0f};
    if (fabsf(out[1]) > 0.99f) glm_vec3_copy((vec3){0.0f, 0.0f, -1.0f}, world_up);
    glm_vec3_crossn(world_up, (float *)out, right);
    glm_vec3_cross((float *)out, right, up);
}

void prom_baker_take_views(prom_baker *baker, float radius, prom_views *views)
{
    prom_target_clear(baker->target, nothing);
    for (uint32_t dir = 0; dir < PROM_DIRS; dir++) {
        float out[3], right[3], up[3];
        prom_direction_of_bin(dir, out);
        frame_of_direction(out, right, up);
        // The viewport counts from the bottom, the read-back from the top.
        prom_pass pass = {
            .x = dir % PROM_ATLAS_COLUMNS * PROM_VIEW_PX,
            .y = PROM_ATLAS_HEIGHT - (dir / PROM_ATLAS_COLUMNS + 1) * PROM_VIEW_PX,
            .width = PROM_VIEW_PX,
            .height = PROM_VIEW_PX,
            .output = PROM_OUTPUT_LIT,
        };
        orthographic(right, up, out, radius, radius, 2.0f * radius, pass.projection);
        prom_draw_list_submit(baker->list, baker->target, &pass);
    }
    prom_target_read_rgba(baker->target, 0, 0, PROM_ATLAS_WIDTH, PROM_ATLAS_HEIGHT,
                          views->rgba[0]);
    if (views->ids)
        prom_target_read_ids(baker->target, 0, 0, PROM_ATLAS_WIDTH, PROM_ATLAS_HEIGHT,
                             views->ids);
}

void prom_baker_take_faces(prom_baker *baker, const float half[3], prom_output output,
                           uint32_t size_px, uint8_t *rgba)
{
    prom_target_clear(baker->target, nothing);
    for (int face = 0; face < 6; face++) {
        float right[3], up[3], out[3];
        prom_box_face_axes(face, right, up, out);
        float extent[3];
        const float *axes[3] = {right, up, out};
        for (int a = 0; a < 3; a++)
            extent[a] = fabsf(axes[a][0]) * half[0] + fabsf(axes[a][1]) * half[1] +
                        fabsf(axes[a][2]) * half[2];
        prom_pass pass = {
            .x = (uint32_t)face * PROM_VIEW_PX,
            .y = 0,
            .width = size_px,
            .height = size_px,
            .output = output,
        };
        orthographic(right, up, out, extent[0], extent[1], extent[2] * 1.1f, pass.projection);
        prom_draw_list_submit(baker->list, baker->target, &pass);
    }
    for (uint32_t face = 0; face < 6; face++)
        prom_target_read_rgba(baker->target, face * PROM_VIEW_PX, 0, size_px, size_px,
                              rgba + (size_t)face * size_px * size_px * 4);
}

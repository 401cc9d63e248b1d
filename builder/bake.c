#include "builder/bake.h"

#include "builder/orthographic.h"
#include "metaobj/base/alloc.h"

// One picture holds all views: the large ones in rows below the others.
#define COLUMNS 12
#define ROWS ((PROM_DIRS + COLUMNS - 1) / COLUMNS)
#define LARGE_COLUMNS (COLUMNS * PROM_VIEW_PX / PROM_VIEW_LARGE_PX)
#define LARGE_ROWS ((PROM_DIRS_LARGE + LARGE_COLUMNS - 1) / LARGE_COLUMNS)
#define WIDTH (COLUMNS * PROM_VIEW_PX)
#define SMALL_HEIGHT (ROWS * PROM_VIEW_PX)
#define HEIGHT (SMALL_HEIGHT + LARGE_ROWS * PROM_VIEW_LARGE_PX)
_Static_assert(COLUMNS >= 6, "the six faces stand in a row");
_Static_assert(PROM_PATCHES_PX <= WIDTH && PROM_PATCHES_PX <= HEIGHT, "patches have room");

struct prom_baker {
    prom_target *target;
    prom_draw_list *list;
    prom_rgba *pixels; // read back
    uint32_t *ids;
    bool large; // drawn too
};

static const uint8_t nothing[4] = {0, 0, 0, 0};

prom_baker *prom_baker_create(prom_renderer *renderer, prom_error *error)
{
    prom_baker *baker = prom_calloc(1, sizeof *baker);
    baker->target = prom_target_create(WIDTH, HEIGHT, true, error);
    if (!baker->target) {
        prom_baker_destroy(baker);
        return NULL;
    }
    baker->list = prom_draw_list_create(renderer);
    baker->pixels = prom_alloc((size_t)WIDTH * HEIGHT, sizeof *baker->pixels);
    baker->ids = prom_alloc((size_t)WIDTH * SMALL_HEIGHT, sizeof *baker->ids);
    return baker;
}

void prom_baker_destroy(prom_baker *baker)
{
    if (!baker) return;
    prom_target_destroy(baker->target);
    prom_draw_list_destroy(baker->list);
    prom_free(baker->pixels);
    prom_free(baker->ids);
    prom_free(baker);
}

void prom_baker_set_subject(prom_baker *baker, const prom_draw_item *items, size_t count)
{
    prom_draw_list_reset(baker->list);
    for (size_t i = 0; i < count; i++) prom_draw_list_add(baker->list, &items[i]);
    prom_draw_list_prepare(baker->list);
}

// Where a view begins, from the top left.
static void place_of_view(uint32_t view, uint32_t *x, uint32_t *y)
{
    if (view < PROM_DIRS) {
        *x = view % COLUMNS * PROM_VIEW_PX;
        *y = view / COLUMNS * PROM_VIEW_PX;
    } else {
        *x = (view - PROM_DIRS) % LARGE_COLUMNS * PROM_VIEW_LARGE_PX;
        *y = SMALL_HEIGHT + (view - PROM_DIRS) / LARGE_COLUMNS * PROM_VIEW_LARGE_PX;
    }
}

static void draw_view(prom_baker *baker, uint32_t view, float radius)
{
    const uint32_t side = prom_view_px(view);
    prom_pass pass = {.width = side, .height = side, .output = PROM_OUTPUT_LIT};
    float out[3], right[3], up[3];
    prom_direction_of_bin(view < PROM_DIRS ? view : view - PROM_DIRS, out);
    prom_frame_of_direction(out, right, up);
    prom_orthographic(right, up, out, radius, radius, 2.0f * radius, pass.projection);
    place_of_view(view, &pass.x, &pass.y);
    pass.y = HEIGHT - pass.y - side; // the viewport counts from the bottom
    prom_draw_list_submit(baker->list, baker->target, &pass);
}

void prom_baker_draw_views(prom_baker *baker, float radius)
{
    prom_target_clear(baker->target, nothing);
    baker->large = false;
    for (uint32_t v = 0; v < PROM_DIRS; v++) draw_view(baker, v, radius);
}

void prom_baker_draw_large_views(prom_baker *baker, float radius)
{
    baker->large = true;
    for (uint32_t v = PROM_DIRS; v < PROM_VIEWS; v++) draw_view(baker, v, radius);
}

void prom_baker_read_views(prom_baker *baker, prom_views *views)
{
    const uint32_t height = baker->large ? HEIGHT : SMALL_HEIGHT;
    prom_target_read_rgba(baker->target, 0, HEIGHT - height, WIDTH, height, baker->pixels[0]);
    prom_views_clear(views);
    for (uint32_t v = 0; v < (baker->large ? PROM_VIEWS : PROM_DIRS); v++) {
        uint32_t x, y;
        place_of_view(v, &x, &y);
        prom_views_add(views, (const prom_rgba *)baker->pixels + (size_t)y * WIDTH + x, WIDTH);
    }
}

void prom_baker_read_shares(prom_baker *baker, uint32_t item_count,
                            uint16_t (*shares)[PROM_DIRS])
{
    prom_target_read_ids(baker->target, 0, HEIGHT - SMALL_HEIGHT, WIDTH, SMALL_HEIGHT,
                         baker->ids);
    for (uint32_t dir = 0; dir < PROM_DIRS; dir++) {
        uint32_t x, y;
        place_of_view(dir, &x, &y);
        prom_view_shares(baker->ids + (size_t)y * WIDTH + x, WIDTH, dir, item_count, shares);
    }
}

void prom_baker_take_views(prom_baker *baker, float radius, bool large, prom_views *views)
{
    prom_baker_draw_views(baker, radius);
    if (large) prom_baker_draw_large_views(baker, radius);
    prom_baker_read_views(baker, views);
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
        prom_orthographic(right, up, out, extent[0], extent[1], extent[2] * 1.1f,
                          pass.projection);
        prom_draw_list_submit(baker->list, baker->target, &pass);
    }
    for (uint32_t face = 0; face < 6; face++)
        prom_target_read_rgba(baker->target, face * PROM_VIEW_PX, 0, size_px, size_px,
                              rgba + (size_t)face * size_px * size_px * 4);
}

void prom_baker_begin_patches(prom_baker *baker)
{
    prom_target_clear(baker->target, nothing);
}

void prom_baker_draw_patch(prom_baker *baker, const prom_patch *patch)
{
    prom_pass pass = {.x = patch->x,
                      .y = HEIGHT - patch->y - patch->height,
                      .width = patch->width,
                      .height = patch->height,
                      .output = PROM_OUTPUT_LIT};
    const float *axes[3] = {patch->right, patch->up, patch->out};
    float half_depth = (patch->front - patch->back) / 2, center[3];
    glm_vec3_copy((float *)patch->center, center);
    glm_vec3_muladds((float *)patch->out, (patch->front + patch->back) / 2, center);
    mat4 *m = &pass.projection;
    prom_orthographic(patch->right, patch->up, patch->out, patch->half_width,
                      patch->half_height, half_depth, *m);
    const float half[3] = {patch->half_width, patch->half_height, 2 * half_depth};
    for (int r = 0; r < 3; r++) (*m)[3][r] -= glm_vec3_dot((float *)axes[r], center) / half[r];
    prom_draw_list_submit(baker->list, baker->target, &pass);
}

void prom_baker_read_patches(prom_baker *baker, uint32_t size_px, uint8_t *rgba)
{
    prom_target_read_rgba(baker->target, 0, HEIGHT - size_px, size_px, size_px, rgba);
}

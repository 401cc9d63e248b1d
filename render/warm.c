// Drivers finish a shader at its first use with a given state, which takes milliseconds: so
// each combination is drawn once, small, before the first frame.
#include "render/renderer_private.h"

#define SIZE 8u

static const prom_material materials[] = {
    {.base_color = {1, 1, 1, 1}, .texture = 0},
    {.base_color = {1, 1, 1, 1},
     .texture = 0,
     .alpha_mode = PROM_ALPHA_MASK,
     .alpha_cutoff = 0.5f},
    {.base_color = {1, 1, 1, 0.5f}, .texture = 0, .alpha_mode = PROM_ALPHA_BLEND},
};
#define MATERIALS (sizeof materials / sizeof *materials)

// One triangle per material, and one without.
static void add_mesh(prom_renderer *r)
{
    static const float corners[3][3] = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}};
    prom_mesh mesh;
    prom_mesh_init(&mesh, 3, 3 * (MATERIALS + 1), MATERIALS + 1);
    for (int i = 0; i < 3; i++)
        mesh.vertices[i] = (prom_vertex){
            .position = {corners[i][0], corners[i][1], corners[i][2]},
            .normal = {0, 0, 127},
            .color = {255, 255, 255, 255},
        };
    for (uint32_t i = 0; i < mesh.index_count; i++) mesh.indices[i] = i % 3;
    for (uint32_t i = 0; i <= MATERIALS; i++)
        mesh.submeshes[i] = (prom_submesh){3 * i, 3, i < MATERIALS ? i : PROM_NONE};
    prom_renderer_add_mesh(r, &mesh);
    prom_mesh_finish(&mesh);
}

static bool add_textures(prom_renderer *r)
{
    bool ok = true;
    for (prom_texture_kind kind = 0; kind < PROM_TEXTURE_KIND_COUNT; kind++) {
        prom_texture texture;
        prom_texture_init(&texture, kind, SIZE, SIZE);
        memset(texture.pixels, 255, prom_texture_bytes(&texture));
        ok = prom_renderer_add_texture(r, &texture) != PROM_NONE && ok;
        prom_texture_finish(&texture);
    }
    return ok;
}

static void fill_list(prom_draw_list *list)
{
    prom_draw_item item = {
        .texture = PROM_NONE, .basis = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .depth = 1};
    prom_draw_list_add(list, &item);
    item.background = true;
    prom_draw_list_add(list, &item);
    item.background = false;
    item.texture = PROM_TEXTURE_IMPOSTOR_LIT;
    item.flags = PROM_REP_UNLIT;
    prom_draw_list_add(list, &item);
    item.texture = PROM_TEXTURE_IMPOSTOR_ALBEDO;
    item.flags = 0;
    prom_draw_list_add(list, &item);
    prom_draw_list_prepare(list);
}

static prom_status draw_all(prom_draw_list *list, bool with_ids, prom_error *error)
{
    static const uint8_t black[4] = {0};
    prom_target *target = prom_target_create(SIZE, SIZE, with_ids, error);
    if (!target) return PROM_ERR_UNSUPPORTED;
    prom_pass pass = {.projection = GLM_MAT4_IDENTITY_INIT, .width = SIZE, .height = SIZE};
    pass.projection[3][2] = 0.5f;
    for (pass.output = 0; pass.output < PROM_OUTPUT_COUNT; pass.output++) {
        // Everything must pass the depth test to be shaded: each output starts anew.
        prom_target_clear(target, black);
        prom_draw_list_submit(list, target, &pass);
    }
    glFinish();
    prom_target_destroy(target);
    return PROM_OK;
}

prom_status renderer_warm(prom_renderer *r, prom_error *error)
{
    add_mesh(r);
    if (!add_textures(r)) return renderer_out_of_memory(error);
    prom_renderer_set_materials(r, materials, MATERIALS);
    prom_draw_list *list = prom_draw_list_create(r);
    fill_list(list);
    prom_status status = draw_all(list, false, error);
    if (!status) status = draw_all(list, true, error);
    prom_draw_list_destroy(list);
    prom_renderer_truncate(r, 0, 0);
    prom_renderer_set_materials(r, NULL, 0);
    r->stats = (prom_draw_stats){0};
    return status;
}

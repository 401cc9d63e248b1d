// LINK: prom_render prom_metaobj
// What pixels show: colours, light, pictures of impostors, normals, false colours, and frames.
#include "tests/render_fixture.h"

#define SIZE 32u
#define PICTURE 16u

static const uint8_t white[4] = {255, 255, 255, 255};
static uint8_t rgba[4 * SIZE * SIZE];

static const uint8_t *middle(void)
{
    return pixel(rgba, SIZE, SIZE / 2, SIZE / 2);
}

static void show(prom_target *target, const prom_draw_item *item, const prom_pass *pass)
{
    prom_draw_list_add(fix.list, item);
    draw(target, pass);
    prom_target_read_rgba(target, 0, 0, SIZE, SIZE, rgba);
}

static void albedo_is_the_colour_given(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    prom_pass pass = pass_parallel(SIZE);
    pass.output = PROM_OUTPUT_ALBEDO;
    for (int v = 0; v < 256; v++) {
        const uint8_t color[4] = {(uint8_t)v, (uint8_t)(255 - v), (uint8_t)(v * 7), 255};
        prom_draw_item item = item_at(add_square(color, PROM_NONE), 0, 0, 0, 1);
        show(target, &item, &pass);
        assert_near(middle(), color, 1);
    }
    // Base colours are linear.
    prom_material material = {.base_color = {0.5f, 0.1f, 0.02f, 0}, .texture = PROM_NONE};
    prom_renderer_set_materials(fix.renderer, &material, 1);
    prom_draw_item item = item_at(add_square(white, 0), 0, 0, 0, 1);
    show(target, &item, &pass);
    const uint8_t encoded[4] = {prom_linear_to_srgb8(0.5f), prom_linear_to_srgb8(0.1f),
                                prom_linear_to_srgb8(0.02f), 255};
    assert_near(middle(), encoded, 1);
    prom_target_destroy(target);
}

// A texture whose texel (x, y) tells its place.
static uint32_t add_map(void)
{
    prom_texture texture;
    prom_texture_init(&texture, PROM_TEXTURE_COLOR, SIZE, SIZE);
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) {
            const uint8_t texel[4] = {(uint8_t)(8 * x), (uint8_t)(8 * y), 99,
                                      (uint8_t)(x < SIZE / 2 ? 255 : 100)};
            memcpy(texture.pixels + 4 * (y * SIZE + x), texel, 4);
        }
    prom_texture_make_mips(&texture, 0);
    uint32_t id = prom_renderer_add_texture(fix.renderer, &texture);
    prom_texture_finish(&texture);
    return id;
}

static void textures_stand_upright(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    for (int i = 0; i < 3; i++)
        add_map(); // the last one is neither first nor alone in its pool
    const prom_material materials[2] = {{.base_color = {1, 1, 1, 1}, .texture = 2},
                                        {.base_color = {1, 1, 1, 1},
                                         .texture = 2,
                                         .alpha_mode = PROM_ALPHA_MASK,
                                         .alpha_cutoff = 0.5f}};
    prom_renderer_set_materials(fix.renderer, materials, 2);
    prom_pass pass = pass_parallel(SIZE);
    pass.output = PROM_OUTPUT_ALBEDO;
    for (uint32_t material = 0; material < 2; material++) {
        prom_draw_item item = item_at(add_square(white, material), 0, 0, 0, 1);
        show(target, &item, &pass);
        for (uint32_t y = 0; y < SIZE; y++)
            for (uint32_t x = 0; x < SIZE; x++) {
                const uint8_t texel[4] = {(uint8_t)(8 * x), (uint8_t)(8 * y), 99, 255};
                bool cut = material == 1 && x >= SIZE / 2;
                assert_near(pixel(rgba, SIZE, x, y), cut ? clear_none : texel, 1);
            }
    }
    prom_target_destroy(target);
}

static void light_falls_from_above(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    const prom_material both = {
        .base_color = {1, 1, 1, 1}, .texture = PROM_NONE, .double_sided = 1};
    prom_renderer_set_materials(fix.renderer, &both, 1);
    uint32_t square = add_square(white, 0);
    // A square that faces each of the six directions, seen from there.
    uint8_t lit[6][4];
    for (int face = 0; face < 6; face++) {
        float right[3], up[3], out[3];
        prom_box_face_axes(face, right, up, out);
        prom_pass pass = pass_from(right, up, out, SIZE);
        prom_draw_item item = item_at(square, 0, 0, 0, 1);
        for (int i = 0; i < 3; i++) {
            item.basis[i] = right[i];
            item.basis[3 + i] = up[i];
            item.basis[6 + i] = out[i];
        }
        show(target, &item, &pass);
        memcpy(lit[face], middle(), 4);
        for (int i = 0; i < 3; i++) assert_in_range(lit[face][i], 60, 254);
        // Seen from behind, a double-sided surface takes the light of the side that is seen.
        for (int i = 0; i < 3; i++) item.basis[i] *= -1, item.basis[6 + i] *= -1;
        show(target, &item, &pass);
        assert_near(middle(), lit[face], 1);
        item.flags = PROM_REP_UNLIT;
        show(target, &item, &pass);
        assert_near(middle(), white, 0);
    }
    assert_true(lit[2][1] > lit[0][1] && lit[2][1] > lit[1][1] && lit[2][1] > lit[3][1]);
    assert_true(lit[3][0] >= lit[3][2]); // the ground's light is brownish
    prom_target_destroy(target);
}

// ---- impostors

static const uint8_t face_colors[6][4] = {{250, 10, 10, 255},  {10, 250, 10, 255},
                                          {10, 10, 250, 255},  {250, 250, 10, 255},
                                          {250, 10, 250, 255}, {10, 250, 250, 255}};

// Pictures in the colour of their face; the top left quarter is black, the bottom right one is
// not there. Normals lean by the same amount to the right, up and out of each face.
static uint32_t add_pictures(prom_texture_kind kind)
{
    prom_texture texture;
    prom_texture_init(&texture, kind, PICTURE, PICTURE);
    for (uint32_t layer = 0; layer < texture.layers; layer++)
        for (uint32_t i = 0; i < PICTURE * PICTURE; i++) {
            uint32_t x = i % PICTURE, y = i / PICTURE;
            uint8_t *texel = texture.pixels + prom_texture_offset(&texture, 0, layer) + 4 * i;
            memcpy(texel, face_colors[layer % 6], 4);
            if (x < PICTURE / 2 && y < PICTURE / 2) memset(texel, 0, 3);
            if (x >= PICTURE / 2 && y >= PICTURE / 2) texel[3] = 0;
            if (layer < 6) continue;
            float right[3], up[3], out[3];
            prom_box_face_axes((int)layer - 6, right, up, out);
            for (int k = 0; k < 3; k++)
                texel[k] = (uint8_t)lroundf(
                    (0.5f + 0.5f * (right[k] + up[k] + out[k]) / sqrtf(3)) * 255);
        }
    prom_texture_make_mips(&texture, 0.5f);
    uint32_t id = prom_renderer_add_texture(fix.renderer, &texture);
    prom_texture_finish(&texture);
    return id;
}

static uint32_t add_box(const uint8_t colors[6][4])
{
    static const float center[3] = {0, 0, 0}, half[3] = {1, 1, 1};
    prom_mesh box;
    prom_mesh_init_box(&box, center, half, colors);
    uint32_t id = prom_renderer_add_mesh(fix.renderer, &box);
    prom_mesh_finish(&box);
    return id;
}

static void assert_quarters(const uint8_t *top_right_color)
{
    static const uint8_t black[4] = {0, 0, 0, 255};
    assert_near(pixel(rgba, SIZE, SIZE / 4, SIZE / 4), black, 1);
    assert_near(pixel(rgba, SIZE, 3 * SIZE / 4, SIZE / 4), top_right_color, 1);
    assert_near(pixel(rgba, SIZE, SIZE / 4, 3 * SIZE / 4), top_right_color, 1);
    assert_near(pixel(rgba, SIZE, 3 * SIZE / 4, 3 * SIZE / 4), clear_none, 0);
}

static void boxes_show_each_face_upright(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    uint32_t textures[2] = {add_pictures(PROM_TEXTURE_IMPOSTOR_LIT),
                            add_pictures(PROM_TEXTURE_IMPOSTOR_ALBEDO)};
    add_pictures(PROM_TEXTURE_IMPOSTOR_ALBEDO);
    prom_draw_item item = item_at(add_box(NULL), 0, 0, 0, 1);
    prom_draw_item average = item_at(add_box(face_colors), 0, 0, 0, 1);
    for (int face = 0; face < 6; face++)
        for (int kind = 0; kind < 2; kind++) {
            float right[3], up[3], out[3];
            prom_box_face_axes(face, right, up, out);
            prom_pass pass = pass_from(right, up, out, SIZE);
            item.texture = textures[kind];
            item.flags = PROM_REP_UNLIT;
            show(target, &item, &pass);
            assert_quarters(face_colors[face]);
            pass.output = PROM_OUTPUT_ALBEDO;
            item.flags = 0;
            show(target, &item, &pass);
            assert_quarters(face_colors[face]);
            show(target, &average, &pass);
            assert_near(middle(), face_colors[face], 1);
        }
    prom_target_destroy(target);
}

// The normal of a pixel, from a picture of normals.
static void assert_normal(const uint8_t *got, const float want[3], int tolerance)
{
    uint8_t encoded[4] = {0, 0, 0, 255};
    for (int i = 0; i < 3; i++) encoded[i] = (uint8_t)lroundf((0.5f + 0.5f * want[i]) * 255);
    assert_near(got, encoded, tolerance);
}

static void normals_turn_with_the_item(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    const prom_material both = {
        .base_color = {1, 1, 1, 1}, .texture = PROM_NONE, .double_sided = 1};
    prom_renderer_set_materials(fix.renderer, &both, 1);
    uint32_t square = add_square(white, 0), box = add_box(NULL);
    uint32_t pictures = add_pictures(PROM_TEXTURE_IMPOSTOR_ALBEDO);
    prom_pass pass = pass_parallel(SIZE);
    pass.output = PROM_OUTPUT_NORMAL;
    for (float angle = -1; angle < 1.1f; angle += 0.5f) {
        float c = cosf(angle), s = sinf(angle);
        // Turned about y, stretched in its own x: normals lean the other way than tangents.
        const float basis[9] = {2 * c, 0, -2 * s, 0, 1, 0, s, 0, c};
        prom_draw_item item = item_at(square, 0, 0, 0, 1);
        memcpy(item.basis, basis, sizeof basis);
        show(target, &item, &pass);
        const float facing[3] = {s, 0, c};
        assert_normal(middle(), facing, 1);
    }
    // A quarter turn about y brings the face that looked to -x before the viewer.
    const float quarter[9] = {0, 0, -1, 0, 1, 0, 1, 0, 0};
    prom_draw_item item = item_at(box, 0, 0, 0, 1);
    memcpy(item.basis, quarter, sizeof quarter);
    item.texture = pictures;
    show(target, &item, &pass);
    const float leaning[3] = {1 / sqrtf(3), 1 / sqrtf(3), 1 / sqrtf(3)};
    assert_normal(pixel(rgba, SIZE, SIZE / 4, SIZE / 4), leaning, 2);
    // Mirrored in x as well: the lean to the right becomes one to the left.
    item.basis[6] = -1;
    show(target, &item, &pass);
    const float mirrored[3] = {-1 / sqrtf(3), 1 / sqrtf(3), 1 / sqrtf(3)};
    assert_normal(pixel(rgba, SIZE, 3 * SIZE / 4, SIZE / 4), mirrored, 2);
    prom_target_destroy(target);
}

static void lit_pictures_match_lit_geometry(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    // A white picture of a flat face is lit as the flat face itself.
    prom_texture texture;
    prom_texture_init(&texture, PROM_TEXTURE_IMPOSTOR_ALBEDO, PICTURE, PICTURE);
    memset(texture.pixels, 255, prom_texture_bytes(&texture));
    for (uint32_t layer = 6; layer < 12; layer++) {
        float right[3], up[3], out[3];
        prom_box_face_axes((int)layer - 6, right, up, out);
        for (uint32_t i = 0; i < PICTURE * PICTURE; i++)
            for (int k = 0; k < 3; k++)
                texture.pixels[prom_texture_offset(&texture, 0, layer) + 4 * i + (size_t)k] =
                    (uint8_t)lroundf((0.5f + 0.5f * out[k]) * 255);
    }
    prom_texture_make_mips(&texture, 0.5f);
    uint32_t pictures = prom_renderer_add_texture(fix.renderer, &texture);
    prom_texture_finish(&texture);
    uint32_t box = add_box(NULL);
    for (float angle = -3; angle < 3; angle += 0.37f) {
        float c = cosf(angle), s = sinf(angle);
        prom_draw_item item = item_at(box, 0, 0, 0, 1);
        const float basis[9] = {c, 0, -s, 0, 1, 0, s, 0, c};
        memcpy(item.basis, basis, sizeof basis);
        prom_pass pass = pass_parallel(SIZE);
        show(target, &item, &pass);
        uint8_t geometry[4];
        memcpy(geometry, middle(), 4);
        item.texture = pictures;
        show(target, &item, &pass);
        assert_near(middle(), geometry, 2);
    }
    prom_target_destroy(target);
}

static void tints_are_false_colours(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    prom_pass pass = pass_parallel(SIZE);
    pass.output = PROM_OUTPUT_TINT;
    prom_draw_item items[2] = {item_at(add_square(white, PROM_NONE), 0, 0, 0, 1),
                               item_at(add_box(NULL), 0, 0, 0, 1)};
    items[1].texture = add_pictures(PROM_TEXTURE_IMPOSTOR_ALBEDO);
    for (int i = 0; i < 2; i++) {
        memcpy(items[i].tint, (const uint8_t[4]){255, 0, 128, 255}, 4);
        show(target, &items[i], &pass);
        const uint8_t *got = pixel(rgba, SIZE, 3 * SIZE / 4, SIZE / 4);
        assert_true(got[0] > 120 && got[1] == 0 && got[2] > 40 && got[2] < got[0]);
    }
    prom_target_destroy(target);
}

// ---- frames

// A root over one leaf, and one node in the background; both are squares, far from the origin.
static void make_model(prom_model *model, uint32_t mesh)
{
    *model =
        (prom_model){.node_count = 3, .tree_count = 2, .prototype_count = 2, .rep_count = 2};
    model->prototype = prom_arena_alloc(&model->arena, 3, sizeof *model->prototype);
    model->placement = prom_arena_alloc(&model->arena, 3, sizeof *model->placement);
    model->center = prom_arena_alloc(&model->arena, 3, sizeof *model->center);
    model->prototypes = prom_arena_alloc(&model->arena, 2, sizeof *model->prototypes);
    model->reps = prom_arena_alloc(&model->arena, 2, sizeof *model->reps);
    for (uint32_t i = 0; i < 2; i++) {
        model->prototypes[i] = (prom_prototype){.first_rep = i, .rep_count = 1};
        model->reps[i] = (prom_representation){.mesh = mesh, .texture = PROM_NONE};
    }
    model->prototypes[1].flags = PROM_PROTO_BACKDROP;
    for (int i = 0; i < 3; i++) {
        model->placement[i] = prom_placement_identity;
        model->placement[i].origin[0] = 3e7;
        model->placement[i].origin[2] = -1e8;
    }
    model->placement[2].origin[2] = -1e8 - 1;
    model->placement[2].basis[0] = model->placement[2].basis[4] = 100;
    model->prototype[2] = 1;
}

static void frames_are_precise_far_from_the_origin(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, true);
    prom_model model;
    make_model(&model, add_square(white, PROM_NONE));
    prom_cut_entry entry = {.node = 1, .rep = 0, .depth = 2};
    prom_cut cut = {.entries = {.data = &entry, .count = 1, .capacity = 1}};
    // Two units in front of the leaf, which fills the left half of the picture up to its edge.
    prom_camera camera = {.eye = {3e7 + 1, 0, -1e8 + 2},
                          .orientation = {0, 0, 0, 1},
                          .fov_y = 0.7f,
                          .z_near = 0.1f,
                          .width = SIZE,
                          .height = SIZE};
    uint32_t id[2];
    prom_frame_options options = {.output = PROM_OUTPUT_ALBEDO};
    for (int background = 0; background < 2; background++) {
        options.no_background = !background;
        prom_renderer_draw_frame(fix.renderer, fix.list, target, &model, &cut, &camera,
                                 &options);
        prom_target_read_rgba(target, 0, 0, SIZE, SIZE, rgba);
        assert_near(pixel(rgba, SIZE, SIZE / 2 - 1, SIZE / 2), white, 0);
        const uint8_t backdrop[4] = {255, 255, 255, 0};
        assert_near(middle(), background ? backdrop : prom_sky_color, 0);
        prom_target_read_ids(target, SIZE / 2 - 1, SIZE / 2, 2, 1, id);
        assert_int_equal(id[0], 1);
        assert_int_equal(id[1], PROM_NONE);
    }
    prom_arena_finish(&model.arena);
    prom_target_destroy(target);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(albedo_is_the_colour_given),
        cmocka_unit_test(textures_stand_upright),
        cmocka_unit_test(light_falls_from_above),
        cmocka_unit_test(boxes_show_each_face_upright),
        cmocka_unit_test(normals_turn_with_the_item),
        cmocka_unit_test(lit_pictures_match_lit_geometry),
        cmocka_unit_test(tints_are_false_colours),
        cmocka_unit_test(frames_are_precise_far_from_the_origin),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}

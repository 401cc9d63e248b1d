// The two box impostors: six colours, or six pictures, from captures of the six sides.
#include "builder/build.h"

#define CAPTURE_PX (2 * PROM_FACE_PX) // taken at twice the stored size and averaged
_Static_assert(CAPTURE_PX <= PROM_VIEW_PX, "a capture must fit a view of the baker");

// Alpha-weighted linear means of the sides; an empty side gets the mean of all.
static void average_faces(const uint8_t *rgba, uint8_t colors[6][4])
{
    double total[4] = {0};
    double sums[6][4] = {{0}};
    for (int f = 0; f < 6; f++) {
        const uint8_t *p = rgba + (size_t)f * CAPTURE_PX * CAPTURE_PX * 4;
        for (int i = 0; i < CAPTURE_PX * CAPTURE_PX; i++, p += 4) {
            double a = p[3] / 255.0;
            for (int c = 0; c < 3; c++) sums[f][c] += a * prom_srgb8_to_linear(p[c]);
            sums[f][3] += a;
        }
        for (int c = 0; c < 4; c++) total[c] += sums[f][c];
    }
    for (int f = 0; f < 6; f++) {
        const double *s = sums[f][3] > 0 ? sums[f] : total;
        for (int c = 0; c < 3; c++)
            colors[f][c] = s[3] > 0 ? prom_linear_to_srgb8((float)(s[c] / s[3])) : 128;
        colors[f][3] = 255;
    }
}

// Six captures (and six of normals) as a texture of half their size with mips.
static void make_texture(prom_texture_kind kind, const uint8_t *color, const uint8_t *normals,
                         prom_texture *out)
{
    const size_t bytes = (size_t)CAPTURE_PX * CAPTURE_PX * 4 * 6;
    prom_texture big;
    prom_texture_init(&big, kind, CAPTURE_PX, CAPTURE_PX);
    memcpy(big.pixels, color, bytes);
    if (normals) memcpy(big.pixels + bytes, normals, bytes);
    prom_texture_dilate(&big, 8);
    prom_texture_make_mips(&big, 0.5f);
    prom_texture_init(out, kind, PROM_FACE_PX, PROM_FACE_PX);
    memcpy(out->pixels, big.pixels + prom_texture_offset(&big, 1, 0), prom_texture_bytes(out));
    prom_texture_finish(&big);
}

static prom_status add_box(prom_build_state *b, uint32_t p, const prom_mesh *mesh,
                           uint32_t kind, uint32_t texture, uint32_t flags, float radius,
                           prom_error *error)
{
    prom_representation rep = {
        .kind = kind, .texture = texture, .flags = flags, .error = radius};
    return prom_build_add_rep(b, p, mesh, &rep, PROM_ADMIT_MEASURED, NULL, error);
}

prom_status prom_build_add_boxes(prom_build_state *b, uint32_t p, const float center[3],
                                 const float half[3], float radius, bool lit, bool textured,
                                 prom_error *error)
{
    const size_t bytes = (size_t)CAPTURE_PX * CAPTURE_PX * 4 * 6;
    uint8_t *color = prom_alloc(bytes, 1), *normals = NULL;
    float thick[3]; // a flat object's box keeps a little depth
    for (int a = 0; a < 3; a++) thick[a] = fmaxf(half[a], 1e-3f * radius);
    prom_baker_take_faces(b->baker, thick, lit ? PROM_OUTPUT_LIT : PROM_OUTPUT_ALBEDO,
                          CAPTURE_PX, color);
    if (textured && !lit) {
        normals = prom_alloc(bytes, 1);
        prom_baker_take_faces(b->baker, thick, PROM_OUTPUT_NORMAL, CAPTURE_PX, normals);
    }
    uint32_t flags = lit ? PROM_REP_UNLIT : 0;
    prom_status status = PROM_OK;
    prom_mesh mesh;
    if (textured) {
        prom_texture texture;
        uint32_t texture_id;
        make_texture(lit ? PROM_TEXTURE_IMPOSTOR_LIT : PROM_TEXTURE_IMPOSTOR_ALBEDO, color,
                     normals, &texture);
        status = prom_build_add_texture(b, &texture, &texture_id, error);
        prom_texture_finish(&texture);
        if (!status) {
            prom_mesh_init_box(&mesh, center, thick, NULL);
            status =
                add_box(b, p, &mesh, PROM_REP_TEXTURED_BOX, texture_id, flags, radius, error);
            prom_mesh_finish(&mesh);
        }
    }
    if (!status) {
        uint8_t colors[6][4];
        average_faces(color, colors);
        prom_mesh_init_box(&mesh, center, thick, colors);
        status = add_box(b, p, &mesh, PROM_REP_AVERAGE_BOX, PROM_NONE, flags, radius, error);
        prom_mesh_finish(&mesh);
    }
    prom_free(color);
    prom_free(normals);
    return status;
}

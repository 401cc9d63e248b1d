// The two box impostors: six colours, or six pictures, from captures of the six sides.
#include "builder/subject.h"

#define CAPTURE_PX (2 * PROM_FACE_PX) // taken at twice the stored size and averaged
_Static_assert(CAPTURE_PX <= PROM_VIEW_PX, "a capture must fit a view of the baker");
#define CAPTURE_BYTES ((size_t)CAPTURE_PX * CAPTURE_PX * 4 * 6)

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
    prom_texture big;
    prom_texture_init(&big, kind, CAPTURE_PX, CAPTURE_PX);
    memcpy(big.pixels, color, CAPTURE_BYTES);
    if (normals) memcpy(big.pixels + CAPTURE_BYTES, normals, CAPTURE_BYTES);
    prom_texture_dilate(&big, 8);
    prom_texture_make_mips(&big, 0.5f);
    prom_texture_init(out, kind, PROM_FACE_PX, PROM_FACE_PX);
    memcpy(out->pixels, big.pixels + prom_texture_offset(&big, 1, 0), prom_texture_bytes(out));
    prom_texture_finish(&big);
}

static prom_status add_box(prom_subject *s, prom_made *made, uint32_t kind,
                           const uint8_t (*colors)[4], const float half[3], uint32_t flags,
                           prom_error *error)
{
    const prom_prototype *proto = &s->build->prototypes[s->prototype];
    prom_representation rep = {.kind = kind,
                               .texture = PROM_NONE,
                               .flags = flags,
                               .error = proto->radius,
                               .switch_distance = INFINITY};
    uint32_t i = s->count;
    prom_mesh_init_box(&made->mesh, proto->center, half, colors);
    prom_candidate *c = prom_subject_add(s, &made->mesh, &rep, PROM_ADMIT_MEASURED);
    if (!colors) c->picture = &made->picture;
    return prom_subject_take_views(s, i, PROM_NONE, error);
}

prom_status prom_subject_add_boxes(prom_subject *s, bool lit, prom_error *error)
{
    prom_build_state *b = s->build;
    const prom_prototype *proto = &b->prototypes[s->prototype];
    bool textured = b->boxed[s->prototype];
    uint32_t flags = lit ? PROM_REP_UNLIT : 0;
    float thick[3]; // a flat object's box keeps a little depth
    for (int a = 0; a < 3; a++) thick[a] = fmaxf(proto->half[a], 1e-3f * proto->radius);
    uint8_t *color = prom_alloc(CAPTURE_BYTES, 1), *normals = NULL;
    prom_baker_set_subject(b->baker, s->items.data, s->items.count);
    prom_baker_take_faces(b->baker, thick, lit ? PROM_OUTPUT_LIT : PROM_OUTPUT_ALBEDO,
                          CAPTURE_PX, color);
    if (textured && !lit) {
        normals = prom_alloc(CAPTURE_BYTES, 1);
        prom_baker_take_faces(b->baker, thick, PROM_OUTPUT_NORMAL, CAPTURE_PX, normals);
    }
    prom_status status = PROM_OK;
    if (textured) {
        prom_made *made = prom_subject_make(s);
        make_texture(lit ? PROM_TEXTURE_IMPOSTOR_LIT : PROM_TEXTURE_IMPOSTOR_ALBEDO, color,
                     normals, &made->picture);
        status = add_box(s, made, PROM_REP_TEXTURED_BOX, NULL, thick, flags, error);
    }
    if (!status) {
        uint8_t colors[6][4];
        average_faces(color, colors);
        status = add_box(s, prom_subject_make(s), PROM_REP_AVERAGE_BOX,
                         (const uint8_t(*)[4])colors, thick, flags, error);
    }
    prom_free(color);
    prom_free(normals);
    return status;
}

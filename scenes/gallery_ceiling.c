// Ceilings: stucco, coffers, vaults, beams and skylights.
#include "scenes/gallery_parts.h"

#include <math.h>

#define PI 3.14159265f

static prom_paint white(prom_gallery *g)
{
    return prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xffffff, 2.0f);
}

static prom_paint gilt(prom_gallery *g)
{
    return prom_gallery_paint(g, PROM_GALLERY_METAL, 0xe6b95c, 0.5f);
}

// A frame of a moulding on the ceiling, round the rectangle (x0,z0)-(x1,z1): `width` wide and
// `drop` deep.
static void build_frame(prom_solid *s, float x0, float z0, float x1, float z1, float y,
                        float width, float drop)
{
    const float d[3] = {0, 0.6f * drop, drop};
    for (int k = 0; k < 2; k++) {
        float w = width * (float)(2 - k) / 2, low = y - d[k + 1];
        int faces = PROM_FACE_ALL & ~PROM_FACE_TOP;
        prom_solid_box(s, x0 - w, low, z0 - w, x1 + w, y, z0, faces);
        prom_solid_box(s, x0 - w, low, z1, x1 + w, y, z1 + w, faces);
        prom_solid_box(s, x0 - w, low, z0, x0, y, z1, faces);
        prom_solid_box(s, x1, low, z0, x1 + w, y, z1, faces);
    }
}

static void build_rosette(prom_gallery *g, prom_solid *s, float x, float y, float z,
                          float radius)
{
    // Its profile hangs: from the outer edge down to the middle.
    const float profile[][2] = {{0.001f, -0.13f},          {0.16f * radius, -0.11f},
                                {0.22f * radius, -0.05f},  {0.45f * radius, -0.06f},
                                {0.55f * radius, -0.02f},  {0.80f * radius, -0.05f},
                                {0.92f * radius, -0.045f}, {radius, 0}};
    prom_solid_frame old = prom_solid_enter(s, x, y, z, 0);
    prom_solid_lathe(s, profile, 8, prom_gallery_sides(g, 96), true);
    for (int i = 0; i < 12 && g->options.detail > 1; i++) {
        float a = 2 * PI * (float)i / 12;
        prom_gallery_ball(s, 0.66f * radius * cosf(a), -0.03f, 0.66f * radius * sinf(a), 0.06f,
                          0.05f, 0.06f, prom_gallery_sides(g, 32), 0);
    }
    prom_solid_leave(s, old);
}

static void build_flat(prom_gallery *g, const prom_gallery_room *r, prom_solid *s)
{
    float cx = 0.5f * (r->x0 + r->x1), cz = 0.5f * (r->z0 + r->z1);
    prom_solid_use(s, white(g));
    prom_gallery_slab(s, r->x0, r->z0, r->x1, r->z1, r->y1, NULL, 0, false);
    build_frame(s, r->x0 + 0.9f, r->z0 + 0.9f, r->x1 - 0.9f, r->z1 - 0.9f, r->y1, 0.16f, 0.05f);
    build_rosette(g, s, cx, r->y1, cz, 0.75f);
}

// ---- coffers

// A recess in the slab at height y, `depth` deep, with a stepped rim.
static void build_coffer(prom_gallery *g, prom_solid *s, const prom_gallery_hole *h, float y,
                         float depth)
{
    float x0 = h->u0, z0 = h->v0, x1 = h->u1, z1 = h->v1;
    int levels = 1 + (int)g->options.detail / 2;
    for (int k = 0; k < levels; k++) {
        float low = y + depth * (float)k / (float)levels, inset = 0.06f;
        float high = y + depth * (float)(k + 1) / (float)levels;
        // Sides look inwards.
        prom_solid_quad(s, (float[]){x0, low, z0}, (float[]){x1, low, z0},
                        (float[]){x1, high, z0}, (float[]){x0, high, z0});
        prom_solid_quad(s, (float[]){x1, low, z1}, (float[]){x0, low, z1},
                        (float[]){x0, high, z1}, (float[]){x1, high, z1});
        prom_solid_quad(s, (float[]){x0, low, z1}, (float[]){x0, low, z0},
                        (float[]){x0, high, z0}, (float[]){x0, high, z1});
        prom_solid_quad(s, (float[]){x1, low, z0}, (float[]){x1, low, z1},
                        (float[]){x1, high, z1}, (float[]){x1, high, z0});
        if (k + 1 == levels) {
            prom_gallery_slab(s, x0, z0, x1, z1, high, NULL, 0, false);
            return;
        }
        prom_gallery_hole inner = {x0 + inset, z0 + inset, x1 - inset, z1 - inset};
        prom_gallery_slab(s, x0, z0, x1, z1, high, &inner, 1, false);
        x0 = inner.u0, z0 = inner.v0, x1 = inner.u1, z1 = inner.v1;
    }
}

static void build_coffers(prom_gallery *g, const prom_gallery_room *r, prom_solid *s)
{
    prom_gallery_hole holes[64];
    float width = r->x1 - r->x0 - 0.9f, depth = r->z1 - r->z0 - 0.9f;
    int nx = (int)fminf(fmaxf(width / 1.5f, 1), 7), nz = (int)fminf(fmaxf(depth / 1.5f, 1), 7);
    int n = 0;
    for (int j = 0; j < nz; j++)
        for (int i = 0; i < nx; i++) {
            float x = r->x0 + 0.45f + width * ((float)i + 0.5f) / (float)nx;
            float z = r->z0 + 0.45f + depth * ((float)j + 0.5f) / (float)nz;
            float a = 0.5f * width / (float)nx - 0.12f, b = 0.5f * depth / (float)nz - 0.12f;
            holes[n++] = (prom_gallery_hole){x - a, z - b, x + a, z + b};
        }
    prom_paint wood = prom_gallery_paint(g, PROM_GALLERY_WOOD, 0xd9b98a, 1.2f);
    bool timber = r->color % 3 == 0;
    prom_solid_use(s, timber ? wood : white(g));
    prom_gallery_slab(s, r->x0, r->z0, r->x1, r->z1, r->y1, holes, n, false);
    for (int i = 0; i < n; i++) {
        prom_solid_use(s, timber ? wood : white(g));
        build_coffer(g, s, &holes[i], r->y1, 0.28f);
        prom_solid_use(s, gilt(g));
        float x = 0.5f * (holes[i].u0 + holes[i].u1), z = 0.5f * (holes[i].v0 + holes[i].v1);
        prom_gallery_ball(s, x, r->y1 + 0.27f, z, 0.11f, 0.06f, 0.11f,
                          prom_gallery_sides(g, 48), 0);
    }
}

// ---- vaults

typedef struct vault {
    float x0, x1, z0, z1, spring, rise; // along z
} vault;

// Seen from below: u runs against the outside's direction.
static void vault_point(const void *context, float u, float v, float p[3])
{
    const vault *b = context;
    float a = PI * u;
    p[0] = 0.5f * (b->x0 + b->x1) - 0.5f * (b->x1 - b->x0) * cosf(a);
    p[1] = b->spring + b->rise * sinf(a);
    p[2] = b->z0 + (b->z1 - b->z0) * v;
}

// The wall under the vault's end, looking towards +z.
static void build_lunette(prom_solid *s, float length, float y, float rise, int steps)
{
    for (int i = 0; i < steps; i++) {
        float a = PI * (float)i / (float)steps, b = PI * (float)(i + 1) / (float)steps;
        float xa = 0.5f * length * (1 - cosf(a)), xb = 0.5f * length * (1 - cosf(b));
        float ya = y + (i ? rise * sinf(a) : 0), yb = y + (i + 1 < steps ? rise * sinf(b) : 0);
        if (i && i + 1 < steps)
            prom_solid_quad(s, (float[]){xa, y, 0}, (float[]){xb, y, 0}, (float[]){xb, yb, 0},
                            (float[]){xa, ya, 0});
        else if (i)
            prom_solid_flat_triangle(s, (float[]){xa, y, 0}, (float[]){xb, y, 0},
                                     (float[]){xa, ya, 0});
        else
            prom_solid_flat_triangle(s, (float[]){xa, y, 0}, (float[]){xb, y, 0},
                                     (float[]){xb, yb, 0});
    }
}

static void build_vault(prom_gallery *g, const prom_gallery_room *r, prom_solid *s)
{
    int steps = prom_gallery_steps(g, 96);
    float length = r->z1 - r->z0, width = r->x1 - r->x0;
    float rise = fminf(0.5f * width, r->y0 + 5.75f - r->y1);
    vault b = {r->x0, r->x1, r->z0, r->z1, r->y1, rise};
    prom_solid_use(s, white(g));
    prom_gallery_surface(s, vault_point, &b, steps, prom_gallery_steps(g, 16), width / 2,
                         length / 2, 0);
    prom_solid_frame old = prom_solid_enter(s, r->x0, 0, r->z0, 0);
    build_lunette(s, width, r->y1, rise, steps);
    prom_solid_leave(s, old);
    old = prom_solid_enter(s, r->x1, 0, r->z1, PI);
    build_lunette(s, width, r->y1, rise, steps);
    prom_solid_leave(s, old);
    // Ribs.
    int ribs = (int)(length / 2.7f) + 1;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xf2e6cc, 2.0f));
    for (int k = 0; k < ribs; k++) {
        float z = r->z0 + length * ((float)k + 0.5f) / (float)ribs, w = 0.16f, d = 0.10f;
        vault rib = {r->x0 + d, r->x1 - d, z - w, z + w, r->y1, rise - d};
        prom_gallery_surface(s, vault_point, &rib, steps, 1, width, 0.3f, 0);
        for (int i = 0; i < steps; i++) {
            float a[3], c[3], e[3], f[3];
            vault skin = {r->x0, r->x1, z - w, z + w, r->y1, rise};
            for (int side = 0; side < 2; side++) {
                float u0 = (float)(side ? i : i + 1) / (float)steps;
                float u1 = (float)(side ? i + 1 : i) / (float)steps;
                vault_point(&rib, u0, (float)side, a);
                vault_point(&rib, u1, (float)side, c);
                vault_point(&skin, u1, (float)side, e);
                vault_point(&skin, u0, (float)side, f);
                prom_solid_quad(s, a, c, e, f);
            }
        }
    }
}

static void build_beams(prom_gallery *g, const prom_gallery_room *r, prom_solid *s)
{
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_BOARDS, 0xfff4e0, 1.6f));
    prom_gallery_slab(s, r->x0, r->z0, r->x1, r->z1, r->y1, NULL, 0, false);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_WOOD, 0xb48a5c, 1.2f));
    int n = (int)((r->z1 - r->z0) / 0.9f);
    for (int i = 0; i < n; i++) {
        float z = r->z0 + (r->z1 - r->z0) * ((float)i + 0.5f) / (float)n;
        prom_solid_box(s, r->x0, r->y1 - 0.20f, z - 0.08f, r->x1, r->y1, z + 0.08f,
                       PROM_FACE_BOTTOM | PROM_FACE_FRONT | PROM_FACE_BACK);
    }
    for (int i = 1; i < 3; i++) {
        float x = r->x0 + (r->x1 - r->x0) * (float)i / 3;
        prom_solid_box(s, x - 0.14f, r->y1 - 0.42f, r->z0, x + 0.14f, r->y1 - 0.18f, r->z1,
                       PROM_FACE_ALL & ~(PROM_FACE_FRONT | PROM_FACE_BACK));
    }
}

// ---- light from above

void prom_gallery_lantern(prom_gallery *g, prom_solid *s, float x0, float z0, float x1,
                          float z1, float y)
{
    float rise = 0.22f * fminf(x1 - x0, z1 - z0), cx = 0.5f * (x0 + x1), b = 0.035f;
    int n = (int)fmaxf(2, roundf((z1 - z0) / 1.1f));
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL, 0x8d9a98, 1.0f));
    for (int i = 0; i <= n; i++) {
        float z = z0 + (z1 - z0) * (float)i / (float)n;
        for (int side = 0; side < 2; side++) {
            float ends[2][3] = {{side ? x1 : x0, y, z}, {cx, y + rise, z}};
            prom_solid_tube(s, (const float(*)[3])ends, (const float[]){b, b}, 2, 4);
        }
    }
    for (int k = 0; k <= 4; k++) { // purlins and the ridge
        float t = (float)(k < 3 ? k : 4 - k) / 2,
              x = k < 3 ? x0 + (cx - x0) * t : x1 - (x1 - cx) * t;
        float ends[2][3] = {{x, y + rise * t, z0}, {x, y + rise * t, z1}};
        prom_solid_tube(s, (const float(*)[3])ends, (const float[]){b, b}, 2, 4);
    }
    prom_solid_use(s, prom_gallery_glass(g));
    prom_solid_quad(s, (float[]){x0, y, z0}, (float[]){cx, y + rise, z0},
                    (float[]){cx, y + rise, z1}, (float[]){x0, y, z1});
    prom_solid_quad(s, (float[]){cx, y + rise, z0}, (float[]){x1, y, z0}, (float[]){x1, y, z1},
                    (float[]){cx, y + rise, z1});
    prom_solid_flat_triangle(s, (float[]){x0, y, z1}, (float[]){x1, y, z1},
                             (float[]){cx, y + rise, z1});
    prom_solid_flat_triangle(s, (float[]){x1, y, z0}, (float[]){x0, y, z0},
                             (float[]){cx, y + rise, z0});
}

static void build_skylight(prom_gallery *g, const prom_gallery_room *r, prom_solid *s)
{
    float mx = 0.26f * (r->x1 - r->x0), mz = 0.26f * (r->z1 - r->z0);
    if (r->kind == PROM_GALLERY_HALL) mx = mz = 1.7f;
    prom_gallery_hole h = {r->x0 + mx, r->z0 + mz, r->x1 - mx, r->z1 - mz};
    prom_solid_use(s, white(g));
    prom_gallery_slab(s, r->x0, r->z0, r->x1, r->z1, r->y1, &h, 1, false);
    build_frame(s, h.u0, h.v0, h.u1, h.v1, r->y1, 0.22f, 0.08f);
    float y0 = r->y1, y1 = PROM_GALLERY_ROOF + 0.25f;
    prom_solid_quad(s, (float[]){h.u0, y0, h.v0}, (float[]){h.u1, y0, h.v0},
                    (float[]){h.u1, y1, h.v0}, (float[]){h.u0, y1, h.v0});
    prom_solid_quad(s, (float[]){h.u1, y0, h.v1}, (float[]){h.u0, y0, h.v1},
                    (float[]){h.u0, y1, h.v1}, (float[]){h.u1, y1, h.v1});
    prom_solid_quad(s, (float[]){h.u0, y0, h.v1}, (float[]){h.u0, y0, h.v0},
                    (float[]){h.u0, y1, h.v0}, (float[]){h.u0, y1, h.v1});
    prom_solid_quad(s, (float[]){h.u1, y0, h.v0}, (float[]){h.u1, y0, h.v1},
                    (float[]){h.u1, y1, h.v1}, (float[]){h.u1, y1, h.v0});
    prom_gallery_lantern(g, s, h.u0, h.v0, h.u1, h.v1, y1);
}

void prom_gallery_build_ceiling(prom_gallery *g, uint32_t id, uint32_t parent)
{
    const prom_gallery_room *room = &g->plan.rooms.data[id];
    prom_solid s;
    prom_solid_init(&s);
    switch (room->ceiling) {
    case PROM_GALLERY_FLAT:
        build_flat(g, room, &s);
        break;
    case PROM_GALLERY_COFFERS:
        build_coffers(g, room, &s);
        break;
    case PROM_GALLERY_VAULT:
        build_vault(g, room, &s);
        break;
    case PROM_GALLERY_BEAMS:
        build_beams(g, room, &s);
        break;
    case PROM_GALLERY_SKYLIGHT:
        build_skylight(g, room, &s);
        break;
    case PROM_GALLERY_OPEN:
        break;
    }
    prom_gallery_add(g, parent, "ceiling", &s);
}

// Flights of steps, balustrades, and the stair room.
#include "scenes/gallery_parts.h"

#include <math.h>

#define PI 3.14159265f
#define THICKNESS 0.28f // of a flight, below its steps
#define RAIL 0.95f      // height
#define STRING 0.14f    // of what the balusters stand on

// ---- balustrades

static void build_baluster(prom_gallery *g, prom_solid *s, float x, float y, float z, float top)
{
    float h = top - y;
    prom_solid_frame old = prom_solid_enter(s, x, y, z, 0);
    if (g->options.detail == 1) {
        prom_solid_box(s, -0.03f, 0, -0.03f, 0.03f, h, 0.03f, PROM_FACE_SIDES);
    } else {
        const float profile[][2] = {
            {0.050f, 0},         {0.050f, 0.08f * h}, {0.030f, 0.12f * h},
            {0.058f, 0.30f * h}, {0.050f, 0.42f * h}, {0.024f, 0.68f * h},
            {0.042f, 0.84f * h}, {0.028f, 0.90f * h}, {0.050f, h}};
        prom_solid_lathe(s, profile, 9, prom_gallery_sides(g, 32), true);
    }
    prom_solid_leave(s, old);
}

// A beam along the foot, which hides the ends of steps.
static void build_string(prom_solid *s, const float a[3], const float b[3])
{
    float dx = b[0] - a[0], dz = b[2] - a[2], length = hypotf(dx, dz), half = 0.09f;
    prom_solid_frame old = prom_solid_enter(s, a[0], 0, a[2], atan2f(-dz, dx));
    float low0 = a[1] - 0.12f, low1 = b[1] - 0.12f, top0 = a[1] + STRING, top1 = b[1] + STRING;
    prom_solid_quad(s, (float[]){0, low0, half}, (float[]){length, low1, half},
                    (float[]){length, top1, half}, (float[]){0, top0, half});
    prom_solid_quad(s, (float[]){length, low1, -half}, (float[]){0, low0, -half},
                    (float[]){0, top0, -half}, (float[]){length, top1, -half});
    prom_solid_quad(s, (float[]){0, top0, half}, (float[]){length, top1, half},
                    (float[]){length, top1, -half}, (float[]){0, top0, -half});
    prom_solid_leave(s, old);
}

static void build_newel(prom_gallery *g, prom_solid *s, const float p[3])
{
    prom_solid_frame old = prom_solid_enter(s, p[0], p[1], p[2], 0);
    prom_solid_box(s, -0.11f, -0.3f, -0.11f, 0.11f, 1.05f, 0.11f, PROM_FACE_ALL);
    prom_solid_box(s, -0.14f, 1.05f, -0.14f, 0.14f, 1.10f, 0.14f, PROM_FACE_ALL);
    prom_gallery_ball(s, 0, 1.22f, 0, 0.12f, 0.12f, 0.12f, prom_gallery_sides(g, 48), 0);
    prom_solid_leave(s, old);
}

void prom_gallery_balustrade(prom_gallery *g, prom_solid *s, const float a[3], const float b[3])
{
    float length = hypotf(b[0] - a[0], b[2] - a[2]);
    int n = (int)fmaxf(1, roundf(length / 0.24f));
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xefe6d6, 1.0f));
    for (int i = 0; i < n; i++) {
        float t = ((float)i + 0.5f) / (float)n, y = a[1] + (b[1] - a[1]) * t;
        build_baluster(g, s, a[0] + (b[0] - a[0]) * t, y + STRING, a[2] + (b[2] - a[2]) * t,
                       y + RAIL);
    }
    build_newel(g, s, a);
    build_newel(g, s, b);
    build_string(s, a, b);
    const float line[2][3] = {{a[0], a[1] + RAIL, a[2]}, {b[0], b[1] + RAIL, b[2]}};
    prom_solid_tube(s, line, (const float[]){0.075f, 0.075f}, 2, prom_gallery_sides(g, 32));
}

// ---- flights

// Each step is three strips across: stone, carpet, stone.
static void build_step(prom_gallery *g, prom_solid *s, float half, const float low[2],
                       const float high[2], bool carpet)
{
    prom_paint stone = prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xe4dacb, 1.4f);
    prom_paint red = prom_gallery_paint(g, PROM_GALLERY_FABRIC, 0xb9443c, 0.4f);
    float c = 0.55f * half;
    const float cuts[4] = {-half, -c, c, half};
    for (int k = 0; k < 3; k++) {
        float a = cuts[k], b = cuts[k + 1], y0 = low[1], y1 = high[1], z0 = low[0],
              z1 = high[0];
        prom_solid_use(s, carpet && k == 1 ? red : stone);
        prom_solid_quad(s, (float[]){a, y0, z0}, (float[]){b, y0, z0}, (float[]){b, y1, z0},
                        (float[]){a, y1, z0});
        prom_solid_quad(s, (float[]){a, y1, z0}, (float[]){b, y1, z0}, (float[]){b, y1, z1},
                        (float[]){a, y1, z1});
    }
}

// The sides and the underside of a step.
static void build_body(prom_solid *s, float half, float z0, float z1, float y, float low0,
                       float low1)
{
    prom_solid_quad(s, (float[]){-half, low1, z1}, (float[]){-half, low0, z0},
                    (float[]){-half, y, z0}, (float[]){-half, y, z1});
    prom_solid_quad(s, (float[]){half, low0, z0}, (float[]){half, low1, z1},
                    (float[]){half, y, z1}, (float[]){half, y, z0});
    prom_solid_quad(s, (float[]){-half, low1, z1}, (float[]){half, low1, z1},
                    (float[]){half, low0, z0}, (float[]){-half, low0, z0});
}

// In a frame in which the flight rises towards -z.
void prom_gallery_flight_of(prom_gallery *g, prom_solid *s, const prom_gallery_flight *f)
{
    float n = (float)f->steps, run = fabsf(f->z1 - f->z0) / n, rise = (f->y1 - f->y0) / n;
    float half = f->width / 2;
    prom_solid_frame old = prom_solid_enter(s, f->x, 0, f->z0, f->z1 < f->z0 ? 0 : PI);
    for (int i = 0; i < f->steps; i++) {
        float k = (float)i, y = f->y0 + k * rise;
        float low0 = fmaxf(f->y0, y - THICKNESS), low1 = fmaxf(f->y0, y + rise - THICKNESS);
        build_step(g, s, half, (float[]){-k * run, y}, (float[]){-(k + 1) * run, y + rise},
                   f->width > 2.5f);
        prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_ASHLAR, 0xf4ead8, 2.4f));
        build_body(s, half, -k * run, -(k + 1) * run, y + rise, low0, low1);
    }
    prom_solid_leave(s, old);
}

static void flight_rail(prom_gallery *g, prom_solid *s, const prom_gallery_flight *f,
                        float side)
{
    float x = f->x + side * (f->width / 2 - 0.12f);
    float rise = (f->y1 - f->y0) / (float)f->steps;
    prom_gallery_balustrade(g, s, (float[]){x, f->y0 + 0.5f * rise, f->z0},
                            (float[]){x, f->y1, f->z1});
}

// ---- the stair room

static void build_landing(prom_solid *s, float x0, float z0, float x1, float z1, float y)
{
    prom_solid_box(s, x0, y - THICKNESS, z0, x1, y, z1, PROM_FACE_ALL);
}

void prom_gallery_build_stairs(prom_gallery *g, uint32_t id, uint32_t parent)
{
    const prom_gallery_room *room = &g->plan.rooms.data[id];
    prom_gallery_flight f[3];
    prom_solid steps, rails;
    prom_gallery_flights(&g->plan, f);
    prom_solid_init(&steps);
    prom_solid_init(&rails);
    prom_gallery_flight_of(g, &steps, &f[1]);
    prom_gallery_flight_of(g, &steps, &f[2]);
    prom_solid_use(&steps, prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xe4dacb, 1.4f));
    float upper = f[1].y1, half = f[1].y0, inner = f[1].x - f[1].width / 2,
          outer = f[2].x + f[2].width / 2;
    build_landing(&steps, room->x0, room->z0, room->x1, f[1].z1, upper);
    build_landing(&steps, room->x0, f[1].z0, room->x1, room->z1, half);
    flight_rail(g, &rails, &f[1], -1);
    flight_rail(g, &rails, &f[2], 1);
    // The landings' open edges.
    prom_gallery_balustrade(g, &rails, (float[]){room->x0 + 0.12f, upper, f[1].z1},
                            (float[]){inner + 0.12f, upper, f[1].z1});
    prom_gallery_balustrade(g, &rails, (float[]){outer - 0.12f, half, f[1].z0},
                            (float[]){inner + 0.12f, half, f[1].z0});
    prom_gallery_add(g, parent, "stairs", &steps);
    prom_gallery_add(g, parent, "balustrades", &rails);
}

#include "scenes/city_parts.h"

#include <assert.h>
#include <math.h>

#define PI 3.14159265f

int prom_city_arch_outline(float x0, float y0, float x1, float spring, int points, bool pointed,
                           float (*outline)[2])
{
    int n = 0;
    float w = x1 - x0, r = w / 2;
    assert(points + 4 <= PROM_ARCH_POINTS_MAX);
    outline[n][0] = x0, outline[n++][1] = y0;
    outline[n][0] = x1, outline[n++][1] = y0;
    for (int i = 0; i <= points; i++) {
        float t = (float)i / (float)points;
        if (pointed) {
            // Up the right side about the left corner, then down the left about the right one.
            float a = t < 0.5f ? PI / 3 * 2 * t : PI / 3 * (2 - 2 * t), c = cosf(a);
            outline[n][0] = t < 0.5f ? x0 + w * c : t > 0.5f ? x1 - w * c : (x0 + x1) / 2;
            outline[n++][1] = spring + w * sinf(a);
        } else {
            outline[n][0] = (x0 + x1) / 2 + r * cosf(PI * t);
            outline[n++][1] = spring + r * sinf(PI * t);
        }
    }
    return n;
}

void prom_city_build_arch_window(prom_city *city, prom_solid *shape, prom_paint frame,
                                 const float o[4], bool pointed)
{
    float inner[PROM_ARCH_POINTS_MAX][2], outer[PROM_ARCH_POINTS_MAX][2];
    int points = city->options.detail < 2 ? 6 : city->options.detail < 4 ? 10 : 20;
    float t = 0.15f * fminf(1, (o[2] - o[0]) + 0.2f);
    int n = prom_city_arch_outline(o[0], o[1], o[2], o[3], points, pointed, inner);
    prom_city_arch_outline(o[0] - t, o[1] - t, o[2] + t, o[3], points, pointed, outer);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WINDOW_DARK, 0xb8c0c8, 3));
    prom_solid_extrude(shape, (const float(*)[2])inner, n, 0, 0.03f, PROM_FACE_FRONT);
    prom_solid_use(shape, frame);
    const float z = 0.12f, low = 0.03f;
    for (int i = 0; i < n; i++) {
        const float *a = outer[i], *b = outer[(i + 1) % n], *c = inner[(i + 1) % n],
                    *d = inner[i];
        prom_solid_quad(shape, (float[]){a[0], a[1], z}, (float[]){b[0], b[1], z},
                        (float[]){c[0], c[1], z}, (float[]){d[0], d[1], z});
        prom_solid_quad(shape, (float[]){a[0], a[1], z}, (float[]){a[0], a[1], 0},
                        (float[]){b[0], b[1], 0}, (float[]){b[0], b[1], z});
        prom_solid_quad(shape, (float[]){d[0], d[1], low}, (float[]){d[0], d[1], z},
                        (float[]){c[0], c[1], z}, (float[]){c[0], c[1], low});
    }
    // Mullion and transom.
    float mid = (o[0] + o[2]) / 2, bar = 0.035f;
    float top = o[3] + (pointed ? 0.8f * (o[2] - o[0]) : 0.47f * (o[2] - o[0]));
    int sides = PROM_FACE_FRONT | PROM_FACE_LEFT | PROM_FACE_RIGHT;
    prom_solid_box(shape, mid - bar, o[1], low, mid + bar, top, 0.075f, sides);
    prom_solid_box(shape, o[0], o[3] - bar, low, o[2], o[3] + bar, 0.07f,
                   PROM_FACE_FRONT | PROM_FACE_TOP | PROM_FACE_BOTTOM);
}

// The wall above and beside an arch, in columns, in one plane that looks to +z or -z.
static void arch_face(prom_solid *shape, const float (*head)[2], int count, float x0, float x1,
                      float height, float z, bool front)
{
    // `head` runs from right to left; piers stand at both sides.
    float spring = head[0][1];
    float edges[PROM_ARCH_POINTS_MAX + 4][2];
    int n = 0;
    edges[n][0] = x1, edges[n++][1] = 0;
    edges[n][0] = head[0][0], edges[n++][1] = 0;
    for (int i = 0; i < count; i++) {
        edges[n][0] = head[i][0];
        edges[n++][1] = i == 0 || i == count - 1 ? spring : head[i][1];
    }
    edges[n][0] = head[count - 1][0], edges[n++][1] = 0;
    edges[n][0] = x0, edges[n++][1] = 0;
    for (int i = 0; i + 1 < n; i++) {
        const float *r = edges[i], *l = edges[i + 1];
        if (r[0] - l[0] < 1e-5f) continue;
        if (front)
            prom_solid_quad(shape, (float[]){l[0], l[1], z}, (float[]){r[0], r[1], z},
                            (float[]){r[0], height, z}, (float[]){l[0], height, z});
        else
            prom_solid_quad(shape, (float[]){r[0], r[1], z}, (float[]){l[0], l[1], z},
                            (float[]){l[0], height, z}, (float[]){r[0], height, z});
    }
}

void prom_city_build_arcade(prom_solid *shape, float width, uint32_t bays, float height,
                            float thick, int points)
{
    float bay = width / (float)bays, pier = fminf(0.55f, 0.22f * bay);
    for (uint32_t b = 0; b < bays; b++) {
        float x0 = bay * (float)b, x1 = x0 + bay, outline[PROM_ARCH_POINTS_MAX][2] = {{0}};
        float l = x0 + pier / 2, r = x1 - pier / 2, spring = height - 0.45f - (r - l) / 2;
        int n = prom_city_arch_outline(l, 0, r, spring, points, false, outline);
        const float(*head)[2] = (const float(*)[2])outline + 2;
        arch_face(shape, head, n - 2, x0, x1, height, 0, true);
        arch_face(shape, head, n - 2, x0, x1, height, -thick, false);
        // Inner faces: up the left pier, over the arch, down the right one.
        for (int i = 1; i < n; i++) {
            const float *p = outline[i], *q = outline[(i + 1) % n];
            prom_solid_quad(shape, (float[]){p[0], p[1], -thick}, (float[]){p[0], p[1], 0},
                            (float[]){q[0], q[1], 0}, (float[]){q[0], q[1], -thick});
        }
    }
    prom_solid_quad(shape, (float[]){0, 0, -thick}, (float[]){0, 0, 0}, (float[]){0, height, 0},
                    (float[]){0, height, -thick});
    prom_solid_quad(shape, (float[]){width, 0, 0}, (float[]){width, 0, -thick},
                    (float[]){width, height, -thick}, (float[]){width, height, 0});
}

#include "scenes/city_wall.h"

#include <math.h>

static bool has_balcony(const prom_facade *f, uint32_t storey, uint32_t bay)
{
    return storey && storey <= f->balcony_top && f->balconies >> bay & 1;
}

static prom_opening place_opening(const prom_facade *f, uint32_t s, uint32_t b)
{
    float bay = f->width / (float)f->bays, mid = bay * ((float)b + 0.5f);
    float floor = f->floors[s], height = f->floors[s + 1] - floor;
    float half = f->wide ? 0.41f * bay : fminf(0.58f, 0.27f * bay);
    float sill = floor + (f->wide ? 0.20f : 0.29f) * height;
    float head = floor + (f->wide ? 0.84f : s ? 0.82f : 0.80f) * height;
    prom_opening o = {mid - half, sill, mid + half, head, PROM_OPENING_WINDOW, s, b};
    if (f->arched) o.y1 -= 0.10f * height;
    if (!s && f->has_door && b == f->door_bay) {
        o = (prom_opening){
            mid - 0.52f, PROM_DOOR_STEP, mid + 0.52f, head, PROM_OPENING_DOOR, s, b};
    } else if (f->loading && b == f->bays / 2) {
        o = (prom_opening){mid - 0.75f,
                           floor + (s ? 0.12f : 0.16f),
                           mid + 0.75f,
                           floor + 0.86f * height,
                           PROM_OPENING_LOADING,
                           s,
                           b};
    } else if (has_balcony(f, s, b)) {
        o.y0 = floor + 0.12f; // a glazed door
    } else if (!s && f->has_shop) {
        o = (prom_opening){
            mid - 0.42f * bay, 0.5f, mid + 0.42f * bay, head, PROM_OPENING_SHOP, s, b};
    }
    return o;
}

// A blind round head, or a flat arch of bricks.
static void build_head(prom_solid *shape, const prom_facade *f, const float o[4])
{
    float outline[PROM_ARCH_POINTS_MAX][2], t = 0.1f;
    int points = f->detail < 2 ? 5 : f->detail < 4 ? 8 : 16;
    int n =
        prom_city_arch_outline(o[0] - t, o[3], o[2] + t, o[3] + 0.02f, points, false, outline);
    for (int i = 0; i < n; i++) outline[i][1] = o[3] + 0.42f * (outline[i][1] - o[3]);
    prom_solid_use(shape, f->trim);
    prom_solid_extrude(shape, (const float(*)[2])outline, n, 0, 0.05f,
                       PROM_FACE_FRONT | PROM_FACE_SIDES);
}

static void build_wide_window(prom_city *city, prom_solid *shape, const prom_facade *f,
                              const float o[4], prom_random *random)
{
    prom_solid_use(shape, f->wall);
    prom_wall_reveal(shape, o, PROM_REVEAL, true);
    prom_wall_glass(city, shape, o, -PROM_REVEAL, true, random);
    prom_solid_use(shape, f->frame);
    prom_wall_ring(shape, o, 0.05f, -PROM_REVEAL, -PROM_REVEAL + 0.05f);
    prom_wall_bars(shape, (float[]){o[0] + 0.05f, o[1] + 0.05f, o[2] - 0.05f, o[3] - 0.05f}, 0,
                   o[2] - o[0] > 1.7f ? 2 : 1, -PROM_REVEAL);
}

static void build_window(prom_city *city, prom_solid *shape, const prom_facade *f,
                         const prom_opening *at, prom_random *random)
{
    const float o[4] = {at->x0, at->y0, at->x1, at->y1};
    bool balcony = has_balcony(f, at->storey, at->bay);
    if (f->wide) {
        build_wide_window(city, shape, f, o, random);
    } else {
        prom_city_build_window(city, shape, f, o, random);
        if (f->arched)
            build_head(shape, f, o);
        else if (f->surrounds && f->detail > 1)
            prom_wall_surround(shape, f, o, f->pediments && at->storey == 1);
    }
    float leaf = (o[2] - o[0]) / 2;
    if (f->shutters && at->storey) {
        prom_wall_shutter(shape, f, o[0] - leaf - 0.02f, o[1], o[0] - 0.02f, o[3]);
        prom_wall_shutter(shape, f, o[2] + 0.02f, o[1], o[2] + leaf + 0.02f, o[3]);
    }
    if (balcony)
        prom_city_build_balcony(city, shape, f, o);
    else if (f->flowers && at->storey && prom_random_unit(random) < 0.6f)
        prom_city_build_flowers(city, shape, o, random);
}

void prom_city_build_facade(prom_city *city, prom_solid *shape, const prom_facade *f,
                            prom_random *random)
{
    prom_opening openings[PROM_OPENINGS_MAX];
    uint32_t count = 0;
    for (uint32_t s = f->from; s < f->storeys; s++)
        for (uint32_t b = 0; b < f->bays && count < PROM_OPENINGS_MAX; b++)
            openings[count++] = place_opening(f, s, b);
    bool awning = prom_random_unit(random) < 0.6f;
    prom_solid_use(shape, f->wall);
    prom_wall_build(shape, f->width, f->floors[f->from], f->floors[f->storeys], openings,
                    count);
    for (uint32_t i = 0; i < count; i++) {
        const prom_opening *o = &openings[i];
        const float rectangle[4] = {o->x0, o->y0, o->x1, o->y1};
        if (o->kind == PROM_OPENING_DOOR)
            prom_front_door(city, shape, f, rectangle, random);
        else if (o->kind == PROM_OPENING_SHOP)
            prom_front_shop(city, shape, f, rectangle, awning, random);
        else if (o->kind == PROM_OPENING_LOADING)
            prom_front_loading(shape, f, rectangle);
        else
            build_window(city, shape, f, o, random);
    }
}

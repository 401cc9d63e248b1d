#include "builder/views.h"

#include "metaobj/base/math.h"

#include <assert.h>
#include <string.h>

void prom_views_clear(prom_views *views)
{
    views->count = 0;
    views->pixels.count = 0;
}

void prom_views_finish(prom_views *views)
{
    prom_array_finish(&views->pixels);
    *views = (prom_views){0};
}

// What a picture covers, but for where that begins in the pixels.
static prom_cutout find_covered(const prom_rgba *picture, size_t row_pixels, uint32_t side)
{
    uint32_t x0 = side, y0 = side, x1 = 0, y1 = 0, covered = 0;
    for (uint32_t y = 0; y < side; y++, picture += row_pixels) {
        uint32_t in_row = 0, first = 0, last = side;
        for (uint32_t x = 0; x < side; x++) in_row += picture[x][3] >= PROM_COVERED;
        if (!in_row) continue;
        while (picture[first][3] < PROM_COVERED) first++;
        while (picture[last - 1][3] < PROM_COVERED) last--;
        covered += in_row;
        if (first < x0) x0 = first;
        if (last > x1) x1 = last;
        if (y < y0) y0 = y;
        y1 = y + 1;
    }
    if (!covered) return (prom_cutout){0};
    return (prom_cutout){.part = {x0, y0, x1 - x0, y1 - y0}, .covered = covered};
}

void prom_views_add(prom_views *views, const prom_rgba *picture, size_t row_pixels)
{
    assert(views->count < PROM_VIEWS);
    prom_cutout *view = &views->at[views->count];
    *view = find_covered(picture, row_pixels, prom_view_px(views->count));
    view->first = (uint32_t)views->pixels.count;
    views->count++;
    if (!view->covered) return;
    const prom_part *part = &view->part;
    picture += part->y * row_pixels + part->x;
    prom_rgba *out = prom_array_extend(&views->pixels, (size_t)part->width * part->height);
    for (uint32_t y = 0; y < part->height; y++)
        memcpy(out + (size_t)y * part->width, picture + y * row_pixels,
               part->width * sizeof *out);
}

uint16_t prom_views_coverage(const prom_views *views, uint32_t dir)
{
    double share = views->at[dir].covered / (GLM_PI / 4.0 * PROM_VIEW_PIXELS);
    return (uint16_t)(65535.0 * (share > 1 ? 1 : share) + 0.5);
}

void prom_view_shares(const uint32_t *ids, size_t row_pixels, uint32_t dir, uint32_t item_count,
                      uint16_t (*shares)[PROM_DIRS])
{
    uint32_t *counts = prom_calloc(item_count, sizeof *counts);
    uint64_t sum = 0;
    for (uint32_t y = 0; y < PROM_VIEW_PX; y++, ids += row_pixels)
        for (uint32_t x = 0; x < PROM_VIEW_PX; x++)
            if (ids[x] < item_count) counts[ids[x]]++, sum++;
    for (uint32_t c = 0; c < item_count; c++)
        shares[c][dir] = sum ? (uint16_t)(65535.0 * counts[c] / (double)sum + 0.5) : 0;
    prom_free(counts);
}

// ---- the store's form

void prom_views_pack(const prom_views *views, prom_pack *pack)
{
    uint32_t pixels = (uint32_t)views->pixels.count;
    prom_pack_bytes(pack, &views->count, sizeof views->count);
    prom_pack_bytes(pack, views->at, views->count * sizeof *views->at);
    prom_pack_bytes(pack, &pixels, sizeof pixels);
    if (pixels) prom_pack_bytes(pack, views->pixels.data, pixels * sizeof(prom_rgba));
}
_Static_assert(sizeof(prom_cutout) == 6 * sizeof(uint32_t), "packed without padding");

// The parts lie within their pictures, one after the other in the pixels.
static bool are_sound(const prom_views *views, uint32_t pixels)
{
    uint64_t next = 0;
    for (uint32_t v = 0; v < views->count; v++) {
        const prom_cutout *view = &views->at[v];
        const uint64_t side = prom_view_px(v), width = view->part.width;
        if (view->part.x + width > side || (uint64_t)view->part.y + view->part.height > side ||
            view->first != next || view->covered > width * view->part.height)
            return false;
        next += width * view->part.height;
    }
    return next == pixels;
}

void prom_views_unpack(prom_unpack *in, prom_views *views)
{
    const uint32_t most =
        PROM_DIRS * PROM_VIEW_PIXELS + PROM_DIRS_LARGE * PROM_VIEW_LARGE_PIXELS;
    prom_views_clear(views);
    views->count = prom_unpack_u32(in, PROM_VIEWS);
    prom_unpack_bytes(in, views->at, views->count * sizeof *views->at);
    uint32_t pixels = prom_unpack_u32(in, most);
    size_t bytes = pixels * sizeof(prom_rgba);
    if (bytes > in->left || !are_sound(views, pixels)) in->failed = true;
    if (in->failed)
        prom_views_clear(views);
    else if (pixels)
        prom_unpack_bytes(in, prom_array_extend(&views->pixels, pixels), bytes);
}

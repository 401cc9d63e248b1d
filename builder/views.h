// Pictures of an object from every direction bin, and large ones along the axes; of each only
// the part that the object covers is kept.
#ifndef PROM_BUILDER_VIEWS_H
#define PROM_BUILDER_VIEWS_H

#include "builder/pack.h"
#include "metaobj/base/alloc.h"
#include "metaobj/view_bins.h"

#include <stdbool.h>

// Pixels along a side of a view, which is the diameter of the object's bounding sphere: the
// largest measured size.
#define PROM_VIEW_PX 128
#define PROM_VIEW_LARGE_PX 512
#define PROM_VIEW_PIXELS (PROM_VIEW_PX * PROM_VIEW_PX)
#define PROM_VIEW_LARGE_PIXELS (PROM_VIEW_LARGE_PX * PROM_VIEW_LARGE_PX)
// View v is that of direction v, or the large one of direction v - PROM_DIRS.
#define PROM_VIEWS (PROM_DIRS + PROM_DIRS_LARGE)

static inline uint32_t prom_view_px(uint32_t view)
{
    return view < PROM_DIRS ? PROM_VIEW_PX : PROM_VIEW_LARGE_PX;
}

// A rectangle of whole pixels, from the top left.
typedef struct prom_part {
    uint32_t x, y, width, height;
} prom_part;

typedef struct prom_cutout {
    prom_part part;   // of the picture that holds all that is covered; nothing: 0 wide
    uint32_t covered; // pixels
    uint32_t first;   // of its pixels
} prom_cutout;

typedef uint8_t prom_rgba[4]; // sRGB-encoded; alpha of at least PROM_COVERED is covered
#define PROM_COVERED 128

typedef struct prom_views {
    uint32_t count; // views that are there: 0, PROM_DIRS or PROM_VIEWS
    prom_cutout at[PROM_VIEWS];
    PROM_ARRAY(prom_rgba) pixels; // of all parts, rows from the top
} prom_views;

void prom_views_clear(prom_views *views); // to no views; {0} before the first time
void prom_views_finish(prom_views *views);
// Adds the next view from its square picture, whose rows are row_pixels apart.
void prom_views_add(prom_views *views, const prom_rgba *picture, size_t row_pixels);
// The covered share of the bounding sphere's disc, 65535 = 1.
uint16_t prom_views_coverage(const prom_views *views, uint32_t dir);

// Each item's share of the visible pixels in a direction: shares[item][dir], summing to 65535
// over the items up to rounding where anything is visible. ids: of the items < item_count, a
// square picture of PROM_VIEW_PX, whose rows are row_pixels apart.
void prom_view_shares(const uint32_t *ids, size_t row_pixels, uint32_t dir, uint32_t item_count,
                      uint16_t (*shares)[PROM_DIRS]);

void prom_views_pack(const prom_views *views, prom_pack *pack);
// Takes them back; where `unpack` fails they are to be finished all the same.
void prom_views_unpack(prom_unpack *unpack, prom_views *views);

#endif

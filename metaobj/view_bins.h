// The view bins for which accuracy, coverage and visible-pixel shares are stored: directions
// times sizes in pixels.
//
// Directions are the vertices of a grid on the octahedral map, 9 x 9 of them; on the map's
// border one direction stands at several, so that there are 66. Every second vertex is a
// coarser grid of the same form, with 18 directions, and every second of those again, with the
// 6 axes. Directions are numbered from the coarsest grid on.
#ifndef PROM_METAOBJ_VIEW_BINS_H
#define PROM_METAOBJ_VIEW_BINS_H

#include <stdint.h>

#define PROM_DIR_GRID 8     // cells along a side of the square
#define PROM_DIRS 66        // directions
#define PROM_DIRS_COARSE 18 // the first ones: those of a grid of half as many cells
#define PROM_DIRS_LARGE 6   // the first ones: the axes -y, -z, -x, +y, +x, +z

// Diameters in pixels: half octaves from 8 to 64, and 128; of some things 256 and 512, seen
// along the axes.
#define PROM_SIZES 8
#define PROM_SIZES_LARGE 2
#define PROM_SIZE_MIN_PX 8.0f
#define PROM_SIZE_MAX_PX 128.0f       // of PROM_SIZES
#define PROM_SIZE_MAX_LARGE_PX 512.0f // of PROM_SIZES_LARGE

// The unit vector of a direction bin, from the object towards the eye, in the prototype's
// frame.
void prom_direction_of_bin(uint32_t bin, float direction[3]);
// The bin nearest on the map to a direction (any length > 0).
uint32_t prom_bin_of_direction(const float direction[3]);
// Diameter in pixels of size bin s < PROM_SIZES + PROM_SIZES_LARGE, the large ones last.
float prom_size_of_bin(uint32_t s);
// The inverse, for whole numbers and between them, linear in the logarithm; sizes below the
// least give 0.
float prom_bin_of_size(float size_px);

// The directions around a place on the octahedral map (prom_octahedral_encode), and their
// weights for bilinear interpolation, which sum to 1.
typedef struct prom_direction_weights {
    uint8_t dir[4];
    float weight[4];
} prom_direction_weights;
void prom_directions_around(const float uv[2], prom_direction_weights *around);
// The same among the axes: the corners of the octahedron's face, of dirs < PROM_DIRS_LARGE.
typedef struct prom_axis_weights {
    uint8_t dir[3];
    float weight[3];
} prom_axis_weights;
void prom_axes_around(const float uv[2], prom_axis_weights *around);
// The nearest of the directions, as prom_bin_of_direction.
uint32_t prom_bin_of_place(const float uv[2]);
// The directions of the coarse grid (< PROM_DIRS_COARSE) around one of the fine grid: the 2
// ends of the edge in whose middle it is, or the 4 corners of the cell. Returns their number; 0
// for a direction of the coarse grid itself.
uint32_t prom_coarse_directions_around(uint32_t bin, uint32_t around[4]);

#endif

#include "metaobj/view_bins.h"

#include "metaobj/base/math.h"

enum { SIDE = PROM_DIR_GRID + 1 };

// The direction at each vertex of the map.
static const uint8_t at_vertex[SIDE][SIDE] = {
    {0, 18, 6, 19, 1, 19, 6, 18, 0},     {20, 21, 22, 23, 24, 25, 26, 27, 28},
    {7, 29, 8, 30, 9, 31, 10, 32, 11},   {33, 34, 35, 36, 37, 38, 39, 40, 41},
    {2, 42, 12, 43, 3, 44, 13, 45, 4},   {33, 46, 47, 48, 49, 50, 51, 52, 41},
    {7, 53, 14, 54, 15, 55, 16, 56, 11}, {20, 57, 58, 59, 60, 61, 62, 63, 28},
    {0, 64, 17, 65, 5, 65, 17, 64, 0},
};

// The first vertex of each direction: row * SIDE + column.
static const uint8_t vertex_of[PROM_DIRS] = {
    0,  4,  36, 40, 44, 76, 2,  18, 20, 22, 24, 26, 38, 42, 56, 58, 60, 74, 1,  3,  9,  10,
    11, 12, 13, 14, 15, 16, 17, 19, 21, 23, 25, 27, 28, 29, 30, 31, 32, 33, 34, 35, 37, 39,
    41, 43, 46, 47, 48, 49, 50, 51, 52, 55, 57, 59, 61, 64, 65, 66, 67, 68, 69, 70, 73, 75};

void prom_direction_of_bin(uint32_t bin, float direction[3])
{
    uint32_t vertex = vertex_of[bin];
    float uv[2] = {(float)(vertex % SIDE) / PROM_DIR_GRID,
                   (float)(vertex / SIDE) / PROM_DIR_GRID};
    prom_octahedral_decode(uv, direction);
}

static int clamped(int value, int most)
{
    return value < 0 ? 0 : value > most ? most : value;
}

uint32_t prom_bin_of_place(const float uv[2])
{
    int column = clamped((int)(uv[0] * PROM_DIR_GRID + 0.5f), PROM_DIR_GRID);
    int row = clamped((int)(uv[1] * PROM_DIR_GRID + 0.5f), PROM_DIR_GRID);
    return at_vertex[row][column];
}

uint32_t prom_bin_of_direction(const float direction[3])
{
    float uv[2];
    prom_octahedral_encode(direction, uv);
    return prom_bin_of_place(uv);
}

void prom_directions_around(const float uv[2], prom_direction_weights *around)
{
    int column = clamped((int)(uv[0] * PROM_DIR_GRID), PROM_DIR_GRID - 1);
    int row = clamped((int)(uv[1] * PROM_DIR_GRID), PROM_DIR_GRID - 1);
    float u = uv[0] * PROM_DIR_GRID - (float)column, v = uv[1] * PROM_DIR_GRID - (float)row;
    for (int k = 0; k < 4; k++) {
        around->dir[k] = at_vertex[row + k / 2][column + k % 2];
        around->weight[k] = (k % 2 ? u : 1.0f - u) * (k / 2 ? v : 1.0f - v);
    }
}

void prom_axes_around(const float uv[2], prom_axis_weights *around)
{
    enum { HALF = PROM_DIR_GRID / 2 };
    float x = 2.0f * uv[0] - 1.0f, z = 2.0f * uv[1] - 1.0f;
    float y = 1.0f - fabsf(x) - fabsf(z);
    if (y < 0.0f) { // prom_octahedral_decode
        float unfolded = 1.0f - fabsf(z);
        around->weight[2] = 1.0f - fabsf(x);
        around->weight[0] = unfolded;
    } else {
        around->weight[0] = fabsf(x);
        around->weight[2] = fabsf(z);
    }
    around->weight[1] = fabsf(y);
    around->dir[0] = at_vertex[HALF][x < 0.0f ? 0 : PROM_DIR_GRID];
    around->dir[1] = y < 0.0f ? at_vertex[0][0] : at_vertex[HALF][HALF];
    around->dir[2] = at_vertex[z < 0.0f ? 0 : PROM_DIR_GRID][HALF];
}

uint32_t prom_coarse_directions_around(uint32_t bin, uint32_t around[4])
{
    if (bin < PROM_DIRS_COARSE) return 0;
    uint32_t row = vertex_of[bin] / SIDE, column = vertex_of[bin] % SIDE, count = 0;
    uint32_t rows = row % 2, columns = column % 2; // whether it lies between two of them
    for (uint32_t r = 0; r <= rows; r++)
        for (uint32_t c = 0; c <= columns; c++)
            around[count++] = at_vertex[row - rows + 2 * r][column - columns + 2 * c];
    return count;
}

// Half octaves from the least size on, then octaves.
#define HALF_OCTAVES 6
#define FIRST_OCTAVE_PX (PROM_SIZE_MIN_PX * (1 << HALF_OCTAVES / 2))

float prom_size_of_bin(uint32_t s)
{
    if (s <= HALF_OCTAVES) return PROM_SIZE_MIN_PX * exp2f(0.5f * (float)s);
    return FIRST_OCTAVE_PX * exp2f((float)(s - HALF_OCTAVES));
}

float prom_bin_of_size(float size_px)
{
    if (!(size_px > PROM_SIZE_MIN_PX)) return 0.0f;
    if (size_px <= FIRST_OCTAVE_PX) return 2.0f * log2f(size_px / PROM_SIZE_MIN_PX);
    return HALF_OCTAVES + log2f(size_px / FIRST_OCTAVE_PX);
}

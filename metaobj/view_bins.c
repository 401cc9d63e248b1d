#include "metaobj/view_bins.h"

#include "metaobj/base/math.h"

void prom_direction_of_bin(uint32_t bin, float direction[3])
{
    float uv[2] = {((float)(bin % PROM_DIR_GRID) + 0.5f) / PROM_DIR_GRID,
                   ((float)(bin / PROM_DIR_GRID % PROM_DIR_GRID) + 0.5f) / PROM_DIR_GRID};
    prom_octahedral_decode(uv, direction);
}

static uint32_t cell(float coordinate)
{
    int c = (int)(coordinate * PROM_DIR_GRID);
    return (uint32_t)(c < 0 ? 0 : c >= PROM_DIR_GRID ? PROM_DIR_GRID - 1 : c);
}

uint32_t prom_bin_of_direction(const float direction[3])
{
    float uv[2];
    prom_octahedral_encode(direction, uv);
    return cell(uv[1]) * PROM_DIR_GRID + cell(uv[0]);
}

float prom_size_of_bin(uint32_t s)
{
    return ldexpf(PROM_SIZE_MIN_PX, (int)s);
}

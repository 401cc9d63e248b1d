// A generated city by a river: houses, a town hall, a church, bridges, streets, trees, hills
// around; textured, instanced; the embedded default scene. By seed and size; deterministic.
#ifndef PROM_SCENES_CITY_H
#define PROM_SCENES_CITY_H

#include "metaobj/base/status.h"

#include <stdint.h>

typedef struct prom_city_options {
    uint64_t seed;
    uint32_t blocks;         // along each side of the square city; 0: 4; a river from 2 on
    uint32_t detail;         // 1 plain, 2 default (0), 3 and 4 rich: triangles per object grow
    uint32_t styles;         // different houses; 0: 12 per detail step
    const char *flight_file; // NULL, or also a path of 600 frames above the roofs
} prom_city_options;

// Writes a .glb (atomically) and, with path_file, a walk of 600 frames through it: a street,
// the bridge, the quay, the square; without a river along two streets.
prom_status prom_city_write(const char *glb_path, const char *path_file,
                            const prom_city_options *options, uint64_t *triangles,
                            prom_error *error);

#endif

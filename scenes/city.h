// A generated city: houses, trees, lamps, streets; textured, instanced; the embedded default
// scene. By seed and size; deterministic.
#ifndef PROM_SCENES_CITY_H
#define PROM_SCENES_CITY_H

#include "metaobj/base/status.h"

#include <stdint.h>

typedef struct prom_city_options {
    uint64_t seed;
    uint32_t blocks; // along each side of the square city; 0: 4
    uint32_t detail; // 1 plain, 2 default (0), 3 and 4 rich: triangles per object grow
    uint32_t styles; // different houses; 0: 12 per detail step
} prom_city_options;

// Writes a .glb (atomically) and, with path_file, a street walk of 600 frames through it.
prom_status prom_city_write(const char *glb_path, const char *path_file,
                            const prom_city_options *options, uint64_t *triangles,
                            prom_error *error);

#endif

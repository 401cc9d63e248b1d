// A generated gallery: two storeys of rooms around a rotunda, a hall of columns and a
// staircase, with pictures, sculptures, vitrines and furniture; textured, instanced. By seed,
// rooms and detail; deterministic.
#ifndef PROM_SCENES_GALLERY_H
#define PROM_SCENES_GALLERY_H

#include "metaobj/base/status.h"

#include <stdbool.h>
#include <stdint.h>

#define PROM_GALLERY_ROOMS_MIN 17u
#define PROM_GALLERY_ROOMS_MAX 2000u
#define PROM_GALLERY_DETAIL_MAX 4u

typedef struct prom_gallery_options {
    uint64_t seed;
    uint32_t rooms;  // at least so many, from 17 to 2000; 0: 24
    uint32_t detail; // 1 plain, 2 default (0), 3 and 4 rich: each has 4 times the triangles
    bool roofless;   // ceilings and roofs are left out, for looking in from above
} prom_gallery_options;

// What was made.
typedef struct prom_gallery_facts {
    uint64_t triangles;
    uint32_t rooms;
    uint32_t walk_keys;
} prom_gallery_facts;

// Writes a .glb (atomically) and, with path_file, a walk through it: 30 keys a second, at eye
// height 1.65 m, over the floors and stairs. *facts may be NULL.
prom_status prom_gallery_write(const char *glb_path, const char *path_file,
                               const prom_gallery_options *options, prom_gallery_facts *facts,
                               prom_error *error);

#endif

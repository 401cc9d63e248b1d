// Private to simplification: which of the vertices at a place a remaining corner takes.
#ifndef PROM_SIMPLIFY_CORNER_H
#define PROM_SIMPLIFY_CORNER_H

#include "builder/simplify/work.h"

// How alike vertices must be to be one for the simplifier.
typedef enum prom_reading {
    PROM_READ_ALL, // all attributes
    PROM_READ_NO_NORMAL,
    PROM_READ_POSITION, // position and owner
} prom_reading;

// representative[v]: the first base vertex that is the same in this reading.
void prom_read_vertices(const prom_work *work, prom_reading reading, uint32_t *representative);

// Replaces representatives in `out` by the vertices among those used by `faces` that fit best:
// the three from one chart of the texture where there is one, with normals along the face's.
void prom_choose_corners(const prom_work *work, const prom_index_array *faces,
                         const uint32_t *representative, bool plain, prom_index_array *out);

#endif

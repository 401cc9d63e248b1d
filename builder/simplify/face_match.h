// Private to simplification: triangles over the same three points.
#ifndef PROM_SIMPLIFY_FACE_MATCH_H
#define PROM_SIMPLIFY_FACE_MATCH_H

#include <stdint.h>

// points: 3 per triangle, distinct. groups: per triangle, NULL: all of one.
// same[t]: the first triangle of t's group with the same points in the same winding, PROM_NONE
// if that is t itself; then t is a repetition.
// opposite[t]: a triangle of any group, itself no repetition, with the same points in the other
// winding; the earliest before t where there is one, else the first after it; PROM_NONE if
// there is none or t is a repetition.
void prom_match_faces(const uint32_t *points, const uint32_t *groups, uint32_t triangles,
                      uint32_t *same, uint32_t *opposite);

#endif

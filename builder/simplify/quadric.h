// Private to simplification: quadrics of squared distance to planes (Garland and Heckbert 1997,
// "Surface simplification using quadric error metrics"), in floats.
//
// A quadric is about an origin of its own, the point that it belongs to: there the terms that
// cancel are of the size of the faces nearby, not of the model, and single precision is enough
// (planes are lost by some 3e-4 of an edge, the root of its 1e-7). Moved by
// `prom_quadric_shift`.
#ifndef PROM_SIMPLIFY_QUADRIC_H
#define PROM_SIMPLIFY_QUADRIC_H

#include <stdbool.h>

// d'A d + 2 b'd + c at d from the origin; w: the sum of the weights in it.
typedef struct prom_quadric {
    float a[6]; // xx, yy, zz, xy, xz, yz
    float b[3];
    float c, w;
} prom_quadric;

// Adds weight * (direction . d)^2: a plane or, for an unnormalised direction, any linear form
// through the origin. Does not add to w.
static inline void prom_quadric_add_form(prom_quadric *q, const float n[3], float weight)
{
    const float x = weight * n[0], y = weight * n[1], z = weight * n[2];
    q->a[0] += x * n[0];
    q->a[1] += y * n[1];
    q->a[2] += z * n[2];
    q->a[3] += x * n[1];
    q->a[4] += x * n[2];
    q->a[5] += y * n[2];
}

static inline void prom_quadric_add(prom_quadric *q, const prom_quadric *other)
{
    for (int k = 0; k < 6; k++) q->a[k] += other->a[k];
    for (int k = 0; k < 3; k++) q->b[k] += other->b[k];
    q->c += other->c;
    q->w += other->w;
}

static inline void prom_quadric_times(const prom_quadric *q, const float d[3], float ad[3])
{
    ad[0] = q->a[0] * d[0] + q->a[3] * d[1] + q->a[4] * d[2];
    ad[1] = q->a[3] * d[0] + q->a[1] * d[1] + q->a[5] * d[2];
    ad[2] = q->a[4] * d[0] + q->a[5] * d[1] + q->a[2] * d[2];
}

static inline float prom_quadric_value(const prom_quadric *q, const float d[3])
{
    float sum = q->c, ad[3];
    prom_quadric_times(q, d, ad);
    for (int k = 0; k < 3; k++) sum += d[k] * (ad[k] + 2 * q->b[k]);
    return sum > 0 ? sum : 0;
}

// The same about an origin that is `d` away.
static inline void prom_quadric_shift(prom_quadric *q, const float d[3])
{
    float ad[3];
    q->c = prom_quadric_value(q, d);
    prom_quadric_times(q, d, ad);
    for (int k = 0; k < 3; k++) q->b[k] += ad[k];
}

// Where it is least, drawn towards `prior` by a 1e-5th of its strength: directions in which it
// is flat, as on planes, end there. False if it says nothing at all.
bool prom_quadric_minimum(const prom_quadric *q, const float prior[3], float place[3]);

#endif

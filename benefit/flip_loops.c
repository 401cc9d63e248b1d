// FLIP's loops: plain C without a branch, that a compiler makes vectors of. They are compiled
// for every processor of a kind, and again for those with wider vectors and fused
// multiplication. That rounds less often: means differ by 2e-8, single errors by less than
// 1e-5, and by 1e-4 where filters narrower than a pixel meet pictures that differ by their
// noise.
#include "benefit/flip_private.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

// A part of the loop's function, so compiled for the same processor.
#define INLINE static inline __attribute__((always_inline))

// Nothing that the next loop stores is loaded by a later round of it.
#ifdef __clang__
#define INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define INDEPENDENT _Pragma("GCC ivdep")
#endif

INLINE size_t whole_vectors(size_t count)
{
    return (count + PROM_FLIP_LANES - 1) & ~(size_t)(PROM_FLIP_LANES - 1);
}

// ---- functions of a number

INLINE int32_t bits_of(float value)
{
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

INLINE float float_of(int32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// NaN gives the least.
INLINE float clamp(float x, float least, float most)
{
    x = x > least ? x : least;
    return x < most ? x : most;
}

// The cube root of a normal positive number, to 2e-7 of it. A first r for x^(-1/3), right to
// some 4 %, comes from the exponent. With h = 1 - x r^3, x^(-1/3) is r (1 - h)^(-1/3), and
// the root x r^2 (1 - h)^(-2/3): the first series to its third power, then the second to its
// first.
INLINE float cube_root(float x)
{
    float r = float_of(0x54a21d2a - (int32_t)((float)bits_of(x) * (1 / 3.0f)));
    float h = 1 - x * (r * r) * r;
    r += r * h * (1 / 3.0f + h * (2 / 9.0f + h * (14 / 81.0f)));
    float root = x * (r * r);
    return root + root * (2 / 3.0f) * (1 - root * r);
}

// Of a normal positive number, to 1e-7 beside the rounding. With x = 2^n m, m between the roots
// of 1/2 and 2, and s = (m - 1) / (m + 1), it is n + 2 artanh(s) / ln 2.
INLINE float log2_of(float x)
{
    const int32_t root_of_half = 0x3f3504f3;
    int32_t above = bits_of(x) - root_of_half;
    float m = float_of((above & 0x7fffff) + root_of_half);
    float s = (m - 1) / (m + 1), q = s * s;
    float series = 1 + q * (1 / 3.0f + q * (1 / 5.0f + q * (1 / 7.0f)));
    return (float)(above >> 23) + s * series * (float)(2 / M_LN2);
}

// For x from -126 to 126, to 3e-7 of the result. With x = n + r, r in [-1/2, 1/2], it is
// 2^n exp(r ln 2).
INLINE float exp2_of(float x)
{
    int32_t biased = (int32_t)(x + 127.5f);
    float z = (x - (float)(biased - 127)) * (float)M_LN2;
    float series = 1 / 24.0f + z * (1 / 120.0f + z * (1 / 720.0f));
    series = 1 + z * (1 + z * (1 / 2.0f + z * (1 / 6.0f + z * series)));
    return series * float_of(biased << 23);
}

// For x from 2^-126 on and exponents from 0 to 1, to 1e-6 of the result.
INLINE float power(float x, float exponent)
{
    return exp2_of(exponent * log2_of(x));
}

// ---- colours

INLINE void transform(const float m[3][3], float a, float b, float c, float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = m[i][0] * a + m[i][1] * b + m[i][2] * c;
}

INLINE void opponents(const prom_flip_recipe *recipe, const float *const rgb[3], size_t count,
                      float *const opponent[3])
{
    float m[3][3];
    memcpy(m, recipe->opponent_of_rgb, sizeof m);
    const float *r = rgb[0], *g = rgb[1], *b = rgb[2];
    float *y = opponent[0], *cx = opponent[1], *cz = opponent[2];
    INDEPENDENT
    for (size_t i = 0; i < whole_vectors(count); i++) {
        float out[3];
        transform(m, r[i], g[i], b[i], out);
        y[i] = out[0], cx[i] = out[1], cz[i] = out[2];
    }
}

INLINE float lab_curve(float t)
{
    const float delta = 6.0f / 29, bend = delta * delta * delta;
    float root = cube_root(t > bend ? t : bend);
    return t > bend ? root : t * (1 / (3 * delta * delta)) + 4.0f / 29;
}

// CIELAB of what can be shown of a colour, its chroma less where it is dark (Hunt's effect).
INLINE void colours(const prom_flip_recipe *recipe, const float *const opponent[4],
                    size_t count, float *const lab[3])
{
    float to_rgb[3][3], to_xyz[3][3];
    memcpy(to_rgb, recipe->rgb_of_opponent, sizeof to_rgb);
    memcpy(to_xyz, recipe->xyz_of_rgb, sizeof to_xyz);
    const float *y = opponent[0], *cx = opponent[1], *cz1 = opponent[2], *cz2 = opponent[3];
    float *l = lab[0], *a = lab[1], *b = lab[2];
    INDEPENDENT
    for (size_t i = 0; i < whole_vectors(count); i++) {
        float rgb[3], f[3];
        transform(to_rgb, y[i], cx[i], cz1[i] + cz2[i], rgb);
        for (int k = 0; k < 3; k++) rgb[k] = clamp(rgb[k], 0, 1);
        transform(to_xyz, rgb[0], rgb[1], rgb[2], f);
        for (int k = 0; k < 3; k++) f[k] = lab_curve(f[k]);
        float light = 116 * f[1] - 16;
        l[i] = light;
        a[i] = 5 * light * (f[0] - f[1]);
        b[i] = 2 * light * (f[1] - f[2]);
    }
}

// ---- filters

enum { GROUP = 5 }; // taps on each side that one loop adds; with more, registers run out

// Adds `group` taps on both sides of in[0], the first of them `first` steps from it, to
// weight * base[0]; and so on for all values. Group is a constant wherever this is used.
INLINE void add_even(const prom_flip_taps *taps, const float *in, ptrdiff_t step, size_t count,
                     int first, int group, float *out)
{
    const float *base = first == 1 ? in : out;
    const float weight = first == 1 ? taps->at[0] : 1;
    const float *before = in - first * step, *after = in + first * step;
    float t[GROUP];
    for (int i = 0; i < group; i++) t[i] = taps->at[first + i];
    INDEPENDENT
    for (size_t j = 0; j < whole_vectors(count); j++) {
        float sum = weight * base[j];
        for (int i = 0; i < group; i++)
            sum += t[i] * (after[(ptrdiff_t)j + i * step] + before[(ptrdiff_t)j - i * step]);
        out[j] = sum;
    }
}

INLINE void add_both(const prom_flip_taps *even, const prom_flip_taps *odd, const float *in,
                     ptrdiff_t step, size_t count, int first, int group, float *out_even,
                     float *out_odd)
{
    const float *base_even = first == 1 ? in : out_even, *base_odd = first == 1 ? in : out_odd;
    const float weight_even = first == 1 ? even->at[0] : 1, weight_odd = first == 1 ? 0 : 1;
    const float *before = in - first * step, *after = in + first * step;
    float e[GROUP], o[GROUP];
    for (int i = 0; i < group; i++) e[i] = even->at[first + i], o[i] = odd->at[first + i];
    INDEPENDENT
    for (size_t j = 0; j < whole_vectors(count); j++) {
        float sum_even = weight_even * base_even[j], sum_odd = weight_odd * base_odd[j];
        for (int i = 0; i < group; i++) {
            float left = before[(ptrdiff_t)j - i * step],
                  right = after[(ptrdiff_t)j + i * step];
            sum_even += e[i] * (right + left);
            sum_odd += o[i] * (right - left);
        }
        out_even[j] = sum_even;
        out_odd[j] = sum_odd;
    }
}

// Calls add(..., first, group, ...) for all taps in groups of constant size.
#define FOR_GROUPS(radius, ADD)                                                                \
    for (int first = 1; first <= (radius); first += GROUP) switch ((radius) + 1 - first) {     \
        case 1:                                                                                \
            ADD(1);                                                                            \
            break;                                                                             \
        case 2:                                                                                \
            ADD(2);                                                                            \
            break;                                                                             \
        case 3:                                                                                \
            ADD(3);                                                                            \
            break;                                                                             \
        case 4:                                                                                \
            ADD(4);                                                                            \
            break;                                                                             \
        default:                                                                               \
            ADD(GROUP);                                                                        \
        }

INLINE void even(const prom_flip_taps *taps, const float *in, ptrdiff_t step, size_t count,
                 float *out){
#define ADD(group) add_even(taps, in, step, count, first, group, out)
    FOR_GROUPS(taps->radius, ADD)
#undef ADD
}

INLINE
    void both(const prom_flip_taps *even_taps, const prom_flip_taps *odd_taps, const float *in,
              ptrdiff_t step, size_t count, float *out_even, float *out_odd){
#define ADD(group)                                                                             \
    add_both(even_taps, odd_taps, in, step, count, first, group, out_even, out_odd)
        FOR_GROUPS(even_taps->radius, ADD)
#undef ADD
    }

INLINE void lengths(const float *a, const float *b, size_t count, float *out)
{
    INDEPENDENT
    for (size_t i = 0; i < whole_vectors(count); i++) out[i] = sqrtf(a[i] * a[i] + b[i] * b[i]);
}

// ---- errors

// HyAB, compressed, and spread: most differences are small, so those below 0.4 of the greatest,
// that between green and blue, get 0.95 of the range.
INLINE float colour_error(float distance)
{
    const float greatest = 41.27610f, bend = 0.4f * greatest;
    float d = power(distance, 0.7f);
    return d < bend ? d * (0.95f / bend) : 0.95f + (d - bend) * (0.05f / (greatest - bend));
}

INLINE void errors(const float *const a[PROM_FLIP_PLANES],
                   const float *const b[PROM_FLIP_PLANES], size_t count, float *map)
{
    const float *l0 = a[0], *a0 = a[1], *b0 = a[2], *e0 = a[3], *p0 = a[4];
    const float *l1 = b[0], *a1 = b[1], *b1 = b[2], *e1 = b[3], *p1 = b[4];
    const float least = 1e-30f; // of a distance that has a logarithm
    INDEPENDENT
    for (size_t i = 0; i < count; i++) {
        float da = a0[i] - a1[i], db = b0[i] - b1[i];
        float distance = fabsf(l0[i] - l1[i]) + sqrtf(da * da + db * db);
        float edges = fabsf(e0[i] - e1[i]), points = fabsf(p0[i] - p1[i]);
        float feature = (edges > points ? edges : points) * (float)M_SQRT1_2;
        float colour = colour_error(distance > least ? distance : least);
        float error = power(colour, 1 - sqrtf(feature < 1 ? feature : 1));
        map[i] = distance > least ? clamp(error, 0, 1) : 0;
    }
}

// ---- the same for each kind of processor

#define DEFINE_LOOPS(kind, TARGET)                                                             \
    TARGET static void opponents_##kind(const prom_flip_recipe *recipe,                        \
                                        const float *const rgb[3], size_t count,               \
                                        float *const opponent[3])                              \
    {                                                                                          \
        opponents(recipe, rgb, count, opponent);                                               \
    }                                                                                          \
    TARGET static void even_##kind(const prom_flip_taps *taps, const float *in,                \
                                   ptrdiff_t step, size_t count, float *out)                   \
    {                                                                                          \
        even(taps, in, step, count, out);                                                      \
    }                                                                                          \
    TARGET static void both_##kind(                                                            \
        const prom_flip_taps *even_taps, const prom_flip_taps *odd_taps, const float *in,      \
        ptrdiff_t step, size_t count, float *out_even, float *out_odd)                         \
    {                                                                                          \
        both(even_taps, odd_taps, in, step, count, out_even, out_odd);                         \
    }                                                                                          \
    TARGET static void lengths_##kind(const float *a, const float *b, size_t count,            \
                                      float *out)                                              \
    {                                                                                          \
        lengths(a, b, count, out);                                                             \
    }                                                                                          \
    TARGET static void colours_##kind(const prom_flip_recipe *recipe,                          \
                                      const float *const opponent[4], size_t count,            \
                                      float *const lab[3])                                     \
    {                                                                                          \
        colours(recipe, opponent, count, lab);                                                 \
    }                                                                                          \
    TARGET static void errors_##kind(const float *const a[PROM_FLIP_PLANES],                   \
                                     const float *const b[PROM_FLIP_PLANES], size_t count,     \
                                     float *map)                                               \
    {                                                                                          \
        errors(a, b, count, map);                                                              \
    }                                                                                          \
    static const prom_flip_loops loops_##kind = {opponents_##kind, even_##kind,                \
                                                 both_##kind,      lengths_##kind,             \
                                                 colours_##kind,   errors_##kind};

DEFINE_LOOPS(plain, )
#ifdef __x86_64__
DEFINE_LOOPS(avx2, __attribute__((target("avx2,fma"))))
DEFINE_LOOPS(avx512, __attribute__((target("avx512f"))))
#endif

const prom_flip_loops *prom_flip_loops_at(size_t i)
{
    const prom_flip_loops *able[3];
    size_t count = 0;
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx512f")) able[count++] = &loops_avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        able[count++] = &loops_avx2;
#endif
    able[count++] = &loops_plain;
    return i < count ? able[i] : NULL;
}

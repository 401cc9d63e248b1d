#include "metaobj/texture.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"

enum { EMPTY, QUEUED, FILLED };

typedef PROM_ARRAY(uint32_t) texel_list;

typedef struct layer {
    uint8_t *pixels;
    uint8_t *state;
    int width, height;
} layer;

// Index of a texel's k-th neighbour (of eight), or -1 outside.
static int64_t neighbour(const layer *l, uint32_t texel, int k)
{
    static const int8_t dx[8] = {-1, 0, 1, -1, 1, -1, 0, 1};
    static const int8_t dy[8] = {-1, -1, -1, 0, 0, 1, 1, 1};
    int x = (int)(texel % (uint32_t)l->width) + dx[k];
    int y = (int)(texel / (uint32_t)l->width) + dy[k];
    if (x < 0 || y < 0 || x >= l->width || y >= l->height) return -1;
    return (int64_t)y * l->width + x;
}

static void queue_around(const layer *l, uint32_t texel, texel_list *queue)
{
    for (int k = 0; k < 8; k++) {
        int64_t n = neighbour(l, texel, k);
        if (n < 0 || l->state[n] != EMPTY) continue;
        l->state[n] = QUEUED;
        prom_array_push(queue, (uint32_t)n);
    }
}

static void fill_from_neighbours(const layer *l, uint32_t texel)
{
    unsigned sum[3] = {0}, count = 0;
    for (int k = 0; k < 8; k++) {
        int64_t n = neighbour(l, texel, k);
        if (n < 0 || l->state[n] != FILLED) continue;
        for (int c = 0; c < 3; c++) sum[c] += l->pixels[4 * n + c];
        count++;
    }
    for (int c = 0; c < 3 && count; c++)
        l->pixels[4 * (size_t)texel + c] = (uint8_t)((sum[c] + count / 2) / count);
}

// The alpha-weighted mean colour; false where nothing is covered.
static bool mean_color(const layer *l, bool linear, uint8_t mean[3])
{
    double sum[3] = {0}, alpha = 0;
    size_t n = (size_t)l->width * (size_t)l->height;
    for (size_t i = 0; i < n; i++) {
        const uint8_t *p = l->pixels + 4 * i;
        if (!p[3]) continue;
        alpha += p[3];
        for (int c = 0; c < 3; c++)
            sum[c] += p[3] * (linear ? p[c] / 255.0 : (double)prom_srgb8_to_linear(p[c]));
    }
    if (alpha <= 0) return false;
    for (int c = 0; c < 3; c++) {
        float m = (float)(sum[c] / alpha);
        mean[c] = linear ? (uint8_t)(m * 255 + 0.5f) : prom_linear_to_srgb8(m);
    }
    return true;
}

static void dilate_layer(const layer *l, int rings, bool linear)
{
    uint8_t mean[3];
    if (!mean_color(l, linear, mean)) return;
    size_t n = (size_t)l->width * (size_t)l->height;
    texel_list ring = {0}, next = {0};
    for (size_t i = 0; i < n; i++) l->state[i] = l->pixels[4 * i + 3] ? FILLED : EMPTY;
    for (size_t i = 0; i < n; i++)
        if (l->state[i] == FILLED) queue_around(l, (uint32_t)i, &ring);
    for (int r = 0; r < rings && ring.count; r++) {
        for (size_t i = 0; i < ring.count; i++) fill_from_neighbours(l, ring.data[i]);
        for (size_t i = 0; i < ring.count; i++) l->state[ring.data[i]] = FILLED;
        next.count = 0;
        for (size_t i = 0; i < ring.count; i++) queue_around(l, ring.data[i], &next);
        texel_list swap = ring;
        ring = next;
        next = swap;
    }
    for (size_t i = 0; i < n; i++)
        if (l->state[i] != FILLED) memcpy(l->pixels + 4 * i, mean, 3);
    prom_array_finish(&ring);
    prom_array_finish(&next);
}

void prom_texture_dilate(prom_texture *texture, int rings)
{
    size_t texels = (size_t)texture->width * texture->height;
    uint8_t *state = prom_alloc(texels, 1);
    for (uint32_t i = 0; i < texture->layers; i++) {
        bool normals = texture->kind == PROM_TEXTURE_IMPOSTOR_ALBEDO && i >= 6;
        layer l = {texture->pixels + prom_texture_offset(texture, 0, i), state,
                   (int)texture->width, (int)texture->height};
        dilate_layer(&l, rings, normals);
    }
    prom_free(state);
}

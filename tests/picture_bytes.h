// Picture files for tests, made byte by byte, so that what they hold is known without a
// library.
#ifndef PROM_TESTS_PICTURE_BYTES_H
#define PROM_TESTS_PICTURE_BYTES_H

#include <assert.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef struct picture_bytes {
    size_t count;
    uint8_t data[1 << 16];
} picture_bytes;

static inline void put_bytes(picture_bytes *to, const void *data, size_t count)
{
    assert(to->count + count <= sizeof to->data);
    memcpy(to->data + to->count, data, count);
    to->count += count;
}

static inline void put_text(picture_bytes *to, const char *text)
{
    put_bytes(to, text, strlen(text));
}

static inline void put_big(picture_bytes *to, uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        put_bytes(to, &(uint8_t){(uint8_t)(value >> shift)}, 1);
}

// ---- PNG (ISO 15948), its data deflated by storing them

static inline uint32_t png_crc(const uint8_t *data, size_t count)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < count; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

static inline void png_chunk(picture_bytes *to, const char *type, const void *data,
                             size_t count)
{
    put_big(to, (uint32_t)count);
    size_t start = to->count;
    put_bytes(to, type, 4);
    put_bytes(to, data, count);
    put_big(to, png_crc(to->data + start, to->count - start));
}

static inline void png_data(picture_bytes *to, const uint8_t *raw, size_t count)
{
    static picture_bytes z;
    z.count = 0;
    assert(count < 65536);
    uint8_t head[7] = {0x78,
                       1,
                       1, // the last block, stored
                       (uint8_t)count,
                       (uint8_t)(count >> 8),
                       (uint8_t)~count,
                       (uint8_t)(~count >> 8)};
    put_bytes(&z, head, sizeof head);
    put_bytes(&z, raw, count);
    uint32_t a = 1, b = 0; // Adler-32
    for (size_t i = 0; i < count; i++) {
        a = (a + raw[i]) % 65521;
        b = (b + a) % 65521;
    }
    put_big(&z, b << 16 | a);
    png_chunk(to, "IDAT", z.data, z.count);
}

typedef struct png_form {
    uint32_t width, height;
    uint8_t depth, type; // type: 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
    const char *extra;   // a chunk before the data, or NULL
    const void *extra_data;
    size_t extra_bytes;
} png_form;

static inline void png_start(picture_bytes *to, const png_form *form)
{
    picture_bytes *head = &(picture_bytes){0};
    to->count = 0;
    put_bytes(to, "\x89PNG\r\n\x1a\n", 8);
    put_big(head, form->width);
    put_big(head, form->height);
    put_bytes(head, (uint8_t[5]){form->depth, form->type}, 5);
    png_chunk(to, "IHDR", head->data, head->count);
    if (form->extra) png_chunk(to, form->extra, form->extra_data, form->extra_bytes);
}

// rows: `height` rows of row_bytes, as the form packs them.
static inline void make_png(picture_bytes *to, const png_form *form, const void *rows,
                            size_t row_bytes)
{
    static picture_bytes raw;
    raw.count = 0;
    for (uint32_t y = 0; y < form->height; y++) {
        put_bytes(&raw, "", 1); // no filter
        put_bytes(&raw, (const uint8_t *)rows + y * row_bytes, row_bytes);
    }
    png_start(to, form);
    png_data(to, raw.data, raw.count);
    png_chunk(to, "IEND", "", 0);
}

// ---- EXR of 32-bit floats, one part, not compressed. Numbers are written as this machine has
// them: little-endian, as the format wants.

static inline void put_int(picture_bytes *to, int32_t value)
{
    put_bytes(to, &value, sizeof value);
}

static inline void exr_attribute(picture_bytes *to, const char *name, const char *type,
                                 const void *data, size_t count)
{
    put_bytes(to, name, strlen(name) + 1);
    put_bytes(to, type, strlen(type) + 1);
    put_int(to, (int32_t)count);
    put_bytes(to, data, count);
}

// data, display: windows as {x0, y0, x1, y1}, their ends within them. names: one letter for
// each channel, in alphabetic order as the format wants. values: [pixel of the data
// window][channel].
static inline void make_exr(picture_bytes *to, const int32_t data[4], const int32_t display[4],
                            const char *names, const float *values)
{
    int channels = (int)strlen(names), width = data[2] - data[0] + 1;
    int height = data[3] - data[1] + 1;
    picture_bytes *list = &(picture_bytes){0};
    for (int c = 0; c < channels; c++) {
        put_bytes(list, (char[2]){names[c]}, 2);
        put_int(list, 2); // float
        put_int(list, 0);
        put_int(list, 1);
        put_int(list, 1);
    }
    put_bytes(list, "", 1);
    to->count = 0;
    put_int(to, 20000630);
    put_int(to, 2);
    exr_attribute(to, "channels", "chlist", list->data, list->count);
    exr_attribute(to, "compression", "compression", "", 1);
    exr_attribute(to, "dataWindow", "box2i", data, 16);
    exr_attribute(to, "displayWindow", "box2i", display, 16);
    exr_attribute(to, "lineOrder", "lineOrder", "", 1);
    exr_attribute(to, "pixelAspectRatio", "float", &(float){1}, 4);
    exr_attribute(to, "screenWindowCenter", "v2f", (float[2]){0}, 8);
    exr_attribute(to, "screenWindowWidth", "float", &(float){1}, 4);
    put_bytes(to, "", 1);
    int32_t row = width * channels * 4;
    for (int y = 0; y < height; y++) {
        uint64_t offset = to->count + (size_t)(height - y) * 8 + (size_t)y * (size_t)(row + 8);
        put_bytes(to, &offset, 8);
    }
    for (int y = 0; y < height; y++) {
        put_int(to, data[1] + y);
        put_int(to, row);
        for (int c = 0; c < channels; c++)
            for (int x = 0; x < width; x++)
                put_bytes(to, &values[(y * width + x) * channels + c], 4);
    }
}

// The usual case: the data fill the display.
static inline void make_plain_exr(picture_bytes *to, int32_t width, int32_t height,
                                  const char *names, const float *values)
{
    int32_t window[4] = {0, 0, width - 1, height - 1};
    make_exr(to, window, window, names, values);
}

#endif

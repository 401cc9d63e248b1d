#include "builder/picture_file.h"

#include "builder/child.h"
#include "builder/picture_parts.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"

#include <stdio.h>

// By taste: room for the largest picture in floats twice, and time for it from a slow format.
#define MEMORY_BYTES ((uint64_t)4 << 30)
#define TIME_S 120u

#define MAGIC 0x70726f6d70696374u

void (*prom_picture_child_hook)(void);

// What the child hands over: this, then the pixels.
typedef struct wire {
    uint64_t magic;
    uint32_t status;
    uint32_t width, height, channels, floats, transparent, left_out;
    char text[sizeof((prom_error *)0)->text];
} wire;

static size_t pixel_bytes(const prom_picture *p)
{
    return p->channels * (p->floats ? sizeof(float) : 1);
}

static size_t picture_bytes(const prom_picture *p)
{
    return (size_t)p->width * p->height * pixel_bytes(p);
}

// ---- in the child

bool prom_picture_pack(FILE *to, const prom_picture_file *file, const prom_error *error)
{
    const prom_picture *p = &file->picture;
    wire head = {.magic = MAGIC,
                 .status = error->status,
                 .width = p->width,
                 .height = p->height,
                 .channels = p->channels,
                 .floats = p->floats,
                 .transparent = file->transparent,
                 .left_out = file->left_out};
    snprintf(head.text, sizeof head.text, "%s", error->text);
    if (fwrite(&head, sizeof head, 1, to) != 1) return false;
    return error->status || fwrite(file->pixels, picture_bytes(p), 1, to) == 1;
}

static bool work(void *user, FILE *result, char *doing)
{
    snprintf(doing, PROM_CHILD_DOING, "decoding the picture");
    if (prom_picture_child_hook) prom_picture_child_hook();
    prom_picture_file file;
    prom_error error = {0};
    prom_picture_decode(user, &file, &error);
    return prom_picture_pack(result, &file, &error);
}

// ---- in the parent

static prom_status check_finite(const prom_picture_file *file, const char *path,
                                prom_error *error)
{
    const prom_picture *p = &file->picture;
    const float *values = file->pixels;
    size_t count = (size_t)p->width * p->height * p->channels;
    for (size_t i = 0; p->floats && i < count; i++) {
        if (isfinite(values[i])) continue;
        size_t pixel = i / p->channels;
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: the value of channel %zu at pixel %zu,%zu is %f; only finite "
                         "values can be compared",
                         path, i % p->channels, pixel % p->width, pixel / p->width,
                         (double)values[i]);
    }
    return PROM_OK;
}

static bool sound(const wire *head)
{
    return head->width && head->height && head->width <= PROM_PICTURE_SIDE_MAX &&
           head->height <= PROM_PICTURE_SIDE_MAX &&
           (uint64_t)head->width * head->height <= PROM_PICTURE_PIXELS_MAX &&
           (head->channels == 1 || head->channels == 3) && head->floats <= 1 &&
           head->transparent <= 1;
}

prom_status prom_picture_unpack(const uint8_t *data, size_t bytes, const char *path,
                                prom_picture_file *file, prom_error *error)
{
    wire head = {0};
    *file = (prom_picture_file){0};
    if (bytes >= sizeof head) memcpy(&head, data, sizeof head);
    head.text[sizeof head.text - 1] = 0;
    if (head.magic == MAGIC && head.status && *head.text)
        return prom_fail(error, PROM_ERR_INPUT, "%s", head.text);
    prom_picture p = {.width = head.width,
                      .height = head.height,
                      .channels = head.channels,
                      .floats = head.floats};
    if (head.magic != MAGIC || head.status || !sound(&head) ||
        bytes - sizeof head != picture_bytes(&p))
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: the decoder handed over damaged data; the file is probably "
                         "damaged",
                         path);
    file->pixels = prom_alloc(picture_bytes(&p), 1);
    memcpy(file->pixels, data + sizeof head, picture_bytes(&p));
    p.pixels = file->pixels;
    file->picture = p;
    file->transparent = head.transparent;
    file->left_out = head.left_out;
    return check_finite(file, path, error);
}

prom_status prom_picture_file_read(const char *path, prom_picture_file *file, prom_error *error)
{
    prom_child_task task = {.path = path,
                            .who = "decoder",
                            .memory_bytes = MEMORY_BYTES,
                            .result_bytes = MEMORY_BYTES,
                            .time_s = TIME_S,
                            .work = work,
                            .user = (void *)(uintptr_t)path};
    prom_child_result result;
    *file = (prom_picture_file){0};
    prom_status status = prom_child_run(&task, &result, error);
    if (status) return status;
    status = prom_picture_unpack(result.data, result.bytes, path, file, error);
    prom_child_result_finish(&result);
    return status;
}

void prom_picture_file_finish(prom_picture_file *file)
{
    prom_free(file->pixels);
    *file = (prom_picture_file){0};
}

// ---- one form for two

static float linear_at(const prom_picture_file *file, size_t i)
{
    if (file->picture.floats) return ((const float *)file->pixels)[i];
    return prom_srgb8_to_linear(((const uint8_t *)file->pixels)[i]);
}

static void bring_to(prom_picture_file *file, uint32_t channels, bool floats)
{
    prom_picture *p = &file->picture;
    if (p->channels == channels && p->floats == floats) return;
    prom_picture wide = *p;
    wide.channels = channels;
    wide.floats = floats;
    void *pixels = prom_alloc(picture_bytes(&wide), 1);
    size_t count = (size_t)p->width * p->height * channels;
    for (size_t i = 0; i < count; i++) {
        size_t from = p->channels == channels ? i : i / channels;
        if (floats)
            ((float *)pixels)[i] = linear_at(file, from);
        else
            ((uint8_t *)pixels)[i] = ((const uint8_t *)file->pixels)[from];
    }
    prom_free(file->pixels);
    file->pixels = pixels;
    wide.pixels = pixels;
    *p = wide;
}

void prom_picture_files_match(prom_picture_file *a, prom_picture_file *b)
{
    uint32_t channels =
        a->picture.channels > b->picture.channels ? a->picture.channels : b->picture.channels;
    bool floats = a->picture.floats || b->picture.floats;
    bring_to(a, channels, floats);
    bring_to(b, channels, floats);
}

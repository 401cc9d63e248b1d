// LINK: prom_builder prom_benefit prom_metaobj
// MAX: 2048
// What a decoder hands over: any bytes. What is taken is a sound picture of just those bytes.
#include "fuzz.h"

#include "builder/picture_parts.h"

#include <math.h>
#include <string.h>

const unsigned fuzz_spoilings = 20000;

static void check_picture(const prom_picture_file *file, size_t count)
{
    const prom_picture *p = &file->picture;
    fuzz_check(p->width && p->width <= PROM_PICTURE_SIDE_MAX);
    fuzz_check(p->height && p->height <= PROM_PICTURE_SIDE_MAX);
    fuzz_check(p->channels == 1 || p->channels == 3);
    fuzz_check(!p->row_bytes && p->pixels && p->pixels == file->pixels);
    size_t values = (size_t)p->width * p->height * p->channels;
    fuzz_check(values * (p->floats ? 4 : 1) < count);
    for (size_t i = 0; p->floats && i < values; i++)
        fuzz_check(isfinite(((const float *)file->pixels)[i]));
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    prom_picture_file file;
    prom_error error = {0};
    prom_status status = prom_picture_unpack(bytes, count, "a.png", &file, &error);
    if (status)
        fuzz_check(status == PROM_ERR_INPUT && *error.text);
    else
        check_picture(&file, count);
    prom_picture_file_finish(&file);
    return 0;
}

static void give(void (*each)(void *user, const char *name, const void *bytes, size_t count),
                 void *user, const char *name, prom_picture_file *file, const prom_error *error)
{
    char *bytes = NULL;
    size_t count = 0;
    FILE *out = open_memstream(&bytes, &count);
    fuzz_check(out && prom_picture_pack(out, file, error));
    fuzz_check(fclose(out) == 0);
    each(user, name, bytes, count);
    free(bytes);
}

void fuzz_seeds(void (*each)(void *user, const char *name, const void *bytes, size_t count),
                void *user)
{
    prom_error none = {0}, broken = {PROM_ERR_INPUT, "a.png: is broken"};
    float floats[12] = {1, 2, -3};
    prom_picture_file grey = {.picture = {.width = 4, .height = 3, .channels = 1},
                              .pixels = floats,
                              .transparent = true};
    prom_picture_file rgb = {
        .picture = {.width = 2, .height = 2, .channels = 3, .floats = true}, .pixels = floats};
    give(each, user, "grey", &grey, &none);
    give(each, user, "rgb", &rgb, &none);
    give(each, user, "error", &(prom_picture_file){0}, &broken);
}

// LINK: prom_scenes prom_builder prom_metaobj
// MAX: 4096
// Camera paths: any bytes as a file. What is read is sound, and written again reads the same.
#include "fuzz.h"

#include "scenes/path.h"

#include <math.h>
#include <string.h>

const unsigned fuzz_spoilings = 2000;

static void check_path(const prom_path *path)
{
    double last = -INFINITY;
    fuzz_check(path->keys.count > 0);
    for (size_t i = 0; i < path->keys.count; i++) {
        const prom_path_key *k = &path->keys.data[i];
        double length = 0;
        fuzz_check(k->t > last && isfinite(k->t));
        last = k->t;
        for (int a = 0; a < 3; a++) fuzz_check(isfinite(k->position[a]));
        for (int a = 0; a < 4; a++)
            length += (double)k->orientation[a] * (double)k->orientation[a];
        fuzz_check(fabs(length - 1) < 1e-3);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    fuzz_file file = fuzz_file_make(bytes, count);
    prom_path path;
    prom_error error = {0};
    prom_status status = prom_path_load(file.path, &path, &error);
    if (status) {
        fuzz_check(status == PROM_ERR_INPUT && strstr(error.text, file.path));
        fuzz_check(!path.keys.count);
    } else {
        check_path(&path);
        prom_camera camera = {0};
        for (uint64_t frame = 0; frame < 3 * path.keys.count && frame < 64; frame++)
            prom_path_pose(&path, frame, &camera);
        prom_path_pose(&path, UINT64_MAX, &camera);
        for (int a = 0; a < 3; a++) fuzz_check(isfinite(camera.eye[a]));
    }
    prom_path_finish(&path);
    close(file.fd);
    return 0;
}

void fuzz_seeds(void (*each)(void *user, const char *name, const void *bytes, size_t count),
                void *user)
{
    static const char *const texts[] = {
        "# promenade camera path 1\n0 1 2 3 0 0 0 1\n0.033333 1 2 2.9 0 0 0 1\n",
        "0 1e3 -2.5 .3 0.5 0.5 0.5 0.5\r\n\n# more\n1 0x1p3 0 0 1 0 0 0",
        "0 1 2 3 0 0 0\n",
        "0 nan 2 3 0 0 0 1\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char name[16];
        snprintf(name, sizeof name, "%zu", i);
        each(user, name, texts[i], strlen(texts[i]));
    }
}

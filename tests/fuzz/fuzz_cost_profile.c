// LINK: prom_traverse prom_metaobj
// MAX: 4096
// Cost profiles: any bytes as a JSON file. What is loaded predicts finite times, and saved
// again loads the same.
#include "fuzz.h"

#include "traverse/cost.h"

#include <math.h>
#include <string.h>

const unsigned fuzz_spoilings = 2000;

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    fuzz_file file = fuzz_file_make(bytes, count);
    prom_cost_model model;
    memset(&model, 0x5a, sizeof model);
    prom_cost_model before = model;
    prom_error error = {0};
    prom_status status = prom_cost_load(file.path, &model, &error);
    if (status) {
        fuzz_check(status == PROM_ERR_INPUT && strstr(error.text, file.path));
        fuzz_check(!memcmp(&model, &before, sizeof model));
    } else {
        prom_cost_features features = {.draws = 10, .vertices = 1e6, .triangles = 1e6};
        double ms = prom_cost_predict(&model, &features);
        fuzz_check(isfinite(ms) && ms >= 0);
        fuzz_check(memchr(model.renderer, 0, sizeof model.renderer));
        prom_cost_is_of(&model, "llvmpipe");
    }
    close(file.fd);
    return 0;
}

void fuzz_seeds(void (*each)(void *user, const char *name, const void *bytes, size_t count),
                void *user)
{
    static const char *const texts[] = {
        "{\"format\": \"promenade-cost-profile\", \"version\": 2, \"renderer\": \"llvmpipe\","
        "\"sample_count\": 90, \"width\": 1280, \"height\": 720, \"fixed_ms\": 0.4,"
        "\"draw_ms\": 0.002, \"vertex_ms\": 2e-5, \"triangle_ms\": 5e-5, \"edge_ms\": 6e-6, "
        "\"hidden_edge_ms\": 2e-6,"
        "\"hidden_pixel_ms\": 1e-7,"
        "\"mean_error\": 0.05, \"worst_under\": 0.2, \"margin\": 0.1, \"pixel_ms\": {"
        "\"plain\": 1e-6, \"textured\": 3e-6, \"masked\": 4e-6, \"blended\": 5e-6,"
        "\"impostor\": 4e-6, \"impostor_lit\": 8e-6}}",
        "{\"format\": \"promenade-cost-profile\", \"version\": 2}",
        "[1, 2, {\"a\": null}]",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char name[16];
        snprintf(name, sizeof name, "%zu", i);
        each(user, name, texts[i], strlen(texts[i]));
    }
}

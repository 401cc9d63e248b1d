// LINK: prom_traverse prom_metaobj
// The cost model's fit and its profile files.
#include "random_model.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

enum { SAMPLES = 240 };

// A device with a price for everything.
static prom_cost_model random_device(uint64_t *seed)
{
    prom_cost_model m = random_cost(seed);
    m.bind_ms = random_between(seed, 1e-3f, 1e-2f);
    m.uploading_ms = random_between(seed, 0.1f, 1);
    m.upload_ms = random_between(seed, 1e-7f, 1e-6f);
    return m;
}

// Scenes as a calibration draws them, timed by a known model with the given relative noise.
static void make_samples(const prom_cost_model *truth, uint64_t *seed, double noise,
                         prom_cost_sample samples[SAMPLES])
{
    for (int i = 0; i < SAMPLES; i++) {
        prom_cost_features *f = &samples[i].features;
        double triangles = pow(10.0, random_between(seed, 2, 6));
        *f = (prom_cost_features){.fixed = 1,
                                  .draws = 1 + random_below(seed, 3000),
                                  .vertices = triangles * random_between(seed, 0.5f, 2.5f),
                                  .triangles = triangles};
        f->hidden = random_below(seed, 2) ? random_between(seed, 0, 3e6f) : 0;
        f->binds = 1 + random_below(seed, 300);
        f->upload_bytes = random_below(seed, 2) ? random_between(seed, 1, 8e6f) : 0;
        f->uploads = f->upload_bytes > 0;
        f->edges = random_between(seed, 0, 1) * sqrt(1e6 * triangles);
        f->hidden_edges = random_between(seed, 0, 1) * sqrt(1e6 * triangles);
        for (int k = 0; k < PROM_COST_KINDS; k++)
            if (random_below(seed, 2)) f->pixels[k] = random_between(seed, 0, 3e6f);
        double factor = 1.0 + noise * (random_unit(seed) + random_unit(seed) - 1.0);
        samples[i].ms = prom_cost_predict(truth, f) * factor;
    }
}

static bool near_to(double value, double truth, double relative)
{
    return fabs(value - truth) <= relative * truth + 1e-12;
}

static void the_fit_recovers_a_known_model(void **state)
{
    (void)state;
    uint64_t seed = 1;
    static prom_cost_sample samples[SAMPLES];
    for (int round = 0; round < 30; round++) {
        prom_cost_model truth = random_device(&seed), fit;
        make_samples(&truth, &seed, 0.0, samples);
        assert_int_equal(prom_cost_fit(samples, SAMPLES, &fit, NULL), PROM_OK);
        assert_true(near_to(fit.fixed_ms, truth.fixed_ms, 1e-3));
        assert_true(near_to(fit.draw_ms, truth.draw_ms, 1e-3));
        assert_true(near_to(fit.vertex_ms, truth.vertex_ms, 1e-3));
        assert_true(near_to(fit.triangle_ms, truth.triangle_ms, 1e-3));
        assert_true(near_to(fit.edge_ms, truth.edge_ms, 1e-3));
        assert_true(near_to(fit.hidden_edge_ms, truth.hidden_edge_ms, 1e-3));
        assert_true(near_to(fit.hidden_pixel_ms, truth.hidden_pixel_ms, 1e-3));
        assert_true(near_to(fit.bind_ms, truth.bind_ms, 1e-3));
        assert_true(near_to(fit.uploading_ms, truth.uploading_ms, 1e-3));
        assert_true(near_to(fit.upload_ms, truth.upload_ms, 1e-3));
        assert_int_equal(fit.form, PROM_COST_SUM);
        for (int k = 0; k < PROM_COST_KINDS; k++)
            assert_true(near_to(fit.pixel_ms[k], truth.pixel_ms[k], 1e-3));
        assert_true(fit.mean_error < 1e-4 && fit.worst_under < 1e-3);
        assert_int_equal(fit.sample_count, SAMPLES);

        make_samples(&truth, &seed, 0.1, samples);
        assert_int_equal(prom_cost_fit(samples, SAMPLES, &fit, NULL), PROM_OK);
        double error = 0.0;
        for (int i = 0; i < SAMPLES; i++)
            error += fabs(prom_cost_predict(&fit, &samples[i].features) /
                              prom_cost_predict(&truth, &samples[i].features) -
                          1.0);
        assert_true(error / SAMPLES < 0.02);
        assert_true(fit.mean_error > 0.01 && fit.mean_error < 0.06);
    }
}

static void coefficients_are_never_negative(void **state)
{
    (void)state;
    uint64_t seed = 2;
    static prom_cost_sample samples[SAMPLES];
    for (int round = 0; round < 200; round++) {
        prom_cost_model truth = random_device(&seed), fit;
        // Some things cost nothing: noise must not make them pay.
        if (random_below(&seed, 2)) truth.vertex_ms = 0.0;
        if (random_below(&seed, 2)) truth.draw_ms = 0.0;
        if (random_below(&seed, 2)) truth.pixel_ms[PROM_SHADE_BLENDED] = 0.0;
        make_samples(&truth, &seed, 0.5, samples);
        size_t count = 17 + random_below(&seed, SAMPLES - 17);
        assert_int_equal(prom_cost_fit(samples, count, &fit, NULL), PROM_OK);
        assert_true(fit.fixed_ms >= 0 && fit.draw_ms >= 0 && fit.vertex_ms >= 0 &&
                    fit.triangle_ms >= 0 && fit.edge_ms >= 0 && fit.hidden_pixel_ms >= 0 &&
                    fit.hidden_edge_ms >= 0 && fit.bind_ms >= 0 && fit.upload_ms >= 0);
        for (int k = 0; k < PROM_COST_KINDS; k++) assert_true(fit.pixel_ms[k] >= 0);
        assert_true(isfinite(fit.mean_error) && isfinite(fit.worst_under));
    }
}

// No other non-negative model near by may explain the samples better.
static void the_fit_is_a_minimum(void **state)
{
    (void)state;
    uint64_t seed = 3;
    static prom_cost_sample samples[SAMPLES];
    for (int round = 0; round < 50; round++) {
        prom_cost_model truth = random_device(&seed), fit;
        truth.vertex_ms = 0.0;
        make_samples(&truth, &seed, 0.4, samples);
        assert_int_equal(prom_cost_fit(samples, SAMPLES, &fit, NULL), PROM_OK);
        if (fit.form != PROM_COST_SUM) continue; // of which only the turns' end is a minimum
        enum { FIELDS = 10 + PROM_COST_KINDS };
        double at[FIELDS], least = -1.0;
        double *fields[FIELDS] = {&fit.fixed_ms,       &fit.draw_ms, &fit.vertex_ms,
                                  &fit.triangle_ms,    &fit.edge_ms, &fit.hidden_pixel_ms,
                                  &fit.hidden_edge_ms, &fit.bind_ms, &fit.upload_ms,
                                  &fit.uploading_ms};
        for (int k = 0; k < PROM_COST_KINDS; k++) fields[10 + k] = &fit.pixel_ms[k];
        for (int a = 0; a < FIELDS; a++) at[a] = *fields[a];
        for (int try = 0; try < 1 + 4 * FIELDS; try++) {
            for (int a = 0; a < FIELDS; a++) *fields[a] = at[a];
            if (try) {
                double *x = fields[(try - 1) % FIELDS];
                double size = try <= 2 * FIELDS ? 1e-2 : 1e-4;
                double change = size * (*x > 0 ? *x : truth.triangle_ms);
                *x += (try - 1) / FIELDS % 2 ? change : -change;
                if (*x < 0) continue;
            }
            double sum = 0.0;
            for (int i = 0; i < SAMPLES; i++) {
                double e = prom_cost_predict(&fit, &samples[i].features) / samples[i].ms - 1.0;
                sum += e * e;
            }
            if (!try)
                least = sum;
            else
                assert_true(sum >= least * (1.0 - 1e-9));
        }
    }
}

// A device that draws while it shades is known by its times, and one that does not is not taken
// for one: also under noise, of which the errors tell.
static void the_form_is_found(void **state)
{
    (void)state;
    uint64_t seed = 10;
    static prom_cost_sample samples[SAMPLES];
    for (int round = 0; round < 40; round++) {
        prom_cost_model truth = random_device(&seed), fit;
        truth.form = round % 2 ? PROM_COST_MAX : PROM_COST_SUM;
        double noise = round / 20 * 0.1;
        make_samples(&truth, &seed, noise, samples);
        assert_int_equal(prom_cost_fit(samples, SAMPLES, &fit, NULL), PROM_OK);
        assert_int_equal(fit.form, truth.form);
        assert_true(fit.mean_error < 0.01 + 0.7 * noise);
        double worst = 0;
        for (int i = 0; i < SAMPLES; i++) {
            const prom_cost_features *f = &samples[i].features;
            worst = fmax(worst,
                         fabs(prom_cost_predict(&fit, f) / prom_cost_predict(&truth, f) - 1));
        }
        assert_true(worst < 0.05 + 2.5 * noise);
    }
}

// What is said of a sample must not depend on its own time.
static void residuals_are_of_samples_not_seen(void **state)
{
    (void)state;
    uint64_t seed = 11;
    static prom_cost_sample samples[SAMPLES];
    static double said[PROM_COST_FORMS][SAMPLES], again[SAMPLES];
    prom_cost_model truth = random_device(&seed), fit;
    make_samples(&truth, &seed, 0.1, samples);
    for (int form = 0; form < PROM_COST_FORMS; form++) {
        assert_true(prom_cost_held_out(samples, SAMPLES, form, said[form]));
        for (int i = 0; i < SAMPLES; i += 29) {
            double kept = samples[i].ms;
            samples[i].ms *= 3;
            assert_true(prom_cost_held_out(samples, SAMPLES, form, again));
            samples[i].ms = kept;
            assert_true(again[i] == said[form][i]);
            assert_memory_not_equal(again, said[form], sizeof again);
        }
    }
    assert_int_equal(prom_cost_fit(samples, SAMPLES, &fit, NULL), PROM_OK);
    double sum = 0;
    for (int i = 0; i < SAMPLES; i++) sum += fabs(said[fit.form][i] / samples[i].ms - 1);
    assert_true(near_to(fit.mean_error, sum / SAMPLES, 1e-12));
    // Too few to be halved: what the fit itself says.
    assert_false(prom_cost_held_out(samples, 20, PROM_COST_SUM, again));
    assert_int_equal(prom_cost_fit(samples, 20, &fit, NULL), PROM_OK);
    for (int i = 0; fit.form == PROM_COST_SUM && i < 20; i++)
        assert_true(near_to(again[i], prom_cost_predict(&fit, &samples[i].features), 1e-9));
}

// The terms of a frame, put together, are its prediction; in the max form no more than the sum.
static void a_frame_is_made_of_its_terms(void **state)
{
    (void)state;
    uint64_t seed = 12;
    static prom_cost_sample samples[SAMPLES];
    prom_cost_model sum = random_device(&seed), max = sum;
    max.form = PROM_COST_MAX;
    make_samples(&sum, &seed, 0, samples);
    for (int i = 0; i < SAMPLES; i++) {
        const prom_cost_features *f = &samples[i].features;
        double terms[PROM_TERMS], all = 0;
        prom_cost_terms(&sum, f, terms);
        for (int t = 0; t < PROM_TERMS; t++) all += terms[t];
        assert_true(near_to(prom_cost_predict(&sum, f), all, 1e-12));
        assert_true(near_to(prom_cost_frame_ms(&sum, terms), all, 1e-12));
        double less = prom_cost_frame_ms(&max, terms);
        assert_true(near_to(prom_cost_predict(&max, f), less, 1e-12));
        double pixels = terms[PROM_TERM_PIXELS] + terms[PROM_TERM_HIDDEN];
        double side = fmin(terms[PROM_TERM_GEOMETRY], pixels);
        assert_true(near_to(less + side, all, 1e-12));
        // Factors of the terms and charges are those of the model.
        const double factors[PROM_TERMS] = {1.5, 0.5, 2, 3};
        prom_cost_model scaled = prom_cost_scaled(&max, factors);
        for (int t = 0; t < PROM_TERMS; t++) terms[t] *= factors[t];
        assert_true(
            near_to(prom_cost_predict(&scaled, f), prom_cost_frame_ms(&max, terms), 1e-12));
        prom_cost_model charged = prom_cost_charged(&sum, f->binds, f->upload_bytes);
        prom_cost_features rest = *f;
        rest.binds = rest.uploads = rest.upload_bytes = 0;
        assert_true(near_to(prom_cost_predict(&charged, &rest), all, 1e-12));
    }
}

static void kinds_without_samples_cost_what_textures_do(void **state)
{
    (void)state;
    uint64_t seed = 4;
    static prom_cost_sample samples[SAMPLES];
    prom_cost_model truth = random_device(&seed), fit;
    make_samples(&truth, &seed, 0.0, samples);
    for (int i = 0; i < SAMPLES; i++) {
        samples[i].features.pixels[PROM_SHADE_BLENDED] = 0;
        samples[i].features.pixels[PROM_SHADE_IMPOSTOR] = 0;
        samples[i].ms = prom_cost_predict(&truth, &samples[i].features);
    }
    assert_int_equal(prom_cost_fit(samples, SAMPLES, &fit, NULL), PROM_OK);
    assert_true(fit.pixel_ms[PROM_SHADE_BLENDED] == fit.pixel_ms[PROM_SHADE_TEXTURED]);
    assert_true(fit.pixel_ms[PROM_SHADE_IMPOSTOR] == fit.pixel_ms[PROM_SHADE_TEXTURED]);
    assert_true(
        near_to(fit.pixel_ms[PROM_SHADE_TEXTURED], truth.pixel_ms[PROM_SHADE_TEXTURED], 1e-3));
}

// A part of what textured pixels cost; see cost.c.
static void hidden_pixels_without_samples_have_a_default(void **state)
{
    (void)state;
    uint64_t seed = 8;
    static prom_cost_sample samples[SAMPLES];
    prom_cost_model truth = random_device(&seed), fit;
    make_samples(&truth, &seed, 0.0, samples);
    for (int i = 0; i < SAMPLES; i++) {
        samples[i].features.hidden = 0;
        samples[i].ms = prom_cost_predict(&truth, &samples[i].features);
    }
    assert_int_equal(prom_cost_fit(samples, SAMPLES, &fit, NULL), PROM_OK);
    assert_true(near_to(fit.hidden_pixel_ms, 0.27 * truth.pixel_ms[PROM_SHADE_TEXTURED], 1e-3));
}

// A representation costs what a frame of its features does.
static void a_representation_costs_its_features(void **state)
{
    (void)state;
    uint64_t seed = 9;
    for (int round = 0; round < 100; round++) {
        prom_cost_model model = random_device(&seed);
        prom_representation rep = {.shading = random_below(&seed, PROM_SHADE_COUNT),
                                   .flags = random_below(&seed, 2) ? PROM_REP_UNLIT : 0,
                                   .draws = 1 + random_below(&seed, 5),
                                   .vertices = random_below(&seed, 100000),
                                   .triangles = 1 + random_below(&seed, 100000)};
        double shaded = random_between(&seed, 0, 1e6f), hidden = random_between(&seed, 0, 1e6f);
        prom_cost_features f = {.draws = rep.draws,
                                .vertices = rep.vertices,
                                .triangles = rep.triangles,
                                .hidden = hidden,
                                .edges = prom_cost_edges(rep.triangles, shaded, hidden),
                                .hidden_edges = prom_cost_edges(rep.triangles, hidden, shaded)};
        bool lit = rep.shading == PROM_SHADE_IMPOSTOR && !rep.flags;
        f.pixels[lit ? PROM_COST_IMPOSTOR_LIT : rep.shading] = shaded;
        assert_true(near_to(prom_cost_of_rep(&model, &rep, shaded, hidden),
                            prom_cost_predict(&model, &f), 1e-9));
        double terms[PROM_TERMS] = {0}, whole[PROM_TERMS];
        prom_cost_add_terms(&model, &rep, shaded, hidden, terms);
        prom_cost_terms(&model, &f, whole);
        for (int t = 0; t < PROM_TERMS; t++) assert_true(near_to(terms[t], whole[t], 1e-9));
        // Half of the triangles show half of the pixels, and half of the edges.
        double half = prom_cost_edges(rep.triangles, shaded, shaded);
        assert_true(near_to(half, prom_cost_edges(0.5 * rep.triangles, shaded, 0), 1e-9));
        assert_true(prom_cost_edges(rep.triangles, 0, 0) == 0);
        assert_true(prom_cost_edges(rep.triangles, 0, hidden) == 0);
    }
}

static void unusable_samples_are_refused(void **state)
{
    (void)state;
    uint64_t seed = 5;
    static prom_cost_sample samples[SAMPLES];
    prom_cost_model truth = random_device(&seed), fit = {.fixed_ms = 7};
    prom_error error = {0};
    make_samples(&truth, &seed, 0.1, samples);
    assert_int_equal(prom_cost_fit(samples, 5, &fit, &error), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "too few"));
    assert_int_equal(prom_cost_fit(NULL, 0, &fit, &error), PROM_ERR_INPUT);
    const double bad[] = {0.0, -1.0, NAN, INFINITY};
    for (size_t i = 0; i < 4; i++) {
        double kept = samples[9].ms;
        samples[9].ms = bad[i];
        assert_int_equal(prom_cost_fit(samples, SAMPLES, &fit, &error), PROM_ERR_INPUT);
        assert_non_null(strstr(error.text, "sample 10 of 240"));
        samples[9].ms = kept;
    }
    samples[3].features.triangles = NAN;
    assert_int_equal(prom_cost_fit(samples, SAMPLES, &fit, &error), PROM_ERR_INPUT);
    assert_true(fit.fixed_ms == 7);
}

// ---- profile files

static char folder[] = "/tmp/prom_test_cost_XXXXXX";
static char path[256];

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/profile.json", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    char *command = prom_format("rm -rf %s", folder);
    int rc = system(command);
    prom_free(command);
    return rc;
}

static char *read_text(void)
{
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    char *text = prom_calloc(1, 65536);
    assert_true(fread(text, 1, 65535, f) > 0);
    fclose(f);
    return text;
}

static void write_text(const char *text, size_t bytes)
{
    remove(path); // truncating would make the file system flush
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, bytes, f), bytes);
    fclose(f);
}

static prom_cost_model some_profile(void)
{
    uint64_t seed = 6;
    prom_cost_model m = random_device(&seed);
    m.form = PROM_COST_MAX;
    m.mean_error = 0.0532;
    m.worst_under = 0.186;
    m.margin = 0.1;
    m.sample_count = 260;
    m.width = 1280;
    m.height = 720;
    strcpy(m.renderer, "llvmpipe (LLVM 15.0.6, 256 bits)");
    return m;
}

static void profiles_come_back_as_they_went(void **state)
{
    (void)state;
    prom_cost_model saved = some_profile(), loaded = {0};
    prom_error error = {0};
    assert_int_equal(prom_cost_save(&saved, path, &error), PROM_OK);
    assert_int_equal(prom_cost_load(path, &loaded, &error), PROM_OK);
    assert_memory_equal(&saved, &loaded, offsetof(prom_cost_model, renderer));
    assert_string_equal(saved.renderer, loaded.renderer);
    // A second one replaces it, and no other file stays behind.
    assert_int_equal(prom_cost_save(&saved, path, &error), PROM_OK);
    char *command = prom_format("test $(ls -A %s | wc -l) = 1", folder);
    assert_int_equal(system(command), 0);
    prom_free(command);
}

static void profiles_without_a_size_load(void **state)
{
    (void)state;
    prom_cost_model saved = some_profile(), loaded = {0};
    prom_error error = {0};
    saved.width = saved.height = 0;
    assert_int_equal(prom_cost_save(&saved, path, &error), PROM_OK);
    assert_int_equal(prom_cost_load(path, &loaded, &error), PROM_OK);
    assert_int_equal(loaded.width, 0);
    assert_int_equal(loaded.height, 0);
}

// One of before binds, uploads and forms.
static void older_profiles_load(void **state)
{
    (void)state;
    prom_cost_model saved = some_profile(), loaded = {0};
    prom_error error = {0};
    saved.bind_ms = saved.uploading_ms = saved.upload_ms = 0;
    saved.form = PROM_COST_SUM;
    assert_int_equal(prom_cost_save(&saved, path, &error), PROM_OK);
    char *command = prom_format("sed -i '/bind_ms/d; /uploading_ms/d; /upload_ms/d; "
                                "/\"form\"/d; s/\"version\": 3/\"version\": 2/' %s",
                                path);
    assert_int_equal(system(command), 0);
    prom_free(command);
    assert_int_equal(prom_cost_load(path, &loaded, &error), PROM_OK);
    assert_memory_equal(&saved, &loaded, offsetof(prom_cost_model, renderer));
}

// A renderer's name survives saving only in part; it must be known again all the same.
static void profiles_know_their_renderer(void **state)
{
    (void)state;
    char name[201];
    memset(name, 'x', sizeof name - 1);
    name[sizeof name - 1] = 0;
    memcpy(name, "Ger\xc3\xa4t\x01", 7);
    prom_cost_model m = some_profile();
    prom_error error = {0};
    assert_false(prom_cost_is_of(&m, name));
    assert_true(prom_cost_is_of(&m, m.renderer));
    snprintf(m.renderer, sizeof m.renderer, "%.*s", (int)sizeof m.renderer - 1, name);
    assert_true(prom_cost_is_of(&m, name));
    assert_int_equal(prom_cost_save(&m, path, &error), PROM_OK);
    assert_int_equal(prom_cost_load(path, &m, &error), PROM_OK);
    assert_true(prom_cost_is_of(&m, name));
    name[100] = 'y';
    assert_false(prom_cost_is_of(&m, name));
}

static void profiles_that_cannot_be_written(void **state)
{
    (void)state;
    prom_cost_model m = some_profile();
    prom_error error = {0};
    assert_int_equal(prom_cost_save(&m, "/nowhere/at/all.json", &error), PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, "/nowhere/at/all.json"));
    m.draw_ms = NAN;
    assert_int_equal(prom_cost_save(&m, path, &error), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "draw_ms"));
}

static void broken_profiles_are_refused(void **state)
{
    (void)state;
    prom_cost_model m = some_profile(), loaded = {.fixed_ms = 7};
    prom_error error = {0};
    assert_int_equal(prom_cost_load("/nowhere.json", &loaded, &error), PROM_ERR_INPUT);
    assert_int_equal(prom_cost_load(folder, &loaded, &error), PROM_ERR_INPUT);
    assert_int_equal(prom_cost_save(&m, path, &error), PROM_OK);
    char *text = read_text();
    size_t bytes = strlen(text);

    // Truncated anywhere before the last brace.
    for (size_t cut = 0; cut + 2 < bytes; cut++) {
        write_text(text, cut);
        assert_int_equal(prom_cost_load(path, &loaded, &error), PROM_ERR_INPUT);
        assert_non_null(strstr(error.text, path));
    }
    // Any byte changed: never a crash, and never a number out of range.
    uint64_t seed = 7;
    for (int i = 0; i < 1000; i++) {
        char *broken = prom_strdup(text);
        broken[random_below(&seed, (uint32_t)bytes)] = (char)random_below(&seed, 256);
        write_text(broken, bytes);
        prom_cost_model other = {0};
        if (prom_cost_load(path, &other, &error) == PROM_OK)
            assert_true(other.hidden_pixel_ms >= 0 && other.margin >= 0 && other.margin < 1 &&
                        other.fixed_ms >= 0 && isfinite(other.triangle_ms));
        prom_free(broken);
    }
    // Single keys made wrong.
    const char *const wrong[][2] = {
        {"\"fixed_ms\": ", "\"fixed_ms\": -"},
        {"\"margin\": 0.1", "\"margin\": 1.5"},
        {"\"hidden_pixel_ms\": ", "\"hidden_pixel_ms\": -"},
        {"\"edge_ms\": ", "\"edge_ms\": -"},
        {"\"impostor_lit\"", "\"impostor_other\""},
        {"\"version\": 3", "\"version\": 1"},
        {"\"version\": 3", "\"version\": 2"}, // which had fewer keys
        {"\"version\": 3", "\"version\": 4"},
        {"\"form\": \"max\"", "\"form\": \"min\""},
        {"\"bind_ms\": ", "\"bind_ms\": -"},
        {"\"upload_ms\"", "\"download_ms\""},
        {"promenade-cost", "other-cost"},
        {"\"draw_ms\": ", "\"draw_ms\": \"x\", \"y\": "},
        {"\"masked\"", "\"mask\""},
        {"{\n", "{\n\"more\": 1,"},
        {"\"width\": 1280", "\"width\": 0"},
        {"\"width\": 1280", "\"width\": 1e3"},
        {"\"height\"", "\"depth\""},
        {"\"vertex_ms\": ", "\"vertex_ms\": 1e300, \"z\": "},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char *at = strstr(text, wrong[i][0]);
        assert_non_null(at);
        char *broken = prom_format("%.*s%s%s", (int)(at - text), text, wrong[i][1],
                                   at + strlen(wrong[i][0]));
        write_text(broken, strlen(broken));
        prom_free(broken);
        assert_int_equal(prom_cost_load(path, &loaded, &error), PROM_ERR_INPUT);
    }
    assert_true(loaded.fixed_ms == 7);
    prom_free(text);
}

static void profiles_have_a_place(void **state)
{
    (void)state;
    char *cache = prom_format("%s/cache/deep", folder);
    setenv("XDG_CACHE_HOME", cache, 1);
    char *place = prom_cost_cache_path("llvmpipe (LLVM 15.0.6, 256 bits)", 1280, 720);
    char *expected =
        prom_format("%s/promenade/llvmpipe-LLVM-15.0.6-256-bits-1280x720.json", cache);
    assert_string_equal(place, expected);
    prom_cost_model m = some_profile();
    assert_int_equal(prom_cost_save(&m, place, NULL), PROM_OK);
    prom_free(expected);
    prom_free(place);

    setenv("XDG_CACHE_HOME", "relative", 1); // the standard says: ignore it
    setenv("HOME", folder, 1);
    place = prom_cost_cache_path("../../x", 640, 360);
    expected = prom_format("%s/.cache/promenade/x-640x360.json", folder);
    assert_string_equal(place, expected);
    prom_free(expected);
    prom_free(place);

    unsetenv("HOME");
    assert_null(prom_cost_cache_path("x", 1, 1));
    prom_free(cache);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fit_recovers_a_known_model),
        cmocka_unit_test(coefficients_are_never_negative),
        cmocka_unit_test(the_fit_is_a_minimum),
        cmocka_unit_test(the_form_is_found),
        cmocka_unit_test(residuals_are_of_samples_not_seen),
        cmocka_unit_test(a_frame_is_made_of_its_terms),
        cmocka_unit_test(kinds_without_samples_cost_what_textures_do),
        cmocka_unit_test(hidden_pixels_without_samples_have_a_default),
        cmocka_unit_test(a_representation_costs_its_features),
        cmocka_unit_test(unusable_samples_are_refused),
        cmocka_unit_test(profiles_come_back_as_they_went),
        cmocka_unit_test(profiles_without_a_size_load),
        cmocka_unit_test(older_profiles_load),
        cmocka_unit_test(profiles_know_their_renderer),
        cmocka_unit_test(profiles_that_cannot_be_written),
        cmocka_unit_test(broken_profiles_are_refused),
        cmocka_unit_test(profiles_have_a_place),
    };
    return cmocka_run_group_tests_name("cost", tests, make_folder, remove_folder);
}

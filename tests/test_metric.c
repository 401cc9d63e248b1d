// LINK: prom_benefit prom_metaobj
// All metrics of the registry: known values and properties of their maps.
#include "metric_fixture.h"

// ---- the registry

static void metrics_are_known_by_name(void **state)
{
    (void)state;
    static const char *const order[] = {"flip", "ssim", "rmse", "sobel", "edge-blur"};
    size_t next = 0;
    FOR_EACH_METRIC(name)
    {
        while (next < 5 && strcmp(order[next], name)) next++;
        assert_true(next < 5);
        const prom_metric_class *class = prom_metric_named(name);
        assert_ptr_equal(class, prom_metric_at(metric_i));
        assert_true(class->summary[0]);
        assert_int_equal(class->squares, !strcmp(name, "rmse") || !strcmp(name, "sobel"));
        assert_int_equal(class->uses_ppd, !strcmp(name, "flip"));
    }
    for (size_t i = 1; i < 5; i++) assert_non_null(prom_metric_named(order[i]));
    assert_null(prom_metric_named("rms"));
    assert_null(prom_metric_named(""));
    prom_metric_destroy(NULL);
}

// ---- known values

static uint8_t pattern(uint32_t x, uint32_t y, uint32_t c)
{
    return (uint8_t)((x * x + (c + 2) * x * y + 7 * y * y + 40 * c) / 6);
}

static void paint_colours(void)
{
    for (uint32_t i = 0; i < W * H * 3; i++) {
        const uint32_t c = i % 3, x = i / 3 % W, y = i / 3 / W;
        memory.bytes[0][i] = pattern(x, y, c);
        memory.bytes[1][i] = (uint8_t)((pattern(x, y, c) + pattern(x + 1, y, c) +
                                        pattern(x, y + 1, c) + pattern(x + 1, y + 1, c) + 2) /
                                       4);
    }
}

// Variances that are small beside the means.
static void paint_bright(void)
{
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) {
            memory.floats[0][y * W + x] = 1 - (float)((13 * x + 7 * y) % 5) / 1024;
            memory.floats[1][y * W + x] = 1 - (float)((3 * x + 11 * y) % 7) / 1024;
        }
}

static void paint_inverse(void)
{
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) {
            uint8_t value = (uint8_t)((x / 3 + y / 3) % 2 * 200 + x / 2);
            memory.bytes[0][y * W + x] = value;
            memory.bytes[1][y * W + x] = (uint8_t)(255 - value);
        }
}

// What numpy and scikit-image 0.19 say of the same pictures in doubles, with
// structural_similarity(a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False,
// data_range=1, full=True) and filters.sobel. `idiff` gives the same root mean squares, of EXR
// files of one float channel, in all six digits that it prints.
static const struct {
    const char *name;
    void (*paint)(void);
    uint32_t channels;
    bool floats;
    double ssim_inside, ssim; // means, without 5 pixels on each side and over all
    double ssim_at[3];        // (0, 0), (30, 18), (60, 7)
    double rmse, sobel;
} vectors[] = {
    {"colours",
     paint_colours,
     3,
     false,
     0.477744578,
     0.495699361,
     {0.941846672, 0.413480789, 0.583263844},
     0.174559574,
     0.132428353},
    {"bright",
     paint_bright,
     1,
     true,
     0.993490700,
     0.993756151,
     {0.995953552, 0.996918985, 0.996939227},
     0.002576618,
     0.000817782},
    {"inverse",
     paint_inverse,
     1,
     false,
     -0.961835334,
     -0.955141973,
     {-0.169739212, -0.961347434, -0.993179882},
     0.793799248,
     0},
};

static double mean_similarity(const float *map, uint32_t border)
{
    double sum = 0;
    for (uint32_t y = border; y < H - border; y++)
        for (uint32_t x = border; x < W - border; x++) sum += 1 - 2 * (double)map[y * W + x];
    return sum / ((W - 2 * border) * (H - 2 * border));
}

static void metrics_agree_with_others(void **state)
{
    (void)state;
    static float map[PIXELS];
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        prom_picture a = byte_picture(memory.bytes[0], W, H, vectors[i].channels);
        prom_picture b = byte_picture(memory.bytes[1], W, H, vectors[i].channels);
        if (vectors[i].floats) {
            a = float_picture(memory.floats[0], W, H, vectors[i].channels);
            b = float_picture(memory.floats[1], W, H, vectors[i].channels);
        }
        vectors[i].paint();
        compare("ssim", a, b, map);
        const size_t places[3] = {0, 18 * W + 30, 7 * W + 60};
        for (int k = 0; k < 3; k++)
            assert_float_equal(1 - 2 * map[places[k]], vectors[i].ssim_at[k], 1e-6);
        assert_float_equal(mean_similarity(map, 5), vectors[i].ssim_inside, 1e-6);
        assert_float_equal(mean_similarity(map, 0), vectors[i].ssim, 1e-6);
        assert_float_equal(compare("rmse", a, b, NULL), vectors[i].rmse, 1e-6);
        assert_float_equal(compare("sobel", a, b, NULL), vectors[i].sobel, 1e-6);
    }
}

// ---- properties

static void errors_are_symmetric_and_0_of_equal_pictures(void **state)
{
    (void)state;
    static float forth[PIXELS], back[PIXELS];
    uint64_t seed = 1;
    FOR_EACH_METRIC(name)
    for (size_t i = 0; i < sizeof odd_sizes / sizeof *odd_sizes; i++) {
        const uint32_t w = odd_sizes[i][0], h = odd_sizes[i][1];
        random_picture(&seed, memory.bytes[0], w, h);
        random_picture(&seed, memory.bytes[1], w, h);
        prom_picture a = byte_picture(memory.bytes[0], w, h, 4);
        prom_picture b = byte_picture(memory.bytes[1], w, h, 4);
        // One pixel has no edges.
        assert_true(compare(name, a, b, forth) > 0 || (w * h == 1 && !strcmp(name, "sobel")));
        compare(name, b, a, back);
        assert_memory_equal(forth, back, w * h * sizeof *forth);
        memcpy(memory.bytes[1], memory.bytes[0], 4 * (size_t)w * h);
        assert_true(compare(name, a, b, forth) == 0);
        for (size_t p = 0; p < w * h; p++) assert_true(forth[p] == 0);
    }
}

// `compare` asserts the range.
static void errors_of_extremes_are_in_range(void **state)
{
    (void)state;
    const prom_picture a = byte_picture(memory.bytes[0], W, H, 4);
    const prom_picture b = byte_picture(memory.bytes[1], W, H, 4);
    uint64_t seed = 2;
    FOR_EACH_METRIC(name)
    for (uint32_t block = 1; block <= 64; block *= 4)
        for (int kind = 0; kind < 3; kind++) {
            for (uint32_t i = 0; i < W * H * 4; i++) {
                const uint32_t p = i / 4;
                bool white = (p % W / block + p / W / block) % 2;
                const uint8_t here = white ? 255 : 0;
                const uint8_t others[3] = {(uint8_t)(255 - here), 255,
                                           (uint8_t)(255 * random_below(&seed, 2))};
                memory.bytes[0][i] = here;
                memory.bytes[1][i] = others[kind];
            }
            double error = compare(name, a, b, NULL);
            assert_true(error > 0 || !strcmp(name, "sobel"));
        }
}

// Each pixel becomes the mean of 3 x 3, in each channel.
static void box_blur(const uint8_t *in, uint8_t *out)
{
    for (int i = 0; i < W * H * 4; i++) {
        const int x = i / 4 % W, y = i / 4 / W, c = i % 4;
        int sum = 0;
        for (int k = 0; k < 9; k++) {
            int xx = x + k % 3 - 1, yy = y + k / 3 - 1;
            xx = xx < 0 ? 0 : xx >= W ? W - 1 : xx;
            yy = yy < 0 ? 0 : yy >= H ? H - 1 : yy;
            sum += in[(yy * W + xx) * 4 + c];
        }
        out[i] = (uint8_t)((sum + 4) / 9);
    }
}

// Blocks of random colours. (Of white noise, SSIM thinks better when it is blurred twice.)
static void paint_blocks(void)
{
    uint64_t seed = 3;
    uint8_t colours[W][4];
    for (int i = 0; i < W * 4; i++) colours[i / 4][i % 4] = (uint8_t)random_below(&seed, 256);
    for (int i = 0; i < W * H * 4; i++)
        memory.bytes[0][i] = colours[(i / 4 % W / 7 + i / 4 / W / 5 * 9) % W][i % 4];
}

static void errors_grow_with_blur(void **state)
{
    (void)state;
    static uint8_t next[W * H * 4];
    paint_blocks();
    FOR_EACH_METRIC(name)
    {
        double last = 0;
        memcpy(memory.bytes[1], memory.bytes[0], sizeof next);
        for (int i = 0; i < 6; i++) {
            box_blur(memory.bytes[1], next);
            memcpy(memory.bytes[1], next, sizeof next);
            double error = compare(name, byte_picture(memory.bytes[0], W, H, 4),
                                   byte_picture(memory.bytes[1], W, H, 4), NULL);
            assert_true(error > last);
            last = error;
        }
    }
}

static void errors_reach_as_far_as_the_radius(void **state)
{
    (void)state;
    static float map[PIXELS];
    const int x = 30, y = 18;
    memset(memory.bytes, 0, sizeof memory.bytes);
    memset(memory.bytes[1] + (y * W + x) * 4, 255, 4);
    const prom_picture a = byte_picture(memory.bytes[0], W, H, 4);
    const prom_picture b = byte_picture(memory.bytes[1], W, H, 4);
    FOR_EACH_METRIC(name)
    {
        prom_metric *metric = prom_metric_create(name, PPD, W, W * H, 1);
        const int radius = (int)prom_metric_radius(metric);
        run(metric, &a, &b, map);
        int reach = 0;
        for (int i = 0; i < W * H; i++) {
            int dx = abs(i % W - x), dy = abs(i / W - y), far = dx > dy ? dx : dy;
            if (map[i] > 0 && far > reach) reach = far;
        }
        assert_true(reach <= radius);
        // The ends of FLIP's filters may be too small to show.
        assert_true(reach == radius || prom_metric_class_of(metric)->uses_ppd);
        prom_metric_destroy(metric);
    }
}

// ---- edge-blur

static void edge_blur_weighs_what_matters(void **state)
{
    (void)state;
    float *object = memory.floats[0], *other = memory.floats[1];
    uint32_t covered = 0;
    double error[2];
    for (int kind = 0; kind < 2; kind++) {
        covered = 0;
        for (uint32_t i = 0; i < W * H; i++) {
            bool in = i % W >= 15 && i % W < 38 && i / W >= 10 && i / W < 30;
            covered += in;
            object[i] = in ? 0.25f : 0.7f;
            other[i] = in && kind ? 0.27f : 0.7f; // missing, shaded
        }
        error[kind] = compare("edge-blur", float_picture(object, W, H, 1),
                              float_picture(other, W, H, 1), NULL);
        error[kind] *= (double)(W * H) / covered;
    }
    assert_true(error[0] > 0.95);
    assert_true(error[1] > 0.01 && error[1] < 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(metrics_are_known_by_name),
        cmocka_unit_test(metrics_agree_with_others),
        cmocka_unit_test(errors_are_symmetric_and_0_of_equal_pictures),
        cmocka_unit_test(errors_of_extremes_are_in_range),
        cmocka_unit_test(errors_grow_with_blur),
        cmocka_unit_test(errors_reach_as_far_as_the_radius),
        cmocka_unit_test(edge_blur_weighs_what_matters),
    };
    return cmocka_run_group_tests_name("metric", tests, NULL, NULL);
}

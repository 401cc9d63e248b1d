// LINK: prom_scenes prom_builder prom_metaobj
// LABEL: slow
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scenes/gallery.h"

#include <unistd.h>

static uint64_t triangles_of(uint32_t rooms, uint32_t detail)
{
    prom_gallery_options options = {.seed = 1, .rooms = rooms, .detail = detail};
    prom_gallery_facts facts = {0};
    prom_error error = {0};
    if (prom_gallery_write("test_gallery_large.glb", NULL, &options, &facts, &error))
        fail_msg("%s", error.text);
    unlink("test_gallery_large.glb");
    assert_true(facts.rooms >= rooms);
    return facts.triangles;
}

// From about 100 thousand to over 100 million triangles.
static void test_sizes(void **unused)
{
    (void)unused;
    uint64_t last = triangles_of(24, 1);
    for (uint32_t detail = 2; detail <= 4; detail++) {
        uint64_t now = triangles_of(24, detail);
        assert_true(now > 3 * last && now < 8 * last);
        last = now;
    }
    assert_true(triangles_of(140, 4) > 100000000u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sizes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

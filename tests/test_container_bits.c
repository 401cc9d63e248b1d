// LINK: prom_metaobj
// The container of a random model, cut short and with single bits flipped: a part of what
// test_container_bits_all does.
#include "container_damage.h"

static void cut_short(void **state)
{
    (void)state;
    damage d;
    damage_init(&d);
    damage_cut_short(&d, 40);
    damage_finish(&d);
}

static void flipped_bits(void **state)
{
    (void)state;
    damage d;
    damage_init(&d);
    uint32_t refused = damage_flip_bits(&d, 200);
    print_message("%u of 200 refused\n", refused);
    assert_true(refused > 180);
    damage_finish(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cut_short),
        cmocka_unit_test(flipped_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

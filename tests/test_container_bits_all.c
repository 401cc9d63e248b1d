// LINK: prom_metaobj
// LABEL: slow
// The container of a random model, cut short at 200 places and with 2,000 single bits flipped.
#include "container_damage.h"

static void cut_short(void **state)
{
    (void)state;
    damage d;
    damage_init(&d);
    damage_cut_short(&d, 200);
    damage_finish(&d);
}

static void flipped_bits(void **state)
{
    (void)state;
    damage d;
    damage_init(&d);
    uint32_t refused = damage_flip_bits(&d, 2000);
    print_message("%u of 2000 refused\n", refused);
    assert_true(refused > 1800);
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

// The container of a random model, cut short at DAMAGE_CUTS places and with DAMAGE_FLIPS single
// bits flipped.
#include "container_damage.h"

static void cut_short(void **state)
{
    (void)state;
    damage d;
    damage_init(&d);
    damage_cut_short(&d, DAMAGE_CUTS);
    damage_finish(&d);
}

static void flipped_bits(void **state)
{
    (void)state;
    damage d;
    damage_init(&d);
    uint32_t refused = damage_flip_bits(&d, DAMAGE_FLIPS);
    print_message("%u of %d refused\n", refused, DAMAGE_FLIPS);
    assert_true(refused > DAMAGE_FLIPS * 9 / 10);
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

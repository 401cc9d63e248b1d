// LINK: prom_metaobj
//
// What becomes of the pixels that nodes show: loss and hidden shares of hand-made cuts.
#include "app/pixel_shares.c"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define NEAR(a, b) assert_true(fabs((a) - (b)) < 1e-6)

// The root has two clusters, 1 and 2; these have the leaves 3, 4 and 5, 6, 7.
enum { NODES = 8, BACKGROUND = 8 };
static uint32_t parents[] = {PROM_NONE, 0, 0, 1, 1, 2, 2, 2};
static const prom_model model = {
    .node_count = NODES + 1, .tree_count = NODES, .parent = parents};
static const uint32_t leaf_px[NODES] = {[3] = 100, [4] = 50, [5] = 200, [7] = 50};

static double loss(const prom_cut_entry *entries, size_t count)
{
    float scratch[NODES];
    prom_cut cut = {.entries = {.data = (prom_cut_entry *)entries, .count = count}};
    return prom_loss_share(&model, &cut, leaf_px, scratch);
}

static void leaves_lose_what_their_entries_lack(void **state)
{
    (void)state;
    const prom_cut_entry cut[] = {{.node = 3, .accuracy = 0.5f},
                                  {.node = 4, .accuracy = 1},
                                  {.node = 2, .accuracy = 0.75f}};
    NEAR(loss(cut, 3), (100 * 0.5 + 250 * 0.25) / 400);
    const prom_cut_entry root[] = {{.node = 0, .accuracy = 0.25f}};
    NEAR(loss(root, 1), 0.75);
}

static void full_detail_loses_nothing(void **state)
{
    (void)state;
    prom_cut_entry cut[5];
    for (uint32_t i = 0; i < 5; i++) cut[i] = (prom_cut_entry){.node = 3 + i, .accuracy = 1};
    assert_true(loss(cut, 5) == 0);
}

// A leaf that shows pixels and that the cut leaves out is lost; one without pixels is not.
static void what_is_left_out_is_lost(void **state)
{
    (void)state;
    const prom_cut_entry cut[] = {{.node = 1, .accuracy = 1}, {.node = 5, .accuracy = 1}};
    NEAR(loss(cut, 2), 50.0 / 400);
    NEAR(loss(NULL, 0), 1);
}

static void nothing_in_view_is_no_loss(void **state)
{
    (void)state;
    const uint32_t none[NODES] = {0};
    float scratch[NODES];
    prom_cut cut = {0};
    assert_true(prom_loss_share(&model, &cut, none, scratch) == 0);
    prom_hidden_share hidden = prom_hidden_share_of(&cut, none);
    assert_true(hidden.cost == 0 && hidden.nodes == 0);
}

static void hidden_is_what_shows_no_pixel(void **state)
{
    (void)state;
    prom_cut_entry entries[] = {{.node = 3, .cost_ms = 1},
                                {.node = 4, .cost_ms = 2},
                                {.node = 6, .cost_ms = 5},
                                {.node = 7, .cost_ms = 0}};
    prom_cut cut = {.entries = {.data = entries, .count = 4}};
    prom_hidden_share hidden = prom_hidden_share_of(&cut, leaf_px); // 6 shows none
    NEAR(hidden.cost, 5.0 / 8);
    NEAR(hidden.nodes, 1.0 / 4);
    for (int i = 0; i < 4; i++) entries[i].cost_ms = 0;
    assert_true(prom_hidden_share_of(&cut, leaf_px).cost == 0);
}

static void ids_outside_the_tree_are_not_counted(void **state)
{
    (void)state;
    const uint32_t ids[] = {3, PROM_NONE, 3, BACKGROUND, 7, 0};
    uint32_t px[NODES + 1] = {[3] = 10}; // one more, to see a wrong one
    prom_count_pixels(ids, 6, NODES, px);
    assert_int_equal(px[3], 12);
    assert_int_equal(px[7], 1);
    assert_int_equal(px[0], 1);
    assert_int_equal(px[BACKGROUND], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leaves_lose_what_their_entries_lack),
        cmocka_unit_test(full_detail_loses_nothing),
        cmocka_unit_test(what_is_left_out_is_lost),
        cmocka_unit_test(nothing_in_view_is_no_loss),
        cmocka_unit_test(hidden_is_what_shows_no_pixel),
        cmocka_unit_test(ids_outside_the_tree_are_not_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

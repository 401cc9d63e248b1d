// LINK: prom_metaobj PkgConfig::SQLITE
// NEEDS: promenade
// LABEL: slow
//
// `promenade shot` on 50 damaged containers, and on some whose rows hold what no builder
// writes: it ends with a picture, or with exit code 2 and one line that names the file; never
// by a signal, and never with half a picture. Skips where there is no GL.
#include "metaobj/container_schema.h"

#include <setjmp.h>
#include <sqlite3.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "tests/program_fixture.h"

#define CUTS 15
#define FLIPS 35

static uint8_t *whole; // bytes of the sound container
static size_t whole_bytes;

static void write_damaged(const uint8_t *bytes, size_t count)
{
    FILE *file = fopen("d.prom", "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    assert_int_equal(fclose(file), 0);
}

// A field of boxes: small, yet with clusters, instances and impostors.
static void write_scene(void)
{
    FILE *file = fopen("c.obj", "w");
    assert_non_null(file);
    for (int i = 0; i < 40; i++) {
        fprintf(file, "o box%d\n", i);
        for (int v = 0; v < 8; v++)
            fprintf(file, "v %d %d %d\n", i % 8 * 4 + v % 2, v / 2 % 2 * (1 + i % 3),
                    i / 8 * 4 + v / 4);
        static const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        for (int f = 0; f < 6; f++)
            fprintf(file, "f %d %d %d %d\n", 8 * i + faces[f][0] + 1, 8 * i + faces[f][1] + 1,
                    8 * i + faces[f][2] + 1, 8 * i + faces[f][3] + 1);
    }
    assert_int_equal(fclose(file), 0);
}

static int make_model(void **state)
{
    (void)state;
    if (!calibrate_small()) return 0;
    write_scene();
    expect("build c.obj -o c.prom --quiet", 0);
    unlink("c.prom.work"); // what the builder keeps for the next build
    struct stat st;
    assert_int_equal(stat("c.prom", &st), 0);
    whole_bytes = (size_t)st.st_size;
    whole = prom_alloc(whole_bytes, 1);
    FILE *file = fopen("c.prom", "rb");
    assert_int_equal(fread(whole, 1, whole_bytes, file), whole_bytes);
    fclose(file);
    return 0;
}

static int free_model(void **state)
{
    (void)state;
    prom_free(whole);
    return 0;
}

// Shoots d.prom; whether a picture came.
static bool shoot(const char *what)
{
    run_program(&run, "shot d.prom -o d.png --resolution 160,90 --profile p.json --quiet "
                      "--budget-ms 20 --selector greedy");
    struct stat st;
    bool picture = stat("d.png", &st) == 0;
    bool good = run.code == 0 ? picture
                              : run.code == 2 && !picture && count_lines(run.err) == 1 &&
                                    strstr(run.err, "d.prom");
    if (!good) fprintf(stderr, "%s: exit %d: %s\n", what, run.code, run.err);
    assert_true(good);
    const char *const made[] = {"c.obj", "c.prom", "d.prom", "d.png", "p.json", NULL};
    assert_int_equal(count_others(".", made), 0);
    unlink("d.png");
    unlink("d.prom");
    return picture;
}

static uint64_t random_below(uint64_t *state, uint64_t n)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (*state >> 20) % n;
}

static void cut_short(void **state)
{
    (void)state;
    if (no_device) skip();
    uint64_t seed = 1;
    for (int i = 0; i < CUTS; i++) {
        size_t bytes =
            i % 2 ? random_below(&seed, whole_bytes) : whole_bytes / CUTS * (size_t)i;
        write_damaged(whole, bytes);
        assert_false(shoot("cut short"));
    }
}

static void flipped_bits(void **state)
{
    (void)state;
    if (no_device) skip();
    uint64_t seed = 2;
    int pictures = 0;
    for (int i = 0; i < FLIPS; i++) {
        size_t at; // not in the long runs of zeros that nobody reads
        do at = random_below(&seed, whole_bytes);
        while (!whole[at]);
        uint8_t old = whole[at];
        whole[at] ^= (uint8_t)(1u << random_below(&seed, 8));
        write_damaged(whole, whole_bytes);
        whole[at] = old;
        pictures += shoot("a flipped bit");
    }
    print_message("%d of %d flips are not seen\n", pictures, FLIPS);
    assert_true(pictures < FLIPS / 4);
}

// Changes d.prom as a hostile writer would: all hashes are right.
static void rewrite(const char *sql)
{
    write_damaged(whole, whole_bytes);
    sqlite3 *db;
    char *text = NULL;
    assert_int_equal(sqlite3_open("d.prom", &db), SQLITE_OK);
    if (sqlite3_exec(db, sql, NULL, NULL, &text)) fail_msg("%s: %s", sql, text);
    for (int t = 0; t < PROM_TABLE_HASHED; t++) {
        uint64_t rows, hash;
        assert_int_equal(prom_table_hash(db, (prom_table)t, NULL, UINT64_MAX, &rows, &hash),
                         SQLITE_OK);
        char *update =
            prom_format("UPDATE table_rows SET row_count=%lld, hash=%lld WHERE id=%d",
                        (long long)rows, (long long)hash, t);
        assert_int_equal(sqlite3_exec(db, update, NULL, NULL, NULL), SQLITE_OK);
        prom_free(update);
    }
    sqlite3_close(db);
}

static void hostile_values(void **state)
{
    (void)state;
    if (no_device) skip();
    static const char *const edits[] = {
        "UPDATE node SET origin_x=9e17",
        "UPDATE node SET origin_y=-9e17 WHERE id%3=1",
        "UPDATE node SET half_x=9e17, half_y=9e17, half_z=9e17, radius=9e17",
        "UPDATE node SET half_x=0, half_y=0, half_z=0, radius=0",
        "UPDATE node SET basis_xx=9e17, basis_yy=9e17, basis_zz=-9e17 WHERE id%17=3",
        "UPDATE node SET basis_xx=0, basis_yy=0, basis_zz=0, basis_xz=0, basis_zx=0",
        "UPDATE prototype SET radius=9e17, half_x=9e17, triangles=9223372036854775807",
        "UPDATE prototype SET radius=0, half_x=0, half_y=0, half_z=0",
        "UPDATE prototype SET coverage=zeroblob(length(coverage)),"
        "shares=zeroblob(length(shares)); UPDATE accuracy SET value=zeroblob(length(value))",
        "UPDATE representation SET error=9e17, near_k=3e38, switch_distance=1e-38,"
        "max_size_px=iif(kind>0,1e-38,NULL)",
        "UPDATE representation SET draws=4294967295,vertices=4294967295,triangles=4294967295",
        "UPDATE representation SET draws=0, vertices=0, triangles=0, level=4294967295,"
        "shading=3, flags=flags|2; UPDATE prototype SET flags=flags|12 WHERE child_count=0",
        "UPDATE material SET red=3e38, green=-3e38, alpha=0, alpha_cutoff=3e38,"
        "alpha_mode=2, double_sided=1; DELETE FROM meta; DELETE FROM stage",
    };
    int pictures = 0, count = (int)(sizeof edits / sizeof *edits);
    for (int i = 0; i < count; i++) {
        rewrite(edits[i]);
        pictures += shoot(edits[i]);
    }
    print_message("%d of %d hostile models are drawn\n", pictures, count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cut_short),
        cmocka_unit_test(flipped_bits),
        cmocka_unit_test(hostile_values),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, make_model, free_model);
    leave_scratch();
    return failed;
}

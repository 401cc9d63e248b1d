// LINK: prom_builder prom_metaobj
// Pictures and whole files in and out.
#include "scene_files.h"

#include "builder/file_io.h"
#include "builder/image_io.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"

#include <fcntl.h>
#include <sys/stat.h>

static void fill(uint8_t *pixels, size_t bytes)
{
    uint32_t seed = 1;
    for (size_t i = 0; i < bytes; i++) {
        seed = seed * 1664525u + 1013904223u;
        pixels[i] = (uint8_t)(seed >> 24);
    }
}

static void a_png_comes_back_as_written(void **state)
{
    (void)state;
    uint8_t pixels[13 * 7 * 4], *back;
    uint32_t w, h;
    fill(pixels, sizeof pixels);
    const char *path = scene_path("a.png");
    assert_int_equal(prom_image_write_png(path, 13, 7, 4, pixels, NULL), PROM_OK);
    assert_int_equal(prom_image_read(path, 64, &w, &h, &back, NULL), PROM_OK);
    assert_int_equal(w, 13);
    assert_int_equal(h, 7);
    assert_memory_equal(back, pixels, sizeof pixels); // straight alpha, colours under 0 as well
    prom_free(back);
    assert_int_equal(prom_image_write_png(path, 13, 7, 3, pixels, NULL), PROM_OK);
    assert_int_equal(prom_image_read(path, 64, &w, &h, &back, NULL), PROM_OK);
    for (int i = 0; i < 13 * 7; i++) {
        assert_memory_equal(back + 4 * i, pixels + 3 * i, 3);
        assert_int_equal(back[4 * i + 3], 255);
    }
    prom_free(back);
}

static void a_reduction_keeps_the_light(void **state)
{
    (void)state;
    static uint8_t board[64 * 64 * 4]; // black and white: half of the light is sRGB 188
    for (int i = 0; i < 64 * 64; i++)
        memset(board + 4 * i, (i % 64 + i / 64) % 2 ? 255 : 0, 3), board[4 * i + 3] = 255;
    uint8_t *png, *small;
    size_t bytes;
    uint32_t w, h;
    assert_int_equal(prom_image_encode_png(64, 64, 4, board, &png, &bytes, NULL), PROM_OK);
    assert_int_equal(prom_image_read_memory(png, bytes, "x", 16, &w, &h, &small, NULL), 0);
    assert_int_equal(w, 16);
    assert_int_equal(h, 16);
    for (int i = 0; i < 16 * 16; i++) {
        assert_in_range(small[4 * i], 184, 192);
        assert_int_equal(small[4 * i + 3], 255);
    }
    prom_free(small);
    prom_free(png);
}

static void empty_texels_lend_no_color(void **state)
{
    (void)state;
    static uint8_t pixels[64 * 32 * 4]; // every other column: red, and empty green
    for (int i = 0; i < 64 * 32; i++)
        memcpy(pixels + 4 * i,
               i % 2 ? (uint8_t[4]){0, 255, 0, 0} : (uint8_t[4]){255, 0, 0, 255}, 4);
    uint8_t *png, *small;
    size_t bytes;
    uint32_t w, h;
    assert_int_equal(prom_image_encode_png(64, 32, 4, pixels, &png, &bytes, NULL), PROM_OK);
    assert_int_equal(prom_image_read_memory(png, bytes, "x", 16, &w, &h, &small, NULL), 0);
    assert_int_equal(w, 16);
    assert_int_equal(h, 8);
    for (int i = 0; i < 16 * 8; i++) {
        assert_in_range(small[4 * i], 250, 255);
        assert_in_range(small[4 * i + 1], 0, 25);
        assert_in_range(small[4 * i + 3], 100, 156);
    }
    prom_free(small);
    prom_free(png);
}

// libpng prints its complaints itself; in the program it does so in a child whose output nobody
// sees. Gives the old stderr, for loud_again.
static int quiet(void)
{
    fflush(stderr);
    int kept = dup(STDERR_FILENO), null = open("/dev/null", O_WRONLY);
    assert_true(kept >= 0 && null >= 0);
    dup2(null, STDERR_FILENO);
    close(null);
    return kept;
}

static void loud_again(int kept)
{
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
}

static void broken_pictures_are_errors(void **state)
{
    (void)state;
    uint8_t pixels[8 * 8 * 4], *png, *rgba = NULL;
    size_t bytes;
    uint32_t w, h;
    prom_error error;
    fill(pixels, sizeof pixels);
    assert_int_equal(prom_image_encode_png(8, 8, 4, pixels, &png, &bytes, NULL), PROM_OK);
#ifdef PROM_SANITIZE
    const size_t last = 8; // later, libpng jumps out of the reader and its message leaks there
#else
    const size_t last = 40;
#endif
    unsigned refused = 0;
    int kept = quiet();
    for (size_t cut = 0; cut < last; cut++)
        refused +=
            prom_image_read_memory(png, cut, "cut", 8, &w, &h, &rgba, &error) == PROM_ERR_INPUT;
    loud_again(kept);
    assert_int_equal(refused, last);
    // A header that promises more than anyone has: refused before it is believed.
    uint8_t header[33];
    memcpy(header, png, sizeof header);
    memcpy(header + 16, "\0\x01\0\0\0\x01\0\0", 8); // 65536 x 65536
    kept = quiet();
    prom_status huge = prom_image_read_memory(header, 33, "huge", 8, &w, &h, &rgba, &error);
    loud_again(kept);
    assert_int_equal(huge, PROM_ERR_INPUT);
    assert_int_equal(prom_image_read_memory("hello, world", 12, "x", 8, &w, &h, &rgba, &error),
                     PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "format"));
    assert_int_equal(prom_image_read(scene_path("absent.png"), 8, &w, &h, &rgba, &error),
                     PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "absent.png"));
    prom_free(png);
}

static void a_failed_write_leaves_nothing(void **state)
{
    (void)state;
    uint8_t pixels[4] = {1, 2, 3, 4};
    prom_error error;
    unsigned before = scene_folder_count();
    const char *path = scene_path("no/such/folder.png");
    assert_int_equal(prom_image_write_png(path, 1, 1, 4, pixels, &error), PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, "folder.png"));
    // The target is a folder: the rename fails and the temporary file goes.
    assert_int_equal(mkdir(scene_path("dir"), 0700), 0);
    assert_int_equal(prom_image_write_png(scene_path("dir"), 1, 1, 4, pixels, &error),
                     PROM_ERR_OUTPUT);
    assert_int_equal(rmdir(scene_path("dir")), 0);
    assert_int_equal(scene_folder_count(), before);
}

static void files_are_found_as_scenes_name_them(void **state)
{
    (void)state;
    scene_write("My Wood.PNG", "x");
    const char *scene = scene_path("scene.obj");
    static const char *const names[] = {"My Wood.PNG",    "my wood.png",
                                        ".\\MY WOOD.png", "D:\\work\\tex\\my wood.png",
                                        "My%20Wood.PNG",  "/home/someone/My Wood.PNG"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char *found = prom_file_find(scene, names[i]);
        assert_non_null(found);
        assert_non_null(strstr(found, "My Wood.PNG"));
        prom_free(found);
    }
    assert_null(prom_file_find(scene, "other.png"));
    assert_null(prom_file_find(scene, ""));
    assert_null(prom_file_find(scene, "/"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_png_comes_back_as_written),
        cmocka_unit_test(a_reduction_keeps_the_light),
        cmocka_unit_test(empty_texels_lend_no_color),
        cmocka_unit_test(broken_pictures_are_errors),
        cmocka_unit_test(a_failed_write_leaves_nothing),
        cmocka_unit_test(files_are_found_as_scenes_name_them),
    };
    return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}

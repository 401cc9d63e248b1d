// An X server for tests of windows: Xvfb on a free display, what its screen shows, and keys and
// mouse through xdotool.
#ifndef PROM_TESTS_X_SERVER_H
#define PROM_TESTS_X_SERVER_H

#include "tests/run_program.h"

#include "metaobj/base/alloc.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define X_SCREEN "640x400x24"

static pid_t x_server; // 0: not running
static char x_display[32];

static void stop(pid_t *program)
{
    if (*program <= 0) return;
    kill(*program, SIGTERM);
    waitpid(*program, NULL, 0);
    *program = 0;
}

static bool has_program(const char *name)
{
    char command[128];
    snprintf(command, sizeof command, "command -v %s > /dev/null 2>&1", name);
    return system(command) == 0;
}

// The first line that a shell command prints; empty without one.
static const char *ask(const char *command)
{
    static char line[512];
    line[0] = 0;
    FILE *pipe = popen(command, "r");
    if (!pipe) return line;
    if (!fgets(line, sizeof line, pipe)) line[0] = 0;
    pclose(pipe);
    line[strcspn(line, "\n")] = 0;
    return line;
}

static void xdotool(const char *arguments)
{
    char command[256];
    snprintf(command, sizeof command, "xdotool %s", arguments);
    assert_int_equal(system(command), 0);
}

// Starts the server with its screen in the working folder, and sets $DISPLAY. False when it
// does not start.
static bool start_server(void)
{
    int ends[2];
    char number[16] = "";
    if (pipe(ends) != 0) return false;
    snprintf(number, sizeof number, "%d", ends[1]);
    fflush(NULL);
    x_server = fork();
    if (x_server == 0) {
        close(ends[0]);
        redirect(1, "xvfb.log");
        redirect(2, "xvfb.log");
        execlp("Xvfb", "Xvfb", "-displayfd", number, "-screen", "0", X_SCREEN, "-fbdir", ".",
               "-nolisten", "tcp", "-noreset", (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    // A line once the server is ready, perhaps in pieces; the pipe's end if it has died.
    size_t length = 0;
    while (length < sizeof number - 1 && !memchr(number, '\n', length)) {
        ssize_t got = read(ends[0], number + length, sizeof number - 1 - length);
        if (got <= 0) break;
        length += (size_t)got;
    }
    close(ends[0]);
    if (!memchr(number, '\n', length)) return false;
    snprintf(x_display, sizeof x_display, ":%d", atoi(number));
    return setenv("DISPLAY", x_display, 1) == 0;
}

typedef struct picture {
    uint32_t width, height;
    uint8_t *rgba;
} picture;

static uint32_t xwd_word(const uint8_t *file, size_t word)
{
    const uint8_t *b = file + 4 * word;
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

// The top left corner of the server's screen, which it keeps as an XWD file: 25 big-endian
// words (XWDFile.h), colours of 12 bytes each, then rows of BGRX.
static picture read_screen(uint32_t width, uint32_t height)
{
    static uint8_t file[2 << 20];
    FILE *f = fopen("Xvfb_screen0", "rb");
    assert_non_null(f);
    size_t bytes = fread(file, 1, sizeof file, f);
    fclose(f);
    assert_true(bytes > 100);
    size_t start = xwd_word(file, 0) + 12 * (size_t)xwd_word(file, 19);
    size_t row = xwd_word(file, 12);
    assert_int_equal(xwd_word(file, 11), 32); // bits a pixel
    assert_true(start + row * height <= bytes && row >= 4 * (size_t)width);
    picture p = {width, height, prom_alloc((size_t)width * height, 4)};
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const uint8_t *from = file + start + row * y + 4 * (size_t)x;
            uint8_t *to = p.rgba + 4 * ((size_t)width * y + x);
            for (int k = 0; k < 3; k++) to[k] = from[2 - k];
            to[3] = 255;
        }
    return p;
}

#endif

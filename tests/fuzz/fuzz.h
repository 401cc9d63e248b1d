// What a fuzz target is: one source that takes bytes from anywhere and must not crash on them,
// and that knows a few good inputs to start from. libFuzzer links it with a search for new
// inputs (`make fuzz`); replay.c, in every build, runs the good inputs and some spoiled ones.
#ifndef PROM_TESTS_FUZZ_H
#define PROM_TESTS_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

// Gives each seed to `each`. It may be called many times.
void fuzz_seeds(void (*each)(void *user, const char *name, const void *bytes, size_t count),
                void *user);
// How many spoiled inputs of each seed a replay tries: by the time that one takes.
extern const unsigned fuzz_spoilings;

// Ends the program where a property of the subject does not hold.
#define fuzz_check(condition)                                                                  \
    do {                                                                                       \
        if (!(condition)) {                                                                    \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);            \
            abort();                                                                           \
        }                                                                                      \
    } while (0)

// A file that is in memory only, with a path to open it by.
typedef struct fuzz_file {
    int fd;
    char path[32];
} fuzz_file;

static inline fuzz_file fuzz_file_make(const void *bytes, size_t count)
{
    fuzz_file file = {.fd = memfd_create("fuzz", MFD_CLOEXEC)};
    fuzz_check(file.fd >= 0);
    for (size_t done = 0; done < count;) {
        ssize_t n = write(file.fd, (const char *)bytes + done, count - done);
        fuzz_check(n > 0);
        done += (size_t)n;
    }
    snprintf(file.path, sizeof file.path, "/proc/self/fd/%d", file.fd);
    return file;
}

#endif

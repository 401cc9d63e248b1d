// Runs a fuzz target without a fuzzer:
//     fuzz_NAME                  the target's seeds, each also spoiled in a fixed random way
//     fuzz_NAME FILE|FOLDER...   these inputs, as a fuzzer left them behind
//     fuzz_NAME --seeds FOLDER   writes the seeds into files
#include "fuzz.h"

#include <dirent.h>
#include <string.h>
#include <sys/stat.h>

static uint64_t inputs;

// A copy of exactly the input's size, so that a sanitizer sees every byte read past it.
static void run(const void *bytes, size_t count)
{
    uint8_t *copy = malloc(count ? count : 1);
    fuzz_check(copy);
    if (count) memcpy(copy, bytes, count);
    LLVMFuzzerTestOneInput(copy, count);
    free(copy);
    inputs++;
}

static uint32_t random_below(uint64_t *state, uint64_t n)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((*state >> 32) % n);
}

// Some bytes changed, most often near others that are not zero, and now and then cut short.
static size_t spoil(uint8_t *bytes, size_t count, uint64_t *state)
{
    for (uint32_t k = random_below(state, 4) + 1; k && count; k--) {
        size_t at = random_below(state, count);
        for (size_t left = count; left && !bytes[at]; left--) at = (at + 1) % count;
        at = (at + random_below(state, 2)) % count;
        switch (random_below(state, 3)) {
        case 0:
            bytes[at] ^= (uint8_t)(1u << random_below(state, 8));
            break;
        case 1:
            bytes[at] = (uint8_t)(random_below(state, 2) * 255);
            break;
        default:
            bytes[at] = (uint8_t)random_below(state, 256);
        }
    }
    return random_below(state, 16) || !count ? count : random_below(state, count);
}

static void run_seed(void *user, const char *name, const void *bytes, size_t count)
{
    (void)user, (void)name;
    run(bytes, count);
    uint64_t state = 1;
    uint8_t *copy = malloc(count ? count : 1);
    fuzz_check(copy);
    for (unsigned k = 0; k < fuzz_spoilings; k++) {
        if (count) memcpy(copy, bytes, count);
        run(copy, spoil(copy, count, &state));
    }
    free(copy);
}

static void write_seed(void *user, const char *name, const void *bytes, size_t count)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/seed-%s", (const char *)user, name);
    FILE *file = fopen(path, "wb");
    bool good = file && fwrite(bytes, 1, count, file) == count;
    if (file) good = !fclose(file) && good;
    if (good) return;
    perror(path);
    exit(1);
}

static void run_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    size_t count = 0, capacity = 1 << 16;
    uint8_t *bytes = malloc(capacity);
    if (!file || !bytes) {
        perror(path);
        exit(1);
    }
    for (size_t n; (n = fread(bytes + count, 1, capacity - count, file)) > 0;) {
        count += n;
        if (count < capacity) continue;
        capacity *= 2;
        bytes = realloc(bytes, capacity);
        fuzz_check(bytes);
    }
    fclose(file);
    run(bytes, count);
    free(bytes);
}

static void run_path(const char *path)
{
    DIR *folder = opendir(path);
    if (!folder) {
        run_file(path);
        return;
    }
    for (struct dirent *entry; (entry = readdir(folder));) {
        if (entry->d_name[0] == '.') continue;
        char inner[4096];
        snprintf(inner, sizeof inner, "%s/%s", path, entry->d_name);
        run_file(inner);
    }
    closedir(folder);
}

int main(int argc, char **argv)
{
    if (argc == 3 && !strcmp(argv[1], "--seeds")) {
        mkdir(argv[2], 0777);
        fuzz_seeds(write_seed, argv[2]);
        return 0;
    }
    for (int i = 1; i < argc; i++) run_path(argv[i]);
    if (argc == 1) fuzz_seeds(run_seed, NULL);
    printf("%llu inputs\n", (unsigned long long)inputs);
    return 0;
}

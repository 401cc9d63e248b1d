// LINK: prom_metaobj
// MAX: 2097152
// The container's reader: any bytes as a file. Most inputs end at a checksum; for what lies
// behind those see fuzz_container_rows.c.
#include "fuzz_read.h"

const unsigned fuzz_spoilings = 300;

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    fuzz_file file = fuzz_file_make(bytes, count);
    fuzz_read_container(file.path);
    close(file.fd);
    return 0;
}

void fuzz_seeds(void (*each)(void *user, const char *name, const void *bytes, size_t count),
                void *user)
{
    size_t count;
    uint8_t *bytes = fuzz_fixture(2, 2, &count);
    each(user, "fixture", bytes, count);
    each(user, "header", bytes, 65536);
    prom_free(bytes);
}

#include "builder/import_parts.h"

#include <stdlib.h>
#include <strings.h>

#define FLAG_BOTH_SIDES 0x20ul

// The lines "SURF 0x20" and the like. One such surface makes the whole file two-sided: to draw
// backs that nobody sees costs a little, to leave out those that somebody sees makes holes.
bool prom_import_ac3d_both_sides(const char *path)
{
    size_t n = strlen(path);
    bool found = false;
    char line[256];
    if (n < 3 || strcasecmp(path + n - 3, ".ac")) return false;
    FILE *file = fopen(path, "rb");
    while (file && !found && fgets(line, sizeof line, file))
        if (!strncmp(line, "SURF ", 5))
            found = (strtoul(line + 5, NULL, 16) & FLAG_BOTH_SIDES) != 0;
    if (file) fclose(file);
    return found;
}

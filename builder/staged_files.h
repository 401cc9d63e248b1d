// Files that belong together: all of them appear whole, or none does.
//
//   for each: prom_staged_open, print to it
//   prom_staged_finish
//
// Each is written as PATH.part; the last one opened, which may name the others, is renamed
// last.
#ifndef PROM_BUILDER_STAGED_FILES_H
#define PROM_BUILDER_STAGED_FILES_H

#include "metaobj/base/alloc.h"
#include "metaobj/base/status.h"

#include <stdio.h>

typedef struct prom_staged_file {
    char *path, *part;
    FILE *out;
} prom_staged_file;

// {0} to start with.
typedef struct prom_staged_files {
    PROM_ARRAY(prom_staged_file) files;
} prom_staged_files;

// To be written until the next call; not to be closed. NULL when it cannot be, with *error.
FILE *prom_staged_open(prom_staged_files *staged, const char *path, prom_error *error);
// `status`: that of the writing so far. With PROM_OK completes all files, else, or when that
// fails, removes them; what stood in their places before stays then, unless the fault comes
// between two renamings. Returns the first failure. *staged is {0} afterwards.
prom_status prom_staged_finish(prom_staged_files *staged, prom_status status,
                               prom_error *error);

#endif

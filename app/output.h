// Files that commands write: checked before the long work, then written whole or not at all.
#ifndef PROM_APP_OUTPUT_H
#define PROM_APP_OUTPUT_H

#include "metaobj/base/status.h"

#include <jansson.h>
#include <stddef.h>
#include <stdio.h>

enum { PROM_FILES_MAX = 4 };

// The files that a command names. NULL: not given.
typedef struct prom_command_files {
    const char *inputs[PROM_FILES_MAX];
    const char **outputs[PROM_FILES_MAX]; // the options themselves, see below
} prom_command_files;

// Before the long work: PROM_ERR_USAGE when an output is an input or another output under
// whatever name, PROM_ERR_OUTPUT unless a regular file can be written there. Leaves nothing.
// An output that is a symbolic link is replaced by what it leads to, so that renaming a
// finished file onto it keeps the link; that name lives as long as the program.
prom_status prom_outputs_check(const prom_command_files *files, prom_error *error);
// Makes a folder with its parents; fine when it is there already.
prom_status prom_output_make_folder(const char *path, prom_error *error);
// Writes PATH.part and renames it. `path` has been checked.
prom_status prom_output_write(const char *path, const char *text, size_t bytes,
                              prom_error *error);
// A longer text: begin, print to `out`, then end, which writes it the same way and frees it.
typedef struct prom_output_text {
    const char *path;
    FILE *out;
    char *text;
    size_t bytes;
} prom_output_text;
prom_status prom_output_begin_text(prom_output_text *file, const char *path, prom_error *error);
prom_status prom_output_end_text(prom_output_text *file, prom_error *error);
// The same for JSON, indented; takes the reference to `json`, also on failure.
prom_status prom_output_write_json(const char *path, json_t *json, prom_error *error);
// JSON values that cannot fail: null for what is not finite; bytes that are not UTF-8 as `?`.
json_t *prom_json_number(double value);
json_t *prom_json_text(const char *text);
// Prints JSON to stdout; takes the reference.
prom_status prom_output_print_json(json_t *json, prom_error *error);

#endif

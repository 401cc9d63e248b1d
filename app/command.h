// The subcommands of `promenade`. Each parses its own options (argp; a wrong one ends the
// program with exit code 1) and returns a prom_status, which is the exit code; on failure
// *error holds the one line for the user.
#ifndef PROM_APP_COMMAND_H
#define PROM_APP_COMMAND_H

#include "metaobj/base/status.h"

// argv[0] is the name for messages ("promenade build").
typedef prom_status (*prom_command_run)(int argc, char **argv, prom_error *error);

prom_status prom_command_build(int argc, char **argv, prom_error *error);
prom_status prom_command_info(int argc, char **argv, prom_error *error);
prom_status prom_command_shot(int argc, char **argv, prom_error *error);
prom_status prom_command_bench(int argc, char **argv, prom_error *error);
prom_status prom_command_walk(int argc, char **argv, prom_error *error);
prom_status prom_command_calibrate(int argc, char **argv, prom_error *error);
prom_status prom_command_compare(int argc, char **argv, prom_error *error);
prom_status prom_command_compare_mesh(int argc, char **argv, prom_error *error);
prom_status prom_command_simplify(int argc, char **argv, prom_error *error);
prom_status prom_command_scene(int argc, char **argv, prom_error *error);

typedef struct prom_command {
    const char *name, *arguments, *summary;
    prom_command_run run;
} prom_command;

// Runs the command that argv[1] names, with argv[0] joined to it. `prefix` is how the list of
// commands is called ("promenade", "promenade scene"). With --help prints the list (exit
// code 0); without argv[1] prints it to stderr, a usage error like an unknown name.
prom_status prom_command_dispatch(const char *prefix, const prom_command *commands,
                                  unsigned count, int argc, char **argv, prom_error *error);

#endif

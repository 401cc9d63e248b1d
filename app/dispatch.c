#include "app/command.h"

#include "metaobj/base/alloc.h"

#include <stdio.h>
#include <string.h>

static void print_list(FILE *to, const char *prefix, const prom_command *commands,
                       unsigned count)
{
    fprintf(to, "Usage: %s COMMAND [OPTION...]\n\nCommands:\n", prefix);
    for (unsigned i = 0; i < count; i++) {
        char usage[64];
        snprintf(usage, sizeof usage, "%s %s", commands[i].name, commands[i].arguments);
        fprintf(to, "  %-24s %s\n", usage, commands[i].summary);
    }
    fprintf(to, "\n`%s COMMAND --help` lists the options of a command.\n", prefix);
}

static const prom_command *find(const prom_command *commands, unsigned count, const char *name)
{
    for (unsigned i = 0; i < count; i++)
        if (!strcmp(commands[i].name, name)) return &commands[i];
    return NULL;
}

static prom_status run(const char *prefix, const prom_command *command, int argc, char **argv,
                       prom_error *error)
{
    char *name = prom_format("%s %s", prefix, command->name);
    argv[1] = name; // argp takes the name for its messages from here
    prom_status status = command->run(argc - 1, argv + 1, error);
    prom_free(name);
    return status;
}

prom_status prom_command_dispatch(const char *prefix, const prom_command *commands,
                                  unsigned count, int argc, char **argv, prom_error *error)
{
    if (argc < 2) {
        print_list(stderr, prefix, commands, count);
        return prom_fail(error, PROM_ERR_USAGE, "%s: which command?", prefix);
    }
    if (!strcmp(argv[1], "--help") || !strcmp(argv[1], "help")) {
        print_list(stdout, prefix, commands, count);
        return PROM_OK;
    }
    if (!strcmp(argv[1], "--version")) {
        printf("promenade %s\n", PROM_VERSION);
        return PROM_OK;
    }
    const prom_command *command = find(commands, count, argv[1]);
    if (command) return run(prefix, command, argc, argv, error);
    return prom_fail(error, PROM_ERR_USAGE,
                     "%s: there is no command `%s`; `%s --help` lists the commands", prefix,
                     argv[1], prefix);
}

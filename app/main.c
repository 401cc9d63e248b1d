// promenade: builds models from scenes and walks them within a frame time.
#include "app/command.h"

#include "metaobj/base/log.h"

#include <argp.h>
#include <stdio.h>

const char *argp_program_version = "promenade " PROM_VERSION;

static const prom_command commands[] = {
    {NULL, NULL, NULL, NULL},
};

int main(int argc, char **argv)
{
    argp_err_exit_status = PROM_ERR_USAGE;
    prom_error error = {0};
    prom_status status = prom_command_dispatch("promenade", commands, 0, argc, argv, &error);
    if (status != PROM_OK) prom_log(PROM_LOG_ERROR, "%s", error.text);
    return status;
}

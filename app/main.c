// promenade: builds models from scenes and walks them within a frame time.
#include "app/command.h"

#include "metaobj/base/log.h"

#include <argp.h>
#include <signal.h>
#include <stdio.h>

const char *argp_program_version = "promenade " PROM_VERSION;

static const prom_command commands[] = {
    {"build", "SCENE -o X.prom", "build a model from a scene", prom_command_build},
    {"info", "X.prom", "tell what a model holds", prom_command_info},
    {"shot", "X.prom -o A.png", "draw one picture", prom_command_shot},
    {"walk", "X.prom", "walk through a model in a window", prom_command_walk},
    {"bench", "X.prom", "walk a path within a time per frame", prom_command_bench},
    {"calibrate", "", "measure what drawing costs here", prom_command_calibrate},
    {"compare", "A B", "tell how different two pictures look", prom_command_compare},
    {"compare-mesh", "A B", "tell how far apart two meshes are", prom_command_compare_mesh},
    {"simplify", "IN -o OUT", "make a mesh of fewer triangles", prom_command_simplify},
    {"scene", "city|tile", "make a scene", prom_command_scene},
};

int main(int argc, char **argv)
{
    argp_err_exit_status = PROM_ERR_USAGE;
    // A file that grows past a limit is an error with a message, not the end of the process.
    signal(SIGXFSZ, SIG_IGN);
    prom_error error = {0};
    prom_status status = prom_command_dispatch(
        "promenade", commands, sizeof commands / sizeof *commands, argc, argv, &error);
    if (status != PROM_OK) prom_log(PROM_LOG_ERROR, "%s", error.text);
    // A full disk or a closed pipe shows only now.
    if (fflush(stdout) != 0 && status == PROM_OK) {
        prom_log(PROM_LOG_ERROR, "stdout: cannot be written");
        status = PROM_ERR_OUTPUT;
    }
    return status;
}

// promenade build: from a scene file to a model.
#include "app/build_options.h"
#include "app/command.h"
#include "app/output.h"

#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"
#include "metaobj/base/stop.h"
#include "metaobj/base/threads.h"
#include "traverse/cost.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// A profile that cannot be used is to be known now, not after the build.
static prom_status check_profile(const char *profile, prom_error *error)
{
    prom_cost_model unused;
    return profile ? prom_cost_load(profile, &unused, error) : PROM_OK;
}

// Of the cells that eyes are spread for: those that are made may be larger.
static double cell_size(const prom_build_command *o)
{
    return o->cells.cell_size > 0 ? o->cells.cell_size : PROM_VIEW_CELL_SIZE;
}

// Camera paths are read now too.
static prom_status check_where(prom_build_command *o, prom_error *error)
{
    prom_status status = PROM_OK;
    for (size_t i = 0; i < o->where.files.count && !status; i++) {
        prom_command_files files = {{o->where.files.data[i]}, {&o->output}};
        status = prom_outputs_check(&files, error);
    }
    return status ? status : prom_where_eyes_of_paths(&o->where, cell_size(o), error);
}

static prom_status check_files(prom_build_command *o, prom_error *error)
{
    struct stat scene;
    if (stat(o->scene, &scene) != 0)
        return prom_fail(error, PROM_ERR_INPUT, "%s: cannot be read: %m", o->scene);
    if (!S_ISREG(scene.st_mode))
        return prom_fail(error, PROM_ERR_INPUT, "%s: is not a file", o->scene);
    prom_command_files files = {{o->scene, o->build.profile}, {&o->output}};
    prom_status status = prom_outputs_check(&files, error);
    if (!status) status = check_profile(o->build.profile, error);
    return status ? status : check_where(o, error);
}

static void print_view_cells(const prom_view_cells_report *c)
{
    printf("view cells       %12" PRIu32 "  (of %.3g m, from %" PRIu64 " eyes in %.1f s, "
           "%.1f KiB; show %.0f %% of the leaves on average)\n",
           c->cells, c->cell_size, c->eyes, c->seconds, (double)c->bytes / 1024,
           100 * c->mean_share);
}

static void print_report(const prom_build_command *o, const prom_build_report *r,
                         const prom_view_cells_report *cells, double seconds)
{
    double triangles = (double)(r->source_triangles ? r->source_triangles : 1);
    printf("%s: built in %.1f s\n", o->output, seconds);
    printf("triangles        %12" PRIu64 "\n", r->source_triangles);
    printf("objects          %12" PRIu32 "\n", r->objects);
    printf("prototypes       %12" PRIu32 "\n", r->prototypes);
    printf("nodes            %12" PRIu32 "  (most children: %" PRIu32 ")\n", r->nodes,
           r->max_children);
    printf("representations  %12" PRIu32 "\n", r->representations);
    if (r->views_taken)
        printf("views taken      %12" PRIu32 "  (prototypes measured in kept pictures)\n",
               r->views_taken);
    if (o->where.kind) print_view_cells(cells);
    printf("file             %12.1f MiB (%.0f bytes a triangle)\n",
           (double)r->file_bytes / (1 << 20), (double)r->file_bytes / triangles);
    if (r->work_bytes)
        printf("work file        %12.1f MiB (makes the next build of this model quick)\n",
               (double)r->work_bytes / (1 << 20));
    printf("peak memory      %12.1f MiB\n", (double)r->peak_bytes / (1 << 20));
}

// The software rasteriser has threads of its own, by default one for each core.
static void use_jobs(unsigned jobs)
{
    char text[16];
    prom_thread_set_count(jobs);
    snprintf(text, sizeof text, "%u", jobs == 1 ? 0 : jobs);
    setenv("LP_NUM_THREADS", text, 0);
}

static volatile sig_atomic_t stop_signal;

static void stop(int signal_number)
{
    stop_signal = signal_number;
    prom_stop_request();
}

// The first such signal ends the build cleanly, a second one the process.
static void stop_on_signals(void)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        struct sigaction action = {.sa_handler = stop, .sa_flags = SA_RESTART | SA_RESETHAND};
        struct sigaction before;
        if (!sigaction(signals[i], NULL, &before) && before.sa_handler != SIG_IGN) // nohup
            sigaction(signals[i], &action, NULL);
    }
}

// Ends by the signal itself, as those who wait for the process expect: a shell ends its loop.
static prom_status end_stopped(const prom_error *error)
{
    prom_log(PROM_LOG_ERROR, "%s", error->text);
    signal(stop_signal, SIG_DFL);
    raise(stop_signal);
    return error->status;
}

// The model is in place then; whatever happens now, it stays.
static prom_status build_view_cells(prom_build_command *o, prom_build_report *report,
                                    prom_view_cells_report *cells, prom_error *error)
{
    prom_eyes *eyes = &o->where.eyes;
    o->cells.anew = o->build.from != PROM_BUILD_FROM_NOWHERE;
    prom_status status = prom_where_eyes_of_model(&o->where, o->output, cell_size(o), error);
    if (!status)
        status = prom_view_cells_build(o->output, (const double(*)[3])eyes->data, eyes->count,
                                       &o->cells, cells, error);
    if (status && status != PROM_ERR_STOPPED)
        prom_log(PROM_LOG_WARNING, "%s is there, without view cells", o->output);
    report->file_bytes = cells->file_bytes;
    report->work_bytes = cells->work_bytes;
    return status;
}

static prom_status build(prom_build_command *o, prom_error *error)
{
    double start = prom_clock_ms();
    prom_build_report report = {0};
    prom_view_cells_report cells = {0};
    if (o->where.kind) { // the last step drops the work
        o->build.view_cells_follow = true;
        o->cells.drop_work = o->build.drop_work;
        o->build.drop_work = false;
    }
    prom_status status = prom_build(o->scene, o->output, &o->build, &report, error);
    if (!status && o->where.kind) status = build_view_cells(o, &report, &cells, error);
    if (status) return status;
    print_report(o, &report, &cells, (prom_clock_ms() - start) / 1000.0);
    return PROM_OK;
}

prom_status prom_command_build(int argc, char **argv, prom_error *error)
{
    prom_build_command o = {0};
    argp_parse(&prom_argp_build, argc, argv, 0, NULL, &o);
    if (o.build.tree.octree == PROM_OCTREE_STRICT && !o.build.tree.divisions[0])
        memcpy(o.build.tree.divisions, (uint32_t[]){16, 1, 16}, sizeof o.build.tree.divisions);
    prom_status status = check_files(&o, error);
    if (!status) {
        if (o.jobs) use_jobs(o.jobs);
        stop_on_signals();
        status = build(&o, error);
    }
    prom_where_finish(&o.where);
    return status == PROM_ERR_STOPPED ? end_stopped(error) : status;
}

#include "app/bench_csv.h"

#include "app/budget_use.h"
#include "app/output.h"
#include "app/statistics.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// An empty field where a frame was not compared.
static void put_share(FILE *out, bool checked, double share)
{
    if (checked)
        fprintf(out, ",%.6f", share);
    else
        fputc(',', out);
}

static void put_guarantee(FILE *out, double start_unix_s, const prom_frame_record *r)
{
    fprintf(out, ",%.2f,%d", r->resolution, r->limited);
    put_share(out, !isnan(r->gap), r->gap);
    fprintf(out, ",%.4f,%.4f,%.4f,%.4f,%016" PRIx64, r->allowed_ms, r->scale, r->margin,
            start_unix_s + r->start_ms / 1000, r->cut_hash);
}

static void put_row(FILE *out, size_t frame, double budget_ms, double start_unix_s,
                    const prom_frame_record *r)
{
    fprintf(out, "%zu,%.4f,%g,%.4f,%.4f,%.4f,%.0f,%.0f,%u,%u,%.1f,%.1f,%d", frame, r->t_s,
            budget_ms, r->frame_ms, r->select_ms, r->predicted_ms, r->triangles, r->draws,
            r->cut_nodes, r->switches.count, r->benefit_px, r->loss_px, r->feasible);
    fprintf(out, ",%d", prom_is_contested(r));
    put_guarantee(out, start_unix_s, r);
    const prom_difference *d = &r->difference;
    bool quality = d->found & PROM_COMPARE_QUALITY;
    put_share(out, d->found & PROM_COMPARE_HOLES, d->holes);
    put_share(out, d->found & PROM_COMPARE_ACCURACY, d->accuracy);
    put_share(out, true, prom_predicted_accuracy(r));
    put_share(out, quality, d->flip);
    put_share(out, quality, d->loss);
    put_share(out, quality, d->hidden_cost);
    put_share(out, quality, d->hidden_nodes);
    fputc('\n', out);
}

prom_status prom_bench_write_csv(const char *path, const prom_loop_options *options,
                                 const prom_loop_result *result, prom_error *error)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *out = open_memstream(&text, &bytes);
    if (!out) return prom_fail(error, PROM_ERR_OUTPUT, "%s: %s", path, strerror(errno));
    fputs("frame,t_s,budget_ms,frame_ms,select_ms,predicted_ms,triangles,draws,cut_nodes,"
          "switches,benefit_px,loss_px,feasible,contested,resolution_scale,limited,gap,allowed_ms,"
          "scale,margin,start_unix_s,cut_hash,holes,accuracy,predicted_accuracy,flip,loss,"
          "hidden_cost,"
          "hidden_nodes\n",
          out);
    for (size_t i = 0; i < result->frames.count; i++)
        put_row(out, i, options->budget_ms, result->start_unix_s, &result->frames.data[i]);
    prom_status status = PROM_OK;
    if (fclose(out) != 0)
        status = prom_fail(error, PROM_ERR_OUTPUT, "%s: %s", path, strerror(errno));
    else
        status = prom_output_write(path, text, bytes, error);
    free(text); // from the C library
    return status;
}

#include "app/bench_report.h"

#include "app/statistics.h"
#include "app/swap_report.h"
#include "metaobj/base/threads.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *spread_json(const prom_spread *spread)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "mean", prom_json_number(spread->mean),
                     "p50", prom_json_number(spread->p50), "p95", prom_json_number(spread->p95),
                     "p99", prom_json_number(spread->p99), "max", prom_json_number(spread->max),
                     "std", prom_json_number(spread->std));
}

static json_t *pair_json(const char *a, double x, const char *b, double y)
{
    return json_pack("{s:o, s:o}", a, prom_json_number(x), b, prom_json_number(y));
}

static json_t *mean_json(double mean)
{
    return json_pack("{s:o}", "mean", prom_json_number(mean));
}

static json_t *device_json(const prom_session *session)
{
    const prom_context *context = session->context;
    return json_pack("{s:o, s:o, s:b, s:i}", "renderer",
                     prom_json_text(prom_context_renderer(context)), "gl_version",
                     prom_json_text(prom_context_version(context)), "software",
                     (int)prom_context_is_software(context), "cores", (int)prom_thread_count());
}

static json_t *holes_json(const prom_run_statistics *t)
{
    if (!t->hole_frames) return json_null(); // not asked for
    return json_pack("{s:i, s:o, s:o}", "frames", (int)t->hole_frames, "mean",
                     prom_json_number(t->holes_mean), "max", prom_json_number(t->holes_max));
}

static json_t *accuracy_json(const prom_run_statistics *t)
{
    if (!t->accuracy_frames) return json_null(); // not asked for
    return json_pack("{s:i, s:o, s:o, s:o}", "frames", (int)t->accuracy_frames, "mean",
                     prom_json_number(t->accuracy_mean), "min",
                     prom_json_number(t->accuracy_min), "predicted",
                     prom_json_number(t->predicted_accuracy));
}

static json_t *quality_json(const prom_run_statistics *t, double ppd)
{
    if (!t->quality_frames) return json_null(); // not asked for
    return json_pack("{s:s, s:o, s:i, s:o, s:o, s:o, s:o, s:o}", "metric", "flip", "ppd",
                     prom_json_number(ppd), "frames", (int)t->quality_frames, "mean",
                     prom_json_number(t->flip.mean), "p95", prom_json_number(t->flip.p95),
                     "loss", prom_json_number(t->loss_share), "hidden_cost",
                     prom_json_number(t->hidden_cost), "hidden_nodes",
                     prom_json_number(t->hidden_nodes));
}

static void set(json_t *object, const char *key, json_t *value)
{
    json_object_set_new(object, key, value);
}

static void set_what(json_t *run, const prom_run_facts *f)
{
    const prom_session *s = f->session;
    set(run, "scene", prom_json_text(f->scene));
    set(run, "path", prom_json_text(f->path));
    set(run, "frames", json_integer((json_int_t)f->result->frames.count));
    set(run, "warmup_frames", json_integer(f->options->warmup));
    set(run, "resolution", json_pack("[i, i]", (int)s->camera.width, (int)s->camera.height));
    set(run, "budget_ms", prom_json_number(f->options->budget_ms));
    set(run, "selector", prom_json_text(f->options->selector));
    set(run, "visibility", prom_json_text(prom_visibility_mode_name(s->visibility)));
    char weights[PROM_WEIGHT_NAMES_BYTES];
    set(run, "weights", prom_json_text(prom_weight_names(s->choice.weights, weights)));
    set(run, "order", prom_json_text(prom_order_name(s->choice.order)));
    set(run, "hysteresis", prom_json_number(s->choice.hysteresis));
    set(run, "device", device_json(s));
    set(run, "program", prom_json_text("promenade " PROM_VERSION));
}

static void set_found(json_t *run, const prom_run_facts *f, const prom_run_statistics *t)
{
    const prom_loop_result *r = f->result;
    set(run, "frame_ms", spread_json(&t->frame_ms));
    set(run, "miss_rate", prom_json_number(t->miss_rate));
    set(run, "misses",
        json_pack("{s:i, s:i}", "count", (int)t->misses, "longest_run",
                  (int)t->longest_misses));
    set(run, "use_of_budget", prom_json_number(t->use_of_budget));
    set(run, "select_ms", pair_json("mean", t->select_ms.mean, "p99", t->select_ms.p99));
    set(run, "triangles", mean_json(t->triangles));
    set(run, "draws", mean_json(t->draws));
    set(run, "cut_nodes", mean_json(t->cut_nodes));
    set(run, "switches", pair_json("mean", t->switches, "px", t->switched_px));
    set(run, "benefit", mean_json(t->benefit_px));
    set(run, "loss", mean_json(t->loss_px));
    set(run, "predict", pair_json("mape", t->mape, "worst_under", t->worst_under));
    set(run, "infeasible_frames", json_integer(r->infeasible_frames));
    set(run, "least_budget_ms",
        r->infeasible_frames ? prom_json_number(r->least_budget_ms) : json_null());
    set(run, "holes", holes_json(t));
    set(run, "accuracy", accuracy_json(t));
    set(run, "quality", quality_json(t, prom_session_ppd(f->session)));
    set(run, "swap", f->swap ? prom_swap_json(f->swap) : json_null());
    set(run, "oracle", f->oracle ? prom_oracle_json(f->oracle) : json_null());
    set(run, "start_s", prom_json_number(f->session->start_s));
    set(run, "calibration_s", prom_json_number(f->session->calibration_s));
    set(run, "memory_mb", pair_json("start", r->memory_start_mb, "end", r->memory_end_mb));
}

static prom_run_statistics statistics(const prom_run_facts *f)
{
    return prom_run_statistics_of(f->result->frames.data, f->result->frames.count,
                                  f->options->budget_ms);
}

json_t *prom_bench_json(const prom_run_facts *facts)
{
    prom_run_statistics t = statistics(facts);
    json_t *run = json_object();
    set_what(run, facts);
    set_found(run, facts, &t);
    return json_pack("{s:[o]}", "runs", run);
}

// An empty field where a frame was not compared.
static void put_share(FILE *out, bool checked, double share)
{
    if (checked)
        fprintf(out, ",%.6f", share);
    else
        fputc(',', out);
}

static void put_row(FILE *out, size_t frame, double budget_ms, const prom_frame_record *r)
{
    fprintf(out, "%zu,%.4f,%g,%.4f,%.4f,%.4f,%.0f,%.0f,%u,%u,%.1f,%.1f,%d", frame, r->t_s,
            budget_ms, r->frame_ms, r->select_ms, r->predicted_ms, r->triangles, r->draws,
            r->cut_nodes, r->switches.count, r->benefit_px, r->loss_px, r->feasible);
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
          "switches,benefit_px,loss_px,feasible,holes,accuracy,predicted_accuracy,flip,loss,"
          "hidden_cost,"
          "hidden_nodes\n",
          out);
    for (size_t i = 0; i < result->frames.count; i++)
        put_row(out, i, options->budget_ms, &result->frames.data[i]);
    prom_status status = PROM_OK;
    if (fclose(out) != 0)
        status = prom_fail(error, PROM_ERR_OUTPUT, "%s: %s", path, strerror(errno));
    else
        status = prom_output_write(path, text, bytes, error);
    free(text); // from the C library
    return status;
}

void prom_bench_print(const prom_run_facts *facts)
{
    const prom_loop_result *r = facts->result;
    prom_run_statistics t = statistics(facts);
    printf("scene      %s, path %s, %zu frames at %ux%u\n", facts->scene, facts->path,
           r->frames.count, facts->session->camera.width, facts->session->camera.height);
    printf("selector   %s, budget %g ms, visibility %s\n", facts->options->selector,
           facts->options->budget_ms, prom_visibility_mode_name(facts->session->visibility));
    printf("frame      mean %.1f ms, p50 %.1f, p95 %.1f, p99 %.1f, max %.1f, std %.1f\n",
           t.frame_ms.mean, t.frame_ms.p50, t.frame_ms.p95, t.frame_ms.p99, t.frame_ms.max,
           t.frame_ms.std);
    printf("misses     %.1f %% (%u, longest run %u), use of budget %.0f %%\n",
           100 * t.miss_rate, t.misses, t.longest_misses, 100 * t.use_of_budget);
    printf("select     mean %.2f ms, p99 %.2f\n", t.select_ms.mean, t.select_ms.p99);
    printf("drawn      %.0f triangles, %.0f nodes; loss %.0f px of %.0f\n", t.triangles,
           t.cut_nodes, t.loss_px, t.loss_px + t.benefit_px);
    printf("switched   %.1f nodes a frame, of %.0f px\n", t.switches, t.switched_px);
    printf("predicted  mean error %.1f %%, worst under-estimate %.0f %%\n", 100 * t.mape,
           100 * t.worst_under);
    if (t.hole_frames)
        printf("holes      mean %.3f %%, max %.3f %% of covered pixels in %u frames\n",
               100 * t.holes_mean, 100 * t.holes_max, t.hole_frames);
    if (t.accuracy_frames)
        printf("accuracy   mean %.2f %%, min %.2f %% in %u frames, predicted mean %.2f %%\n",
               100 * t.accuracy_mean, 100 * t.accuracy_min, t.accuracy_frames,
               100 * t.predicted_accuracy);
    if (t.quality_frames) {
        printf("quality    FLIP mean %.4f, p95 %.4f at %.2f pixels a degree in %u frames\n",
               t.flip.mean, t.flip.p95, prom_session_ppd(facts->session), t.quality_frames);
        printf("visible    %.2f %% of the pixels lost; hidden: %.1f %% of the cost, %.1f %% of "
               "the nodes\n",
               100 * t.loss_share, 100 * t.hidden_cost, 100 * t.hidden_nodes);
    }
    if (facts->swap) prom_swap_print(facts->swap);
    if (facts->oracle) prom_oracle_print(facts->oracle);
    printf("start      %.1f s, memory %.0f MiB, at the end %.0f\n", facts->session->start_s,
           r->memory_start_mb, r->memory_end_mb);
}

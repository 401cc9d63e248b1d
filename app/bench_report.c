#include "app/bench_report.h"

#include "app/guarantee_report.h"
#include "app/statistics.h"
#include "app/swap_report.h"
#include "metaobj/base/threads.h"

#include <stdio.h>

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

static json_t *popping_json(const prom_run_statistics *t)
{
    if (!t->popping_frames) return json_null(); // not asked for
    const prom_popped *p = &t->popped;
    return json_pack("{s:i, s:o, s:o, s:o, s:o}", "frames", (int)t->popping_frames, "flip",
                     prom_json_number(p->flip), "floor", prom_json_number(p->floor), "popping",
                     prom_json_number(p->flip - p->floor), "valid_share",
                     prom_json_number(p->valid_share));
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
    set(run, "max_switches", json_integer(s->choice.max_switches));
    set(run, "device", device_json(s));
    set(run, "program", prom_json_text("promenade " PROM_VERSION));
}

static void set_found(json_t *run, const prom_run_facts *f, const prom_run_statistics *t)
{
    const prom_loop_result *r = f->result;
    set(run, "select_ms", pair_json("mean", t->select_ms.mean, "p99", t->select_ms.p99));
    set(run, "triangles", mean_json(t->triangles));
    set(run, "resolution_scale", mean_json(t->resolution));
    set(run, "draws", mean_json(t->draws));
    set(run, "cut_nodes", mean_json(t->cut_nodes));
    set(run, "switches", pair_json("mean", t->switches, "px", t->switched_px));
    set(run, "benefit", mean_json(t->benefit_px));
    set(run, "loss", mean_json(t->loss_px));
    set(run, "predicted_ms", pair_json("mean", t->predicted_ms.mean, "p99", t->predicted_ms.p99));
    set(run, "predict", pair_json("mape", t->mape, "worst_under", t->worst_under));
    set(run, "infeasible_frames", json_integer(r->infeasible_frames));
    set(run, "least_budget_ms",
        r->infeasible_frames ? prom_json_number(r->least_budget_ms) : json_null());
    set(run, "holes", holes_json(t));
    set(run, "accuracy", accuracy_json(t));
    set(run, "quality", quality_json(t, prom_session_ppd(f->session)));
    set(run, "popping", popping_json(t));
    set(run, "swap", f->swap ? prom_swap_json(f->swap) : json_null());
    set(run, "oracle", f->oracle ? prom_oracle_json(f->oracle) : json_null());
    set(run, "start_s", prom_json_number(f->session->start_s));
    set(run, "calibration_s", prom_json_number(f->session->calibration_s));
    set(run, "memory_mb", pair_json("start", r->memory_start_mb, "end", r->memory_end_mb));
}

static prom_budget_report budget_report(const prom_run_facts *f)
{
    return prom_budget_report_of(f->result, f->options->budget_ms);
}

static prom_run_statistics statistics(const prom_run_facts *f)
{
    return prom_run_statistics_of(f->result->frames.data, f->result->frames.count);
}

json_t *prom_bench_json(const prom_run_facts *facts)
{
    prom_run_statistics t = statistics(facts);
    prom_budget_report budget = budget_report(facts);
    json_t *run = json_object();
    set_what(run, facts);
    prom_guarantee_add_json(run, facts, &budget);
    set_found(run, facts, &t);
    return json_pack("{s:[o]}", "runs", run);
}

void prom_bench_print(const prom_run_facts *facts)
{
    const prom_loop_result *r = facts->result;
    prom_run_statistics t = statistics(facts);
    prom_budget_report budget = budget_report(facts);
    printf("scene      %s, path %s, %zu frames at %ux%u\n", facts->scene, facts->path,
           r->frames.count, facts->session->camera.width, facts->session->camera.height);
    printf("selector   %s, budget %g ms, visibility %s\n", facts->options->selector,
           facts->options->budget_ms, prom_visibility_mode_name(facts->session->visibility));
    prom_guarantee_print(facts, &budget);
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
    if (t.popping_frames)
        printf("popping    FLIP %.4f, of full detail %.4f: %+.4f; %.1f %% of the pixels in %u "
               "frames\n",
               t.popped.flip, t.popped.floor, t.popped.flip - t.popped.floor,
               100 * t.popped.valid_share, t.popping_frames);
    if (facts->swap) prom_swap_print(facts->swap);
    if (facts->oracle) prom_oracle_print(facts->oracle);
    printf("start      %.1f s, memory %.0f MiB, at the end %.0f\n", facts->session->start_s,
           r->memory_start_mb, r->memory_end_mb);
}

#include "app/calibration_report.h"

#include "app/output.h"
#include "app/scatter.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

static const char *const form_names[PROM_COST_FORMS] = {"sum", "max"};

// What a sample draws: a kind of pixels, or
enum { BINDS = PROM_COST_KINDS, UPLOADS, EMPTY, GROUPS };

static const char *const group_names[GROUPS] = {"plain",   "textured", "masked",
                                                "blended", "impostor", "lit impostor",
                                                "binds",   "uploads",  "empty"};
_Static_assert(GROUPS <= PROM_SCATTER_GROUPS, "each has a colour");

static uint32_t group_of(const prom_cost_sample *sample)
{
    const prom_cost_features *f = &sample->features;
    if (f->upload_bytes > 0) return UPLOADS;
    if (f->binds > 1) return BINDS;
    for (uint32_t k = 0; k < PROM_COST_KINDS; k++)
        if (f->pixels[k] > 0) return k;
    return EMPTY;
}

// A coefficient as it is shown: times `factor`, in `unit`.
typedef struct coefficient {
    const char *name, *unit;
    size_t offset; // in prom_cost_model
    double factor;
} coefficient;

#define COEFFICIENT(name, unit, field, factor)                                                 \
    {                                                                                          \
        name, unit, offsetof(prom_cost_model, field), factor                                   \
    }
static const coefficient coefficients[] = {
    COEFFICIENT("frame", "ms", fixed_ms, 1),
    COEFFICIENT("bind", "us", bind_ms, 1e3),
    COEFFICIENT("uploading", "us", uploading_ms, 1e3),
    COEFFICIENT("upload", "us/MB", upload_ms, 1e9),
    COEFFICIENT("draw", "us", draw_ms, 1e3),
    COEFFICIENT("vertex", "ns", vertex_ms, 1e6),
    COEFFICIENT("triangle", "ns", triangle_ms, 1e6),
    COEFFICIENT("edge", "ns", edge_ms, 1e6),
    COEFFICIENT("hidden edge", "ns", hidden_edge_ms, 1e6),
    COEFFICIENT("plain pixel", "ns", pixel_ms[PROM_SHADE_PLAIN], 1e6),
    COEFFICIENT("textured pixel", "ns", pixel_ms[PROM_SHADE_TEXTURED], 1e6),
    COEFFICIENT("masked pixel", "ns", pixel_ms[PROM_SHADE_MASKED], 1e6),
    COEFFICIENT("blended pixel", "ns", pixel_ms[PROM_SHADE_BLENDED], 1e6),
    COEFFICIENT("impostor pixel", "ns", pixel_ms[PROM_SHADE_IMPOSTOR], 1e6),
    COEFFICIENT("lit impostor pixel", "ns", pixel_ms[PROM_COST_IMPOSTOR_LIT], 1e6),
    COEFFICIENT("hidden pixel", "ns", hidden_pixel_ms, 1e6),
};
enum { COEFFICIENTS = sizeof coefficients / sizeof *coefficients };

static double value_of(const prom_cost_model *model, const coefficient *c)
{
    double ms;
    memcpy(&ms, (const char *)model + c->offset, sizeof ms);
    return ms * c->factor;
}

static double mean_error(const prom_cost_samples *samples, const double *predicted_ms)
{
    double sum = 0;
    for (size_t i = 0; i < samples->count; i++)
        sum += fabs(predicted_ms[i] / samples->data[i].ms - 1);
    return samples->count ? sum / (double)samples->count : 0;
}

void prom_calibration_report_init(prom_calibration_report *report, const prom_cost_model *model,
                                  const prom_cost_samples *samples)
{
    *report = (prom_calibration_report){.model = model, .samples = samples};
    report->held_out_ms = prom_alloc(samples->count, sizeof *report->held_out_ms);
    // The model's own form last: its predictions stay.
    for (int i = 1; i <= PROM_COST_FORMS; i++) {
        prom_cost_form form = (prom_cost_form)(((int)model->form + i) % PROM_COST_FORMS);
        prom_cost_held_out(samples->data, samples->count, form, report->held_out_ms);
        report->form_errors[form] = mean_error(samples, report->held_out_ms);
    }
}

void prom_calibration_report_finish(prom_calibration_report *report)
{
    prom_free(report->held_out_ms);
    *report = (prom_calibration_report){0};
}

// ---- errors by group

typedef struct group_errors {
    size_t samples;
    double mean, bias, worst_under, worst_over; // of predicted/measured - 1; under: the inverse
} group_errors;

static group_errors errors_of(const prom_calibration_report *r, uint32_t group)
{
    group_errors e = {0};
    for (size_t i = 0; i < r->samples->count; i++) {
        const prom_cost_sample *s = &r->samples->data[i];
        if (group_of(s) != group) continue;
        double error = r->held_out_ms[i] / s->ms - 1;
        e.samples++;
        e.mean += fabs(error);
        e.bias += error;
        e.worst_over = fmax(e.worst_over, error);
        if (r->held_out_ms[i] > 0)
            e.worst_under = fmax(e.worst_under, s->ms / r->held_out_ms[i] - 1);
    }
    if (e.samples) e.mean /= (double)e.samples;
    if (e.samples) e.bias /= (double)e.samples;
    return e;
}

void prom_calibration_print(const prom_calibration_report *report)
{
    const prom_cost_model *m = report->model;
    printf("device       %s\n", m->renderer);
    printf("clock        %s\n",
           report->queries ? "the device's timer" : "wall clock around a finish");
    printf("samples      %u at %ux%u, taken in %.1f s\n", m->sample_count, m->width, m->height,
           report->seconds);
    printf("form         %s (mean error %.1f %% as a sum, %.1f %% as a maximum)\n",
           form_names[m->form], 100 * report->form_errors[PROM_COST_SUM],
           100 * report->form_errors[PROM_COST_MAX]);
    for (int i = 0; i < COEFFICIENTS; i++)
        printf("%-18s %10.4f %s\n", coefficients[i].name, value_of(m, &coefficients[i]),
               coefficients[i].unit);
    printf("errors on samples that the fit had not seen\n"
           "  %-14s %7s %7s %7s %11s %11s\n",
           "", "samples", "mean", "bias", "worst under", "worst over");
    for (uint32_t g = 0; g < GROUPS; g++) {
        group_errors e = errors_of(report, g);
        if (e.samples)
            printf("  %-14s %7zu %5.1f %% %5.1f %% %9.1f %% %9.1f %%\n", group_names[g],
                   e.samples, 100 * e.mean, 100 * e.bias, 100 * e.worst_under,
                   100 * e.worst_over);
    }
    printf("mean error   %10.1f %%\n", 100 * m->mean_error);
    printf("worst under  %10.1f %%\n", 100 * m->worst_under);
    printf("margin       %10.1f %%\n", 100 * m->margin);
}

static json_t *group_json(const group_errors *e)
{
    return json_pack("{s:I, s:o, s:o, s:o, s:o}", "samples", (json_int_t)e->samples,
                     "mean_error", prom_json_number(e->mean), "bias", prom_json_number(e->bias),
                     "worst_under", prom_json_number(e->worst_under), "worst_over",
                     prom_json_number(e->worst_over));
}

// A key of JSON: a name, then its unit.
static void set_value(json_t *object, const char *name, const char *unit, json_t *value)
{
    char *key = unit ? prom_format("%s_%s", name, unit) : prom_strdup(name);
    for (char *c = key; *c; c++)
        if (*c == ' ' || *c == '/') *c = '_';
    json_object_set_new(object, key, value);
    prom_free(key);
}

json_t *prom_calibration_json(const prom_calibration_report *report)
{
    const prom_cost_model *m = report->model;
    json_t *values = json_object(), *groups = json_object();
    for (int i = 0; i < COEFFICIENTS; i++)
        set_value(values, coefficients[i].name, coefficients[i].unit,
                  prom_json_number(value_of(m, &coefficients[i])));
    for (uint32_t g = 0; g < GROUPS; g++) {
        group_errors e = errors_of(report, g);
        set_value(groups, group_names[g], NULL, group_json(&e));
    }
    return json_pack(
        "{s:o, s:s, s:i, s:i, s:I, s:o, s:s, s:{s:o, s:o}, s:o, s:o, s:o, s:o, s:o}", "device",
        prom_json_text(m->renderer), "clock", report->queries ? "device" : "wall", "width",
        (int)m->width, "height", (int)m->height, "samples", (json_int_t)m->sample_count,
        "taken_s", prom_json_number(report->seconds), "form", form_names[m->form],
        "form_mean_error", "sum", prom_json_number(report->form_errors[PROM_COST_SUM]), "max",
        prom_json_number(report->form_errors[PROM_COST_MAX]), "mean_error",
        prom_json_number(m->mean_error), "worst_under", prom_json_number(m->worst_under),
        "margin", prom_json_number(m->margin), "coefficients", values, "errors", groups);
}

// ---- files

prom_status prom_calibration_write_residuals(const prom_calibration_report *report,
                                             const char *path, prom_error *error)
{
    prom_output_text file;
    prom_status status = prom_output_begin_text(&file, path, error);
    if (status) return status;
    fputs("sample,drawn,draws,vertices,triangles,binds,upload_bytes,edges,hidden_edges,"
          "hidden_px,plain_px,textured_px,masked_px,blended_px,impostor_px,impostor_lit_px,"
          "measured_ms,predicted_ms,held_out_ms\n",
          file.out);
    for (size_t i = 0; i < report->samples->count; i++) {
        const prom_cost_sample *s = &report->samples->data[i];
        const prom_cost_features *f = &s->features;
        fprintf(file.out, "%zu,\"%s\",%.0f,%.0f,%.0f,%.0f,%.0f,%.1f,%.1f,%.0f", i,
                group_names[group_of(s)], f->draws, f->vertices, f->triangles, f->binds,
                f->upload_bytes, f->edges, f->hidden_edges, f->hidden);
        for (int k = 0; k < PROM_COST_KINDS; k++) fprintf(file.out, ",%.0f", f->pixels[k]);
        fprintf(file.out, ",%.5f,%.5f,%.5f\n", s->ms, prom_cost_predict(report->model, f),
                report->held_out_ms[i]);
    }
    return prom_output_end_text(&file, error);
}

prom_status prom_calibration_write_plot(const prom_calibration_report *report, const char *path,
                                        prom_error *error)
{
    prom_output_text file;
    prom_status status = prom_output_begin_text(&file, path, error);
    if (status) return status;
    const prom_cost_model *m = report->model;
    size_t count = report->samples->count;
    prom_scatter_point *points = prom_alloc(count, sizeof *points);
    for (size_t i = 0; i < count; i++) {
        const prom_cost_sample *s = &report->samples->data[i];
        points[i] = (prom_scatter_point){report->held_out_ms[i], s->ms, group_of(s)};
    }
    char *title = prom_format("Cost model: mean error %.1f %%, worst under-estimate %.0f %%",
                              100 * m->mean_error, 100 * m->worst_under);
    char *subtitle = prom_format("%s, %ux%u, %zu samples, each predicted from others; "
                                 "form: %s; dashed: equal",
                                 m->renderer, m->width, m->height, count, form_names[m->form]);
    prom_scatter plot = {.title = title,
                         .subtitle = subtitle,
                         .x_label = "predicted, ms (logarithmic beyond 1)",
                         .y_label = "measured, ms (logarithmic beyond 1)",
                         .linear = 1,
                         .group_count = GROUPS,
                         .points = points,
                         .count = count};
    for (uint32_t g = 0; g < GROUPS; g++) plot.groups[g] = group_names[g];
    prom_scatter_write(&plot, file.out);
    prom_free(points);
    prom_free(title);
    prom_free(subtitle);
    return prom_output_end_text(&file, error);
}

#include "app/swap_report.h"

#include "app/scatter.h"

#include <stdio.h>

static bool is_to_kind(const prom_swap *swap, uint32_t kind)
{
    return swap->kind_to == kind;
}

static bool is_cluster(const prom_swap *swap, uint32_t cluster)
{
    return swap->cluster == (cluster != 0);
}

static json_t *agreement_json(const prom_swap_agreement *a)
{
    return json_pack("{s:I, s:o, s:o, s:o}", "swaps", (json_int_t)a->swaps, "spearman",
                     prom_json_number(a->spearman), "slope", prom_json_number(a->slope),
                     "spearman_selector", prom_json_number(a->spearman_selector));
}

json_t *prom_swap_json(const prom_swap_result *result)
{
    prom_swap_agreement a = prom_swap_agreement_of(result, NULL, 0);
    json_t *json = agreement_json(&a), *kinds = json_object(), *nodes = json_object();
    json_object_set_new(json, "frames", json_integer(result->frames));
    json_object_set_new(json, "least_px", json_integer(PROM_SWAP_LEAST_PX));
    for (uint32_t k = 0; k < PROM_SWAP_KINDS; k++) {
        a = prom_swap_agreement_of(result, is_to_kind, k);
        json_object_set_new(kinds, prom_swap_kind_name(k), agreement_json(&a));
    }
    for (uint32_t cluster = 0; cluster < 2; cluster++) {
        a = prom_swap_agreement_of(result, is_cluster, cluster);
        json_object_set_new(nodes, cluster ? "cluster" : "leaf", agreement_json(&a));
    }
    json_object_set_new(json, "kinds", kinds);
    json_object_set_new(json, "nodes", nodes);
    return json;
}

// ---- files

static void put_quoted(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '"') fputc('"', out);
        fputc(*text, out);
    }
    fputc('"', out);
}

prom_status prom_swap_write_csv(const char *path, const prom_model *model,
                                const prom_swap_result *result, prom_error *error)
{
    prom_output_text file;
    prom_status status = prom_output_begin_text(&file, path, error);
    if (status) return status;
    fputs("frame,node,name,cluster,kind_from,kind_to,level_from,level_to,size_px,px,predicted,"
          "predicted_selector,measured\n",
          file.out);
    for (size_t i = 0; i < result->swaps.count; i++) {
        const prom_swap *s = &result->swaps.data[i];
        fprintf(file.out, "%u,%u,", s->frame, s->node);
        put_quoted(file.out, model->names + model->name[s->node]);
        fprintf(file.out, ",%d,%s,%s,%u,%u,%.2f,%u,%.4f,%.4f,%.4f\n", s->cluster,
                prom_swap_kind_name(s->kind_from), prom_swap_kind_name(s->kind_to),
                s->level_from, s->level_to, (double)s->size_px, s->px, s->predicted,
                s->predicted_selector, s->measured);
    }
    return prom_output_end_text(&file, error);
}

prom_status prom_swap_write_plot(const char *path, const char *scene,
                                 const prom_swap_result *result, prom_error *error)
{
    prom_output_text file;
    prom_status status = prom_output_begin_text(&file, path, error);
    if (status) return status;
    size_t count = result->swaps.count;
    prom_scatter_point *points = prom_alloc(count, sizeof *points);
    for (size_t i = 0; i < count; i++) {
        const prom_swap *s = &result->swaps.data[i];
        points[i] = (prom_scatter_point){s->predicted, s->measured, s->kind_to};
    }
    prom_swap_agreement a = prom_swap_agreement_of(result, NULL, 0);
    char *title = prom_format("Swap test: Spearman %.3f, slope %.2f", a.spearman, a.slope);
    char *subtitle = prom_format(
        "%s: %zu swaps in %u frames, coloured by what was swapped in; dashed: equal", scene,
        count, result->frames);
    prom_scatter plot = {
        .title = title,
        .subtitle = subtitle,
        .x_label = "predicted change of the error sum, pixels (logarithmic beyond 10)",
        .y_label = "measured change, pixels (logarithmic beyond 10)",
        .linear = 10,
        .group_count = PROM_SWAP_KINDS,
        .points = points,
        .count = count,
    };
    for (uint32_t k = 0; k < PROM_SWAP_KINDS; k++) plot.groups[k] = prom_swap_kind_name(k);
    prom_scatter_write(&plot, file.out);
    prom_free(points);
    prom_free(title);
    prom_free(subtitle);
    return prom_output_end_text(&file, error);
}

// ---- text

static void print_agreement(const char *name, const prom_swap_agreement *a)
{
    if (a->swaps)
        printf("  %-13s %5zu swaps, Spearman %6.3f, slope %6.3f; by the selector's pixels "
               "%6.3f\n",
               name, a->swaps, a->spearman, a->slope, a->spearman_selector);
}

void prom_swap_print(const prom_swap_result *result)
{
    prom_swap_agreement a = prom_swap_agreement_of(result, NULL, 0);
    printf("swap       predicted against measured change of the error in %u frames\n",
           result->frames);
    print_agreement("all", &a);
    for (uint32_t k = 0; k < PROM_SWAP_KINDS; k++) {
        a = prom_swap_agreement_of(result, is_to_kind, k);
        print_agreement(prom_swap_kind_name(k), &a);
    }
    for (uint32_t cluster = 0; cluster < 2; cluster++) {
        a = prom_swap_agreement_of(result, is_cluster, cluster);
        print_agreement(cluster ? "of a cluster" : "of a leaf", &a);
    }
}

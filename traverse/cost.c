#include "traverse/cost.h"

#include <assert.h>
#include <math.h>

void prom_cost_terms(const prom_cost_model *model, const prom_cost_features *features,
                     double terms[PROM_TERMS])
{
    terms[PROM_TERM_FIXED] =
        model->fixed_ms * features->fixed + model->bind_ms * features->binds +
        model->uploading_ms * features->uploads + model->upload_ms * features->upload_bytes;
    terms[PROM_TERM_GEOMETRY] =
        model->draw_ms * features->draws + model->vertex_ms * features->vertices +
        model->triangle_ms * features->triangles + model->edge_ms * features->edges +
        model->hidden_edge_ms * features->hidden_edges;
    terms[PROM_TERM_PIXELS] = 0.0;
    for (int k = 0; k < PROM_COST_KINDS; k++)
        terms[PROM_TERM_PIXELS] += model->pixel_ms[k] * features->pixels[k];
    terms[PROM_TERM_HIDDEN] = model->hidden_pixel_ms * features->hidden;
}

double prom_cost_frame_ms(const prom_cost_model *model, const double terms[PROM_TERMS])
{
    double geometry = terms[PROM_TERM_GEOMETRY];
    double pixels = terms[PROM_TERM_PIXELS] + terms[PROM_TERM_HIDDEN];
    bool sum = model->form == PROM_COST_SUM;
    return terms[PROM_TERM_FIXED] + (sum ? geometry + pixels : fmax(geometry, pixels));
}

double prom_cost_predict(const prom_cost_model *model, const prom_cost_features *features)
{
    double terms[PROM_TERMS];
    prom_cost_terms(model, features, terms);
    return prom_cost_frame_ms(model, terms);
}

uint32_t prom_cost_kind(const prom_representation *rep)
{
    bool lit = rep->shading == PROM_SHADE_IMPOSTOR && !(rep->flags & PROM_REP_UNLIT);
    return lit ? PROM_COST_IMPOSTOR_LIT : rep->shading;
}

static double geometry_ms(const prom_cost_model *model, const prom_representation *rep,
                          double shaded_px, double hidden_px)
{
    assert(rep->shading < PROM_SHADE_COUNT);
    return model->draw_ms * rep->draws + model->vertex_ms * rep->vertices +
           model->triangle_ms * rep->triangles +
           model->edge_ms * prom_cost_edges(rep->triangles, shaded_px, hidden_px) +
           model->hidden_edge_ms * prom_cost_edges(rep->triangles, hidden_px, shaded_px);
}

void prom_cost_add_terms(const prom_cost_model *model, const prom_representation *rep,
                         double shaded_px, double hidden_px, double terms[PROM_TERMS])
{
    terms[PROM_TERM_GEOMETRY] += geometry_ms(model, rep, shaded_px, hidden_px);
    terms[PROM_TERM_PIXELS] += model->pixel_ms[prom_cost_kind(rep)] * shaded_px;
    terms[PROM_TERM_HIDDEN] += model->hidden_pixel_ms * hidden_px;
}

double prom_cost_of_rep(const prom_cost_model *model, const prom_representation *rep,
                        double shaded_px, double hidden_px)
{
    return geometry_ms(model, rep, shaded_px, hidden_px) +
           model->pixel_ms[prom_cost_kind(rep)] * shaded_px +
           model->hidden_pixel_ms * hidden_px;
}

prom_cost_model prom_cost_scaled(const prom_cost_model *model, const double factors[PROM_TERMS])
{
    prom_cost_model scaled = *model;
    scaled.fixed_ms *= factors[PROM_TERM_FIXED];
    scaled.bind_ms *= factors[PROM_TERM_FIXED];
    scaled.uploading_ms *= factors[PROM_TERM_FIXED];
    scaled.upload_ms *= factors[PROM_TERM_FIXED];
    scaled.draw_ms *= factors[PROM_TERM_GEOMETRY];
    scaled.vertex_ms *= factors[PROM_TERM_GEOMETRY];
    scaled.triangle_ms *= factors[PROM_TERM_GEOMETRY];
    scaled.edge_ms *= factors[PROM_TERM_GEOMETRY];
    scaled.hidden_edge_ms *= factors[PROM_TERM_GEOMETRY];
    for (int k = 0; k < PROM_COST_KINDS; k++) scaled.pixel_ms[k] *= factors[PROM_TERM_PIXELS];
    scaled.hidden_pixel_ms *= factors[PROM_TERM_HIDDEN];
    return scaled;
}

prom_cost_model prom_cost_charged(const prom_cost_model *model, double binds,
                                  double upload_bytes)
{
    prom_cost_model charged = *model;
    charged.fixed_ms += model->bind_ms * binds;
    if (upload_bytes > 0.0)
        charged.fixed_ms += model->uploading_ms + model->upload_ms * upload_bytes;
    return charged;
}

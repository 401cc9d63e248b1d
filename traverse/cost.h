// The cost model (DESIGN 6): predicted milliseconds of a frame, by the features of
// cost_features.h. Coefficients times features make four terms:
//   fixed    = fixed + binds + uploads
//   geometry = draws + vertices + triangles + edges
//   pixels   = shaded pixels, by kind
//   hidden   = pixels behind others
// and the frame takes their sum, or on devices that draw while they shade
// fixed + max(geometry, pixels + hidden), whichever fits its calibration.
#ifndef PROM_TRAVERSE_COST_H
#define PROM_TRAVERSE_COST_H

#include "metaobj/base/status.h"
#include "metaobj/cost_features.h"

typedef enum prom_cost_form { PROM_COST_SUM, PROM_COST_MAX, PROM_COST_FORMS } prom_cost_form;

typedef struct prom_cost_model {
    double fixed_ms, draw_ms, vertex_ms, triangle_ms, pixel_ms[PROM_COST_KINDS];
    double edge_ms, hidden_edge_ms; // see prom_cost_features: edges
    double hidden_pixel_ms;         // a pixel drawn behind what is there already (early z)
    double bind_ms;                 // a change of state between draws
    double uploading_ms;            // a frame in which anything is sent to the device
    double upload_ms;               // a byte of it
    double mean_error;              // of the fit: mean |predicted/actual - 1|
    double worst_under;             // greatest actual/predicted - 1
    double margin; // part of the budget kept back for noise, from repeats at calibration
    uint32_t sample_count;
    uint32_t width, height; // of the pictures that were timed; 0: not known
    prom_cost_form form;
    char renderer[128];
} prom_cost_model;

// ---- fit

// Non-negative least squares with 1/T weights (relative errors). The max form is taken where
// its mean error on samples that the fit has not seen is clearly the smaller one. Fails with
// fewer samples than coefficients (of features that occur at all) or a sample that is not
// finite. Sets every field: errors are measured on samples that the fit had not seen where
// there are enough; shading kinds without samples cost what textured pixels do, hidden pixels
// without samples 0.27 of it; margin 0.1, no size and an empty renderer are for the caller to
// replace.
prom_status prom_cost_fit(const prom_cost_sample *samples, size_t count, prom_cost_model *model,
                          prom_error *error);
// The residuals of a fit: predicted_ms[i] is what a model of this form says of sample i that
// was fitted to samples without it (the other half). Where there are too few for that it was
// fitted to all, and false is returned. The samples are those of a fit that succeeded.
bool prom_cost_held_out(const prom_cost_sample *samples, size_t count, prom_cost_form form,
                        double *predicted_ms);

// ---- use

// A frame of these features; in parts, terms[PROM_TERMS] is set.
double prom_cost_predict(const prom_cost_model *model, const prom_cost_features *features);
void prom_cost_terms(const prom_cost_model *model, const prom_cost_features *features,
                     double terms[PROM_TERMS]);
// What a frame of these terms takes, by the model's form.
double prom_cost_frame_ms(const prom_cost_model *model, const double terms[PROM_TERMS]);
// The kind of a representation's pixels: an index into pixel_ms.
uint32_t prom_cost_kind(const prom_representation *rep);
// A representation that in this view shades `shaded_px` pixels and covers `hidden_px` more
// behind other things: the sum of its terms. Selection adds these up, which in the max form is
// never below what the frame takes; the factors of the terms that are learnt while running
// (guarantee.h) bring the sum near it, for frames like the last ones.
double prom_cost_of_rep(const prom_cost_model *model, const prom_representation *rep,
                        double shaded_px, double hidden_px);
// The same in its parts, added to terms[PROM_TERMS]. Nothing is fixed in it.
void prom_cost_add_terms(const prom_cost_model *model, const prom_representation *rep,
                         double shaded_px, double hidden_px, double terms[PROM_TERMS]);
// The model with the coefficients of each term multiplied by its factor.
prom_cost_model prom_cost_scaled(const prom_cost_model *model,
                                 const double factors[PROM_TERMS]);
// The model of frames that have these changes of state and uploads: with them in its fixed
// part. How often state changes follows from how the draws of a whole frame can be sorted, not
// from any one representation: charge what the last frame had (prom_draw_stats.calls).
prom_cost_model prom_cost_charged(const prom_cost_model *model, double binds,
                                  double upload_bytes);

// ---- profiles

// JSON profile files (docs/FORMAT.md). Saving replaces the file at once or not at all. Loading
// checks every key and number; on failure *model stays as it was. Profiles without a size load,
// and those of version 2, in which binds and uploads cost nothing.
prom_status prom_cost_save(const prom_cost_model *model, const char *path, prom_error *error);
prom_status prom_cost_load(const char *path, prom_cost_model *model, prom_error *error);
// Whether the model is of this renderer, whose name a profile may hold shortened and with marks
// in place of what is not ASCII.
bool prom_cost_is_of(const prom_cost_model *model, const char *renderer);
// The profile's place for a renderer: $XDG_CACHE_HOME/promenade/<renderer>-<W>x<H>.json (or
// ~/.cache/...). Makes the folders. Free with prom_free; NULL when there is no home.
char *prom_cost_cache_path(const char *renderer, uint32_t width, uint32_t height);

#endif

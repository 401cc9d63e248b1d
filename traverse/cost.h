// The cost model (DESIGN 6): predicted milliseconds = fixed + sum over the cut of
// k_draw*draws + k_vertex*vertices + k_triangle*triangles + k_edge*edges + k_pixel[kind]*shaded
// pixels + k_hidden*hidden pixels, over the features of cost_features.h.
#ifndef PROM_TRAVERSE_COST_H
#define PROM_TRAVERSE_COST_H

#include "metaobj/base/status.h"
#include "metaobj/cost_features.h"

typedef struct prom_cost_model {
    double fixed_ms, draw_ms, vertex_ms, triangle_ms, pixel_ms[PROM_COST_KINDS];
    double edge_ms, hidden_edge_ms; // see prom_cost_features: edges
    double hidden_pixel_ms;         // a pixel drawn behind what is there already (early z)
    double mean_error;              // of the fit: mean |predicted/actual - 1|
    double worst_under;             // greatest actual/predicted - 1
    double margin; // part of the budget kept back for noise, from repeats at calibration
    uint32_t sample_count;
    uint32_t width, height; // of the pictures that were timed; 0: not known
    char renderer[128];
} prom_cost_model;

// Non-negative least squares with 1/T weights (relative errors). Fails with fewer samples than
// coefficients (of features that occur at all) or a sample that is not finite. Sets every
// field: errors are measured on samples that the fit had not seen where there are enough;
// shading kinds without samples cost what textured pixels do, hidden pixels without samples
// 0.27 of it; margin 0.1, no size and an empty
// renderer are for the caller to replace.
prom_status prom_cost_fit(const prom_cost_sample *samples, size_t count, prom_cost_model *model,
                          prom_error *error);
double prom_cost_predict(const prom_cost_model *model, const prom_cost_features *features);
// The kind of a representation's pixels: an index into pixel_ms.
uint32_t prom_cost_kind(const prom_representation *rep);
// A representation that in this view shades `shaded_px` pixels and covers `hidden_px` more
// behind other things.
double prom_cost_of_rep(const prom_cost_model *model, const prom_representation *rep,
                        double shaded_px, double hidden_px);

// The same in its parts, added to terms[PROM_TERMS]. Nothing is fixed in it.
void prom_cost_add_terms(const prom_cost_model *model, const prom_representation *rep,
                         double shaded_px, double hidden_px, double terms[PROM_TERMS]);
// The model with the coefficients of each term multiplied by its factor.
prom_cost_model prom_cost_scaled(const prom_cost_model *model,
                                 const double factors[PROM_TERMS]);

// JSON profile files (docs/FORMAT.md). Saving replaces the file at once or not at all. Loading
// checks every key and number; on failure *model stays as it was. Profiles without a size load.
prom_status prom_cost_save(const prom_cost_model *model, const char *path, prom_error *error);
prom_status prom_cost_load(const char *path, prom_cost_model *model, prom_error *error);
// Whether the model is of this renderer, whose name a profile may hold shortened and with marks
// in place of what is not ASCII.
bool prom_cost_is_of(const prom_cost_model *model, const char *renderer);
// The profile's place for a renderer: $XDG_CACHE_HOME/promenade/<renderer>-<W>x<H>.json (or
// ~/.cache/...). Makes the folders. Free with prom_free; NULL when there is no home.
char *prom_cost_cache_path(const char *renderer, uint32_t width, uint32_t height);

#endif

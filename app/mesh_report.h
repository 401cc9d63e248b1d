// What `promenade compare-mesh` found, as text and JSON.
#ifndef PROM_APP_MESH_REPORT_H
#define PROM_APP_MESH_REPORT_H

#include "builder/mesh_pictures.h"
#include "builder/simplify/mesh_distance.h"

#include <jansson.h>

typedef struct prom_mesh_facts {
    const char *path;
    uint32_t triangles, vertices;
    double diagonal, area, volume; // of the bounds, surface, inside
    bool closed;                   // else the volume is not known
} prom_mesh_facts;

// A metric over views: the mean is of the kind of the metric's own.
typedef struct prom_looks {
    double mean, object_mean; // over all pixels; over those that the meshes cover
    double worst;             // of the views' means
    uint32_t worst_view;
} prom_looks;

typedef struct prom_mesh_comparison {
    prom_mesh_facts facts[2];
    double origin[3]; // that both are relative to, in the scene's world
    prom_mesh_distances distances;
    uint32_t view_count, size_px; // no views: looks are not known
    double ppd;
    prom_look_difference views[PROM_CUBE_VIEWS][PROM_LOOK_METRICS];
    prom_looks looks[PROM_LOOK_METRICS];
} prom_mesh_comparison;

// Everything but the path.
void prom_mesh_facts_find(const prom_mesh *mesh, prom_mesh_facts *facts);
// looks from views.
void prom_looks_sum_up(prom_mesh_comparison *comparison);
// `value` in percent of the first one's diagonal.
double prom_percent_of_diagonal(const prom_mesh_comparison *comparison, double value);
// NAN unless both are closed and the first one's is not 0.
double prom_volume_difference_percent(const prom_mesh_comparison *comparison);

void prom_mesh_comparison_print(const prom_mesh_comparison *comparison);
json_t *prom_mesh_comparison_json(const prom_mesh_comparison *comparison);

#endif

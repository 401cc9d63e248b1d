// What a model holds, counted: for `info`.
#ifndef PROM_APP_MODEL_FACTS_H
#define PROM_APP_MODEL_FACTS_H

#include "metaobj/container.h"
#include "metaobj/model.h"
#include "metaobj/texture.h"
#include "metaobj/view_cells.h"

#define PROM_FACT_LEVELS 64 // levels of a tree that are told apart

typedef struct prom_rep_facts {
    uint32_t leaf, cluster; // representations of leaves' and of clusters' prototypes
    uint64_t triangles;     // of all of them, each once
} prom_rep_facts;

typedef struct prom_texture_facts {
    uint32_t count;
    uint64_t bytes;
} prom_texture_facts;

typedef struct prom_table_facts {
    const char *name;
    uint64_t rows, bytes; // as loaded, without allocation overhead
} prom_table_facts;

#define PROM_FACT_TABLES 8

typedef struct prom_model_facts {
    uint64_t triangles; // full detail, instanced, with the background
    uint32_t leaves, clusters, backdrops;
    uint32_t object_leaves, surface_leaves, blended_leaves; // by layer, sum = leaves
    uint32_t leaf_prototypes, cluster_prototypes,
        shared_prototypes; // shared: placed twice or more
    uint32_t most_children, levels;
    uint32_t nodes_by_level[PROM_FACT_LEVELS];
    prom_rep_facts reps[PROM_REP_KIND_COUNT];
    prom_texture_facts textures[PROM_TEXTURE_KIND_COUNT];
    prom_table_facts tables[PROM_FACT_TABLES];
    uint32_t materials;
    double size[3];    // of the layout, scene units
    double cell_size;  // of the view cells, scene units; 0: there are none
    double cell_shows; // part of the tree's leaves that a view cell shows, their mean
} prom_model_facts;

void prom_model_facts_of(const prom_model *model, const prom_view_cells *cells,
                         prom_model_facts *facts);
// "color", "impostor-lit", "impostor-albedo"
const char *prom_texture_kind_name(uint32_t kind);

#endif

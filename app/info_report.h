// What `info` says of a model, as text or JSON.
#ifndef PROM_APP_INFO_REPORT_H
#define PROM_APP_INFO_REPORT_H

#include "app/model_facts.h"

#include <jansson.h>

typedef struct prom_info_facts {
    const char *path;
    prom_container *container;
    prom_model_facts model;
    prom_measured measured;
    uint64_t file_bytes, content_hash;
    uint32_t cells;
    uint64_t cell_bytes; // in the file
    json_t *stages;      // array of {name, ms, content}
} prom_info_facts;

// Gathers the facts of a model that has been loaded from the container at `path`.
prom_status prom_info_gather(prom_info_facts *facts, const char *path,
                             prom_container *container, const prom_model *model,
                             prom_error *error);
void prom_info_finish(prom_info_facts *facts); // {0} is allowed

json_t *prom_info_json(const prom_info_facts *facts);
void prom_info_print(const prom_info_facts *facts);

#endif

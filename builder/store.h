// The store of a build: what its units of work have made, by the hash of their inputs, in the
// file X.prom.work beside the model X.prom.
//
// A build that is cut off goes on from it, and a build with another setting or a changed scene
// takes from it what is still right. Deleting the file costs only time, even under a running
// build. A unit is kept in a transaction of its own; the process may be killed at any moment.
// Each entry has a checksum, and what cannot be read counts as not there; a damaged file is
// begun anew.
#ifndef PROM_BUILDER_STORE_H
#define PROM_BUILDER_STORE_H

#include "builder/pack.h"
#include "metaobj/base/status.h"

typedef struct prom_store prom_store;

// The kinds of units, in the order of the build.
typedef enum prom_unit_kind {
    PROM_UNIT_LEVELS,        // meshes of a shape
    PROM_UNIT_LEAF_VIEWS,    // pictures of a shape's prototype, if they are to be kept
    PROM_UNIT_LEAF,          // representations of it
    PROM_UNIT_MERGE,         // merged meshes of a cluster
    PROM_UNIT_CLUSTER_VIEWS, // pictures of its prototype, if they are to be kept
    PROM_UNIT_CLUSTER,       // representations of it
    PROM_UNIT_VIEW_CELL,     // what shows from a cell of eyes
    PROM_UNIT_COUNT
} prom_unit_kind;

// Opens the store of the model at `model_path`, or starts one. A damaged one is replaced; what
// is no store is left alone, an error. Units of kinds from `redo` on are not given back
// (PROM_UNIT_COUNT: all are). The caller holds the lock on the model's .part. NULL with *error
// if it cannot be opened or written.
prom_store *prom_store_open(const char *model_path, prom_unit_kind redo, prom_error *error);
// Keeps the file. NULL is allowed.
void prom_store_close(prom_store *store);
// Drops the units of kinds [first, end) that have neither been taken nor put since it was
// opened.
prom_status prom_store_prune(prom_store *store, prom_unit_kind first, prom_unit_kind end,
                             prom_error *error);
// The file of the model's store; free it.
char *prom_store_path(const char *model_path);
// Deletes the model's store, if there is one.
prom_status prom_store_delete(const char *model_path, prom_error *error);

// The next three may be called from several threads.
// False if there is no such unit; else its bytes are in *pack.
bool prom_store_get(prom_store *store, prom_unit_kind kind, uint64_t key, prom_pack *pack);
// Notes that the unit, if it is there, is still of use (prom_store_prune).
void prom_store_touch(prom_store *store, prom_unit_kind kind, uint64_t key);
prom_status prom_store_put(prom_store *store, prom_unit_kind kind, uint64_t key,
                           const prom_pack *pack, prom_error *error);

#endif

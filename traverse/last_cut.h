// The cut of the frame before: for selectors that stay with what is shown, and to count what
// changed.
#ifndef PROM_TRAVERSE_LAST_CUT_H
#define PROM_TRAVERSE_LAST_CUT_H

#include "metaobj/cut.h"
#include "metaobj/model.h"

typedef struct prom_last_cut {
    const prom_model *model;
    uint32_t *rep;   // per node: what it was drawn by, or PROM_NONE
    uint32_t *above; // per node: the last cut that drew something below it, by its number
    uint32_t number; // of cuts so far
    PROM_ARRAY(uint32_t) nodes;
} prom_last_cut;

// The model must outlive it.
void prom_last_cut_init(prom_last_cut *last, const prom_model *model);
void prom_last_cut_finish(prom_last_cut *last); // {0} is allowed

// What a switch is: an entry that shows something, in the place of what was drawn otherwise.
// What comes into view, or was hidden and is so still, does not switch.
typedef struct prom_switches {
    uint32_t count;
    double px; // visible pixels of these entries
} prom_switches;

bool prom_last_cut_is_switch(const prom_last_cut *last, const prom_cut_entry *entry);
// Whether something below the node was drawn.
static inline bool prom_last_cut_opened(const prom_last_cut *last, uint32_t node)
{
    return last->number && last->above[node] == last->number;
}

// Takes a cut as the last one; returns what has switched since the one before.
prom_switches prom_last_cut_note(prom_last_cut *last, const prom_cut *cut);

#endif

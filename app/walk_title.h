// The window's title: what the last quarter of a second showed.
#ifndef PROM_APP_WALK_TITLE_H
#define PROM_APP_WALK_TITLE_H

#include <stdbool.h>
#include <stdint.h>

#define PROM_WALK_TITLE_BYTES 256

// Start with {0}.
typedef struct prom_walk_title {
    double shown_ms; // when it last changed
    uint64_t all, misses;
    // Since then, and what the title says now.
    uint32_t frames;
    double frame_ms, triangles;
    double told_ms, told_triangles;
    bool told_at_rest, told_refined, told_captured;
} prom_walk_title;

typedef struct prom_walk_title_facts {
    const char *name, *selector;
    double budget_ms;
    bool playing, at_rest, captured;
    bool refined; // at rest the picture shows full detail
} prom_walk_title_facts;

void prom_walk_title_add(prom_walk_title *title, double frame_ms, double triangles, bool miss);
// Whether it is time for a new title at now_ms; then `text` holds it.
bool prom_walk_title_due(prom_walk_title *title, const prom_walk_title_facts *facts,
                         double now_ms, char text[PROM_WALK_TITLE_BYTES]);

#endif

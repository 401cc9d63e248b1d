// The rules that a user may choose for what is drawn how.
#ifndef PROM_TRAVERSE_CHOICE_H
#define PROM_TRAVERSE_CHOICE_H

// What orders the things to be drawn; a finished cut is scored by its own pixels.
typedef enum prom_order {
    PROM_ORDER_PIXELS, // a node's share in the visible pixels of the whole; for `meta`, a
                       // cluster's place is that of the best of its children
    // The classic: an object counts by what it would show by itself, and a cluster by the sum
    // of its children.
    PROM_ORDER_SUM,
} prom_order;

// The classic rules of thumb, flags. `meta` and `greedy` heed them.
typedef enum prom_prior {
    // A node smaller than the tables go (PROM_SIZE_MIN_PX) is drawn by its box of average
    // colours, where it has one that is valid.
    PROM_PRIOR_FEW_PIXELS = 1,
    // An object that covers PROM_PRIOR_LARGE_SHARE of the picture is drawn by its full
    // geometry.
    PROM_PRIOR_FULL_DETAIL = 2,
} prom_prior;
#define PROM_PRIOR_LARGE_SHARE 0.25f // by taste

#endif

// What is seen of what is drawn: counts the visible pixels of frames and keeps the visibility
// of the model's nodes from them, and from its view cells.
//
//   every frame: prom_sight_begin, select with sight->visibility, prom_sight_draw
#ifndef PROM_APP_SIGHT_H
#define PROM_APP_SIGHT_H

#include "app/session.h"
#include "render/id_counter.h"
#include "traverse/visibility.h"

// A frame whose pixels are being counted.
typedef struct prom_sighting {
    uint64_t frame;
    prom_camera camera;
    prom_ids ids;
    float scale;                           // pixels of the camera's picture for each one drawn
    PROM_ARRAY(prom_visible_count) counts; // its cut; px is filled in when they are known
} prom_sighting;

// Of a node that is see-through in part: both kinds of pixels, as counted last.
typedef struct prom_glass_count {
    bool is;        // there is something see-through in it
    float px[2];    // 0: what is not, 1: what is
    uint32_t at[2]; // 1 + the counting; 0: none yet
} prom_glass_count;

typedef struct prom_sight {
    prom_session *session;
    prom_visibility *visibility; // NULL: nothing is known, nor asked for
    prom_id_counter *counter;    // NULL: frames are not counted
    prom_sighting sightings[PROM_ID_RING];
    float *px;               // per node; 0 between the frames
    prom_glass_count *glass; // per node
    uint64_t counted;        // frames, so far
    uint32_t uncounted;      // frames since the last of them
    uint32_t in_a_row;       // frames that are still to be counted whatever the camera does
    double way;              // of the camera at that
} prom_sight;

// As the session's visibility mode says. On failure there is nothing to finish.
prom_status prom_sight_init(prom_sight *sight, prom_session *session, prom_error *error);
void prom_sight_finish(prom_sight *sight);
// Takes the counts that have arrived, in a frozen session all of the frame before; to be called
// before the cut is selected.
void prom_sight_begin(prom_sight *sight, const prom_camera *camera);
// Whether the next frame's pixels will be counted.
bool prom_sight_counts(const prom_sight *sight);
// Draws a cut into the session's target, has its pixels counted, and waits for the picture.
void prom_sight_draw(prom_sight *sight, const prom_cut *cut, const prom_camera *camera,
                     const prom_frame_options *options);

#endif

// A session: a model opened and loaded on the device, with all that it takes to draw frames of
// it. Shared by `shot`, `bench` and `walk`.
#ifndef PROM_APP_SESSION_H
#define PROM_APP_SESSION_H

#include "app/options.h"
#include "metaobj/container.h"
#include "metaobj/cut.h"
#include "metaobj/view_cells.h"
#include "render/renderer.h"
#include "scenes/path.h"
#include "traverse/cost.h"
#include "traverse/selector.h"
#include "traverse/view.h"

typedef struct prom_session {
    prom_container *container;
    prom_model model;
    prom_view_cells cells; // of the model; none where they are not asked for
    prom_visibility_mode visibility;
    prom_context *context;
    prom_renderer *renderer;
    prom_draw_list *list;
    prom_target *target;
    prom_choice_options choice;
    double miss_rate;     // accepted share of frames over the budget
    double min_scale;     // see prom_view_options
    bool frozen;          // a profile was given: nothing that is measured changes what is drawn
    float *semantics;     // weights of the tree's nodes; NULL: all 1
    prom_cost_model cost; // {0} when nothing is known and neither budget nor selector needs it
    prom_path path;
    prom_camera camera;   // all but the pose is set
    double ppd;           // as given; see prom_session_ppd
    double start_s;       // opening, loading and warming, without calibration
    double calibration_s; // 0 when a profile was at hand
} prom_session;

// Opens everything, or nothing: on failure *session is {0}. options->selector must be set.
// `path_frames` is the length of an automatic path; with_path false leaves the path empty.
prom_status prom_session_open(prom_session *session, const char *model_path,
                              const prom_view_options *options, bool with_path,
                              uint32_t path_frames, prom_error *error);
// Where a session gets its GL context from, once the model has been read. The context becomes
// the session's; size_px is the size asked for and may be changed to what there is.
typedef struct prom_session_device {
    prom_context *(*create)(void *user, uint32_t size_px[2], prom_error *error);
    void *user;
} prom_session_device;
// The same on another device than a headless one.
prom_status prom_session_open_on(prom_session *session, const prom_session_device *device,
                                 const char *model_path, const prom_view_options *options,
                                 bool with_path, uint32_t path_frames, prom_error *error);
void prom_session_close(prom_session *session); // {0} is allowed

// Gives the pictures another size. On failure the old one stays.
prom_status prom_session_resize(prom_session *session, const uint32_t size_px[2],
                                prom_error *error);
// Pixels per degree of the pictures: as given, or those of one that fills the screen 0.7 m wide
// and 0.7 m away that FLIP's values are usually given for.
double prom_session_ppd(const prom_session *session);
// What a cut may be predicted at in a frame of budget_ms before anything has been measured.
double prom_session_allowed_ms(const prom_session *session, double budget_ms);
// Seconds from one key of the path to the next.
double prom_session_step_s(const prom_session *session);
// What a selector of this session is given. visibility: NULL, or begun for this view.
prom_selection prom_session_selection(const prom_session *session, const prom_view *view,
                                      const prom_visibility *visibility, double budget_ms,
                                      double rule_scale);
// Selects a cut for a view. visibility: NULL, or begun for it.
void prom_session_select(const prom_session *session, prom_selector *selector,
                         const prom_visibility *visibility, const prom_camera *camera,
                         double budget_ms, double rule_scale, prom_cut *cut);
// Draws a cut into the session's target; `draw` waits for the picture.
void prom_session_submit(prom_session *session, const prom_cut *cut, const prom_camera *camera,
                         const prom_frame_options *options);
void prom_session_draw(prom_session *session, const prom_cut *cut, const prom_camera *camera,
                       const prom_frame_options *options);
// Writes the target's picture as a PNG; what the tree does not cover shows the background.
prom_status prom_session_write_png(prom_session *session, const char *path, prom_error *error);

#endif

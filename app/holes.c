#include "app/holes.h"

#include <math.h>

#define COVERED 128 // alpha: the tree gives 1, the clear 0

prom_status prom_holes_init(prom_holes *holes, const prom_session *session, prom_error *error)
{
    size_t pixels = (size_t)session->camera.width * session->camera.height;
    *holes = (prom_holes){0};
    holes->full = prom_selector_create("full", &session->model, error);
    if (!holes->full) return error->status;
    holes->truth = prom_alloc(pixels, 4);
    holes->shown = prom_alloc(pixels, 4);
    return PROM_OK;
}

void prom_holes_finish(prom_holes *holes)
{
    if (holes->full) prom_selector_destroy(holes->full);
    prom_cut_finish(&holes->cut);
    prom_free(holes->truth);
    prom_free(holes->shown);
    *holes = (prom_holes){0};
}

static void draw(prom_session *session, const prom_camera *camera, const prom_cut *cut,
                 uint8_t *rgba)
{
    prom_frame_options options = {.no_background = true};
    prom_session_draw(session, cut, camera, &options);
    prom_target_read_rgba(session->target, 0, 0, camera->width, camera->height, rgba);
}

void prom_holes_check(prom_holes *holes, prom_session *session, const prom_camera *camera,
                      const prom_cut *cut)
{
    prom_session_select(session, holes->full, camera, INFINITY, 1, &holes->cut);
    draw(session, camera, cut, holes->shown);
    draw(session, camera, &holes->cut, holes->truth);
    size_t pixels = (size_t)camera->width * camera->height, covered = 0, missing = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (holes->truth[4 * i + 3] < COVERED) continue;
        covered++;
        missing += holes->shown[4 * i + 3] < COVERED;
    }
    double share = covered ? (double)missing / (double)covered : 0;
    holes->frames++;
    holes->sum += share;
    holes->max = fmax(holes->max, share);
}

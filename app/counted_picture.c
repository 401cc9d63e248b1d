#include "app/counted_picture.h"

#include "app/pixel_shares.h"

void prom_picture_draw(prom_session *session, prom_target *target, const prom_camera *camera,
                       const prom_cut *cut, prom_ids ids)
{
    const prom_frame_options options = {.ids = ids};
    prom_renderer_draw_frame(session->renderer, session->list, target, &session->model, cut,
                             camera, &options);
}

static void count(const prom_model *model, prom_target *target, const prom_camera *camera,
                  uint32_t *px, uint32_t *ids)
{
    prom_target_read_ids(target, 0, 0, camera->width, camera->height, ids);
    prom_count_pixels(ids, (size_t)camera->width * camera->height, model->tree_count, px);
}

void prom_picture_draw_counted(prom_session *session, prom_target *target,
                               const prom_camera *camera, const prom_cut *cut, uint8_t *rgba,
                               uint32_t *px, uint32_t *ids)
{
    const prom_model *m = &session->model;
    prom_picture_draw(session, target, camera, cut, PROM_IDS_OPAQUE);
    prom_target_read_rgba(target, 0, 0, camera->width, camera->height, rgba);
    memset(px, 0, m->tree_count * sizeof *px);
    count(m, target, camera, px, ids);
    if (!prom_draw_list_has_blended(session->list)) return;
    prom_picture_draw(session, target, camera, cut, PROM_IDS_BLENDED);
    count(m, target, camera, px, ids);
}

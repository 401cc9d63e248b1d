// The synthetic scenes of calibration: how they are drawn up, and what they are made of.
// Private to render/.
#ifndef PROM_RENDER_CALIBRATE_SCENE_H
#define PROM_RENDER_CALIBRATE_SCENE_H

#include "metaobj/cost_features.h"
#include "render/renderer.h"

#define SCENE_DETAILS 5 // sizes of the meshes

// What a sample draws: items side by side in a grid over the picture, each a ball (or, for
// impostors, a box), in as many layers behind each other as `layers` says.
typedef struct scene_plan {
    uint32_t kind;          // prom_shading or PROM_COST_IMPOSTOR_LIT
    uint32_t items, detail; // detail: index of a mesh size; unused for impostors
    uint32_t layers;        // 1 for impostors
    float area;             // of a cell that its item covers, about
} scene_plan;

// Meshes, textures and materials of all samples, uploaded after whatever the renderer holds.
typedef struct scene_kit {
    uint32_t meshes[SCENE_DETAILS][PROM_SHADE_COUNT];
    uint32_t box, pictures_unlit, pictures_lit;
    uint32_t triangles[SCENE_DETAILS], vertices[SCENE_DETAILS];
} scene_kit;

// false when the device has no memory left. Replaces the renderer's materials.
bool scene_kit_upload(scene_kit *kit, prom_renderer *renderer);
// The plan of a kind's index-th sample: spread evenly over sizes, numbers and details
// however many samples are taken (quasi-random), and the same everywhere.
scene_plan scene_plan_at(const scene_kit *kit, uint32_t kind, uint32_t index);
// Fills and prepares the list, front to back. Draw it with the identity as projection. solid:
// textures cut nothing out and nothing is blended.
void scene_fill_list(const scene_kit *kit, const scene_plan *plan, float aspect, bool solid,
                     prom_draw_list *list);

#endif

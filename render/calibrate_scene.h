// The synthetic scenes of calibration: how they are drawn up, and what they are made of.
// Private to render/.
#ifndef PROM_RENDER_CALIBRATE_SCENE_H
#define PROM_RENDER_CALIBRATE_SCENE_H

#include "metaobj/cost_features.h"
#include "render/renderer.h"

#define SCENE_DETAILS 5 // sizes of the meshes
#define SCENE_STATES 14 // different states of the device, with which state is changed

// What samples vary: a kind of pixels (prom_shading or PROM_COST_IMPOSTOR_LIT), or
enum {
    SCENE_BINDS = PROM_COST_KINDS, // changes of state between many small draws
    SCENE_UPLOADS,                 // what is sent to the device meanwhile
    SCENE_SERIES
};

// What a sample draws: items side by side in a grid over the picture, each a ball (or, for
// impostors, a box), in as many layers behind each other as `layers` says.
typedef struct scene_plan {
    uint32_t series;
    uint32_t items, detail; // detail: index of a mesh size; unused for impostors
    uint32_t layers;        // 1 for impostors
    float area;             // of a cell that its item covers, about
    uint32_t states;        // of SCENE_BINDS: among the items, in turn
    uint32_t copies;        // of SCENE_UPLOADS: of what is sent
    bool textures;          // textures are sent, not meshes
} scene_plan;

// Meshes, textures and materials of all samples, uploaded after whatever the renderer holds.
typedef struct scene_kit {
    uint32_t meshes[SCENE_DETAILS][PROM_SHADE_COUNT];
    uint32_t box, pictures_unlit, pictures_lit;
    uint32_t states[SCENE_STATES]; // small meshes of a state each
    uint32_t triangles[SCENE_DETAILS], vertices[SCENE_DETAILS];
    uint32_t mesh_count, texture_count; // of the renderer, with all these
    prom_mesh spare_mesh;               // what SCENE_UPLOADS sends
    prom_texture spare_texture;
} scene_kit;

// false when the device has no memory left. Replaces the renderer's materials. Free with
// scene_kit_finish in either case; what is on the device stays there.
bool scene_kit_upload(scene_kit *kit, prom_renderer *renderer);
void scene_kit_finish(scene_kit *kit);
// The plan of a series' index-th sample: spread evenly over sizes, numbers and details
// however many samples are taken (quasi-random), and the same everywhere.
scene_plan scene_plan_at(const scene_kit *kit, uint32_t series, uint32_t index);
// Fills and prepares the list, front to back. Draw it with the identity as projection. solid:
// textures cut nothing out and nothing is blended.
void scene_fill_list(const scene_kit *kit, const scene_plan *plan, float aspect, bool solid,
                     prom_draw_list *list);
// Whether `solid` makes a difference.
bool scene_is_cut(const scene_plan *plan);
// Sends what the plan says, in the place of what was sent before; returns the bytes.
size_t scene_send(const scene_kit *kit, const scene_plan *plan, prom_renderer *renderer);
// The part of the items that is drawn by plain pixels instead of the series' own kind, which
// for SCENE_BINDS is textured.
double scene_plain_share(const scene_plan *plan);

#endif

// The renderer: a store of meshes, textures and materials on the device, and draw lists of
// placed meshes in few multi-draw calls.
//
//   renderer = prom_renderer_create(context)
//   ids = prom_renderer_add_texture / _add_mesh ..., prom_renderer_set_materials
//   prom_draw_list: reset, add items, then submit with a projection, any number of times
//
// Shading: Lambert sun plus hemisphere ambient, per vertex, from fixed lights (lighting.glsl),
// on encoded colours (see lighting.glsl). Depth is reverse z, infinite far.
#ifndef PROM_RENDER_RENDERER_H
#define PROM_RENDER_RENDERER_H

#include "metaobj/camera.h"
#include "metaobj/container.h"
#include "metaobj/cut.h"
#include "metaobj/model.h"
#include "metaobj/texture.h"
#include "render/context.h"

typedef struct prom_renderer prom_renderer;

// Compiles and warms every shader variant.
prom_renderer *prom_renderer_create(prom_context *context, prom_error *error);
void prom_renderer_destroy(prom_renderer *renderer);

// ---- the store

// Uploads; the data may be freed afterwards. Ids count from 0 in call order; PROM_NONE when the
// device has no memory left.
uint32_t prom_renderer_add_mesh(prom_renderer *renderer, const prom_mesh *mesh);
uint32_t prom_renderer_add_texture(prom_renderer *renderer, const prom_texture *texture);
// The materials that submeshes name; their textures are texture ids of this renderer.
void prom_renderer_set_materials(prom_renderer *renderer, const prom_material *materials,
                                 uint32_t count);
// Forgets meshes and textures added after the given counts (for the builder's short-lived
// ones).
void prom_renderer_truncate(prom_renderer *renderer, uint32_t mesh_count,
                            uint32_t texture_count);
uint32_t prom_renderer_mesh_count(const prom_renderer *renderer);
uint32_t prom_renderer_texture_count(const prom_renderer *renderer);
// Everything of a model in place of what the store held, so that the ids here equal those of
// the model. Fails with the container's error, or PROM_ERR_UNSUPPORTED when the device has no
// memory left; the store is then empty.
prom_status prom_renderer_load(prom_renderer *renderer, prom_container *container,
                               const prom_model *model, prom_error *error);
// Bytes of device memory that the store holds.
uint64_t prom_renderer_bytes(const prom_renderer *renderer);

// ---- drawing

// What a pixel shows.
typedef enum prom_output {
    PROM_OUTPUT_LIT = 0, // the picture
    PROM_OUTPUT_ALBEDO,  // colour without light
    PROM_OUTPUT_NORMAL,  // n/2 + 1/2, per component
    PROM_OUTPUT_TINT,    // the item's tint, lightly shaded: false colours
    PROM_OUTPUT_COUNT
} prom_output;

// Whose ids a target with ids gets.
typedef enum prom_ids {
    PROM_IDS_ALL = 0, // blended over opaque
    PROM_IDS_OPAQUE,  // what is blended writes none: what it covers can be seen through it
    PROM_IDS_BLENDED, // only what is blended, where nothing opaque is before it
    PROM_IDS_NONE,    // nobody's: as fast as a target without, whose ids stay as they were
} prom_ids;

typedef struct prom_draw_item {
    uint32_t mesh;
    uint32_t texture; // impostor pictures, or PROM_NONE
    uint32_t flags;   // PROM_REP_UNLIT
    uint32_t id;      // for the id buffer
    uint8_t tint[4];  // sRGB; for PROM_OUTPUT_TINT
    float origin[3];  // placement relative to the eye (or to the bake's centre)
    float basis[9];   // column-major
    float depth;      // draw order: ascending, blended ones descending
    bool background;  // behind everything else, whatever its depth
    bool hidden;      // not expected to show: drawn after all opaque ones that are
    float cost_ms;    // predicted; only prom_draw_list_part looks at it
} prom_draw_item;

typedef struct prom_draw_list prom_draw_list;

prom_draw_list *prom_draw_list_create(prom_renderer *renderer);
void prom_draw_list_destroy(prom_draw_list *list);
void prom_draw_list_reset(prom_draw_list *list);
void prom_draw_list_add(prom_draw_list *list, const prom_draw_item *item);
// Sorts and uploads the commands: opaque front to back in depth slices, grouped by state within
// a slice; what is hidden; then the background; then blended back to front. Call once before
// submitting.
void prom_draw_list_prepare(prom_draw_list *list);
// Whether a prepared list has something blended, the background aside.
bool prom_draw_list_has_blended(const prom_draw_list *list);
// Draws of a prepared list, numbered in the order of drawing.
size_t prom_draw_list_length(const prom_draw_list *list);
// Where the part that starts at draw `first` ends, so that what it holds of the items costs
// cost_ms at most; it holds one draw at least.
size_t prom_draw_list_part(const prom_draw_list *list, size_t first, double cost_ms);

typedef struct prom_pass {
    mat4 projection;              // clip from eye-relative world; reverse z
    uint32_t x, y, width, height; // viewport in the target, from the bottom left
    prom_output output;
    prom_ids ids;
    bool wireframe;
    size_t first, end; // the draws, see prom_draw_list_part; end 0: to the last one
} prom_pass;

// Binds and clears the whole target: colour (sRGB RGBA bytes), depth, ids to PROM_NONE.
void prom_target_clear(prom_target *target, const uint8_t rgba[4]);
// Copies another target's colours all over this one's, scaled where the sizes differ (linear).
void prom_target_copy_colors(prom_target *target, const prom_target *from);
// Draws a prepared list into the bound target. May be called many times (one per baked view).
// Alpha of drawn pixels is 1 for the tree, and stays the clear's under the background layer.
void prom_draw_list_submit(prom_draw_list *list, prom_target *target, const prom_pass *pass);
// glFinish.
void prom_renderer_finish(prom_renderer *renderer);

// What was submitted since the last call: draws, vertices (of the drawn meshes), triangles.
typedef struct prom_draw_stats {
    uint64_t draws, vertices, triangles, calls;
} prom_draw_stats;
prom_draw_stats prom_renderer_take_stats(prom_renderer *renderer);

// ---- frames of a model

// The view-projection of a camera, eye at the origin.
void prom_camera_projection(const prom_camera *camera, mat4 projection);

typedef struct prom_frame_options {
    prom_output output; // PROM_OUTPUT_TINT: colour by representation kind
    prom_ids ids;
    bool wireframe;
    bool no_background;
    uint32_t size_px[2]; // drawn so large, from the target's bottom left; 0: as the camera says
} prom_frame_options;

// Draws the cut and the background layer of a loaded model from a camera: fills the list,
// clears the target with the sky colour (alpha 0), submits. Does not wait.
void prom_renderer_draw_frame(prom_renderer *renderer, prom_draw_list *list,
                              prom_target *target, const prom_model *model, const prom_cut *cut,
                              const prom_camera *camera, const prom_frame_options *options);
// The same in two steps, for frames that are drawn in parts: the list is filled and prepared;
// then its draws [first, end) are submitted, in one go or in parts that follow each other with
// whatever time between. The first part clears the target. The same draws in the same order
// give the same pixels.
void prom_renderer_prepare_frame(prom_draw_list *list, const prom_model *model,
                                 const prom_cut *cut, const prom_camera *camera,
                                 const prom_frame_options *options);
void prom_renderer_submit_frame(prom_draw_list *list, prom_target *target,
                                const prom_camera *camera, const prom_frame_options *options,
                                size_t first, size_t end);

// The clear colour where nothing is drawn.
extern const uint8_t prom_sky_color[4];

#endif

// Selecting for a renderer of your own: a tutorial that compiles, and is run by the tests.
//
//   embed MODEL.prom BUDGET_MS [PROFILE.json]
//
// It links prom_traverse, prom_benefit and prom_metaobj: no GL, no window, no threads. The
// functions whose names begin with `your_` stand for your renderer; here they print what it
// would do. The headers say the rest: metaobj/container.h, traverse/selector.h,
// traverse/guarantee.h, traverse/visibility.h.
#include "metaobj/container.h"
#include "traverse/bound.h"
#include "traverse/guarantee.h"

#include <stdio.h>
#include <stdlib.h>

enum { FRAMES = 12, WIDTH = 1280, HEIGHT = 720 };

typedef struct embedding {
    prom_container *container; // the file: bulk data are read from it when they are needed
    prom_model model;          // the tree and its tables, whole in memory
    prom_guarantee guarantee;  // what a frame may be predicted at
    prom_visibility *visibility;
    prom_selector *selector;
    prom_cut cut;   // of this frame; its memory is used again and again
    bool *uploaded; // per mesh
    PROM_ARRAY(prom_visible_count) counts;
    prom_camera counted; // that they were seen from
} embedding;

// ---- your renderer

// What your device takes for a frame of nothing, a draw call, a vertex and so on. Better than
// numbers from a data sheet: draw scenes of your own, note their prom_cost_features and times,
// and let prom_cost_fit find the numbers.
static prom_cost_model your_costs(void)
{
    prom_cost_model cost = {.fixed_ms = 0.4,
                            .draw_ms = 0.002,
                            .vertex_ms = 2e-5,
                            .triangle_ms = 1e-4,
                            .hidden_pixel_ms = 5e-7,
                            .margin = 0.1};
    for (int kind = 0; kind < PROM_COST_KINDS; kind++) cost.pixel_ms[kind] = 2e-6;
    return cost;
}

// A mesh is 28-byte vertices and 32-bit indices, ready for a vertex buffer; each of its parts
// has a material, whose texture is read in the same way by prom_container_read_texture.
static prom_status your_upload(embedding *e, uint32_t id, prom_error *error)
{
    prom_mesh mesh;
    prom_status status = prom_container_read_mesh(e->container, &e->model, id, &mesh, error);
    if (status) return status;
    printf("  upload mesh %u: %u vertices, %u triangles\n", id, mesh.vertex_count,
           mesh.index_count / 3);
    for (uint32_t i = 0; i < mesh.submesh_count; i++) {
        uint32_t m = mesh.submeshes[i].material;
        if (m != PROM_NONE && e->model.materials[m].texture != PROM_NONE)
            printf("    and texture %u\n", e->model.materials[m].texture);
    }
    e->uploaded[id] = true;
    prom_mesh_finish(&mesh);
    return PROM_OK;
}

// A mesh at a place: world = origin + basis * position. A box is a mesh of 12 triangles with
// the six pictures of rep->texture, or none.
static prom_status your_draw(embedding *e, uint32_t node, const prom_representation *rep,
                             prom_error *error)
{
    const prom_model *m = &e->model;
    const prom_placement *place = &m->placement[node];
    // Your renderer will want to do this ahead of time; if not, its time goes to `other_ms`.
    prom_status status = e->uploaded[rep->mesh] ? PROM_OK : your_upload(e, rep->mesh, error);
    if (!status)
        printf("  draw node %u \"%s\": %s, mesh %u at %.1f %.1f %.1f\n", node,
               m->names + m->name[node], prom_rep_kind_name(rep->kind), rep->mesh,
               place->origin[0], place->origin[1], place->origin[2]);
    return status;
}

// Pixels that show of each entry, as your id buffer or your occlusion queries have it; here
// half of what it covers by itself. Counts may come some frames late: keep the entries that
// they are of.
static void your_counts(embedding *e)
{
    e->counts.count = 0;
    for (size_t i = 0; i < e->cut.entries.count; i++) {
        const prom_cut_entry *entry = &e->cut.entries.data[i];
        prom_array_push(&e->counts, (prom_visible_count){*entry, 0.5f * entry->footprint_px});
    }
}

// From three times the model's radius away into its middle, along a diagonal.
static prom_camera your_camera(const prom_model *model, int frame)
{
    prom_camera camera = {.fov_y = 1.0f, .z_near = 0.1f, .width = WIDTH, .height = HEIGHT};
    const double *center = model->center[0];
    double away = 3.0 * (double)model->radius[0] * (1.0 - (double)frame / FRAMES);
    for (int k = 0; k < 3; k++) camera.eye[k] = center[k] + 0.6 * away;
    prom_camera_look_at(&camera, center);
    return camera;
}

// ---- a frame

// An entry of the cut may stand for a house or for a whole quarter. Skies and the like are no
// part of the tree: they are drawn whole, behind everything, and the prediction knows it.
static prom_status draw_cut(embedding *e, prom_error *error)
{
    const prom_model *m = &e->model;
    prom_status status = PROM_OK;
    for (size_t i = 0; i < e->cut.entries.count && !status; i++) {
        const prom_cut_entry *entry = &e->cut.entries.data[i];
        status = your_draw(e, entry->node, &m->reps[entry->rep], error);
    }
    for (uint32_t n = m->tree_count; n < m->node_count && !status; n++)
        status = your_draw(e, n, &m->reps[m->prototypes[m->prototype[n]].first_rep], error);
    return status;
}

static prom_status draw_frame(embedding *e, int frame, prom_error *error)
{
    prom_camera camera = your_camera(&e->model, frame);
    prom_view view;
    prom_view_init(&view, &camera);
    // What was counted of the last frame, before this one's camera.
    if (frame)
        prom_visibility_feed(e->visibility, &e->counted, e->counts.data, e->counts.count);
    prom_visibility_begin(e->visibility, &camera);

    // The guarantee turns your budget into what the selector may predict.
    prom_selection selection = {.view = &view,
                                .cost = prom_guarantee_cost(&e->guarantee),
                                .budget_ms = prom_guarantee_allowed(&e->guarantee),
                                .visibility = e->visibility,
                                .certify = true};
    prom_selector_run(e->selector, &selection, &e->cut);

    // The certificate: no choice within the budget shows more than cut.bound, so of what there
    // is to gain over the cheapest picture, at most the gap is missing.
    printf("frame %d: %zu entries, %.2f of %.2f ms, %s, gap at most %.1f %%\n", frame,
           e->cut.entries.count, e->cut.predicted_ms, selection.budget_ms,
           e->cut.feasible ? "fits" : "the least there is", 100 * prom_cut_gap(&e->cut));
    prom_status status = draw_cut(e, error);
    if (status) return status;
    your_counts(e);
    e->counted = camera;

    // From the start of drawing to the finished picture, by your clock. Here the device is a
    // third slower than its cost model says; after a few frames that is known.
    prom_guarantee_frame measured = {.draw_ms = e->cut.predicted_ms * 1.33};
    memcpy(measured.terms_ms, e->cut.terms_ms, sizeof measured.terms_ms);
    prom_guarantee_feed(&e->guarantee, &measured);
    return PROM_OK;
}

// ---- before the first frame, and after the last

static prom_status open_model(embedding *e, const char *path, const char *profile,
                              double budget_ms, prom_error *error)
{
    e->container = prom_container_open(path, error);
    if (!e->container) return error->status;
    prom_status status = prom_container_load_model(e->container, &e->model, error);
    prom_cost_model cost = your_costs();
    if (!status && profile) status = prom_cost_load(profile, &cost, error);
    if (status) return status;
    prom_guarantee_options options = {.budget_ms = budget_ms, .miss_rate = PROM_MISS_RATE};
    prom_guarantee_init(&e->guarantee, &cost, &options);
    e->uploaded = prom_calloc(e->model.mesh_count, sizeof *e->uploaded);
    e->visibility = prom_visibility_create(&e->model, NULL);
    e->selector = prom_selector_create(PROM_SELECTOR_DEFAULT, &e->model, error);
    return e->selector ? PROM_OK : error->status;
}

static void finish(embedding *e)
{
    prom_array_finish(&e->counts);
    prom_cut_finish(&e->cut);
    prom_selector_destroy(e->selector);
    prom_visibility_destroy(e->visibility);
    prom_free(e->uploaded);
    prom_model_finish(&e->model);
    prom_container_close(e->container);
}

int main(int argc, char **argv)
{
    prom_error error = {0};
    embedding e = {0};
    double budget_ms = argc > 2 ? strtod(argv[2], NULL) : 0.0;
    if (argc < 3 || argc > 4 || !(budget_ms > 0.0)) {
        fprintf(stderr, "usage: embed MODEL.prom BUDGET_MS [PROFILE.json]\n");
        return PROM_ERR_USAGE;
    }
    prom_status status = open_model(&e, argv[1], argc > 3 ? argv[3] : NULL, budget_ms, &error);
    for (int frame = 0; frame < FRAMES && !status; frame++)
        status = draw_frame(&e, frame, &error);
    finish(&e);
    if (status) fprintf(stderr, "embed: %s\n", error.text);
    return status;
}

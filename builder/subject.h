// A prototype on its way into the model. Its candidates are drawn on the device, compared with
// the true object in every view bin on all cores, and those worth keeping become its
// representations.
//
// Several subjects are under way at a time: while one is compared, the next is drawn
// (prom_subjects_run). They are settled, and written, in order.
#ifndef PROM_BUILDER_SUBJECT_H
#define PROM_BUILDER_SUBJECT_H

#include "builder/atlas_bake.h"
#include "builder/build.h"
#include "metaobj/base/log.h"

// How a candidate comes into the model.
typedef enum prom_admission {
    PROM_ADMIT_UNMEASURED, // as it is: accuracy 1, no views taken
    PROM_ADMIT_TRUTH,      // it is the object: the others are compared with it
    PROM_ADMIT_MEASURED,   // kept if it is closed enough to be shown at some size
} prom_admission;

// Candidates made from pictures of the truth: a cluster's meshes with atlases; the textured
// box and that of average colours.
#define PROM_MADE_MAX (PROM_CLUSTER_LEVELS + 2)
#define PROM_CANDIDATES_MAX (PROM_LEVELS_MAX + PROM_MADE_MAX)

typedef struct prom_candidate {
    const prom_mesh *mesh; // in the frame of the prototype
    prom_admission admission;
    prom_views views; // their memory is kept from subject to subject
    prom_comparison result;
    // What it becomes; kind, flags, level, error and switch_distance are set at the start.
    prom_representation rep;
    const prom_texture *picture; // of a box: rep.texture; of a mesh: its atlas; NULL: none
    bool kept, outdone;          // outdone: good enough, but another of its level is better
} prom_candidate;

// A candidate's own mesh and picture.
typedef struct prom_made {
    prom_mesh mesh;
    prom_texture picture;
} prom_made;

typedef struct prom_subject {
    prom_build_state *build;
    uint32_t prototype;
    uint64_t views_key; // of what is drawn,
    uint64_t key;       // and of what comes of it
    bool known;         // settled by an earlier build
    bool views_known;   // drawn by one
    prom_candidate candidates[PROM_CANDIDATES_MAX];
    uint32_t count, first_made; // what is made, if anything, stands from first_made on
    prom_made made[PROM_MADE_MAX];
    PROM_ARRAY(prom_draw_item) items; // what shows the truth, relative to the bounds' centre
    PROM_ARRAY(prom_draw_item) large_items; // and in the large views; none: the same
    PROM_ARRAY(prom_sphere) item_spheres;   // around each of either; needed for atlases
    prom_views truth;
    uint32_t child_count; // of a cluster
    uint16_t (*shares)[PROM_DIRS];
    uint16_t coverage[PROM_DIRS];
    prom_loop loop;
    prom_measuring measuring;
    prom_comparison *comparisons[PROM_CANDIDATES_MAX];
    uint32_t comparison_count;
} prom_subject;

// Adds a candidate; `rep` has kind, flags, level, error, switch_distance, texture PROM_NONE.
prom_candidate *prom_subject_add(prom_subject *s, const prom_mesh *mesh,
                                 const prom_representation *rep, prom_admission admission);
// Where the next candidate's own mesh and picture, both empty, are to stand.
prom_made *prom_subject_make(prom_subject *s);
// Forgets what was made; the candidates that have it go with it.
void prom_subject_unmake(prom_subject *s);
// Takes the truth's views, coverage and shares: of the subject's items. Large views if a mesh
// is to be measured, which must have been added.
void prom_subject_take_truth(prom_subject *s);
// Uploads candidate i for its views, and forgets it again; device_id other than PROM_NONE: it
// is there already.
prom_status prom_subject_take_views(prom_subject *s, uint32_t i, uint32_t device_id,
                                    prom_error *error);
// Average-colour box and, if the prototype is to have one, textured box of what the items show,
// as candidates with views. lit: bake the light in (clusters).
prom_status prom_subject_add_boxes(prom_subject *s, bool lit, prom_error *error);
// If the prototype is to have them: the measured meshes once more, with the light and all that
// the items show in an atlas, as candidates with views. Of the two of a level one is kept.
prom_status prom_subject_add_atlases(prom_subject *s, prom_error *error);
// A mesh in its prototype's frame, moved so that the views look at the bounds' centre.
prom_draw_item prom_item_around(uint32_t device_mesh, const float center[3]);

// ---- meshes with atlases (subject_atlas.c)

// The picture is an atlas, not that of a box.
bool prom_candidate_has_atlas(const prom_candidate *c);
// What its mesh is drawn with; rep.shading says whether it is masked.
prom_material prom_atlas_material(const prom_representation *rep, uint32_t texture);
// A view of the mesh, whose one submesh gets a material: the mesh's own keeps PROM_NONE, since
// the material's number is of this build only. `submesh` is where the view's stands.
prom_mesh prom_mesh_with_material(const prom_mesh *mesh, uint32_t material,
                                  prom_submesh *submesh);

// What a kind of subjects does. Both get the number of the subject in the run.
typedef struct prom_subject_class {
    prom_unit_kind kind, views_kind;
    // Sets prototype, views_key, key and items, and adds the mesh candidates. Meshes that later
    // subjects need are uploaded.
    prom_status (*begin)(prom_subject *s, uint32_t index, prom_error *error);
    // Takes truth and views; not called when an earlier build knows them, or the results.
    prom_status (*draw)(prom_subject *s, uint32_t index, prom_error *error);
    // Adds what turned out to be needed, with views, once all else is measured. NULL: nothing.
    prom_status (*amend)(prom_subject *s, uint32_t index, prom_error *error);
    // Notes what the later work needs to know of the settled candidates. NULL: nothing.
    void (*settled)(prom_subject *s, uint32_t index);
} prom_subject_class;

// Runs the subjects [0, count), where `index_of` (NULL: the number itself) gives their indices.
prom_status prom_subjects_run(prom_build_state *b, const prom_subject_class *class,
                              const uint32_t *index_of, uint32_t count, prom_progress *progress,
                              prom_error *error);

static inline float prom_subject_radius(const prom_subject *s)
{
    return s->build->prototypes[s->prototype].radius;
}

static inline bool prom_candidate_is_measured_mesh(const prom_candidate *c)
{
    return c->admission == PROM_ADMIT_MEASURED && c->rep.kind == PROM_REP_MESH;
}

// ---- settling (subject_settle.c)

// Completes the candidates from `first` on by what was measured, and says which may be kept.
void prom_subject_settle(prom_subject *s, uint32_t first);
// Of a mesh and the same with an atlas one is kept, and of levels those that show more than a
// cheaper one.
void prom_subject_choose(prom_subject *s);

// Writes a settled subject (subject_write.c).
prom_status prom_subject_write(prom_subject *s, prom_error *error);

// ---- the store's form (subject_pack.c)

void prom_subject_pack(const prom_subject *s, prom_pack *pack);
// Fills in the results; the mesh candidates have been added. False if the bytes are not such.
bool prom_subject_unpack(prom_subject *s, const prom_pack *pack);
// The same for what was drawn: boxes, coverage, shares and all views.
void prom_subject_pack_views(const prom_subject *s, prom_pack *pack);
bool prom_subject_unpack_views(prom_subject *s, const prom_pack *pack);

#endif

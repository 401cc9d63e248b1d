// Writes a glTF 2.0 binary file (.glb): images, materials, meshes and a tree of nodes.
//
//   glb = prom_glb_create(path)
//   image, material, mesh and node numbers = prom_glb_add_...
//   prom_glb_finish(glb)
//   prom_glb_destroy(glb)
//
// Vertices, indices and pictures go to a temporary file beside the target at once, so that
// memory holds only the nodes. A failure is kept and reported by finish; until then the
// functions may be called on (they do nothing). The file appears complete or not at all.
#ifndef PROM_BUILDER_GLB_WRITER_H
#define PROM_BUILDER_GLB_WRITER_H

#include "metaobj/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PROM_GLB_NONE UINT32_MAX

// v = 0 at the first row of the picture.
typedef struct prom_glb_vertex {
    float position[3], normal[3], uv[2];
} prom_glb_vertex;

// Triangles of one material: counter-clockwise ones face the viewer.
typedef struct prom_glb_part {
    uint32_t material;
    const prom_glb_vertex *vertices;
    const uint16_t (*colors)[4]; // per vertex: linear, straight alpha, 65535 = 1; NULL: white
    const uint32_t *indices;
    uint32_t vertex_count, index_count; // both above 0
} prom_glb_part;

typedef enum prom_glb_alpha { PROM_GLB_OPAQUE, PROM_GLB_MASK, PROM_GLB_BLEND } prom_glb_alpha;

typedef struct prom_glb_material {
    const char *name;
    float base_color[4]; // linear
    uint32_t image;      // PROM_GLB_NONE: colour alone
    prom_glb_alpha alpha;
    float alpha_cutoff; // of PROM_GLB_MASK
    bool double_sided;
} prom_glb_material;

// Scale first, then the turn, then the shift; all relative to the parent.
typedef struct prom_glb_node {
    const char *name;
    uint32_t parent; // PROM_GLB_NONE: a root of the scene; else an earlier node
    uint32_t mesh;   // PROM_GLB_NONE: a group
    double translation[3];
    double yaw;   // radians about +y
    double scale; // the same along each axis
} prom_glb_node;

typedef struct prom_glb prom_glb;

// Never NULL; a path that cannot be written is reported by prom_glb_finish.
prom_glb *prom_glb_create(const char *path);
// Removes what an unfinished file left on disk. NULL is allowed.
void prom_glb_destroy(prom_glb *glb);

// Each returns the number that later calls name it by, counted from 0. Names are copied.
uint32_t prom_glb_add_png(prom_glb *glb, const char *name, const void *png, size_t bytes);
uint32_t prom_glb_add_material(prom_glb *glb, const prom_glb_material *material);
uint32_t prom_glb_add_mesh(prom_glb *glb, const char *name, const prom_glb_part *parts,
                           size_t part_count);
uint32_t prom_glb_add_node(prom_glb *glb, const prom_glb_node *node);

// Triangles of all meshes, each as often as nodes show it.
uint64_t prom_glb_triangles(const prom_glb *glb);
bool prom_glb_failed(const prom_glb *glb);
// Completes the file. `generator` names the maker in the file's header.
prom_status prom_glb_finish(prom_glb *glb, const char *generator, prom_error *error);

#endif

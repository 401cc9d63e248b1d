// A whole mesh through the engine (engine.h): its submeshes are the groups, so that borders
// between them never crack; sheets with two sides are collapsed as one and keep both.
#ifndef PROM_SIMPLIFY_MESH_COLLAPSE_H
#define PROM_SIMPLIFY_MESH_COLLAPSE_H

#include "builder/simplify/engine.h"
#include "builder/simplify/work.h"

typedef struct prom_mesh_collapse {
    prom_work work;
    prom_collapse_mesh mesh;
    prom_collapser *collapser;
} prom_mesh_collapse;

// options->locked and options->records: NULL, since vertices are numbered anew. `mesh` and
// `options` are read here only.
void prom_mesh_collapse_init(prom_mesh_collapse *collapse, const prom_mesh *mesh,
                             const prom_collapse_options *options);
void prom_mesh_collapse_finish(prom_mesh_collapse *collapse); // {0} is allowed
// As prom_collapser_run, with triangles counted with their back sides.
float prom_mesh_collapse_run(prom_mesh_collapse *collapse, uint32_t target_triangles,
                             float max_error);
// Triangles left, with back sides.
uint32_t prom_mesh_collapse_triangles(const prom_mesh_collapse *collapse);
// The mesh as it stands, in an order that suits caches; none of its vertices is in two
// submeshes. Owned by the caller. May be called once.
void prom_mesh_collapse_emit(prom_mesh_collapse *collapse, prom_mesh *out);

// The faces that are left of a mesh over the work's vertices and owners; vertices that
// collapses made are appended to the work.
void prom_collapse_mesh_faces(const prom_collapse_mesh *mesh, prom_work *work,
                              prom_index_array *out);

#endif

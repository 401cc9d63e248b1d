// A scene file as one mesh, for tools that look at single meshes.
#ifndef PROM_BUILDER_MESH_FILE_H
#define PROM_BUILDER_MESH_FILE_H

#include "builder/source.h"

typedef struct prom_mesh_file {
    double origin[3];   // of the mesh, in the scene's world
    prom_mesh mesh;     // every node's own meshes, placed; one submesh per material
    prom_source source; // has the materials that the mesh names, and their pictures
} prom_mesh_file;

// Reads whatever prom_source_import does; options: as there, NULL for its defaults. origin:
// what positions become relative to; NULL: a round place near the centre of the bounds, from
// which floats of the file are told exactly, so that writing gives them back. Fails as import
// does, and with PROM_ERR_UNSUPPORTED where instances make more than a mesh can hold; *file is
// then {0}.
prom_status prom_mesh_file_read(const char *path, const prom_import_options *options,
                                const double origin[3], prom_mesh_file *file,
                                prom_error *error);
void prom_mesh_file_finish(prom_mesh_file *file); // {0} is allowed

#endif

// Writes a mesh with its materials as a file for other programs: Wavefront OBJ with its MTL,
// PLY (binary, little-endian) or glTF binary, by the ending of the name.
//
// What a format cannot hold:
//   OBJ  that opaque materials show from both sides, alpha of vertex colours; where there are
//        vertex colours, the material's goes into them, since readers take one of both
//   PLY  materials: their colours go into the vertices', and their picture is named only where
//        all share one; readers may show both sides
#ifndef PROM_BUILDER_MESH_WRITE_H
#define PROM_BUILDER_MESH_WRITE_H

#include "builder/mesh_file.h"

// ".obj", ".ply" and ".glb", in any case.
bool prom_mesh_write_known(const char *path);

// Writes all or nothing, positions in the scene's world. `path` is of a known ending;
// file->mesh has triangles, and none of its vertices in two submeshes.
//
// OBJ and PLY name the pictures' files where they can (relative to the mesh), those of `scene`,
// the file that the mesh came from. Others (embedded ones, or with an alpha that is not to be
// seen) are written beside the mesh as PATH-0.png and so on; with `scene` NULL all of them. An
// MTL that this program has not written is not replaced: PROM_ERR_USAGE.
prom_status prom_mesh_write(const char *path, const prom_mesh_file *file, const char *scene,
                            prom_error *error);

#endif

// Private to import: what its pieces share. import.c runs the child (child.h); everything
// that touches the foreign file (import_gltf*.c, import_file.c, import_scene.c,
// import_levels.c, import_axes.c, import_mesh.c, import_material.c) runs in it, and decoding of
// pictures (import_image.c) in children of its own (import_workers.c); import_wire.c carries
// the result over.
#ifndef PROM_BUILDER_IMPORT_PARTS_H
#define PROM_BUILDER_IMPORT_PARTS_H

#include "builder/child.h"
#include "builder/import_gltf.h"
#include "builder/source.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/scene.h>
#include <stdio.h>

// The child's work.
typedef struct prom_import {
    const char *path;
    prom_import_options options; // zeros replaced by the defaults
    const struct aiScene *scene;
    bool gltf;                         // colours and factors are linear, alpha modes are given
    prom_gltf gltf_file;               // what was read before assimp, empty for other formats
    bool both_sides;                   // every surface is seen from both
    double unit;                       // distances of the file to those of the source
    PROM_ARRAY(uint32_t) node_numbers; // per node of the source, while gltf_file.numbered
    prom_source *source;               // the result
    PROM_ARRAY(char *) warnings;
    char *doing; // PROM_CHILD_DOING bytes that the parent can read after a crash
} prom_import;

// Called in the child before it reads, for tests that simulate a crash or a hang. NULL.
extern void (*prom_import_child_hook)(void);

void prom_import_doing(prom_import *import, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void prom_import_warn(prom_import *import, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// import_scene.c: reads the file into import->source.
prom_status prom_import_run(prom_import *import, prom_error *error);

void prom_import_multiply(const double a[16], const double b[16], double out[16]); // a b

// import_file.c: assimp's way to files; lives as long as `import`.
struct aiFileIO prom_import_files(prom_import *import);

// import_axes.c: up axis and unit. prepare: before reading, what loaders are to do about them.
// apply: to the root's matrix, after reading; sets import->unit.
void prom_import_axes_prepare(const prom_import *import, struct aiPropertyStore *settings);
void prom_import_axes_apply(prom_import *import, double root[16]);

// import_ac3d.c: assimp does not tell which surfaces of an AC3D file are seen from both sides;
// true when some are. False for other formats.
bool prom_import_ac3d_both_sides(const char *path);

// import_levels.c: once nodes and meshes are read, puts the levels that import_gltf_lod.c found
// where they belong.
void prom_import_levels_attach(prom_import *import);

// import_mesh.c: how the vertices of a mesh are to be read.
typedef struct prom_import_mesh_options {
    uint32_t uv_channel;
    bool linear_colors; // vertex colours are linear (glTF), else sRGB-encoded
    uint32_t material;
} prom_import_mesh_options;

// One submesh, equal vertices joined, normals made where missing. False when no triangle is
// left. *dropped grows by the triangles left out because a vertex is not finite.
bool prom_import_mesh_read(const struct aiMesh *mesh, const prom_import_mesh_options *options,
                           prom_mesh *out, uint64_t *dropped);

// Applies an affine matrix, column-major.
void prom_import_mesh_transform(prom_mesh *mesh, const double m[16]);

// import_normals.c: a unit normal per corner, angle-weighted over the faces around its vertex
// (Thuermer and Wuethrich 1998) that lie within the crease angle. Vertices at equal positions
// count as one. Triangles must have three different corners.
void prom_import_normals(const float (*positions)[3], uint32_t vertex_count,
                         const uint32_t *indices, uint32_t index_count, double crease_cos,
                         float (*normals)[3]);

// What the meshes tell about a material.
typedef struct prom_import_use {
    bool used, colored, uncolored; // by a mesh with vertex colours, by one without
    float min_alpha;               // of vertex colours
} prom_import_use;

typedef struct prom_import_material_map {
    uint32_t material; // index into source->materials
    uint32_t uv_channel;
} prom_import_material_map;

// import_material.c: fills source->materials and source->images; uses and map have a row per
// material of the scene. Equal materials become one; unused ones are left out.
void prom_import_materials(prom_import *import, const prom_import_use *uses,
                           prom_import_material_map *map);

// import_image.c: a picture to be decoded.
typedef struct prom_import_picture {
    const char *color;    // as the scene names it, or NULL: white
    const char *mask;     // a separate picture of the opacity, or NULL
    const char *material; // the first that uses it, for messages
    uint32_t width, height;
    uint8_t *rgba;
    uint8_t min_alpha;
    bool missing;
    char *warning; // NULL: all is well
} prom_import_picture;

// Decodes one, in this process. A missing or broken one becomes one neutral grey texel.
void prom_import_picture_decode(const prom_import *import, prom_import_picture *picture);
void prom_import_picture_lost(prom_import_picture *picture, const prom_error *error);

// import_workers.c: decodes all of them, in as many processes as there are cores. A crash or a
// hang of a decoder loses one picture.
void prom_import_pictures(prom_import *import, prom_import_picture *pictures, size_t count);

// Called before a picture is decoded, for tests that simulate a crash or a hang. NULL.
extern void (*prom_import_picture_hook)(const char *name);

// import_wire.c: the result of the child as bytes. Pack ends with false when the file cannot
// take them. Unpack trusts nothing: every count, index and number is checked.
bool prom_import_pack(FILE *file, const prom_source *source, char *const *warnings,
                      size_t warning_count, const prom_error *error);
prom_status prom_import_unpack(const uint8_t *data, size_t bytes, const char *path,
                               prom_source *source, prom_error *error);

#endif

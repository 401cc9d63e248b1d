// Private to writing meshes: what the formats share. mesh_write.c has the formats' list and
// GLB, mesh_write_obj.c and mesh_write_ply.c theirs, mesh_write_pictures.c finds names for
// pictures.
#ifndef PROM_BUILDER_MESH_WRITE_PARTS_H
#define PROM_BUILDER_MESH_WRITE_PARTS_H

#include "builder/mesh_write.h"
#include "builder/staged_files.h"

prom_status prom_mesh_write_obj(const char *path, const prom_mesh_file *file, const char *scene,
                                prom_error *error);
prom_status prom_mesh_write_ply(const char *path, const prom_mesh_file *file, const char *scene,
                                prom_error *error);
prom_status prom_mesh_write_glb(const char *path, const prom_mesh_file *file,
                                prom_error *error);

// White for PROM_NONE.
prom_material prom_write_material(const prom_mesh_file *file, uint32_t material);
void prom_write_normal(const prom_vertex *vertex, float normal[3]); // of unit length
bool prom_write_has_colors(const prom_mesh *mesh);                  // that are not white
// A vertex's colour times its material's, sRGB-encoded, straight alpha.
void prom_write_color(const prom_vertex *vertex, const prom_material *material,
                      uint8_t color[4]);
// 3 unless a pixel is not opaque, then 4; of `opaque` materials always 3.
prom_status prom_write_png(const prom_source_image *image, bool opaque, uint8_t **png,
                           size_t *bytes, prom_error *error);

// The names by which a material's picture is found from the mesh; NULL: none.
typedef struct prom_picture_names {
    char *color, *mask;
} prom_picture_names;

typedef struct prom_picture_writer {
    const char *path, *scene; // as in prom_mesh_write
    const prom_source *source;
    bool masks;                // the format can name a picture for the alpha alone
    prom_staged_files *staged; // takes the pictures that must be written
    PROM_ARRAY(uint32_t) keys; // of those that were: 2 x image + 1 if opaque
} prom_picture_writer;

// The material has a texture. Writes the picture if it must be and has not been.
prom_status prom_picture_name(prom_picture_writer *writer, const prom_material *material,
                              prom_picture_names *names, prom_error *error);
void prom_picture_names_finish(prom_picture_names *names);
void prom_picture_writer_finish(prom_picture_writer *writer);

#endif

#include "builder/source.h"

void prom_source_finish(prom_source *source)
{
    for (size_t i = 0; i < source->meshes.count; i++) prom_mesh_finish(&source->meshes.data[i]);
    for (size_t i = 0; i < source->images.count; i++) prom_free(source->images.data[i].rgba);
    prom_array_finish(&source->nodes);
    prom_array_finish(&source->mesh_refs);
    prom_array_finish(&source->levels);
    prom_array_finish(&source->meshes);
    prom_array_finish(&source->materials);
    prom_array_finish(&source->images);
    prom_arena_finish(&source->strings);
    *source = (prom_source){0};
}

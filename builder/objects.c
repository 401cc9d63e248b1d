#include "builder/objects.h"

#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"

// The objects of a group's first member, repeated for the others.
static void repeat_members(prom_finder *finder, const prom_scope *scope, size_t first)
{
    prom_objects *out = finder->out;
    size_t count = out->objects.count - first;
    const prom_source_node *nodes = finder->source->nodes.data;
    const double *home = &nodes[scope->roots.data[0]].world[12];
    if (!count) return;
    for (size_t m = 0; m < scope->roots.count; m++) {
        const double *at = &nodes[scope->roots.data[m]].world[12];
        uint32_t group = (uint32_t)out->groups.count;
        prom_array_push(&out->groups,
                        (prom_group){.kind = scope->group_kind,
                                     .origin = {at[0], at[1], at[2]},
                                     .first_object = (uint32_t)(first + m * count),
                                     .object_count = (uint32_t)count});
        prom_object *o =
            m ? prom_array_extend(&out->objects, count) : out->objects.data + first;
        for (size_t i = 0; i < count; i++) {
            if (m) {
                o[i] = out->objects.data[first + i];
                out->shapes.data[o[i].shape].instances++;
                for (int k = 0; k < 3; k++) o[i].placement.origin[k] += at[k] - home[k];
            }
            o[i].group = group;
        }
    }
}

static void make_objects(prom_finder *finder)
{
    for (size_t i = 0; i < finder->scopes.count; i++) {
        const prom_scope *scope = &finder->scopes.data[i];
        size_t first = finder->out->objects.count;
        prom_make_scope(finder, scope);
        uint32_t members = scope->roots.count ? (uint32_t)scope->roots.count : 1;
        finder->out->split += finder->split * members;
        finder->out->gathered += finder->gathered * members;
        if (scope->roots.count) repeat_members(finder, scope, first);
    }
}

static void sum_up(prom_objects *out)
{
    prom_wbox layout = PROM_WBOX_EMPTY;
    for (size_t i = 0; i < out->objects.count; i++) {
        const prom_object *o = &out->objects.data[i];
        const prom_shape *shape = &out->shapes.data[o->shape];
        out->chunks += shape->layer == PROM_LAYER_SURFACE;
        out->backdrops += shape->layer == PROM_LAYER_BACKDROP;
        out->blended += shape->layer == PROM_LAYER_BLENDED;
        out->instanced += shape->instances > 1;
        if (shape->layer == PROM_LAYER_BACKDROP) continue;
        prom_wbox b = prom_wbox_of_placed(&shape->bounds, &o->placement);
        prom_wbox_add(&layout, &b);
    }
    for (int k = 0; k < 3; k++) {
        out->layout.min[k] = (float)layout.min[k];
        out->layout.max[k] = (float)layout.max[k];
    }
}

static void finish_finder(prom_finder *finder)
{
    for (size_t i = 0; i < finder->uses.count; i++) {
        prom_free(finder->uses.data[i].world);
        prom_free(finder->uses.data[i].copy);
        prom_free(finder->uses.data[i].stamp);
    }
    for (size_t i = 0; i < finder->scopes.count; i++)
        prom_array_finish(&finder->scopes.data[i].roots);
    prom_array_finish(&finder->scopes);
    prom_array_finish(&finder->parts);
    prom_array_finish(&finder->part_meshes);
    prom_array_finish(&finder->part_levels);
    prom_array_finish(&finder->uses);
    prom_array_finish(&finder->faces);
    prom_array_finish(&finder->items);
    prom_free(finder->node_scope);
    prom_free(finder->node_name);
    prom_free(finder->node_weight);
    prom_free(finder->kind_shape);
}

// Only one given: the other's default must not stand in its way.
prom_object_options prom_object_options_resolved(prom_object_options o)
{
    uint32_t most = o.max_triangles, least = o.min_triangles;
    if (!most)
        o.max_triangles = least > PROM_OBJECT_TRIANGLES_MAX ? least : PROM_OBJECT_TRIANGLES_MAX;
    if (!least)
        o.min_triangles =
            most && most < PROM_OBJECT_TRIANGLES_MIN ? most : PROM_OBJECT_TRIANGLES_MIN;
    return o;
}

static prom_status check_options(prom_object_options *o, prom_error *error)
{
    *o = prom_object_options_resolved(*o);
    if (o->min_triangles > o->max_triangles)
        return prom_fail(error, PROM_ERR_USAGE,
                         "objects: the least triangles (%u) exceed the most (%u); lower the "
                         "first or raise the second",
                         o->min_triangles, o->max_triangles);
    if (!(o->chunk_size >= 0) || !isfinite(o->chunk_size))
        return prom_fail(error, PROM_ERR_USAGE,
                         "objects: a chunk size of %g is not a length; give a positive one",
                         o->chunk_size);
    return PROM_OK;
}

prom_status prom_objects_find(const prom_source *source, const prom_object_options *options,
                              prom_objects *objects, prom_error *error)
{
    memset(objects, 0, sizeof *objects);
    prom_finder finder = {.source = source, .out = objects};
    if (options) finder.options = *options;
    prom_status status = check_options(&finder.options, error);
    if (status != PROM_OK) return status;

    prom_find_groups(&finder);
    status = prom_find_parts(&finder, error);
    if (status != PROM_OK) goto done;
    size_t nodes = source->nodes.count;
    finder.node_name = prom_alloc(nodes, sizeof *finder.node_name);
    memset(finder.node_name, 0xff, nodes * sizeof *finder.node_name);
    finder.node_weight = prom_calloc(nodes, sizeof *finder.node_weight);
    prom_array_push(&objects->names, '\0');
    prom_find_items(&finder);
    prom_find_layout(&finder);
    make_objects(&finder);
    sum_up(objects);
done:
    finish_finder(&finder);
    return status;
}

void prom_objects_finish(prom_objects *objects)
{
    for (size_t i = 0; i < objects->shapes.count; i++) {
        prom_shape *shape = &objects->shapes.data[i];
        prom_mesh_finish(&shape->mesh);
        for (uint32_t k = 0; k < shape->level_count; k++)
            prom_mesh_finish(&shape->levels[k].mesh);
        prom_free(shape->levels);
    }
    prom_array_finish(&objects->shapes);
    prom_array_finish(&objects->objects);
    prom_array_finish(&objects->groups);
    prom_array_finish(&objects->names);
}

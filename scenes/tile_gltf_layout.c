#include "scenes/tile_gltf_layout.h"

#include <math.h>
#include <stdlib.h>

#define BACKDROP_RATIO 3.0
#define MAX_DEPTH 512u
enum { FLOAT32 = 5126 };

// ---- transforms

static bool numbers(const json_t *array, size_t count, double *out)
{
    if (json_array_size(array) != count) return false;
    for (size_t i = 0; i < count; i++) {
        const json_t *value = json_array_get(array, i);
        if (!json_is_number(value) || !isfinite(json_number_value(value))) return false;
        out[i] = json_number_value(value);
    }
    return true;
}

static void compose(const double t[3], const double q[4], const double s[3], double m[16])
{
    double x = q[0], y = q[1], z = q[2], w = q[3];
    const double columns[16] = {s[0] * (1 - 2 * (y * y + z * z)),
                                s[0] * 2 * (x * y + z * w),
                                s[0] * 2 * (x * z - y * w),
                                0,
                                s[1] * 2 * (x * y - z * w),
                                s[1] * (1 - 2 * (x * x + z * z)),
                                s[1] * 2 * (y * z + x * w),
                                0,
                                s[2] * 2 * (x * z + y * w),
                                s[2] * 2 * (y * z - x * w),
                                s[2] * (1 - 2 * (x * x + y * y)),
                                0,
                                t[0],
                                t[1],
                                t[2],
                                1};
    memcpy(m, columns, sizeof columns);
}

static void local_of(const json_t *node, double m[16])
{
    double t[3] = {0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    if (numbers(json_object_get(node, "matrix"), 16, m)) return;
    numbers(json_object_get(node, "translation"), 3, t);
    numbers(json_object_get(node, "rotation"), 4, q);
    numbers(json_object_get(node, "scale"), 3, s);
    compose(t, q, s, m);
}

static void multiply(const double a[16], const double b[16], double out[16])
{
    for (int i = 0; i < 16; i++) {
        out[i] = 0;
        for (int k = 0; k < 4; k++) out[i] += a[k * 4 + i % 4] * b[i / 4 * 4 + k];
    }
}

// ---- bounds of primitives

// From the vertices themselves, where the accessor names no bounds.
static bool bounds_from_data(const prom_tile_gltf *gltf, const json_t *accessor, double min[3],
                             double max[3])
{
    const json_t *views = json_object_get(gltf->root, "bufferViews");
    size_t v;
    if (!prom_tile_gltf_index(accessor, "bufferView", json_array_size(views), &v)) return false;
    const json_t *view = json_array_get(views, v);
    uint64_t count = prom_tile_gltf_bytes(accessor, "count", 0);
    uint64_t offset = prom_tile_gltf_bytes(accessor, "byteOffset", 0);
    uint64_t stride = prom_tile_gltf_bytes(view, "byteStride", 12);
    uint64_t start = prom_tile_gltf_bytes(view, "byteOffset", 0);
    uint64_t length = prom_tile_gltf_bytes(view, "byteLength", 0);
    bool fits = stride >= 12 && stride <= 252 && count && count <= length && offset <= length &&
                (count - 1) * stride + 12 <= length - offset;
    const json_t *type = json_object_get(accessor, "componentType");
    if (!fits || json_integer_value(type) != FLOAT32) return false;
    for (int a = 0; a < 3; a++) min[a] = INFINITY, max[a] = -INFINITY;
    for (uint64_t i = 0; i < count; i++) {
        float p[3];
        memcpy(p, gltf->bin.data + start + offset + i * stride, sizeof p);
        for (int a = 0; a < 3; a++) {
            min[a] = fmin(min[a], (double)p[a]);
            max[a] = fmax(max[a], (double)p[a]);
        }
    }
    return isfinite(min[0] + min[1] + min[2] + max[0] + max[1] + max[2]);
}

static bool bounds_of(const prom_tile_gltf *gltf, const json_t *primitive, double min[3],
                      double max[3])
{
    const json_t *accessors = json_object_get(gltf->root, "accessors");
    size_t a;
    if (!prom_tile_gltf_index(json_object_get(primitive, "attributes"), "POSITION",
                              json_array_size(accessors), &a))
        return false;
    const json_t *accessor = json_array_get(accessors, a);
    return (numbers(json_object_get(accessor, "min"), 3, min) &&
            numbers(json_object_get(accessor, "max"), 3, max)) ||
           bounds_from_data(gltf, accessor, min, max);
}

static void to_world(const double m[16], const double min[3], const double max[3],
                     prom_tile_gltf_part *part)
{
    for (int a = 0; a < 3; a++) {
        part->min[a] = part->max[a] = m[12 + a];
        for (int k = 0; k < 3; k++) {
            double low = m[k * 4 + a] * min[k], high = m[k * 4 + a] * max[k];
            part->min[a] += fmin(low, high);
            part->max[a] += fmax(low, high);
        }
    }
}

static void add_parts(const prom_tile_gltf *gltf, uint32_t node, prom_tile_gltf_layout *layout)
{
    const json_t *meshes = json_object_get(gltf->root, "meshes");
    const json_t *json = json_array_get(json_object_get(gltf->root, "nodes"), node), *primitive;
    size_t mesh, p;
    if (!prom_tile_gltf_index(json, "mesh", json_array_size(meshes), &mesh)) return;
    json_array_foreach(json_object_get(json_array_get(meshes, mesh), "primitives"), p,
                       primitive)
    {
        double min[3], max[3];
        if (!bounds_of(gltf, primitive, min, max)) continue;
        prom_tile_gltf_part part = {
            .node = node, .mesh = (uint32_t)mesh, .primitive = (uint32_t)p};
        to_world(layout->world[node], min, max, &part);
        prom_array_push(&layout->parts, part);
    }
}

// ---- the walk

typedef struct visit {
    uint32_t node, depth;
    const double *parent; // world matrix
} visit;

typedef PROM_ARRAY(visit) visit_stack;

static bool push_all(const json_t *indices, size_t node_count, uint32_t depth,
                     const double *parent, visit_stack *stack)
{
    for (size_t i = json_array_size(indices); i-- > 0;) {
        json_int_t n = json_integer_value(json_array_get(indices, i));
        bool good = json_is_integer(json_array_get(indices, i)) && n >= 0 &&
                    (uint64_t)n < node_count && depth < MAX_DEPTH;
        if (!good) return false;
        prom_array_push(stack, (visit){(uint32_t)n, depth, parent});
    }
    return true;
}

static prom_status walk(const prom_tile_gltf *gltf, const char *path, const json_t *roots,
                        prom_tile_gltf_layout *layout, prom_error *error)
{
    static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const json_t *nodes = json_object_get(gltf->root, "nodes");
    size_t count = json_array_size(nodes);
    layout->world = prom_calloc(count, sizeof *layout->world);
    layout->placed = prom_calloc(count, sizeof *layout->placed);
    visit_stack stack = {0};
    bool good = push_all(roots, count, 0, identity, &stack);
    while (good && stack.count) {
        visit at = stack.data[--stack.count];
        const json_t *node = json_array_get(nodes, at.node);
        if (layout->placed[at.node] || !json_is_object(node)) good = false;
        if (!good) break;
        layout->placed[at.node] = true;
        double local[16];
        local_of(node, local);
        multiply(at.parent, local, layout->world[at.node]);
        add_parts(gltf, at.node, layout);
        good = push_all(json_object_get(node, "children"), count, at.depth + 1,
                        layout->world[at.node], &stack);
    }
    prom_array_finish(&stack);
    if (good) return PROM_OK;
    return prom_fail(error, PROM_ERR_INPUT,
                     "%s: its nodes are no tree (a child is missing, has two parents or stands "
                     "below itself); the file is damaged",
                     path);
}

// ---- the backdrop

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double middle_range(const prom_tile_gltf_layout *layout, int axis)
{
    size_t n = layout->parts.count;
    double *centers = prom_alloc(n, sizeof *centers);
    for (size_t i = 0; i < n; i++)
        centers[i] = (layout->parts.data[i].min[axis] + layout->parts.data[i].max[axis]) / 2;
    qsort(centers, n, sizeof *centers, ascending);
    double range = centers[n - 1 - n / 20] - centers[n / 20];
    prom_free(centers);
    return range;
}

static double width_of(const prom_tile_gltf_part *part)
{
    return fmax(part->max[0] - part->min[0], part->max[2] - part->min[2]);
}

static void find_backdrop(prom_tile_gltf_layout *layout)
{
    enum { FEW = 20 }; // with fewer parts nine in ten of them say nothing
    double middle = fmax(middle_range(layout, 0), middle_range(layout, 2));
    for (int a = 0; a < 3; a++) layout->min[a] = INFINITY, layout->max[a] = -INFINITY;
    for (size_t i = 0; i < layout->parts.count; i++) {
        prom_tile_gltf_part *part = &layout->parts.data[i];
        part->backdrop = layout->parts.count >= FEW && width_of(part) > BACKDROP_RATIO * middle;
        layout->backdrops += part->backdrop;
        for (int a = 0; a < 3 && !part->backdrop; a++) {
            layout->min[a] = fmin(layout->min[a], part->min[a]);
            layout->max[a] = fmax(layout->max[a], part->max[a]);
        }
    }
}

prom_status prom_tile_gltf_layout_find(const prom_tile_gltf *gltf, const char *path,
                                       const json_t *roots, prom_tile_gltf_layout *layout,
                                       prom_error *error)
{
    *layout = (prom_tile_gltf_layout){0};
    prom_status status = walk(gltf, path, roots, layout, error);
    if (!status && !layout->parts.count)
        status = prom_fail(error, PROM_ERR_INPUT, "%s: its scene has no geometry", path);
    if (!status) find_backdrop(layout);
    if (status) prom_tile_gltf_layout_finish(layout);
    return status;
}

void prom_tile_gltf_layout_finish(prom_tile_gltf_layout *layout)
{
    prom_array_finish(&layout->parts);
    prom_free(layout->world);
    prom_free(layout->placed);
    *layout = (prom_tile_gltf_layout){0};
}

// LINK: prom_scenes prom_builder prom_metaobj PkgConfig::JANSSON
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "builder/glb_writer.h"
#include "metaobj/base/alloc.h"
#include "scenes/city.h"
#include "scenes/path.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// ---- a small reader, apart from the writer

typedef struct glb {
    uint8_t *bytes;
    size_t size;
    json_t *json;
    const uint8_t *bin;
    size_t bin_bytes;
} glb;

static uint32_t word(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static void read_bytes(const char *path, uint8_t **bytes, size_t *size)
{
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    assert_int_equal(fseek(f, 0, SEEK_END), 0);
    *size = (size_t)ftell(f);
    rewind(f);
    *bytes = prom_alloc(*size, 1);
    assert_int_equal(fread(*bytes, 1, *size, f), *size);
    fclose(f);
}

static void open_glb(const char *path, glb *g)
{
    read_bytes(path, &g->bytes, &g->size);
    assert_true(g->size > 28);
    assert_memory_equal(g->bytes, "glTF", 4);
    assert_int_equal(word(g->bytes + 4), 2);
    assert_int_equal(word(g->bytes + 8), g->size);
    size_t json_bytes = word(g->bytes + 12);
    assert_memory_equal(g->bytes + 16, "JSON", 4);
    assert_int_equal(json_bytes % 4, 0);
    assert_true(20 + json_bytes + 8 <= g->size);
    json_error_t error;
    g->json = json_loadb((const char *)g->bytes + 20, json_bytes, 0, &error);
    assert_non_null(g->json);
    g->bin_bytes = word(g->bytes + 20 + json_bytes);
    assert_memory_equal(g->bytes + 24 + json_bytes, "BIN", 4);
    g->bin = g->bytes + 28 + json_bytes;
    assert_int_equal(28 + json_bytes + g->bin_bytes, g->size);
}

static void close_glb(glb *g)
{
    json_decref(g->json);
    prom_free(g->bytes);
}

static size_t number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    return value ? (size_t)json_integer_value(value) : 0;
}

static json_t *item(const glb *g, const char *array, size_t i)
{
    json_t *value = json_array_get(json_object_get(g->json, array), i);
    assert_non_null(value);
    return value;
}

static size_t count_of(const glb *g, const char *array)
{
    return json_array_size(json_object_get(g->json, array));
}

// The bytes of an accessor's elements, checked to lie in the file.
static const uint8_t *elements(const glb *g, size_t accessor, size_t bytes, size_t *count,
                               size_t *stride)
{
    const json_t *a = item(g, "accessors", accessor);
    const json_t *v = item(g, "bufferViews", number(a, "bufferView"));
    size_t start = number(v, "byteOffset") + number(a, "byteOffset");
    *count = number(a, "count");
    *stride = number(v, "byteStride") ? number(v, "byteStride") : bytes;
    assert_true(*count > 0);
    assert_int_equal(start % 4, 0);
    assert_true(number(a, "byteOffset") + *stride * (*count - 1) + bytes <=
                number(v, "byteLength"));
    assert_true(number(v, "byteOffset") + number(v, "byteLength") <= g->bin_bytes);
    return g->bin + start;
}

static size_t mesh_triangles(const glb *g, size_t mesh)
{
    size_t n = 0;
    json_t *primitives = json_object_get(item(g, "meshes", mesh), "primitives");
    for (size_t i = 0; i < json_array_size(primitives); i++)
        n += number(item(g, "accessors", number(json_array_get(primitives, i), "indices")),
                    "count") /
             3;
    return n;
}

// Times that each mesh is shown; also checks that the nodes are a tree.
static size_t *count_instances(const glb *g)
{
    size_t nodes = count_of(g, "nodes"), meshes = count_of(g, "meshes");
    size_t *uses = prom_calloc(meshes, sizeof *uses),
           *parents = prom_calloc(nodes, sizeof *parents);
    size_t edges = 0;
    for (size_t i = 0; i < nodes; i++) {
        const json_t *n = item(g, "nodes", i);
        assert_non_null(json_string_value(json_object_get(n, "name")));
        if (json_object_get(n, "mesh")) {
            assert_true(number(n, "mesh") < meshes);
            uses[number(n, "mesh")]++;
        }
        const json_t *children = json_object_get(n, "children");
        for (size_t k = 0; k < json_array_size(children); k++, edges++) {
            size_t child = (size_t)json_integer_value(json_array_get(children, k));
            assert_true(child > i && child < nodes);
            assert_int_equal(parents[child]++, 0);
        }
    }
    assert_int_equal(edges, nodes - 1); // one root
    prom_free(parents);
    return uses;
}

static uint64_t instanced_triangles(const glb *g)
{
    uint64_t n = 0;
    size_t *uses = count_instances(g);
    for (size_t i = 0; i < count_of(g, "meshes"); i++) n += uses[i] * mesh_triangles(g, i);
    prom_free(uses);
    return n;
}

// ---- the contents

static void check_vertices(const glb *g, const json_t *primitive, size_t *vertices)
{
    const json_t *attributes = json_object_get(primitive, "attributes");
    size_t stride, n;
    const json_t *a = item(g, "accessors", number(attributes, "POSITION"));
    const uint8_t *p = elements(g, number(attributes, "POSITION"), 12, vertices, &stride);
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < *vertices; i++) {
        float v[3];
        memcpy(v, p + i * stride, sizeof v);
        for (int k = 0; k < 3; k++) {
            assert_true(isfinite(v[k]));
            low[k] = fminf(low[k], v[k]);
            high[k] = fmaxf(high[k], v[k]);
        }
    }
    for (size_t k = 0; k < 3; k++) {
        assert_true((float)json_number_value(json_array_get(json_object_get(a, "min"), k)) ==
                    low[k]);
        assert_true((float)json_number_value(json_array_get(json_object_get(a, "max"), k)) ==
                    high[k]);
    }
    p = elements(g, number(attributes, "NORMAL"), 12, &n, &stride);
    assert_int_equal(n, *vertices);
    for (size_t i = 0; i < n; i++) {
        float v[3];
        memcpy(v, p + i * stride, sizeof v);
        assert_true(fabsf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - 1) < 1e-4f);
    }
    p = elements(g, number(attributes, "TEXCOORD_0"), 8, &n, &stride);
    assert_int_equal(n, *vertices);
    for (size_t i = 0; i < n; i++) {
        float v[2];
        memcpy(v, p + i * stride, sizeof v);
        assert_true(isfinite(v[0]) && isfinite(v[1]) && fabsf(v[0]) < 1e4f &&
                    fabsf(v[1]) < 1e4f);
    }
}

static uint32_t index_at(const uint8_t *p, size_t i, bool wide)
{
    return wide ? word(p + 4 * i) : (uint32_t)p[2 * i] | (uint32_t)p[2 * i + 1] << 8;
}

// A vertex attribute of three floats.
typedef struct attribute {
    const uint8_t *bytes;
    size_t count, stride;
} attribute;

static attribute open_attribute(const glb *g, const json_t *primitive, const char *what)
{
    attribute a;
    const json_t *attributes = json_object_get(primitive, "attributes");
    a.bytes = elements(g, number(attributes, what), 12, &a.count, &a.stride);
    return a;
}

static void load_vertex(const attribute *a, uint32_t i, float out[3])
{
    assert_true(i < a->count);
    memcpy(out, a->bytes + i * a->stride, 12);
}

// Triangles by whether their winding agrees with their vertices' normals.
static void check_triangles(const glb *g, const json_t *primitive, size_t vertices,
                            size_t sides[2], size_t *empty)
{
    size_t n, stride;
    const json_t *a = item(g, "accessors", number(primitive, "indices"));
    bool wide = number(a, "componentType") == 5125;
    assert_true(wide || number(a, "componentType") == 5123);
    const uint8_t *p = elements(g, number(primitive, "indices"), wide ? 4 : 2, &n, &stride);
    assert_int_equal(n % 3, 0);
    attribute positions = open_attribute(g, primitive, "POSITION");
    attribute normals = open_attribute(g, primitive, "NORMAL");
    for (size_t i = 0; i < n; i += 3) {
        float v[3][3], m[3] = {0}, c[3];
        for (size_t k = 0; k < 3; k++) {
            float normal[3];
            uint32_t id = index_at(p, i + k, wide);
            assert_true(id < vertices);
            load_vertex(&positions, id, v[k]);
            load_vertex(&normals, id, normal);
            for (int j = 0; j < 3; j++) m[j] += normal[j];
        }
        for (int j = 0; j < 3; j++) {
            int x = (j + 1) % 3, y = (j + 2) % 3;
            c[j] = (v[1][x] - v[0][x]) * (v[2][y] - v[0][y]) -
                   (v[1][y] - v[0][y]) * (v[2][x] - v[0][x]);
        }
        float area = sqrtf(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        *empty += area < 1e-9f;
        sides[c[0] * m[0] + c[1] * m[1] + c[2] * m[2] < -1e-3f * area]++;
    }
}

static void make_city(const char *path, const char *walk, prom_city_options options,
                      uint64_t *triangles)
{
    prom_error error = {0};
    assert_int_equal(prom_city_write(path, walk, &options, triangles, &error), PROM_OK);
    char *part = prom_format("%s.part", path);
    assert_int_equal(access(part, F_OK), -1);
    prom_free(part);
    part = prom_format("%s.bin.part", path);
    assert_int_equal(access(part, F_OK), -1);
    prom_free(part);
}

static void test_same_seed_same_city(void **unused)
{
    (void)unused;
    uint8_t *a, *b, *c;
    size_t na, nb, nc;
    prom_city_options options = {.seed = 5, .blocks = 2, .detail = 2, .styles = 8};
    make_city("test_city_a.glb", NULL, options, NULL);
    make_city("test_city_b.glb", NULL, options, NULL);
    options.seed = 6;
    make_city("test_city_c.glb", NULL, options, NULL);
    read_bytes("test_city_a.glb", &a, &na);
    read_bytes("test_city_b.glb", &b, &nb);
    read_bytes("test_city_c.glb", &c, &nc);
    assert_int_equal(na, nb);
    assert_memory_equal(a, b, na);
    assert_true(na != nc || memcmp(a, c, na));
    prom_free(a);
    prom_free(b);
    prom_free(c);
    unlink("test_city_a.glb");
    unlink("test_city_b.glb");
    unlink("test_city_c.glb");
}

static void check_city(prom_city_options options)
{
    glb g = {0};
    uint64_t triangles = 0;
    make_city("test_city_d.glb", NULL, options, &triangles);
    open_glb("test_city_d.glb", &g);
    assert_true(triangles == instanced_triangles(&g));
    for (size_t m = 0; m < count_of(&g, "meshes"); m++) {
        const json_t *mesh = item(&g, "meshes", m);
        const json_t *primitives = json_object_get(mesh, "primitives");
        size_t sides[2] = {0}, empty = 0;
        for (size_t i = 0; i < json_array_size(primitives); i++) {
            const json_t *p = json_array_get(primitives, i);
            const json_t *material = item(&g, "materials", number(p, "material"));
            size_t vertices;
            check_vertices(&g, p, &vertices);
            size_t unused_sides[2] = {0};
            // A leaf card is seen from both sides and lit as part of its crown.
            check_triangles(
                &g, p, vertices,
                json_is_true(json_object_get(material, "doubleSided")) ? unused_sides : sides,
                &empty);
        }
        assert_int_equal(sides[1], 0);
        assert_true(empty * 100 <= mesh_triangles(&g, m));
    }
    for (size_t i = 0; i < count_of(&g, "images"); i++) {
        const json_t *v = item(&g, "bufferViews", number(item(&g, "images", i), "bufferView"));
        assert_memory_equal(g.bin + number(v, "byteOffset"), "\x89PNG", 4);
    }
    close_glb(&g);
    unlink("test_city_d.glb");
}

static void test_geometry_is_sound(void **unused)
{
    (void)unused;
    for (uint32_t detail = 1; detail <= 4; detail++)
        check_city((prom_city_options){
            .seed = detail, .blocks = detail == 2 ? 3 : 2, .detail = detail, .styles = 24});
    check_city((prom_city_options){.seed = 9, .blocks = 1, .detail = 1, .styles = 1});
}

// The measures of the large city, at its number of styles but fewer blocks and less detail.
static void test_many_prototypes(void **unused)
{
    (void)unused;
    glb g = {0};
    uint64_t triangles = 0;
    size_t shown = 0;
    make_city("test_city_e.glb", NULL,
              (prom_city_options){.seed = 1, .blocks = 8, .detail = 1, .styles = 180},
              &triangles);
    open_glb("test_city_e.glb", &g);
    size_t *uses = count_instances(&g);
    for (size_t i = 0; i < count_of(&g, "meshes"); i++) {
        shown += uses[i] > 0;
        assert_true((double)(uses[i] * mesh_triangles(&g, i)) < 0.05 * (double)triangles);
    }
    assert_true(shown >= 200);
    prom_free(uses);
    close_glb(&g);
    unlink("test_city_e.glb");
}

// ---- the city as it stands: nodes with their places in the world

typedef struct placed {
    const char *name;
    json_t *node;
    double c, s, scale, at[3]; // turned about +y, scaled, shifted
} placed;

static double json_at(const json_t *object, const char *key, size_t i, double missing)
{
    const json_t *array = json_object_get(object, key);
    return array ? json_number_value(json_array_get(array, i)) : missing;
}

// Parents come before their children.
static placed *place_nodes(const glb *g)
{
    size_t n = count_of(g, "nodes");
    placed *all = prom_calloc(n, sizeof *all);
    for (size_t i = 0; i < n; i++) {
        if (!all[i].node) all[i] = (placed){.c = 1, .scale = 1}; // the root
        all[i].node = item(g, "nodes", i);
        all[i].name = json_string_value(json_object_get(all[i].node, "name"));
        const json_t *children = json_object_get(all[i].node, "children");
        for (size_t k = 0; k < json_array_size(children); k++) {
            size_t id = (size_t)json_integer_value(json_array_get(children, k));
            const json_t *node = item(g, "nodes", id);
            double half = json_at(node, "rotation", 1, 0), w = json_at(node, "rotation", 3, 1);
            double c = w * w - half * half, s = 2 * half * w,
                   x = json_at(node, "translation", 0, 0),
                   z = json_at(node, "translation", 2, 0);
            const placed *p = &all[i];
            all[id] = (placed){.node = json_object_get(g->json, "nodes"), // marks it as placed
                               .c = p->c * c - p->s * s,
                               .s = p->s * c + p->c * s,
                               .scale = p->scale * json_at(node, "scale", 0, 1),
                               .at = {p->at[0] + p->scale * (p->c * x + p->s * z),
                                      p->at[1] + p->scale * json_at(node, "translation", 1, 0),
                                      p->at[2] + p->scale * (p->c * z - p->s * x)}};
        }
    }
    return all;
}

static size_t count_named(const placed *all, size_t n, const char *name)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) count += !strncmp(all[i].name, name, strlen(name));
    return count;
}

typedef void (*triangle_visitor)(void *user, const placed *node, double v[3][3]);

static void visit_triangles(const glb *g, const placed *node, triangle_visitor visit,
                            void *user)
{
    if (!json_object_get(node->node, "mesh")) return;
    const json_t *primitives =
        json_object_get(item(g, "meshes", number(node->node, "mesh")), "primitives");
    for (size_t i = 0; i < json_array_size(primitives); i++) {
        const json_t *p = json_array_get(primitives, i);
        const json_t *a = item(g, "accessors", number(p, "indices"));
        bool wide = number(a, "componentType") == 5125;
        size_t n, stride, vertices, vertex_stride;
        const uint8_t *ids = elements(g, number(p, "indices"), wide ? 4 : 2, &n, &stride);
        const uint8_t *at = elements(g, number(json_object_get(p, "attributes"), "POSITION"),
                                     12, &vertices, &vertex_stride);
        for (size_t k = 0; k < n; k += 3) {
            double v[3][3];
            for (size_t j = 0; j < 3; j++) {
                float q[3];
                memcpy(q, at + index_at(ids, k + j, wide) * vertex_stride, sizeof q);
                double x = node->scale * (double)q[0], z = node->scale * (double)q[2];
                v[j][0] = node->at[0] + node->c * x + node->s * z;
                v[j][1] = node->at[1] + node->scale * (double)q[1];
                v[j][2] = node->at[2] + node->c * z - node->s * x;
            }
            visit(user, node, v);
        }
    }
}

// ---- river and size

static void test_river(void **unused)
{
    (void)unused;
    for (uint32_t blocks = 1; blocks <= 4; blocks *= 2) {
        glb g = {0};
        make_city("test_city_i.glb", NULL,
                  (prom_city_options){.seed = 1, .blocks = blocks, .detail = 1}, NULL);
        open_glb("test_city_i.glb", &g);
        size_t n = count_of(&g, "nodes");
        placed *all = place_nodes(&g);
        bool river = blocks > 1;
        assert_int_equal(count_named(all, n, "water"), river);
        assert_int_equal(count_named(all, n, "quay_"), river ? 2 * blocks : 0);
        assert_int_equal(count_named(all, n, "stone_bridge"), river);
        assert_int_equal(count_named(all, n, "foot_bridge"), blocks > 2);
        assert_int_equal(count_named(all, n, "town_hall"), river);
        assert_int_equal(count_named(all, n, "church"), blocks > 2);
        assert_int_equal(count_named(all, n, "boat") > 0, river);
        prom_free(all);
        close_glb(&g);
    }
    unlink("test_city_i.glb");
}

// What the documentation promises of small cities.
static void test_sizes(void **unused)
{
    (void)unused;
    static const struct {
        uint32_t blocks, detail;
        uint64_t least, most;
    } sizes[] = {{1, 1, 60000, 130000}, {2, 1, 120000, 300000}, {0, 0, 1000000, 1500000}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        uint64_t triangles = 0;
        make_city("test_city_j.glb", NULL,
                  (prom_city_options){
                      .seed = 1, .blocks = sizes[i].blocks, .detail = sizes[i].detail},
                  &triangles);
        assert_in_range(triangles, sizes[i].least, sizes[i].most);
    }
    unlink("test_city_j.glb");
}

// ---- the walk

#define STRIDE 4 // frames between the places that are tried
#define PLACES (600 / STRIDE)

typedef struct walker {
    double eye[PLACES][3], low[2], high[2];
    double ground[PLACES];  // the highest thing below the eye
    const char *on[PLACES]; // and its name
    const char *blocked;    // by what, or NULL
} walker;

// Cuts a polygon at height y, keeping what is above (sign 1) or below (-1).
static size_t clip(double (*out)[3], double (*in)[3], size_t n, double y, double sign)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        const double *a = in[i], *b = in[(i + 1) % n];
        double da = sign * (a[1] - y), db = sign * (b[1] - y);
        if (da >= 0) memcpy(out[count++], a, sizeof *out);
        if ((da < 0) == (db < 0)) continue;
        double t = da / (da - db);
        for (int k = 0; k < 3; k++) out[count][k] = a[k] + t * (b[k] - a[k]);
        count++;
    }
    return count;
}

static bool near_edge(const double a[3], const double b[3], const double p[3], double radius)
{
    double dx = b[0] - a[0], dz = b[2] - a[2], length = dx * dx + dz * dz;
    double t = length > 0 ? ((p[0] - a[0]) * dx + (p[2] - a[2]) * dz) / length : 0;
    t = fmin(fmax(t, 0), 1);
    return hypot(p[0] - a[0] - t * dx, p[2] - a[2] - t * dz) < radius;
}

// Height of the triangle over (x, z); NAN beside it.
static double height_at(double v[3][3], double x, double z)
{
    double d =
        (v[1][0] - v[0][0]) * (v[2][2] - v[0][2]) - (v[2][0] - v[0][0]) * (v[1][2] - v[0][2]);
    if (fabs(d) < 1e-9) return NAN;
    double s = ((x - v[0][0]) * (v[2][2] - v[0][2]) - (v[2][0] - v[0][0]) * (z - v[0][2])) / d;
    double t = ((v[1][0] - v[0][0]) * (z - v[0][2]) - (x - v[0][0]) * (v[1][2] - v[0][2])) / d;
    if (s < -1e-6 || t < -1e-6 || s + t > 1 + 1e-6) return NAN;
    return v[0][1] + s * (v[1][1] - v[0][1]) + t * (v[2][1] - v[0][1]);
}

static void meet(void *user, const placed *node, double v[3][3])
{
    walker *w = user;
    const double r = 0.35;
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(v[0][k], fmin(v[1][k], v[2][k]));
        high[k] = fmax(v[0][k], fmax(v[1][k], v[2][k]));
    }
    if (high[0] < w->low[0] - r || low[0] > w->high[0] + r || high[2] < w->low[1] - r ||
        low[2] > w->high[1] + r)
        return;
    for (int i = 0; i < PLACES; i++) {
        const double *p = w->eye[i];
        if (high[0] < p[0] - r || low[0] > p[0] + r || high[2] < p[2] - r ||
            low[2] > p[2] + r || low[1] > p[1] + 0.3)
            continue;
        double h = height_at(v, p[0], p[2]);
        if (h < p[1] && h > w->ground[i]) { // false for NAN
            w->ground[i] = h;
            w->on[i] = node->name;
        }
        // The body: from knee to hat.
        double a[8][3], b[8][3];
        memcpy(a, v, 3 * sizeof *a);
        size_t n = clip(b, a, 3, p[1] - 1.2, 1);
        n = clip(a, b, n, p[1] + 0.2, -1);
        for (size_t k = 0; k < n; k++)
            if (near_edge(a[k], a[(k + 1) % n], p, r)) w->blocked = node->name;
    }
}

static void check_walk(const glb *g, const prom_path *path, bool river)
{
    walker *w = prom_calloc(1, sizeof *w);
    size_t n = count_of(g, "nodes");
    placed *all = place_nodes(g);
    for (int k = 0; k < 2; k++) w->low[k] = INFINITY, w->high[k] = -INFINITY;
    for (int i = 0; i < PLACES; i++) {
        memcpy(w->eye[i], path->keys.data[i * STRIDE].position, sizeof w->eye[i]);
        w->ground[i] = -INFINITY;
        for (int k = 0; k < 2; k++) {
            w->low[k] = fmin(w->low[k], w->eye[i][2 * k]);
            w->high[k] = fmax(w->high[k], w->eye[i][2 * k]);
        }
    }
    for (size_t i = 0; i < n; i++) visit_triangles(g, &all[i], meet, w);
    if (w->blocked) fail_msg("the walk runs into %s", w->blocked);
    bool street = false, bridge = false, quay = false, square = false;
    for (int i = 0; i < PLACES; i++) {
        assert_non_null(w->on[i]);
        if (fabs(w->eye[i][1] - w->ground[i] - 1.7) > 0.12)
            fail_msg("frame %d is %.2f m above %s", i * STRIDE, w->eye[i][1] - w->ground[i],
                     w->on[i]);
        street |= !strcmp(w->on[i], "street");
        bridge |= !strcmp(w->on[i], "stone_bridge_0");
        quay |= !strcmp(w->on[i], "quay");
        square |= !strcmp(w->on[i], "ground");
    }
    assert_true(street);
    assert_true(bridge == river && quay == river && square == river);
    prom_free(all);
    prom_free(w);
}

static void check_motion(const prom_path *path)
{
    const prom_path_key *k = path->keys.data;
    for (size_t i = 1; i < path->keys.count; i++) {
        double step = hypot(k[i].position[0] - k[i - 1].position[0],
                            k[i].position[2] - k[i - 1].position[2]);
        assert_true(step > 0.05 && step < 0.25); // between a walk and a bicycle's speed
        assert_true(fabs(k[i].position[1] - k[i - 1].position[1]) < 0.045);
        double dot = 0;
        for (int j = 0; j < 4; j++)
            dot += (double)(k[i].orientation[j] * k[i - 1].orientation[j]);
        assert_true(fabs(dot) > cos(0.04)); // under five degrees a frame
    }
}

static void test_walk(void **unused)
{
    (void)unused;
    for (uint32_t blocks = 1; blocks <= 4; blocks *= 2) {
        prom_city_options options = {.seed = blocks, .blocks = blocks, .detail = 1};
        prom_path path;
        prom_error error = {0};
        glb g = {0};
        options.flight_file = "test_city_f.flight";
        make_city("test_city_f.glb", "test_city_f.path", options, NULL);
        assert_int_equal(prom_path_load("test_city_f.path", &path, &error), PROM_OK);
        assert_int_equal(path.keys.count, 600);
        open_glb("test_city_f.glb", &g);
        check_motion(&path);
        check_walk(&g, &path, blocks > 1);
        close_glb(&g);
        prom_path_finish(&path);
        assert_int_equal(prom_path_load("test_city_f.flight", &path, &error), PROM_OK);
        assert_int_equal(path.keys.count, 600);
        for (size_t i = 0; i < 600; i++) assert_true(path.keys.data[i].position[1] > 30);
        prom_path_finish(&path);
    }
    unlink("test_city_f.glb");
    unlink("test_city_f.path");
    unlink("test_city_f.flight");
}

// ---- refusals

static void test_bad_options(void **unused)
{
    (void)unused;
    prom_error error = {0};
    assert_int_equal(prom_city_write("test_city_g.glb", NULL,
                                     &(prom_city_options){.blocks = 1000}, NULL, &error),
                     PROM_ERR_USAGE);
    assert_int_equal(prom_city_write("test_city_g.glb", NULL, &(prom_city_options){.detail = 5},
                                     NULL, &error),
                     PROM_ERR_USAGE);
    assert_int_equal(prom_city_write("test_city_g.glb", NULL,
                                     &(prom_city_options){.styles = 1u << 20}, NULL, &error),
                     PROM_ERR_USAGE);
    assert_int_equal(access("test_city_g.glb", F_OK), -1);
    prom_city_options small = {.blocks = 1, .detail = 1, .styles = 3};
    assert_int_equal(prom_city_write("no/such/x.glb", NULL, &small, NULL, &error),
                     PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, "no/such/x.glb"));
    assert_int_equal(prom_city_write("test_city_g.glb", "no/such/x.path", &small, NULL, &error),
                     PROM_ERR_OUTPUT);
    assert_int_equal(access("test_city_g.glb", F_OK), -1);
    small.flight_file = "no/such/x.path";
    assert_int_equal(
        prom_city_write("test_city_g.glb", "test_city_g.path", &small, NULL, &error),
        PROM_ERR_OUTPUT);
    assert_int_equal(access("test_city_g.glb", F_OK), -1);
    assert_int_equal(access("test_city_g.path", F_OK), -1);
}

// Meshes above 65535 vertices have 32-bit indices.
static void test_wide_indices(void **unused)
{
    (void)unused;
    for (uint32_t n = 65535; n <= 65536; n++) {
        prom_glb *out = prom_glb_create("test_city_h.glb");
        prom_glb_vertex *vertices = prom_calloc(n, sizeof *vertices);
        for (uint32_t i = 0; i < n; i++) {
            vertices[i].position[0] = (float)i;
            vertices[i].normal[1] = 1;
        }
        uint32_t indices[3] = {0, 1, n - 1};
        prom_glb_material material = {.name = "m", .image = PROM_GLB_NONE};
        prom_glb_part part = {.material = prom_glb_add_material(out, &material),
                              .vertices = vertices,
                              .indices = indices,
                              .vertex_count = n,
                              .index_count = 3};
        uint32_t mesh = prom_glb_add_mesh(out, "mesh", &part, 1);
        prom_glb_add_node(
            out, &(prom_glb_node){
                     .name = "node", .parent = PROM_GLB_NONE, .mesh = mesh, .scale = 1});
        prom_error error = {0};
        assert_int_equal(prom_glb_finish(out, "test", &error), PROM_OK);
        prom_glb_destroy(out);
        prom_free(vertices);
        glb g = {0};
        open_glb("test_city_h.glb", &g);
        const json_t *p =
            json_array_get(json_object_get(item(&g, "meshes", 0), "primitives"), 0);
        const json_t *a = item(&g, "accessors", number(p, "indices"));
        bool wide = number(a, "componentType") == 5125;
        assert_int_equal(wide, n > 65535);
        size_t count, stride;
        const uint8_t *bytes =
            elements(&g, number(p, "indices"), wide ? 4 : 2, &count, &stride);
        assert_int_equal(index_at(bytes, 2, wide), n - 1);
        close_glb(&g);
    }
    unlink("test_city_h.glb");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_seed_same_city),
        cmocka_unit_test(test_geometry_is_sound),
        cmocka_unit_test(test_many_prototypes),
        cmocka_unit_test(test_walk),
        cmocka_unit_test(test_river),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_bad_options),
        cmocka_unit_test(test_wide_indices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

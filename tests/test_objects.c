// LINK: prom_builder prom_metaobj
// Objects from sources made in memory: nothing is lost, nothing is torn, equal things are
// shared.
#include "builder/objects.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/hash.h"
#include "metaobj/base/log.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

enum { OPAQUE, OTHER, SEE_THROUGH, MATERIALS };

// ---- sources

static void source_init(prom_source *s)
{
    memset(s, 0, sizeof *s);
    for (uint32_t m = 0; m < MATERIALS; m++)
        prom_array_push(&s->materials,
                        (prom_material){.texture = PROM_NONE,
                                        .alpha_mode = m == SEE_THROUGH ? PROM_ALPHA_BLEND
                                                                       : PROM_ALPHA_OPAQUE});
}

static void source_finish(prom_source *s)
{
    for (size_t i = 0; i < s->meshes.count; i++) prom_mesh_finish(&s->meshes.data[i]);
    prom_array_finish(&s->meshes);
    prom_array_finish(&s->nodes);
    prom_array_finish(&s->mesh_refs);
    prom_array_finish(&s->levels);
    prom_array_finish(&s->materials);
}

static uint32_t push_mesh(prom_source *s, prom_mesh mesh, uint32_t material)
{
    mesh.submeshes[0].material = material;
    prom_array_push(&s->meshes, mesh);
    return (uint32_t)s->meshes.count - 1;
}

static uint32_t add_box(prom_source *s, const float center[3], float half, uint32_t material)
{
    prom_mesh mesh;
    prom_mesh_init_box(&mesh, center, (float[3]){half, half, half}, NULL);
    return push_mesh(s, mesh, material);
}

// A height field of n x n squares over [-half, half], 2 n n triangles, one connected piece.
static uint32_t add_field(prom_source *s, uint32_t n, float half, uint32_t material)
{
    prom_mesh m;
    prom_mesh_init(&m, (n + 1) * (n + 1), 6 * n * n, 1);
    for (uint32_t z = 0; z <= n; z++)
        for (uint32_t x = 0; x <= n; x++) {
            prom_vertex *v = &m.vertices[z * (n + 1) + x];
            v->position[0] = half * (2.0f * (float)x / (float)n - 1.003f);
            v->position[1] = half * 0.01f * sinf((float)(x * 7 + z * 13));
            v->position[2] = half * (2.0f * (float)z / (float)n - 0.997f);
            v->normal[1] = 127;
        }
    uint32_t *i = m.indices;
    for (uint32_t z = 0; z < n; z++)
        for (uint32_t x = 0; x < n; x++, i += 6) {
            uint32_t a = z * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            memcpy(i, (uint32_t[6]){a, c, b, b, c, d}, 6 * sizeof *i);
        }
    m.submeshes[0] = (prom_submesh){0, m.index_count, 0};
    return push_mesh(s, m, material);
}

static void identity(double m[16])
{
    memset(m, 0, 16 * sizeof *m);
    for (int k = 0; k < 4; k++) m[5 * k] = 1;
}

// A scale, then a turn about y, then a move.
static void pose(double m[16], double x, double y, double z, double angle, double sx, double sy,
                 double sz)
{
    identity(m);
    m[0] = cos(angle) * sx;
    m[2] = -sin(angle) * sx;
    m[5] = sy;
    m[8] = sin(angle) * sz;
    m[10] = cos(angle) * sz;
    m[12] = x;
    m[13] = y;
    m[14] = z;
}

static uint32_t add_node(prom_source *s, uint32_t parent, const double local[16],
                         const uint32_t *meshes, uint32_t count, char *name)
{
    prom_source_node n = {.name = name,
                          .parent = parent,
                          .first_mesh = (uint32_t)s->mesh_refs.count,
                          .mesh_count = count};
    memcpy(n.local, local, sizeof n.local);
    memcpy(n.world, local, sizeof n.world);
    if (parent != PROM_NONE) {
        const double *a = s->nodes.data[parent].world;
        for (int c = 0; c < 4; c++)
            for (int r = 0; r < 4; r++) {
                n.world[4 * c + r] = 0;
                for (int k = 0; k < 4; k++)
                    n.world[4 * c + r] += a[4 * k + r] * local[4 * c + k];
            }
    }
    for (uint32_t i = 0; i < count; i++) prom_array_push(&s->mesh_refs, meshes[i]);
    prom_array_push(&s->nodes, n);
    return (uint32_t)s->nodes.count - 1;
}

static uint32_t add_at(prom_source *s, uint32_t parent, uint32_t mesh, double x, double z)
{
    double m[16];
    pose(m, x, 0, z, 0, 1, 1, 1);
    return add_node(s, parent, m, &mesh, 1, "thing");
}

static uint32_t add_root(prom_source *s)
{
    double m[16];
    identity(m);
    return add_node(s, PROM_NONE, m, NULL, 0, "root");
}

// ---- properties that always hold

static uint64_t source_triangles(const prom_source *s)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < s->mesh_refs.count; i++)
        sum += s->meshes.data[s->mesh_refs.data[i]].index_count / 3;
    return sum;
}

static uint64_t object_triangles(const prom_objects *o)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < o->objects.count; i++)
        sum += o->shapes.data[o->objects.data[i].shape].mesh.index_count / 3;
    return sum;
}

static const prom_shape *shape_of(const prom_objects *o, size_t object)
{
    return &o->shapes.data[o->objects.data[object].shape];
}

static uint32_t count_layer(const prom_objects *o, prom_layer layer)
{
    uint32_t count = 0;
    for (size_t i = 0; i < o->objects.count; i++) count += shape_of(o, i)->layer == layer;
    return count;
}

// The area of all triangles where they stand, and the volume below them as signed by winding.
static void measure_triangle(const double p[3][3], double *area, double *volume)
{
    double a[3], b[3], n[3];
    for (int k = 0; k < 3; k++) {
        a[k] = p[1][k] - p[0][k];
        b[k] = p[2][k] - p[0][k];
    }
    for (int k = 0; k < 3; k++)
        n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    *area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    *volume += (n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2]) / 6;
}

static void measure_source(const prom_source *s, double *area, double *volume)
{
    *area = *volume = 0;
    for (size_t i = 0; i < s->nodes.count; i++) {
        const prom_source_node *n = &s->nodes.data[i];
        for (uint32_t k = 0; k < n->mesh_count; k++) {
            const prom_mesh *m = &s->meshes.data[s->mesh_refs.data[n->first_mesh + k]];
            prom_placement at = prom_placement_from_matrix(n->world);
            double sign = prom_basis_determinant(at.basis) < 0 ? -1 : 1, v = 0;
            for (uint32_t t = 0; t + 2 < m->index_count; t += 3) {
                double p[3][3];
                for (int c = 0; c < 3; c++)
                    prom_placement_apply(&at, m->vertices[m->indices[t + c]].position, p[c]);
                measure_triangle(p, area, &v);
            }
            *volume += sign * v;
        }
    }
}

// Also checks that normals look to the side from which the triangles are seen.
static void measure_objects(const prom_objects *o, double *area, double *volume, bool normals)
{
    *area = *volume = 0;
    for (size_t i = 0; i < o->objects.count; i++) {
        const prom_mesh *m = &shape_of(o, i)->mesh;
        const prom_placement *at = &o->objects.data[i].placement;
        double sign = prom_basis_determinant(at->basis) < 0 ? -1 : 1, sum = 0;
        for (uint32_t t = 0; t + 2 < m->index_count; t += 3) {
            double p[3][3], local[3][3];
            for (int c = 0; c < 3; c++) {
                const prom_vertex *v = &m->vertices[m->indices[t + c]];
                prom_placement_apply(at, v->position, p[c]);
                for (int k = 0; k < 3; k++) local[c][k] = v->position[k];
            }
            measure_triangle(p, area, &sum);
            if (!normals) continue;
            for (int c = 0; c < 3; c++) {
                const prom_vertex *v = &m->vertices[m->indices[t + c]];
                double a[3], b[3], dot = 0;
                for (int k = 0; k < 3; k++) {
                    a[k] = local[1][k] - local[0][k];
                    b[k] = local[2][k] - local[0][k];
                }
                for (int k = 0; k < 3; k++)
                    dot += v->normal[k] *
                           (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
                assert_true(dot > 0);
            }
        }
        *volume += sign * sum;
    }
}

static void check_common(const prom_source *s, const prom_objects *o)
{
    uint32_t *instances = prom_calloc(o->shapes.count, sizeof *instances);
    for (size_t i = 0; i < o->objects.count; i++) {
        assert_in_range(o->objects.data[i].shape, 0, o->shapes.count - 1);
        instances[o->objects.data[i].shape]++;
        assert_in_range(o->objects.data[i].name, 0, o->names.count - 1);
    }
    for (size_t i = 0; i < o->shapes.count; i++) {
        const prom_shape *shape = &o->shapes.data[i];
        const char *wrong = prom_mesh_check(&shape->mesh, (uint32_t)s->materials.count);
        if (wrong) fail_msg("shape %zu: %s", i, wrong);
        assert_true(shape->mesh.index_count > 0);
        assert_int_equal(shape->instances, instances[i]);
        for (uint32_t k = 1; k < shape->mesh.submesh_count; k++)
            assert_true(shape->mesh.submeshes[k].material >
                        shape->mesh.submeshes[k - 1].material);
    }
    prom_free(instances);
    assert_int_equal(o->names.data[0], 0);
    assert_int_equal(o->names.data[o->names.count - 1], 0);
}

static void find(const prom_source *s, prom_objects *o)
{
    prom_error error;
    if (prom_objects_find(s, NULL, o, &error) != PROM_OK) fail_msg("%s", error.text);
    check_common(s, o);
}

static void check_kept(const prom_source *s, const prom_objects *o, bool normals)
{
    assert_int_equal(object_triangles(o), source_triangles(s));
    double area, volume, area2, volume2;
    measure_source(s, &area, &volume);
    measure_objects(o, &area2, &volume2, normals);
    assert_true(fabs(area - area2) < 1e-4 * area);
    assert_true(fabs(volume - volume2) < 1e-3 * fabs(volume) + 1e-5 * area);
}

// ---- instances

static void instances_share_a_shape(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s), box = add_box(&s, (float[3]){1, 2, 3}, 1, OPAQUE);
    double m[16];
    for (int i = 0; i < 10; i++) {
        double scale = 1 + 0.1 * i;
        pose(m, 10.0 * i, 0, 0, 0.3 * i, i == 5 ? -scale : scale, scale, scale);
        add_node(&s, root, m, &box, 1, "box");
    }
    prom_objects o;
    find(&s, &o);
    assert_int_equal(o.shapes.count, 1);
    assert_int_equal(o.objects.count, 10);
    assert_int_equal(o.instanced, 10);
    assert_string_equal(o.names.data + o.objects.data[3].name, "box");
    check_kept(&s, &o, true);
    prom_objects_finish(&o);
    source_finish(&s);
}

static void stretched_ones_have_their_own(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s), box = add_box(&s, (float[3]){1, 0, 0}, 1, OPAQUE);
    const double scales[7][3] = {{1, 1, 1},  {1.04, 1, 1},    {1, 2, 1},  {3, 6.02, 3},
                                 {-1, 2, 1}, {0.5, 0.5, 0.1}, {1, 1, 0.5}};
    double m[16];
    for (int i = 0; i < 7; i++) {
        pose(m, 10.0 * i, 0, 0, i, scales[i][0], scales[i][1], scales[i][2]);
        add_node(&s, root, m, &box, 1, "box");
    }
    prom_objects o;
    prom_error error;
    prom_object_options keep = {.min_triangles = 1};
    assert_int_equal(prom_objects_find(&s, &keep, &o, &error), PROM_OK);
    check_common(&s, &o);
    check_kept(&s, &o, true);
    assert_int_equal(o.objects.count, 7);
    const prom_object *b = o.objects.data;
    uint32_t uniform = 0, tall = 0;
    for (size_t i = 0; i < 7; i++) {
        // Which source it was tells the place.
        int source = (int)lround(b[i].placement.origin[0] / 10);
        if (source < 2) uniform |= 1u << b[i].shape;
        if (source >= 2 && source < 5) tall |= 1u << b[i].shape;
        float lengths[3];
        for (int c = 0; c < 3; c++) {
            const float *v = b[i].placement.basis + 3 * c;
            lengths[c] = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        }
        for (int c = 1; c < 3; c++) assert_true(fabsf(lengths[c] / lengths[0] - 1) < 0.051f);
    }
    assert_int_equal(__builtin_popcount(uniform), 1);
    assert_int_equal(__builtin_popcount(tall), 1);
    assert_true(uniform != tall);
    prom_objects_finish(&o);
    source_finish(&s);
}

static void blended_meshes_stand_apart(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s);
    uint32_t meshes[3] = {add_box(&s, (float[3]){0, 0, 0}, 1, OTHER),
                          add_box(&s, (float[3]){0, 3, 0}, 1, SEE_THROUGH),
                          add_box(&s, (float[3]){0, 6, 0}, 1, OPAQUE)};
    double m[16];
    for (int i = 0; i < 4; i++) {
        pose(m, 10 * i, 0, 0, 1, 1, 1, 1);
        add_node(&s, root, m, meshes, 3, "window");
    }
    prom_objects o;
    find(&s, &o);
    check_kept(&s, &o, true);
    assert_int_equal(o.shapes.count, 2);
    assert_int_equal(o.blended, 4);
    assert_int_equal(count_layer(&o, PROM_LAYER_OBJECT), 4);
    for (size_t i = 0; i < o.shapes.count; i++) {
        bool blended = o.shapes.data[i].layer == PROM_LAYER_BLENDED;
        for (uint32_t k = 0; k < o.shapes.data[i].mesh.submesh_count; k++)
            assert_int_equal(o.shapes.data[i].mesh.submeshes[k].material == SEE_THROUGH,
                             blended);
        assert_int_equal(o.shapes.data[i].mesh.submesh_count, blended ? 1 : 2);
    }
    prom_objects_finish(&o);
    source_finish(&s);
}

// ---- a village: instances on a ground under a sky

static void add_village(prom_source *s, uint32_t root, uint32_t box, uint32_t ground)
{
    double m[16];
    for (int i = 0; i < 10; i++)
        for (int k = 0; k < 10; k++) add_at(s, root, box, 10.0 * i - 45, 10.0 * k - 45);
    identity(m);
    add_node(s, root, m, &ground, 1, "ground");
}

static int by_position(const void *pa, const void *pb)
{
    return memcmp(pa, pb, 3 * sizeof(double));
}

// The number of different positions, to the bit, of the vertices of a layer.
static size_t count_positions(const prom_objects *o, prom_layer layer)
{
    PROM_ARRAY(double) all = {0};
    for (size_t i = 0; i < o->objects.count; i++) {
        const prom_mesh *m = &shape_of(o, i)->mesh;
        if (shape_of(o, i)->layer != layer) continue;
        for (uint32_t v = 0; v < m->vertex_count; v++) {
            double p[3];
            prom_placement_apply(&o->objects.data[i].placement, m->vertices[v].position, p);
            for (int k = 0; k < 3; k++) prom_array_push(&all, p[k] + 0.0);
        }
    }
    qsort(all.data, all.count / 3, 3 * sizeof(double), by_position);
    size_t distinct = 0;
    for (size_t i = 0; i < all.count; i += 3)
        distinct += !i || memcmp(all.data + i, all.data + i - 3, 3 * sizeof(double)) != 0;
    prom_array_finish(&all);
    return distinct;
}

static void ground_becomes_chunks_sky_backdrop(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s), n = 80;
    uint32_t box = add_box(&s, (float[3]){0, 1, 0}, 1, OPAQUE);
    uint32_t ground = add_field(&s, n, 60, OTHER);
    uint32_t sky = add_box(&s, (float[3]){0, 0, 0}, 600, OTHER);
    add_village(&s, root, box, ground);
    add_at(&s, root, sky, 5, 5);
    prom_objects o;
    find(&s, &o);
    check_kept(&s, &o, true);
    assert_int_equal(o.backdrops, 1);
    assert_int_equal(count_layer(&o, PROM_LAYER_BACKDROP), 1);
    assert_int_equal(count_layer(&o, PROM_LAYER_OBJECT), 100);
    assert_int_equal(count_layer(&o, PROM_LAYER_SURFACE), o.chunks);
    assert_true(o.chunks >= 16);
    assert_int_equal(o.split, 1);
    for (size_t i = 0; i < o.shapes.count; i++) {
        if (o.shapes.data[i].layer != PROM_LAYER_SURFACE) continue;
        assert_true(o.shapes.data[i].lock_border);
        assert_true(o.shapes.data[i].mesh.index_count <= 3 * 4096);
        assert_true(prom_box_diagonal(&o.shapes.data[i].bounds) < 120);
    }
    // Neighbours meet exactly: no more positions than the ground has vertices.
    assert_int_equal(count_positions(&o, PROM_LAYER_SURFACE), (n + 1) * (n + 1));
    assert_true(o.layout.max[0] < 70 && o.layout.min[0] > -70);
    prom_objects_finish(&o);
    source_finish(&s);
}

static void chunk_size_is_followed(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s), n = 96;
    uint32_t box = add_box(&s, (float[3]){0, 1, 0}, 1, OPAQUE);
    add_village(&s, root, box, add_field(&s, n, 64, OTHER));
    prom_objects o;
    prom_error error;
    prom_object_options options = {.chunk_size = 16};
    assert_int_equal(prom_objects_find(&s, &options, &o, &error), PROM_OK);
    check_common(&s, &o);
    check_kept(&s, &o, true);
    assert_in_range(o.chunks, 64, 200); // 8 x 8 cells, more where hills cross a level
    for (size_t i = 0; i < o.shapes.count; i++)
        if (o.shapes.data[i].layer == PROM_LAYER_SURFACE)
            for (int k = 0; k < 3; k++)
                assert_true(o.shapes.data[i].bounds.max[k] - o.shapes.data[i].bounds.min[k] <
                            16 + 2 * 128.0f / (float)n);
    assert_int_equal(count_positions(&o, PROM_LAYER_SURFACE), (n + 1) * (n + 1));
    prom_objects_finish(&o);
    source_finish(&s);
}

// ---- gathering and splitting

static void tiny_neighbours_are_gathered(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s);
    srand(1);
    enum { TINY = 1500 };
    for (int i = 0; i < TINY; i++) {
        uint32_t box = add_box(&s, (float[3]){0, 0, 0}, 0.2f + 0.001f * (float)(i % 100),
                               i % 7 == 0 ? SEE_THROUGH
                               : i % 2    ? OTHER
                                          : OPAQUE);
        double m[16], mirror = i % 3 ? 1 : -1;
        pose(m, rand() % 1000, rand() % 20, rand() % 1000, i, mirror, 1, 1 + i % 2);
        add_node(&s, root, m, &box, 1, "crumb");
    }
    prom_objects o;
    find(&s, &o);
    check_kept(&s, &o, true);
    assert_int_equal(o.gathered, o.objects.count);
    assert_true(o.objects.count < TINY / 4);
    for (size_t i = 0; i < o.objects.count; i++) {
        assert_true(shape_of(&o, i)->mesh.index_count <= 3 * 512);
        assert_true(prom_box_diagonal(&shape_of(&o, i)->bounds) < 300);
        assert_string_equal(o.names.data + o.objects.data[i].name, "crumb");
        for (int k = 0; k < 9; k++)
            assert_true(o.objects.data[i].placement.basis[k] == (k % 4 ? 0.0f : 1.0f));
    }
    assert_true(o.blended > 0);
    assert_int_equal(o.blended, count_layer(&o, PROM_LAYER_BLENDED));
    prom_objects_finish(&o);
    source_finish(&s);
}

// Appends a mesh of `count` boxes in a row as one.
static uint32_t add_row(prom_source *s, uint32_t count, float gap)
{
    prom_mesh m, box;
    prom_mesh_init(&m, 24 * count, 36 * count, 1);
    for (uint32_t i = 0; i < count; i++) {
        prom_mesh_init_box(&box, (float[3]){gap * (float)i, 0, 0}, (float[3]){1, 1, 1}, NULL);
        memcpy(m.vertices + 24 * i, box.vertices, 24 * sizeof *box.vertices);
        for (uint32_t k = 0; k < 36; k++) m.indices[36 * i + k] = 24 * i + box.indices[k];
        prom_mesh_finish(&box);
    }
    m.submeshes[0] = (prom_submesh){0, m.index_count, 0};
    return push_mesh(s, m, OPAQUE);
}

static void sprawling_mesh_is_split(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s), field;
    uint32_t row = add_row(&s, 600, 10);
    add_at(&s, root, row, 0, 0);
    // A piece too large for one object, yet small in the scene.
    field = add_field(&s, 64, 40, OTHER);
    uint32_t both[2] = {field, add_box(&s, (float[3]){0, 5, 0}, 2, OPAQUE)};
    double m[16];
    pose(m, 100, 0, 300, 0, 1, 1, 1);
    add_node(&s, root, m, both, 2, "hill");
    // Enough beside them not to be taken for a single thing.
    uint32_t box = add_box(&s, (float[3]){0, 0, 0}, 1, OPAQUE);
    for (int i = 0; i < 100; i++) add_at(&s, root, box, 60 * i, 500);
    prom_objects o;
    find(&s, &o);
    check_kept(&s, &o, true);
    assert_int_equal(o.split, 2);
    uint32_t locked = 0;
    for (size_t i = 0; i < o.objects.count; i++) {
        const prom_shape *shape = shape_of(&o, i);
        assert_true(shape->mesh.index_count <= 3 * 4096);
        assert_true(prom_box_diagonal(&shape->bounds) < 1000);
        locked += shape->lock_border;
    }
    assert_int_equal(locked, 2);
    prom_objects_finish(&o);
    source_finish(&s);
}

static void lone_model_is_kept_or_cut(void **state)
{
    (void)state;
    for (int large = 0; large < 2; large++) {
        prom_source s;
        source_init(&s);
        uint32_t root = add_root(&s), n = large ? 256 : 128;
        add_at(&s, root, add_field(&s, n, 0.1f, OPAQUE), 3, 4);
        prom_objects o;
        find(&s, &o);
        check_kept(&s, &o, true);
        if (large) {
            assert_true(o.objects.count > 16);
            assert_int_equal(count_layer(&o, PROM_LAYER_SURFACE), o.objects.count);
            assert_int_equal(count_positions(&o, PROM_LAYER_SURFACE), (n + 1) * (n + 1));
        } else {
            assert_int_equal(o.objects.count, 1);
            assert_int_equal(shape_of(&o, 0)->layer, PROM_LAYER_OBJECT);
        }
        prom_objects_finish(&o);
        source_finish(&s);
    }
}

// ---- groups

// A tile: a village of its own with a unique ground, a nested node and see-through things; of
// more parts than a single thing would have.
enum { TILE_BOXES = 81 };

static void add_tile(prom_source *s, uint32_t root, double x, double z, uint32_t box,
                     uint32_t ground, uint32_t glass, double nudge)
{
    double m[16];
    pose(m, x, 0.5, z, 0.25, 1, 1, 1);
    uint32_t tile = add_node(s, root, m, NULL, 0, "tile");
    identity(m);
    uint32_t inner = add_node(s, tile, m, NULL, 0, "inner");
    for (int i = 0; i < TILE_BOXES; i++)
        add_at(s, i % 2 ? inner : tile, box, 2.2 * (i % 9) - 9 + nudge, 2.2 * (i / 9) - 9);
    add_node(s, tile, m, &ground, 1, "ground");
    add_at(s, inner, glass, 1, 1);
}

static void tiles_are_groups(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s);
    uint32_t box = add_box(&s, (float[3]){0, 1, 0}, 1, OPAQUE);
    uint32_t ground = add_field(&s, 48, 10, OTHER);
    uint32_t glass = add_box(&s, (float[3]){0, 4, 0}, 1, SEE_THROUGH);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            add_tile(&s, root, 20.0 * (i - 1) + 0.1, 20.0 * (k - 1), box, ground, glass, 0);
    add_tile(&s, root, 100, 0, box, ground, glass, 1e-9); // differs by a hair
    uint32_t sky = add_box(&s, (float[3]){0, 0, 0}, 900, OTHER);
    add_at(&s, root, sky, 0, 0);
    prom_objects o;
    find(&s, &o);
    check_kept(&s, &o, true);
    assert_int_equal(o.groups.count, 9);
    assert_int_equal(o.backdrops, 1);
    const prom_group *first = &o.groups.data[0];
    uint32_t grouped = 0;
    for (size_t g = 0; g < 9; g++) {
        const prom_group *group = &o.groups.data[g];
        assert_int_equal(group->kind, first->kind);
        assert_int_equal(group->object_count, first->object_count);
        grouped += group->object_count;
        for (uint32_t i = 0; i < group->object_count; i++) {
            const prom_object *a = &o.objects.data[first->first_object + i];
            const prom_object *b = &o.objects.data[group->first_object + i];
            assert_int_equal(b->group, g);
            assert_int_equal(a->shape, b->shape);
            assert_memory_equal(a->placement.basis, b->placement.basis,
                                sizeof a->placement.basis);
            for (int k = 0; k < 3; k++)
                assert_true(fabs(b->placement.origin[k] - a->placement.origin[k] -
                                 (group->origin[k] - first->origin[k])) < 1e-12);
            if (o.shapes.data[a->shape].layer == PROM_LAYER_SURFACE)
                assert_int_equal(o.shapes.data[a->shape].instances, 9);
        }
    }
    // The boxes, the glass and the chunks of the ground in each.
    uint32_t chunks = 0;
    for (uint32_t i = 0; i < first->object_count; i++)
        chunks += shape_of(&o, first->first_object + i)->layer == PROM_LAYER_SURFACE;
    assert_true(chunks > 0);
    assert_int_equal(first->object_count, TILE_BOXES + 1 + chunks);
    for (size_t i = 0; i < o.objects.count; i++)
        if (o.objects.data[i].group == PROM_NONE) grouped++;
    assert_int_equal(grouped, o.objects.count);
    prom_objects_finish(&o);
    source_finish(&s);
}

// ---- levels by the scene's artist

// Gives the last node a level of one mesh; levels come in order, right after the node.
static void add_level(prom_source *s, uint32_t mesh, float own_until, float until)
{
    prom_source_node *n = &s->nodes.data[s->nodes.count - 1];
    if (!n->level_count) n->first_level = (uint32_t)s->levels.count;
    n->level_count++;
    n->until = own_until;
    prom_array_push(&s->levels, (prom_source_level){(uint32_t)s->mesh_refs.count, 1, until});
    prom_array_push(&s->mesh_refs, mesh);
}

static void what_has_levels_stays_whole(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s), field = add_field(&s, 64, 1, OPAQUE);
    uint32_t box = add_box(&s, (float[3]){0, 0, 0}, 1, OPAQUE);
    // More triangles than an object may have, and alone of its kind; and two that differ in
    // where they switch alone.
    add_at(&s, root, field, 0, 0);
    add_level(&s, box, 50, INFINITY);
    for (int i = 0; i < 3; i++) {
        add_at(&s, root, box, 10 + 5 * i, 0);
        add_level(&s, field, i == 2 ? 30 : 20, 80);
        add_level(&s, box, i == 2 ? 30 : 20, 200);
    }
    prom_objects o;
    find(&s, &o);
    assert_int_equal(o.objects.count, 4);
    assert_int_equal(o.shapes.count, 3);
    uint32_t shared = 0;
    for (size_t i = 0; i < 4; i++) {
        const prom_shape *shape = shape_of(&o, i);
        bool large = shape->mesh.index_count == 3 * 2 * 64 * 64;
        assert_int_equal(shape->level_count, large ? 1 : 2);
        float until = large ? 50 : shape->instances == 2 ? 20 : 30;
        assert_float_equal(shape->until, until, 0);
        assert_int_equal(shape->levels[0].mesh.index_count, large ? 36 : 3 * 2 * 64 * 64);
        shared += shape->instances == 2;
        for (int k = 0; k < 3; k++) // the box is wider than the field: it is inside the bounds
            assert_true(shape->bounds.min[k] <= -1 && shape->bounds.max[k] >= 1);
    }
    assert_int_equal(shared, 2);
    prom_objects_finish(&o);
    source_finish(&s);
}

static void levels_are_split_like_their_node(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s);
    uint32_t wall = add_box(&s, (float[3]){0, 0, 0}, 1, OPAQUE);
    uint32_t pane = add_box(&s, (float[3]){0, 0, 2}, 0.5f, SEE_THROUGH);
    uint32_t low = add_box(&s, (float[3]){0, 0, 0}, 1, OTHER);
    double m[16];
    pose(m, 0, 0, 0, 0, 1, 2, 1); // stretched: so is the level
    add_node(&s, root, m, (uint32_t[2]){wall, pane}, 2, "house");
    add_level(&s, low, 40, 90);
    prom_objects o;
    find(&s, &o);
    assert_int_equal(o.objects.count, 2);
    for (size_t i = 0; i < 2; i++) {
        const prom_shape *shape = shape_of(&o, i);
        bool glass = shape->layer == PROM_LAYER_BLENDED;
        assert_int_equal(shape->level_count, glass ? 0 : 1);
        if (glass) {
            assert_true(isinf(shape->until));
            continue;
        }
        assert_int_equal(shape->levels[0].mesh.submeshes[0].material, OTHER);
        prom_box fine = prom_mesh_bounds(&shape->mesh);
        prom_box coarse = prom_mesh_bounds(&shape->levels[0].mesh);
        assert_memory_equal(&fine, &coarse, sizeof fine);
    }
    assert_int_equal(count_layer(&o, PROM_LAYER_BLENDED), 1);
    prom_objects_finish(&o);
    source_finish(&s);
}

// ---- odd input

static void odd_nodes_are_left_out(void **state)
{
    (void)state;
    prom_source s;
    source_init(&s);
    uint32_t root = add_root(&s), box = add_box(&s, (float[3]){0, 0, 0}, 1, OPAQUE);
    double m[16];
    pose(m, NAN, 0, 0, 0, 1, 1, 1);
    add_node(&s, root, m, &box, 1, "nowhere");
    pose(m, 0, 0, 0, 0, 0, 0, 0);
    add_node(&s, root, m, &box, 1, "nothing");
    prom_objects o;
    prom_error error;
    assert_int_equal(prom_objects_find(&s, NULL, &o, &error), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "extent"));
    prom_objects_finish(&o);

    pose(m, 0, 0, 0, 0.5, 1, 0, 1); // flat is fine
    add_node(&s, root, m, &box, 1, NULL);
    prom_mesh one;
    prom_mesh_init(&one, 3, 3, 1);
    one.vertices[1].position[0] = one.vertices[2].position[1] = 1;
    memcpy(one.indices, (uint32_t[3]){0, 1, 2}, 3 * sizeof(uint32_t));
    one.submeshes[0] = (prom_submesh){0, 3, PROM_NONE};
    add_at(&s, root, push_mesh(&s, one, PROM_NONE), 5, 5);
    find(&s, &o);
    assert_int_equal(object_triangles(&o), 12 + 1);
    for (size_t i = 0; i < o.objects.count; i++)
        for (int k = 0; k < 9; k++) assert_true(isfinite(o.objects.data[i].placement.basis[k]));
    prom_objects_finish(&o);

    prom_object_options wrong = {.max_triangles = 10, .min_triangles = 20};
    assert_int_equal(prom_objects_find(&s, &wrong, &o, &error), PROM_ERR_USAGE);
    wrong = (prom_object_options){.chunk_size = -1};
    assert_int_equal(prom_objects_find(&s, &wrong, &o, &error), PROM_ERR_USAGE);
    source_finish(&s);
}

static uint64_t hash_objects(const prom_objects *o)
{
    uint64_t h = prom_hash(o->names.data, o->names.count, 0);
    for (size_t i = 0; i < o->shapes.count; i++) h = prom_mesh_hash(&o->shapes.data[i].mesh, h);
    for (size_t i = 0; i < o->objects.count; i++) {
        h = prom_hash(&o->objects.data[i].shape, sizeof(uint32_t), h);
        h = prom_hash(&o->objects.data[i].placement.origin, 3 * sizeof(double), h);
    }
    return h;
}

static void same_input_same_objects(void **state)
{
    (void)state;
    uint64_t hashes[2];
    for (int round = 0; round < 2; round++) {
        prom_source s;
        source_init(&s);
        uint32_t root = add_root(&s), box = add_box(&s, (float[3]){0, 1, 0}, 1, OPAQUE);
        add_village(&s, root, box, add_field(&s, 64, 60, OTHER));
        add_at(&s, root, add_row(&s, 500, 3), 0, 0);
        prom_objects o;
        find(&s, &o);
        hashes[round] = hash_objects(&o);
        prom_objects_finish(&o);
        source_finish(&s);
    }
    assert_true(hashes[0] == hashes[1]);
}

int main(void)
{
    prom_log_set_level(PROM_LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances_share_a_shape),
        cmocka_unit_test(stretched_ones_have_their_own),
        cmocka_unit_test(blended_meshes_stand_apart),
        cmocka_unit_test(ground_becomes_chunks_sky_backdrop),
        cmocka_unit_test(chunk_size_is_followed),
        cmocka_unit_test(tiny_neighbours_are_gathered),
        cmocka_unit_test(sprawling_mesh_is_split),
        cmocka_unit_test(lone_model_is_kept_or_cut),
        cmocka_unit_test(tiles_are_groups),
        cmocka_unit_test(what_has_levels_stays_whole),
        cmocka_unit_test(levels_are_split_like_their_node),
        cmocka_unit_test(odd_nodes_are_left_out),
        cmocka_unit_test(same_input_same_objects),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

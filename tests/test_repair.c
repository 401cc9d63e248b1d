// LINK: prom_simplify
#include "builder/simplify/repair.h"

#include "metaobj/base/alloc.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

// ---- meshes

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static float uniform(uint32_t *state)
{
    return (float)next_random(state) / (float)(1 << 24);
}

// A globe of n x 2n quads, triangles at the poles, normals outwards. The seam of the texture
// has its vertices twice, with u = 0 and 1; the poles have theirs once.
static void init_globe(prom_mesh *mesh, uint32_t n, float radius)
{
    uint32_t rows = n - 1, columns = 2 * n + 1, at = 0;
    prom_mesh_init(mesh, rows * columns + 2, (rows - 1) * 2 * n * 6 + 2 * 2 * n * 3, 1);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t j = v / columns, i = v % columns;
        float lat = (float)(j + 1) / (float)n * (float)M_PI;
        float lon = (float)(i % (2 * n)) / (float)n * (float)M_PI;
        float p[3] = {sinf(lat) * cosf(lon), cosf(lat), sinf(lat) * sinf(lon)};
        if (j == rows) p[0] = p[2] = 0, p[1] = i ? -1 : 1;
        for (int k = 0; k < 3; k++) mesh->vertices[v].position[k] = radius * p[k];
        prom_pack_normal(p, mesh->vertices[v].normal);
        memset(mesh->vertices[v].color, 255, 4);
        mesh->vertices[v].uv[0] = (float)i / (float)(2 * n);
        mesh->vertices[v].uv[1] = lat;
    }
    uint32_t north = rows * columns, south = north + 1;
    for (uint32_t i = 0; i < 2 * n; i++) {
        uint32_t last = (rows - 1) * columns + i;
        const uint32_t caps[6] = {north, i + 1, i, south, last, last + 1};
        memcpy(mesh->indices + at, caps, sizeof caps);
        at += 6;
        for (uint32_t j = 0; j + 1 < rows; j++) {
            uint32_t a = j * columns + i, b = a + columns;
            const uint32_t quad[6] = {a, a + 1, b, b, a + 1, b + 1};
            memcpy(mesh->indices + at, quad, sizeof quad);
            at += 6;
        }
    }
    mesh->submeshes[0] = (prom_submesh){0, at, 0};
}

static void init_cube(prom_mesh *mesh)
{
    prom_mesh_init_box(mesh, (float[3]){0, 0, 0}, (float[3]){1, 2, 3}, NULL);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) mesh->vertices[v].normal[3] = 0;
}

// A sheet of n x n quads in y = 0 that faces upwards.
static void init_sheet(prom_mesh *mesh, uint32_t n)
{
    prom_mesh_init(mesh, (n + 1) * (n + 1), n * n * 6, 1);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        mesh->vertices[v].position[0] = (float)(v % (n + 1));
        mesh->vertices[v].position[2] = (float)(v / (n + 1));
        mesh->vertices[v].normal[1] = 127;
    }
    for (uint32_t q = 0; q < n * n; q++) {
        uint32_t a = q / n * (n + 1) + q % n, b = a + n + 1;
        const uint32_t quad[6] = {a, b, a + 1, a + 1, b, b + 1};
        memcpy(mesh->indices + q * 6, quad, sizeof quad);
    }
    mesh->submeshes[0] = (prom_submesh){0, n * n * 6, 0};
}

// Appends triangles to the last submesh; `corners` may be the mesh's own.
static void add_triangles(prom_mesh *mesh, const uint32_t *corners, uint32_t count)
{
    uint32_t *all = prom_alloc(mesh->index_count + count * 3, sizeof *all);
    memcpy(all, mesh->indices, mesh->index_count * sizeof *all);
    memcpy(all + mesh->index_count, corners, count * 3 * sizeof *all);
    prom_free(mesh->indices);
    mesh->indices = all;
    mesh->index_count += count * 3;
    mesh->submeshes[mesh->submesh_count - 1].index_count += count * 3;
}

static uint32_t add_vertex(prom_mesh *mesh, prom_vertex vertex)
{
    mesh->vertices =
        prom_realloc(mesh->vertices, mesh->vertex_count + 1, sizeof *mesh->vertices);
    mesh->vertices[mesh->vertex_count] = vertex;
    return mesh->vertex_count++;
}

static void turn(prom_mesh *mesh, uint32_t triangle)
{
    uint32_t *t = mesh->indices + triangle * 3, second = t[1];
    t[1] = t[2];
    t[2] = second;
}

static uint32_t turn_some(prom_mesh *mesh, uint32_t per_cent, uint32_t *seed)
{
    uint32_t turned = 0;
    for (uint32_t t = 0; t < mesh->index_count / 3; t++) {
        if (next_random(seed) % 100 >= per_cent) continue;
        turn(mesh, t);
        turned++;
    }
    return turned;
}

// Gives every triangle vertices of its own.
static void unweld(prom_mesh *mesh)
{
    prom_vertex *loose = prom_alloc(mesh->index_count, sizeof *loose);
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        loose[i] = mesh->vertices[mesh->indices[i]];
        mesh->indices[i] = i;
    }
    prom_free(mesh->vertices);
    mesh->vertices = loose;
    mesh->vertex_count = mesh->index_count;
}

static void normals_from_windings(prom_mesh *mesh)
{
    unweld(mesh);
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        prom_vertex *v = mesh->vertices + i;
        vec3 e, f, n;
        glm_vec3_sub(v[1].position, v[0].position, e);
        glm_vec3_sub(v[2].position, v[0].position, f);
        glm_vec3_cross(e, f, n);
        for (int k = 0; k < 3; k++) prom_pack_normal(n, v[k].normal);
    }
}

// ---- what is asked of them

static double volume(const prom_mesh *mesh)
{
    double sum = 0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        vec3 c;
        const prom_vertex *v[3];
        for (int k = 0; k < 3; k++) v[k] = &mesh->vertices[mesh->indices[i + k]];
        glm_vec3_cross((float *)v[1]->position, (float *)v[2]->position, c);
        sum += (double)glm_vec3_dot((float *)v[0]->position, c) / 6;
    }
    return sum;
}

// Corners whose normal is against their triangle's winding.
static uint32_t against(const prom_mesh *mesh)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        const prom_vertex *v[3];
        for (uint32_t k = 0; k < 3; k++) v[k] = &mesh->vertices[mesh->indices[i / 3 * 3 + k]];
        vec3 e, f, c;
        glm_vec3_sub((float *)v[1]->position, (float *)v[0]->position, e);
        glm_vec3_sub((float *)v[2]->position, (float *)v[0]->position, f);
        glm_vec3_cross(e, f, c);
        const int8_t *normal = v[i % 3]->normal;
        n += normal[0] * c[0] + normal[1] * c[1] + normal[2] * c[2] < 0;
    }
    return n;
}

static bool same_bytes(const void *a, const void *b, size_t bytes)
{
    return !bytes || !memcmp(a, b, bytes); // arrays of nothing may be NULL
}

static bool same_mesh(const prom_mesh *a, const prom_mesh *b)
{
    return a->vertex_count == b->vertex_count && a->index_count == b->index_count &&
           a->submesh_count == b->submesh_count &&
           same_bytes(a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices) &&
           same_bytes(a->indices, b->indices, a->index_count * sizeof *a->indices) &&
           same_bytes(a->submeshes, b->submeshes, a->submesh_count * sizeof *a->submeshes);
}

// Repairs, and sees to what holds of every repair: the mesh is sound, and a second repair with
// the same options finds nothing and changes nothing.
static prom_repair_report repair(prom_mesh *mesh, const prom_repair_options *options)
{
    prom_repair_report first, second;
    prom_mesh_repair(mesh, options, &first);
    assert_null(prom_mesh_check(mesh, UINT32_MAX));
    assert_int_equal(first.faces, mesh->index_count / 3);
    prom_mesh again;
    prom_mesh_copy(&again, mesh);
    prom_mesh_repair(&again, options, &second);
    assert_true(same_mesh(mesh, &again));
    assert_false(prom_repair_mended(&second));
    prom_mesh_finish(&again);
    prom_repair_report left = first;
    left.snapped = left.welded = left.degenerate = left.duplicate = left.turned = 0;
    assert_memory_equal(&left, &second, sizeof second);
    return first;
}

// ---- tests

static void sound_meshes_stay(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    for (int kind = 0; kind < 3; kind++) {
        if (kind == 0) init_cube(&mesh);
        if (kind == 1) init_globe(&mesh, 8, 1);
        if (kind == 2) init_sheet(&mesh, 5);
        prom_mesh_copy(&before, &mesh);
        prom_repair_report r = repair(&mesh, NULL);
        assert_true(same_mesh(&before, &mesh));
        assert_false(prom_repair_mended(&r));
        assert_int_equal(r.patches, 1);
        assert_int_equal(r.closed_patches, kind < 2);
        assert_int_equal(prom_repair_closed(&r), kind < 2);
        assert_int_equal(r.open_edges, kind < 2 ? 0 : 20);
        prom_mesh_finish(&mesh);
        prom_mesh_finish(&before);
    }
}

static void loose_triangles_are_welded(void **state)
{
    (void)state;
    prom_mesh mesh;
    init_globe(&mesh, 8, 1);
    uint32_t vertices = mesh.vertex_count;
    unweld(&mesh);
    uint32_t loose = mesh.vertex_count;
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(mesh.vertex_count, vertices);
    assert_int_equal(r.welded, loose - vertices);
    assert_int_equal(r.snapped, 0);
    assert_true(prom_repair_closed(&r));
    prom_mesh_finish(&mesh);
}

// Jitter far below the tolerance, everywhere: cells of the search have borders somewhere.
static void cracks_close_wherever_they_are(void **state)
{
    (void)state;
    uint32_t seed = 5;
    for (int turn_no = 0; turn_no < 20; turn_no++) {
        prom_mesh mesh;
        float radius = powf(10, 4 * uniform(&seed) - 2);
        init_globe(&mesh, 12, radius);
        uint32_t vertices = mesh.vertex_count;
        unweld(&mesh);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            for (int k = 0; k < 3; k++)
                mesh.vertices[v].position[k] += 0.4e-5f * radius * (2 * uniform(&seed) - 1);
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(mesh.vertex_count, vertices);
        assert_true(r.snapped > 0);
        assert_true(prom_repair_closed(&r));
        prom_mesh_finish(&mesh);
    }
}

// No vertex moves further than the tolerance, none stays nearer than that to another's place.
static void the_tolerance_holds(void **state)
{
    (void)state;
    uint32_t seed = 9;
    prom_mesh mesh, before;
    init_sheet(&mesh, 12);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        for (int k = 0; k < 3; k++)
            mesh.vertices[v].position[k] = 0.3f * uniform(&seed) + (v == 0 && k == 1);
    prom_mesh_copy(&before, &mesh);
    const prom_repair_options options = {.tolerance = 0.05f, .orient = PROM_ORIENT_NOT};
    prom_box box = prom_mesh_bounds(&mesh);
    float tolerance = 0.05f * prom_box_diagonal(&box) / 2;
    prom_mesh_repair(&mesh, &options, &(prom_repair_report){0});
    assert_true(mesh.vertex_count > 10 && mesh.vertex_count < before.vertex_count);
    for (uint32_t a = 0; a < mesh.vertex_count; a++) {
        float nearest = INFINITY;
        for (uint32_t b = 0; b < before.vertex_count; b++) {
            float far = 0;
            for (int k = 0; k < 3; k++)
                far = fmaxf(
                    far, fabsf(mesh.vertices[a].position[k] - before.vertices[b].position[k]));
            nearest = fminf(nearest, far);
        }
        assert_true(nearest == 0); // the place of one that was there
        for (uint32_t b = 0; b < a; b++) {
            float far = 0;
            for (int k = 0; k < 3; k++)
                far = fmaxf(far,
                            fabsf(mesh.vertices[a].position[k] - mesh.vertices[b].position[k]));
            assert_true(far > tolerance || far == 0);
        }
    }
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

static void what_is_further_apart_stays_apart(void **state)
{
    (void)state;
    for (int wide = 0; wide < 2; wide++) {
        prom_mesh mesh;
        init_sheet(&mesh, 2); // radius sqrt(2)
        unweld(&mesh);
        float gap = sqrtf(2) * PROM_REPAIR_TOLERANCE * (wide ? 1.1f : 0.9f);
        for (uint32_t v = 0; v < 3; v++) mesh.vertices[v].position[1] += gap;
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(r.open_edges, wide ? 8 + 2 : 8);
        prom_mesh_finish(&mesh);
    }
    prom_mesh exact;
    init_sheet(&exact, 2);
    exact.vertices[0].position[1] = 1e-7f;
    unweld(&exact);
    exact.vertices[0].position[1] = 0;
    prom_repair_report r = repair(&exact, &(prom_repair_options){.tolerance = -1});
    assert_int_equal(r.snapped, 0);
    prom_mesh_finish(&exact);
}

static void seams_of_the_texture_survive(void **state)
{
    (void)state;
    prom_mesh mesh;
    uint32_t n = 8, seed = 3;
    init_globe(&mesh, n, 1);
    uint32_t vertices = mesh.vertex_count;
    for (uint32_t v = 0; v < vertices; v++)
        for (int k = 0; k < 3; k++)
            mesh.vertices[v].position[k] += 0.4e-5f * (2 * uniform(&seed) - 1);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(mesh.vertex_count, vertices);
    assert_int_equal(r.welded, 0);
    assert_int_equal(r.snapped, n - 1); // one of each pair at the seam
    assert_true(prom_repair_closed(&r));
    uint32_t pairs = 0;
    for (uint32_t a = 0; a < vertices; a++)
        for (uint32_t b = 0; b < a; b++)
            pairs += !memcmp(mesh.vertices[a].position, mesh.vertices[b].position,
                             sizeof mesh.vertices[a].position) &&
                     fabsf(mesh.vertices[a].uv[0] - mesh.vertices[b].uv[0]) == 1;
    assert_int_equal(pairs, n - 1);
    prom_mesh_finish(&mesh);
}

static void faces_without_area_go(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    init_globe(&mesh, 6, 1);
    prom_mesh_copy(&before, &mesh);
    prom_vertex bad = mesh.vertices[0];
    bad.position[1] = NAN;
    uint32_t nan = add_vertex(&mesh, bad);
    bad.position[1] = INFINITY;
    uint32_t infinite = add_vertex(&mesh, bad);
    bad.position[1] = mesh.vertices[0].position[1] + 1e-7f;
    uint32_t near = add_vertex(&mesh, bad);
    const uint32_t faces[] = {4, 4, 9, 7, 7, 7, 0, 1, nan, 2, infinite, 5, 0, near, 20};
    add_triangles(&mesh, faces, 5);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.degenerate, 5);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

static void repeated_faces_go(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    init_globe(&mesh, 6, 1);
    prom_mesh_copy(&before, &mesh);
    const uint32_t *t = mesh.indices;
    const uint32_t faces[] = {t[0], t[1], t[2],
                              t[4], t[5], t[3]}; // the second begins elsewhere
    add_triangles(&mesh, faces, 2);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.duplicate, 2);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

// The same faces in another material lie over these (a decal).
static void faces_of_other_materials_stay(void **state)
{
    (void)state;
    prom_mesh mesh;
    init_sheet(&mesh, 3);
    uint32_t count = mesh.index_count;
    add_triangles(&mesh, mesh.indices, count / 3);
    prom_free(mesh.submeshes);
    mesh.submeshes = prom_calloc(2, sizeof *mesh.submeshes);
    mesh.submesh_count = 2;
    mesh.submeshes[0] = (prom_submesh){0, count, 0};
    mesh.submeshes[1] = (prom_submesh){count, count, 1};
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.duplicate, 0);
    assert_int_equal(mesh.index_count, 2 * count);
    assert_int_equal(r.patches, 1);
    // Both turn over, both come back.
    prom_mesh before;
    prom_mesh_copy(&before, &mesh);
    turn(&mesh, 7);
    turn(&mesh, count / 3 + 7);
    r = repair(&mesh, NULL);
    assert_int_equal(r.turned, 2);
    assert_true(prom_mesh_hash(&mesh, 0) == prom_mesh_hash(&before, 0));
    prom_mesh_finish(&before);
    prom_mesh_finish(&mesh);
}

static void two_sided_sheets_stay(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    init_sheet(&mesh, 4);
    uint32_t count = mesh.index_count;
    // The back has the front's normals, which speak against its winding.
    add_triangles(&mesh, mesh.indices, count / 3);
    for (uint32_t t = count / 3; t < 2 * count / 3; t++) turn(&mesh, t);
    for (prom_repair_orient how = PROM_ORIENT_BY_NORMALS; how <= PROM_ORIENT_NOT; how++) {
        prom_mesh_copy(&before, &mesh);
        prom_repair_report r = repair(&mesh, &(prom_repair_options){.orient = how});
        assert_true(same_mesh(&before, &mesh));
        assert_int_equal(r.two_sided, 2 * count / 3);
        assert_int_equal(r.patches, 0);
        assert_false(prom_repair_closed(&r));
        prom_mesh_finish(&before);
    }
    prom_mesh_finish(&mesh);
}

// Whatever share of faces is turned over, normals that know better bring them all back.
static void turned_faces_come_back_by_normals(void **state)
{
    (void)state;
    uint32_t seed = 11;
    for (uint32_t i = 0; i < 60; i++) {
        prom_mesh mesh, before;
        if (i % 3 == 0)
            init_cube(&mesh);
        else if (i % 3 == 1)
            init_globe(&mesh, 3 + i % 9, 0.1f + uniform(&seed));
        else
            init_sheet(&mesh, 1 + i % 9);
        prom_mesh_copy(&before, &mesh);
        // An open sheet that is wholly turned over is left so.
        uint32_t turned = turn_some(&mesh, i % 3 == 2 ? 50 : i * 2, &seed);
        bool whole = turned == mesh.index_count / 3 && i % 3 == 2;
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(r.turned, whole ? 0 : turned);
        assert_int_equal(r.clashing_edges, 0);
        if (!whole) assert_true(prom_mesh_hash(&mesh, 0) == prom_mesh_hash(&before, 0));
        prom_mesh_finish(&mesh);
        prom_mesh_finish(&before);
    }
}

// Without a word from the author: closed ones have their volume, open ones their majority.
static void turned_faces_come_back_by_shape(void **state)
{
    (void)state;
    uint32_t seed = 12;
    const prom_repair_options by_shape = {.orient = PROM_ORIENT_BY_SHAPE};
    for (uint32_t i = 0; i < 40; i++) {
        prom_mesh mesh;
        bool open = i % 2;
        if (open)
            init_sheet(&mesh, 6);
        else
            init_globe(&mesh, 6, 1);
        uint32_t vertices = mesh.vertex_count;
        double inside = volume(&mesh);
        uint32_t turned = turn_some(&mesh, open ? 1 + i / 2 : 5 + 2 * i, &seed);
        normals_from_windings(&mesh);
        prom_repair_report r = repair(&mesh, &by_shape);
        assert_int_equal(r.clashing_edges, 0);
        assert_int_equal(r.turned, turned);
        assert_int_equal(against(&mesh), 0);
        if (open)
            assert_int_equal(mesh.vertex_count, vertices);
        else
            assert_true(fabs(volume(&mesh) - inside) < 1e-5);
        prom_mesh_finish(&mesh);
    }
}

static void normals_protect_their_faces(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    uint32_t seed = 13;
    init_globe(&mesh, 8, 1);
    turn_some(&mesh, 30, &seed);
    normals_from_windings(&mesh);
    prom_mesh_repair(&mesh, NULL, &(prom_repair_report){0}); // welds
    prom_mesh_copy(&before, &mesh);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.turned, 0);
    assert_true(r.clashing_edges > 0);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

// Normals that contradict each other say nothing about the windings.
static void quarrelling_normals_are_not_believed(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    uint32_t seed = 14;
    init_sheet(&mesh, 10);
    unweld(&mesh);
    turn_some(&mesh, 30, &seed);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) // by triangle
        if (v / 3 * 7 % 10 < 4) mesh.vertices[v].normal[1] = -127;
    prom_mesh_repair(&mesh, &(prom_repair_options){.orient = PROM_ORIENT_NOT},
                     &(prom_repair_report){0});
    prom_mesh_copy(&before, &mesh);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.turned, 0);
    assert_true(r.clashing_edges > 0);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

// Of three sheets along one edge none has a side that the others would prove; but a large
// surface may touch others somewhere.
static void few_tangled_edges_do_no_harm(void **state)
{
    (void)state;
    for (uint32_t n = 1; n <= 8; n += 7) {
        prom_mesh mesh;
        init_sheet(&mesh, n);
        prom_vertex top = mesh.vertices[0];
        top.position[1] = 1;
        uint32_t a = add_vertex(&mesh, top);
        top.position[1] = -1;
        uint32_t b = add_vertex(&mesh, top);
        add_triangles(&mesh, (uint32_t[6]){0, 1, a, 0, 1, b}, 2);
        turn(&mesh, n * n * 2 - 1);
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(r.non_manifold_edges, 1);
        assert_int_equal(r.turned, n == 8);
        prom_mesh_finish(&mesh);
    }
}

// A room is a box seen from within: its normals say so, or nothing does.
static void rooms_and_backdrops_stay(void **state)
{
    (void)state;
    for (int how = 0; how <= PROM_ORIENT_NOT; how++) {
        prom_mesh room;
        init_cube(&room);
        for (uint32_t t = 0; t < 12; t++) turn(&room, t);
        for (uint32_t v = 0; v < room.vertex_count && how < PROM_ORIENT_NOT; v++)
            for (int k = 0; k < 3; k++) room.vertices[v].normal[k] *= -1;
        prom_repair_report r = repair(&room, &(prom_repair_options){.orient = how});
        assert_int_equal(r.turned, 0);
        assert_true(volume(&room) < 0);
        prom_mesh_finish(&room);
    }
}

// One twist in a closed band: no choice of sides makes all faces agree.
static void one_sided_bands_stay(void **state)
{
    (void)state;
    enum { N = 24 };
    prom_mesh mesh, before;
    prom_mesh_init(&mesh, 2 * N, 6 * N, 1);
    for (uint32_t i = 0; i < 2 * N; i++) {
        float at = 2 * (float)M_PI * (float)(i / 2) / N, side = i % 2 ? 0.3f : -0.3f;
        float r = 1 + side * cosf(at / 2);
        const float p[3] = {r * cosf(at), side * sinf(at / 2), r * sinf(at)};
        for (int k = 0; k < 3; k++) mesh.vertices[i].position[k] = p[k] + 0.0f; // no -0
    }
    for (uint32_t i = 0; i < N; i++) {
        uint32_t a = 2 * i, b = a + 1, c = a + 2, d = a + 3;
        if (i + 1 == N) c = 1, d = 0;
        const uint32_t quad[6] = {a, c, b, b, c, d};
        memcpy(mesh.indices + 6 * i, quad, sizeof quad);
    }
    mesh.submeshes[0].index_count = 6 * N;
    prom_mesh_copy(&before, &mesh);
    prom_repair_report r =
        repair(&mesh, &(prom_repair_options){.orient = PROM_ORIENT_BY_SHAPE});
    assert_int_equal(r.turned, 0);
    assert_int_equal(r.clashing_edges, 1);
    assert_int_equal(r.open_edges, 2 * N);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

// Three sheets along one edge.
static void edges_of_three_faces_are_counted(void **state)
{
    (void)state;
    prom_mesh mesh;
    prom_mesh_init(&mesh, 5, 9, 1);
    const float at[5][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
    for (int v = 0; v < 5; v++) memcpy(mesh.vertices[v].position, at[v], sizeof at[v]);
    const uint32_t faces[9] = {0, 1, 2, 0, 1, 3, 0, 1, 4};
    memcpy(mesh.indices, faces, sizeof faces);
    mesh.submeshes[0].index_count = 9;
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.non_manifold_edges, 1);
    assert_int_equal(r.open_edges, 6);
    assert_int_equal(r.patches, 3);
    prom_mesh_finish(&mesh);
}

static void everything_at_once(void **state)
{
    (void)state;
    uint32_t seed = 77;
    for (uint32_t i = 0; i < 30; i++) {
        prom_mesh mesh;
        init_globe(&mesh, 6 + i % 7, 2);
        uint32_t vertices = mesh.vertex_count, faces = mesh.index_count / 3;
        double inside = volume(&mesh);
        unweld(&mesh);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            for (int k = 0; k < 3; k++)
                mesh.vertices[v].position[k] += 0.8e-5f * (2 * uniform(&seed) - 1);
        for (uint32_t d = 0; d < 20; d++) { // before any is turned: no back sides come of it
            uint32_t t = next_random(&seed) % faces;
            add_triangles(&mesh, (uint32_t[3]){3 * t, 3 * t + 1, 3 * t + 2}, 1);
            add_triangles(&mesh, (uint32_t[3]){3 * t, 3 * t + 1, 3 * t + 1}, 1);
        }
        uint32_t turned = 0;
        bool *over = prom_calloc(faces, sizeof *over);
        for (uint32_t t = 0; t < faces; t++) over[t] = next_random(&seed) % 4 == 0;
        for (uint32_t t = 0; t < mesh.index_count / 3; t++)
            if (over[mesh.indices[3 * t] / 3]) turn(&mesh, t);
        for (uint32_t t = 0; t < faces; t++) turned += over[t];
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(r.degenerate, 20);
        assert_int_equal(r.duplicate, 20);
        assert_int_equal(r.turned, turned);
        assert_int_equal(mesh.index_count / 3, faces);
        assert_int_equal(mesh.vertex_count, vertices);
        assert_true(prom_repair_closed(&r));
        assert_true(fabs(volume(&mesh) - inside) < 1e-3);
        prom_free(over);
        prom_mesh_finish(&mesh);
    }
}

// Random triangles over few places: all that can go wrong does.
static void nothing_hurts_soups(void **state)
{
    (void)state;
    uint32_t seed = 99;
    for (uint32_t i = 0; i < 300; i++) {
        prom_mesh mesh;
        uint32_t vertices = 3 + next_random(&seed) % 12, faces = next_random(&seed) % 40;
        prom_mesh_init(&mesh, vertices, faces * 3, 2);
        for (uint32_t v = 0; v < vertices; v++) {
            for (int k = 0; k < 3; k++) {
                mesh.vertices[v].position[k] = (float)(next_random(&seed) % 3) - 1;
                mesh.vertices[v].normal[k] = (int8_t)(next_random(&seed) % 255 - 127);
            }
            if (next_random(&seed) % 50 == 0) mesh.vertices[v].position[0] = NAN;
            if (next_random(&seed) % 9 == 0) mesh.vertices[v].position[0] = -0.0f;
        }
        for (uint32_t c = 0; c < faces * 3; c++)
            mesh.indices[c] = next_random(&seed) % vertices;
        uint32_t half = faces / 2 * 3;
        mesh.submeshes[0] = (prom_submesh){0, half, 0};
        mesh.submeshes[1] = (prom_submesh){half, faces * 3 - half, 1};
        const prom_repair_options options = {.tolerance = i % 5 ? 0.0f : 0.3f,
                                             .orient = i % 3 ? i % 3 : PROM_ORIENT_BY_NORMALS};
        prom_repair_report r = repair(&mesh, &options);
        assert_int_equal(r.faces + r.degenerate + r.duplicate, faces);
        prom_mesh_finish(&mesh);
    }
}

static void empty_meshes_are_fine(void **state)
{
    (void)state;
    prom_mesh empty = {0};
    prom_repair_report r = repair(&empty, NULL);
    assert_false(prom_repair_mended(&r));
    assert_false(prom_repair_closed(&r));
    prom_mesh_finish(&empty);
    prom_mesh point;
    init_sheet(&point, 2);
    for (uint32_t v = 0; v < point.vertex_count; v++)
        memset(point.vertices[v].position, 0, sizeof point.vertices[v].position);
    r = repair(&point, NULL);
    assert_int_equal(r.degenerate, 8);
    assert_int_equal(point.vertex_count, 0);
    assert_int_equal(point.submesh_count, 0);
    prom_mesh_finish(&point);
}

static void numbers_are_told(void **state)
{
    (void)state;
    prom_repair_report r = {.welded = 12, .turned = 1, .faces = 9}, sum = {0}, read = {0};
    char *text = prom_repair_text(&r);
    assert_string_equal(text, "12 vertices welded, 1 face turned");
    prom_free(text);
    prom_repair_report_add(&sum, &r);
    prom_repair_report_add(&sum, &r);
    assert_int_equal(sum.welded, 24);
    assert_int_equal(sum.faces, 18);
    char *json = prom_repair_json(&r);
    assert_non_null(strstr(json, "\"welded\": 12,"));
    assert_non_null(strstr(json, "\"closed_patches\": 0}"));
    prom_free(json);
    prom_repair_set(&read, "welded", 12);
    prom_repair_set(&read, "turned", 1);
    prom_repair_set(&read, "faces", 9);
    prom_repair_set(&read, "nonsense", 7);
    assert_memory_equal(&read, &r, sizeof r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sound_meshes_stay),
        cmocka_unit_test(loose_triangles_are_welded),
        cmocka_unit_test(cracks_close_wherever_they_are),
        cmocka_unit_test(the_tolerance_holds),
        cmocka_unit_test(what_is_further_apart_stays_apart),
        cmocka_unit_test(seams_of_the_texture_survive),
        cmocka_unit_test(faces_without_area_go),
        cmocka_unit_test(repeated_faces_go),
        cmocka_unit_test(faces_of_other_materials_stay),
        cmocka_unit_test(two_sided_sheets_stay),
        cmocka_unit_test(turned_faces_come_back_by_normals),
        cmocka_unit_test(turned_faces_come_back_by_shape),
        cmocka_unit_test(normals_protect_their_faces),
        cmocka_unit_test(quarrelling_normals_are_not_believed),
        cmocka_unit_test(few_tangled_edges_do_no_harm),
        cmocka_unit_test(rooms_and_backdrops_stay),
        cmocka_unit_test(one_sided_bands_stay),
        cmocka_unit_test(edges_of_three_faces_are_counted),
        cmocka_unit_test(everything_at_once),
        cmocka_unit_test(nothing_hurts_soups),
        cmocka_unit_test(empty_meshes_are_fine),
        cmocka_unit_test(numbers_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

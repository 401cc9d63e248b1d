// Damage for containers: a file of a random model, cut short or with single bits flipped, and
// read whole. Reading must give one clear error or the very same content; that it does not
// crash or read past a buffer is for the sanitizer build to watch.
#ifndef PROM_TESTS_CONTAINER_DAMAGE_H
#define PROM_TESTS_CONTAINER_DAMAGE_H

#include "container_fixture.h"
#include "random_model.h"

#include "metaobj/base/log.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/stat.h>

#include <cmocka.h>

typedef struct damage {
    char *path;
    int fd; // for writing
    uint64_t bytes, content_hash;
} damage;

static inline void damage_mesh(prom_mesh *mesh, const prom_mesh_info *info, uint64_t *seed)
{
    prom_mesh_init(mesh, info->vertex_count, info->index_count, info->submesh_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        prom_vertex *p = &mesh->vertices[v];
        for (int a = 0; a < 3; a++) p->position[a] = random_between(seed, -1, 1);
        p->normal[1] = 127;
        memset(p->color, (int)random_below(seed, 256), sizeof p->color);
    }
    // Neighbours in a strip, as meshes are, and some from anywhere.
    for (uint32_t i = 0; i < mesh->index_count; i++)
        mesh->indices[i] = random_below(seed, 8) ? (i / 3 + i % 3) % mesh->vertex_count
                                                 : random_below(seed, mesh->vertex_count);
    mesh->submeshes[0] = (prom_submesh){0, mesh->index_count, PROM_NONE};
}

static inline prom_status damage_write_bulk(prom_writer *w, const prom_model *m, uint64_t *seed,
                                            prom_error *error)
{
    prom_status status = PROM_OK;
    for (uint32_t i = 0; i < m->mesh_count && !status; i++) {
        prom_mesh mesh;
        damage_mesh(&mesh, &m->meshes[i], seed);
        status = prom_writer_add_mesh(w, &mesh, NULL, error);
        prom_mesh_finish(&mesh);
    }
    for (uint32_t i = 0; i < m->texture_count && !status; i++) {
        prom_texture texture;
        prom_texture_init(&texture, m->textures[i].kind, m->textures[i].width,
                          m->textures[i].height);
        for (size_t k = prom_texture_bytes(&texture); k-- > 0;)
            texture.pixels[k] = (uint8_t)(k / 64 + random_below(seed, 8));
        status = prom_writer_add_texture(w, &texture, NULL, error);
        prom_texture_finish(&texture);
    }
    return status;
}

static inline void damage_init(damage *d)
{
    const random_model_options options = {
        .leaves = 60, .max_children = 6, .extent = 50, .bare_clusters = 0.3f};
    prom_error error = {0};
    prom_model m;
    uint64_t seed = 5;
    random_model(&m, seed, &options);
    d->path = fixture_path("damage");
    prom_writer *w = prom_writer_create(d->path, &error);
    prom_status status = w ? damage_write_bulk(w, &m, &seed, &error) : error.status;
    if (!status) status = prom_writer_set_meta(w, "source", "random", &error);
    if (!status) status = prom_writer_set_meta(w, "settings", "none", &error);
    if (!status) status = prom_writer_add_stage(w, "all", 7, 1, &error);
    if (!status) status = prom_writer_put_model(w, &m, &error);
    prom_view_cells cells;
    uint32_t cell_seed = 6;
    fixture_view_cells(&cells, &m, 40, &cell_seed);
    if (!status) status = prom_writer_put_view_cells(w, &cells, &error);
    prom_view_cells_finish(&cells);
    if (!status) status = prom_writer_finish(w, &error);
    if (!status) status = fixture_read_hash(d->path, &d->content_hash, &error);
    if (status) print_error("%s\n", error.text);
    assert_int_equal(status, PROM_OK);
    prom_writer_destroy(w);
    prom_model_finish(&m);
    d->fd = open(d->path, O_RDWR | O_CLOEXEC);
    struct stat info;
    assert_int_equal(fstat(d->fd, &info), 0);
    d->bytes = (uint64_t)info.st_size;
    prom_log_set_level(PROM_LOG_ERROR);
}

static inline void damage_finish(damage *d)
{
    prom_log_set_level(PROM_LOG_INFO);
    close(d->fd);
    unlink(d->path);
    prom_free(d->path);
}

// Reads the file as it is now; whether it was refused.
static inline bool damage_refused(const damage *d)
{
    prom_error error = {0};
    uint64_t hash = 0;
    prom_status status = fixture_read_hash(d->path, &hash, &error);
    if (!status) {
        assert_true(hash == d->content_hash);
        return false;
    }
    assert_int_equal(status, PROM_ERR_INPUT);
    bool clear = strstr(error.text, d->path) && !strstr(error.text, "malformed") &&
                 !strstr(error.text, "database") && strlen(error.text) < 300;
    if (!clear) print_error("%s\n", error.text);
    assert_true(clear);
    return true;
}

// One of `count` places in [0, size): the even ones are spread evenly, the odd ones random.
static inline uint64_t damage_place(uint32_t i, uint32_t count, uint64_t size, uint64_t *seed)
{
    return i % 2 ? random_u64(seed) % size : size / count * i;
}

// Cuts the file at `count` places; the longest is last to be cut.
static inline void damage_cut_short(const damage *d, uint32_t count)
{
    uint8_t *whole = prom_alloc(d->bytes, 1);
    assert_int_equal(pread(d->fd, whole, d->bytes, 0), d->bytes);
    uint64_t seed = 3;
    for (uint32_t i = 0; i < count; i++) {
        uint64_t bytes = i ? damage_place(i, count, d->bytes, &seed) : d->bytes - 1;
        assert_int_equal(ftruncate(d->fd, (off_t)bytes), 0);
        assert_true(damage_refused(d));
        assert_int_equal(pwrite(d->fd, whole + bytes, d->bytes - bytes, (off_t)bytes),
                         d->bytes - bytes);
    }
    assert_false(damage_refused(d));
    prom_free(whole);
}

// Flips one of the bits that are not in the long runs of zeros between a page's header and its
// cells. Returns how many of `count` flips were refused.
static inline uint32_t damage_flip_bits(const damage *d, uint32_t count)
{
    uint64_t seed = 11;
    uint32_t refused = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint64_t bit = damage_place(i, count, 8 * d->bytes, &seed), at = bit / 8;
        uint8_t old = 0;
        for (uint64_t left = d->bytes; left && !old; left--) {
            assert_int_equal(pread(d->fd, &old, 1, (off_t)at), 1);
            if (!old) at = (at + 1) % d->bytes;
        }
        uint8_t flipped = (uint8_t)(old ^ 1u << bit % 8);
        assert_int_equal(pwrite(d->fd, &flipped, 1, (off_t)at), 1);
        refused += damage_refused(d);
        assert_int_equal(pwrite(d->fd, &old, 1, (off_t)at), 1);
    }
    assert_false(damage_refused(d));
    return refused;
}

#endif

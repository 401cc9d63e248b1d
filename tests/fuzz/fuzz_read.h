// Reads all that is in a container, going on after errors, and checks what must hold whatever
// is in the file: a model that is loaded is sound, and every refusal has its line of text.
#ifndef PROM_TESTS_FUZZ_READ_H
#define PROM_TESTS_FUZZ_READ_H

#include "fuzz.h"

#include "metaobj/base/log.h"
#include "metaobj/container.h"
#include "tests/container_fixture.h"

// Whether it was read.
static inline bool fuzz_expect(prom_status status, const prom_error *error, const char *path)
{
    if (!status) return true;
    fuzz_check(status == PROM_ERR_INPUT && error->status == status);
    fuzz_check(!strncmp(error->text, path, strlen(path)) || strstr(error->text, "cannot open"));
    return false;
}

static inline void fuzz_stage(void *user, const char *name, uint64_t content_hash, double ms)
{
    fuzz_check(strlen(name) < SIZE_MAX && isfinite(ms));
    *(uint64_t *)user += content_hash;
}

static inline bool fuzz_read_bulk(prom_container *c, const prom_model *m, const char *path)
{
    bool all = true;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        prom_error error = {0};
        prom_mesh mesh;
        prom_status status = prom_container_read_mesh(c, m, i, &mesh, &error);
        all &= fuzz_expect(status, &error, path);
        if (!status) fuzz_check(!prom_mesh_check(&mesh, m->material_count));
        prom_mesh_finish(&mesh);
    }
    for (uint32_t i = 0; i < m->texture_count; i++) {
        prom_error error = {0};
        prom_texture texture;
        prom_status status = prom_container_read_texture(c, m, i, &texture, &error);
        all &= fuzz_expect(status, &error, path);
        if (!status) fuzz_check(prom_texture_bytes(&texture) > 0);
        prom_texture_finish(&texture);
    }
    prom_error error = {0};
    prom_view_cells cells;
    prom_status status = prom_container_read_view_cells(c, m, &cells, &error);
    all &= fuzz_expect(status, &error, path);
    if (!status) {
        uint64_t cell;
        fuzz_check(!prom_view_cells_check(&cells, m, &cell));
    }
    prom_view_cells_finish(&cells);
    return all;
}

// Whether there was nothing wrong with it.
static inline bool fuzz_read_container(const char *path)
{
    prom_error error = {0};
    prom_model m;
    uint64_t hash = 0;
    prom_log_set_level(PROM_LOG_ERROR);
    prom_container *c = prom_container_open(path, &error);
    if (!fuzz_expect(c ? PROM_OK : error.status, &error, path)) return false;
    prom_container_meta(c, "source");
    bool all = fuzz_expect(prom_container_stages(c, fuzz_stage, &hash, &error), &error, path);
    all &= fuzz_expect(prom_container_content_hash(c, &hash, &error), &error, path);
    bool loaded = fuzz_expect(prom_container_load_model(c, &m, &error), &error, path);
    if (loaded) {
        uint64_t row;
        fuzz_check(!prom_model_check(&m, &row));
        all &= fuzz_read_bulk(c, &m, path);
        prom_model_finish(&m);
    }
    prom_container_close(c);
    return all && loaded;
}

// The bytes of the fixture's container; free them.
static inline uint8_t *fuzz_fixture(uint32_t clusters, uint32_t leaves, size_t *count)
{
    fixture f;
    prom_error error = {0};
    fixture_init(&f, clusters, leaves);
    char folder[] = "/tmp/fuzz-XXXXXX";
    fuzz_check(mkdtemp(folder));
    char *path = prom_format("%s/fixture.prom", folder);
    prom_status status = fixture_write(&f, path, 1, &error);
    if (status) fprintf(stderr, "%s\n", error.text);
    fuzz_check(!status);
    fixture_finish(&f);
    FILE *file = fopen(path, "rb");
    fuzz_check(file && !fseek(file, 0, SEEK_END));
    *count = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = prom_alloc(*count, 1);
    fuzz_check(fread(bytes, 1, *count, file) == *count);
    fclose(file);
    unlink(path);
    rmdir(folder);
    prom_free(path);
    return bytes;
}

#endif

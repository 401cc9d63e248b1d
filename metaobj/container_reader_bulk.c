// Bulk data from the container: chunks found, checked, decoded; meshes and textures of them.
#include "metaobj/container_reader.h"

#include "metaobj/base/hash.h"

#include <math.h>
#include <unistd.h>

// Squares of such lengths are finite floats; prom_model_check holds bounds to the same.
#define POSITION_MAX 1e18f

prom_status prom_container_refuse(prom_container *container, const char *table, uint64_t row,
                                  const char *why, prom_error *error)
{
    return prom_fail(error, PROM_ERR_INPUT,
                     "%s: table %s, row %llu: %s; the file is damaged: build it again",
                     container->path, table, (unsigned long long)row, why);
}

// Steps to a chunk's row; the caller resets the statement.
static prom_status find_chunk(prom_container *c, const char *columns, uint64_t id,
                              sqlite3_stmt **statement, prom_error *error)
{
    if (!*statement) {
        char *sql = prom_format("SELECT %s FROM chunk WHERE id=?", columns);
        int rc = sqlite3_prepare_v2(c->db, sql, -1, statement, NULL);
        prom_free(sql);
        if (rc != SQLITE_OK) return prom_container_fail_sqlite(c, "chunk", id, error);
    }
    sqlite3_bind_int64(*statement, 1, (int64_t)id);
    int rc = sqlite3_step(*statement);
    if (rc == SQLITE_DONE)
        return prom_container_refuse(c, "chunk", id, "the row is missing", error);
    return rc == SQLITE_ROW ? PROM_OK : prom_container_fail_sqlite(c, "chunk", id, error);
}

// Before memory is taken: the chunks must be there and large enough for what they claim.
static prom_status check_chunks(prom_container *c, const prom_stream *stream, uint64_t first,
                                uint64_t *stored, prom_error *error)
{
    prom_status status = PROM_OK;
    sqlite3_stmt *statement = NULL;
    for (uint64_t i = 0; i < prom_stream_chunks(stream) && !status; i++) {
        uint64_t raw = prom_stream_chunk_count(stream, i) * stream->stride;
        status = find_chunk(c, "codec,length(data)", first + i, &statement, error);
        if (status) break;
        int64_t codec = sqlite3_column_int64(statement, 0);
        uint64_t bytes = (uint64_t)sqlite3_column_int64(statement, 1);
        if (sqlite3_column_type(statement, 0) != SQLITE_INTEGER)
            status = prom_container_refuse(c, "chunk", first + i,
                                           "its codec is no whole number", error);
        else if (bytes < prom_codec_least_bytes(codec, raw))
            status = prom_container_refuse(c, "chunk", first + i,
                                           "it is too short for its data", error);
        sqlite3_reset(statement);
        *stored += bytes;
    }
    sqlite3_finalize(statement);
    return status;
}

// Well compressed data may be thousands of times the file: honest for a picture of one colour,
// and yet too much to try.
static prom_status check_memory(prom_container *c, const char *table, uint32_t id,
                                uint64_t bytes, prom_error *error)
{
    long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page_bytes <= 0 || bytes / (uint64_t)page_bytes < (uint64_t)pages)
        return PROM_OK;
    return prom_fail(error, PROM_ERR_INPUT,
                     "%s: table %s, row %u: it needs %.1f GB, more than the memory of this "
                     "machine",
                     c->path, table, id, (double)bytes / 1e9);
}

prom_status prom_container_check_streams(prom_container *container, const char *table,
                                         uint32_t id, const prom_stream *streams, int count,
                                         uint64_t first_chunk, uint64_t *stored_bytes,
                                         prom_error *error)
{
    prom_status status = PROM_OK;
    uint64_t bytes = 0, stored = 0;
    for (int s = 0; s < count && !status; s++) {
        status = check_chunks(container, &streams[s], first_chunk, &stored, error);
        first_chunk += prom_stream_chunks(&streams[s]);
        bytes += streams[s].count * streams[s].stride;
    }
    if (stored_bytes) *stored_bytes = stored;
    return status ? status : check_memory(container, table, id, bytes, error);
}

static prom_status decode_chunk(prom_container *c, const prom_stream *stream, uint64_t id,
                                void *out, uint64_t count, prom_error *error)
{
    prom_status status = find_chunk(c, "codec,checksum,data", id, &c->chunk, error);
    if (!status) {
        const void *data = sqlite3_column_blob(c->chunk, 2);
        size_t bytes = (size_t)sqlite3_column_bytes(c->chunk, 2);
        int64_t codec = sqlite3_column_int64(c->chunk, 0);
        if (!data || sqlite3_column_type(c->chunk, 2) != SQLITE_BLOB)
            status = prom_container_refuse(c, "chunk", id, "its data cannot be read", error);
        else if ((uint64_t)sqlite3_column_int64(c->chunk, 1) != prom_hash(data, bytes, 0))
            status = prom_container_refuse(c, "chunk", id,
                                           "its data do not match their checksum", error);
        else if (!prom_chunk_decode(stream, codec, data, bytes, out, count))
            status = prom_container_refuse(c, "chunk", id, "its data cannot be decoded", error);
    }
    if (c->chunk) sqlite3_reset(c->chunk);
    return status;
}

static prom_status decode_stream(prom_container *c, const prom_stream *stream, uint64_t first,
                                 void *out, prom_error *error)
{
    uint8_t *bytes = out;
    for (uint64_t i = 0; i < prom_stream_chunks(stream); i++) {
        uint64_t count = prom_stream_chunk_count(stream, i);
        prom_status status = decode_chunk(c, stream, first + i, bytes, count, error);
        if (status) return status;
        bytes += count * stream->stride;
    }
    return PROM_OK;
}

prom_status prom_container_decode_streams(prom_container *container, const prom_stream *streams,
                                          int count, uint64_t first_chunk, void *const *out,
                                          prom_error *error)
{
    for (int s = 0; s < count; s++) {
        prom_status status = decode_stream(container, &streams[s], first_chunk, out[s], error);
        if (status) return status;
        first_chunk += prom_stream_chunks(&streams[s]);
    }
    return PROM_OK;
}

static const char *check_positions(const prom_mesh *mesh)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (int a = 0; a < 3; a++)
            if (!(fabsf(mesh->vertices[v].position[a]) <= POSITION_MAX))
                return "a position is out of range";
    return NULL;
}

static prom_status wrong_id(prom_container *c, const char *table, uint32_t id,
                            prom_error *error)
{
    return prom_fail(error, PROM_ERR_INPUT, "%s: table %s has no row %u for this model",
                     c->path, table, id);
}

prom_status prom_container_read_mesh(prom_container *container, const prom_model *model,
                                     uint32_t id, prom_mesh *mesh, prom_error *error)
{
    *mesh = (prom_mesh){0};
    prom_container *c = container;
    if (id >= c->mesh_count || id >= model->mesh_count) return wrong_id(c, "mesh", id, error);
    const prom_mesh_info *info = &model->meshes[id];
    const prom_bulk_ref *ref = &c->meshes[id];
    prom_stream streams[PROM_MESH_STREAMS];
    prom_mesh_streams(info, streams);
    prom_status status = prom_container_check_streams(c, "mesh", id, streams, PROM_MESH_STREAMS,
                                                      ref->first_chunk, NULL, error);
    if (status) return status;
    prom_mesh_init(mesh, info->vertex_count, info->index_count, info->submesh_count);
    void *const out[PROM_MESH_STREAMS] = {mesh->vertices, mesh->indices, mesh->submeshes};
    status = prom_container_decode_streams(c, streams, PROM_MESH_STREAMS, ref->first_chunk, out,
                                           error);
    if (!status) {
        const char *wrong = prom_mesh_check(mesh, model->material_count);
        if (!wrong) wrong = check_positions(mesh);
        if (!wrong && prom_mesh_hash(mesh, 0) != ref->content_hash)
            wrong = "its content does not match its hash";
        if (wrong) status = prom_container_refuse(c, "mesh", id, wrong, error);
    }
    if (status) prom_mesh_finish(mesh);
    return status;
}

prom_status prom_container_read_texture(prom_container *container, const prom_model *model,
                                        uint32_t id, prom_texture *texture, prom_error *error)
{
    *texture = (prom_texture){0};
    prom_container *c = container;
    if (id >= c->texture_count || id >= model->texture_count)
        return wrong_id(c, "texture", id, error);
    const prom_texture_info *i = &model->textures[id];
    const prom_bulk_ref *ref = &c->textures[id];
    prom_texture t = {i->kind, i->width, i->height, i->layers, i->levels, NULL};
    size_t bytes = prom_texture_bytes(&t);
    if (!bytes)
        return prom_container_refuse(c, "texture", id, "its kind or size is out of range",
                                     error);
    prom_stream stream = prom_texture_stream(bytes);
    prom_status status = prom_container_check_streams(c, "texture", id, &stream, 1,
                                                      ref->first_chunk, NULL, error);
    if (status) return status;
    t.pixels = prom_alloc(bytes, 1);
    status = decode_stream(c, &stream, ref->first_chunk, t.pixels, error);
    if (!status && prom_texture_hash(&t, 0) != ref->content_hash)
        status = prom_container_refuse(c, "texture", id, "its content does not match its hash",
                                       error);
    if (status)
        prom_texture_finish(&t);
    else
        *texture = t;
    return status;
}

// Bulk data of the container: meshes and textures as compressed, checksummed chunks.
#include "metaobj/container_writer.h"

#include "metaobj/base/hash.h"

// Chosen by taste: what a kill may cost, against a commit for every small picture.
#define COMMIT_BYTES (32u << 20)

static prom_status commit_if_much(prom_writer *w, prom_error *error)
{
    if (w->uncommitted_bytes < COMMIT_BYTES) return PROM_OK;
    w->uncommitted_bytes = 0;
    return prom_writer_exec(w, "COMMIT; BEGIN", error);
}

static prom_status refuse_late(prom_writer *w, const char *what, prom_error *error)
{
    return prom_fail(error, PROM_ERR_OUTPUT, "%s: a %s was added after the model", w->path,
                     what);
}

prom_status prom_writer_add_stream(prom_writer *writer, const prom_stream *stream,
                                   const void *data, prom_error *error)
{
    prom_writer *w = writer;
    const uint8_t *bytes = data;
    for (uint64_t i = 0; i < prom_stream_chunks(stream); i++) {
        uint64_t count = prom_stream_chunk_count(stream, i);
        size_t raw = (size_t)count * stream->stride;
        prom_codec codec = prom_chunk_encode(stream, bytes, count, &w->encoded);
        const void *blob = codec == PROM_CODEC_RAW ? bytes : w->encoded.data;
        size_t blob_bytes = codec == PROM_CODEC_RAW ? raw : w->encoded.count;
        prom_row_out row = prom_row_begin(w, PROM_TABLE_CHUNK);
        prom_put_int(&row, codec);
        prom_put_int(&row, (int64_t)prom_hash(blob, blob_bytes, 0));
        prom_put_blob(&row, blob, blob_bytes);
        prom_status status = prom_row_end(&row, error);
        if (status) return status;
        bytes += raw;
        w->uncommitted_bytes += blob_bytes;
    }
    return PROM_OK;
}

static void note_materials(prom_writer *w, const prom_mesh *mesh)
{
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        uint32_t material = mesh->submeshes[s].material;
        if (material != PROM_NONE && material >= w->material_count)
            w->material_count = material + 1;
    }
}

prom_status prom_writer_add_mesh(prom_writer *writer, const prom_mesh *mesh, uint32_t *id,
                                 prom_error *error)
{
    if (prom_writer_ready(writer, error)) return PROM_ERR_OUTPUT;
    if (writer->has_model) return refuse_late(writer, "mesh", error);
    const char *wrong = prom_mesh_check(mesh, PROM_NONE);
    if (wrong)
        return prom_fail(error, PROM_ERR_OUTPUT, "%s: mesh %zu cannot be stored: %s",
                         writer->path, writer->meshes.count, wrong);
    uint64_t first_chunk = writer->rows[PROM_TABLE_CHUNK];
    prom_mesh_info info = {mesh->vertex_count, mesh->index_count, mesh->submesh_count};
    prom_stream streams[PROM_MESH_STREAMS];
    prom_mesh_streams(&info, streams);
    const void *data[PROM_MESH_STREAMS] = {mesh->vertices, mesh->indices, mesh->submeshes};
    prom_status status = PROM_OK;
    for (int s = 0; s < PROM_MESH_STREAMS && !status; s++)
        status = prom_writer_add_stream(writer, &streams[s], data[s], error);
    if (status) return status;
    prom_row_out row = prom_row_begin(writer, PROM_TABLE_MESH);
    prom_put_int(&row, info.vertex_count);
    prom_put_int(&row, info.index_count);
    prom_put_int(&row, info.submesh_count);
    prom_put_int(&row, (int64_t)prom_mesh_hash(mesh, 0));
    prom_put_int(&row, (int64_t)first_chunk);
    if ((status = prom_row_end(&row, error))) return status;
    note_materials(writer, mesh);
    if (id) *id = (uint32_t)writer->meshes.count;
    prom_array_push(&writer->meshes, info);
    return commit_if_much(writer, error);
}

prom_status prom_writer_add_texture(prom_writer *writer, const prom_texture *texture,
                                    uint32_t *id, prom_error *error)
{
    if (prom_writer_ready(writer, error)) return PROM_ERR_OUTPUT;
    if (writer->has_model) return refuse_late(writer, "texture", error);
    size_t bytes = prom_texture_bytes(texture);
    if (!bytes)
        return prom_fail(
            error, PROM_ERR_OUTPUT,
            "%s: texture %zu cannot be stored: kind %u, %u x %u texels, %u layers, "
            "%u levels are no texture",
            writer->path, writer->textures.count, texture->kind, texture->width,
            texture->height, texture->layers, texture->levels);
    uint64_t first_chunk = writer->rows[PROM_TABLE_CHUNK];
    prom_stream stream = prom_texture_stream(bytes);
    prom_status status = prom_writer_add_stream(writer, &stream, texture->pixels, error);
    if (status) return status;
    prom_row_out row = prom_row_begin(writer, PROM_TABLE_TEXTURE);
    prom_put_int(&row, texture->kind);
    prom_put_int(&row, texture->width);
    prom_put_int(&row, texture->height);
    prom_put_int(&row, texture->layers);
    prom_put_int(&row, texture->levels);
    prom_put_int(&row, (int64_t)prom_texture_hash(texture, 0));
    prom_put_int(&row, (int64_t)first_chunk);
    if ((status = prom_row_end(&row, error))) return status;
    if (id) *id = (uint32_t)writer->textures.count;
    prom_array_push(&writer->textures,
                    (prom_texture_info){texture->kind, texture->width, texture->height,
                                        texture->layers, texture->levels});
    return commit_if_much(writer, error);
}

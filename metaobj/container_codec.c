// Chunks of bulk data: meshoptimizer's codecs for vertices and indices, zstd for the rest.
#include "metaobj/container_schema.h"

#include <meshoptimizer.h>
#include <zstd.h>

// Chosen by measurement: level 3 costs little more than 1 and saves some 10 % on textures.
#define ZSTD_LEVEL 3

void prom_mesh_streams(const prom_mesh_info *info, prom_stream streams[PROM_MESH_STREAMS])
{
    streams[0] = (prom_stream){PROM_CODEC_VERTEX, sizeof(prom_vertex), info->vertex_count};
    streams[1] = (prom_stream){PROM_CODEC_INDEX, sizeof(uint32_t), info->index_count};
    streams[2] = (prom_stream){PROM_CODEC_ZSTD, sizeof(prom_submesh), info->submesh_count};
}

prom_stream prom_texture_stream(size_t bytes)
{
    return (prom_stream){PROM_CODEC_ZSTD, 1, bytes};
}

void prom_view_cell_streams(uint32_t entry_count, prom_stream streams[PROM_VIEW_CELL_STREAMS])
{
    streams[0] = (prom_stream){PROM_CODEC_ZSTD, sizeof(uint32_t), entry_count};
    streams[1] = (prom_stream){PROM_CODEC_ZSTD, sizeof(uint8_t), entry_count};
}

uint64_t prom_stream_chunk_elements(const prom_stream *stream)
{
    uint64_t elements = PROM_CONTAINER_CHUNK_BYTES / stream->stride;
    return stream->codec == PROM_CODEC_INDEX ? elements / 3 * 3 : elements;
}

uint64_t prom_stream_chunks(const prom_stream *stream)
{
    uint64_t each = prom_stream_chunk_elements(stream);
    return (stream->count + each - 1) / each;
}

uint64_t prom_stream_chunk_count(const prom_stream *stream, uint64_t i)
{
    uint64_t each = prom_stream_chunk_elements(stream), left = stream->count - i * each;
    return left < each ? left : each;
}

static size_t encode_vertices(const prom_stream *s, const void *data, size_t count,
                              prom_bytes *out)
{
    prom_array_reserve(out, meshopt_encodeVertexBufferBound(count, s->stride));
    return meshopt_encodeVertexBuffer(out->data, out->capacity, data, count, s->stride);
}

static size_t encode_indices(const uint32_t *data, size_t count, prom_bytes *out)
{
    if (count % 3) return 0;
    uint32_t largest = 0;
    for (size_t i = 0; i < count; i++)
        if (data[i] > largest) largest = data[i];
    prom_array_reserve(out, meshopt_encodeIndexBufferBound(count, (size_t)largest + 1));
    return meshopt_encodeIndexBuffer(out->data, out->capacity, data, count);
}

static size_t encode_zstd(const void *data, size_t bytes, prom_bytes *out)
{
    prom_array_reserve(out, ZSTD_compressBound(bytes));
    size_t n = ZSTD_compress(out->data, out->capacity, data, bytes, ZSTD_LEVEL);
    return ZSTD_isError(n) ? 0 : n;
}

prom_codec prom_chunk_encode(const prom_stream *stream, const void *data, uint64_t count,
                             prom_bytes *buffer)
{
    size_t raw = (size_t)count * stream->stride, n = 0;
    switch (stream->codec) {
    case PROM_CODEC_VERTEX:
        n = encode_vertices(stream, data, (size_t)count, buffer);
        break;
    case PROM_CODEC_INDEX:
        n = encode_indices(data, (size_t)count, buffer);
        break;
    case PROM_CODEC_ZSTD:
        n = encode_zstd(data, raw, buffer);
        break;
    case PROM_CODEC_RAW:
        break;
    }
    buffer->count = n;
    return n && n < raw ? stream->codec : PROM_CODEC_RAW;
}

bool prom_chunk_decode(const prom_stream *stream, int64_t codec, const void *bytes,
                       size_t byte_count, void *data, uint64_t count)
{
    size_t raw = (size_t)count * stream->stride;
    if (codec == PROM_CODEC_RAW) {
        if (byte_count != raw) return false;
        if (raw) memcpy(data, bytes, raw);
        return true;
    }
    if (codec != (int64_t)stream->codec) return false;
    switch (stream->codec) {
    case PROM_CODEC_VERTEX:
        return !meshopt_decodeVertexBuffer(data, (size_t)count, stream->stride, bytes,
                                           byte_count);
    case PROM_CODEC_INDEX:
        // The codec asserts whole triangles.
        return count % 3 == 0 && !meshopt_decodeIndexBuffer(
                                     data, (size_t)count, sizeof(uint32_t), bytes, byte_count);
    case PROM_CODEC_ZSTD:
        return ZSTD_decompress(data, raw, bytes, byte_count) == raw;
    case PROM_CODEC_RAW:
        break;
    }
    return false;
}

uint64_t prom_codec_least_bytes(int64_t codec, uint64_t raw_bytes)
{
    switch (codec) {
    case PROM_CODEC_RAW:
        return raw_bytes;
    // Two bits for 16 equal bytes.
    case PROM_CODEC_VERTEX:
        return raw_bytes / 64;
    // A byte for a triangle.
    case PROM_CODEC_INDEX:
        return raw_bytes / 12;
    // A block of at most 128 KiB has a header of three bytes.
    case PROM_CODEC_ZSTD:
        return raw_bytes / (128u << 10) * 3;
    default:
        return UINT64_MAX;
    }
}

// Private to the container: the schema, what writer and reader must agree on, and the codecs of
// the bulk data. docs/FORMAT.md describes the same for people.
#ifndef PROM_METAOBJ_CONTAINER_SCHEMA_H
#define PROM_METAOBJ_CONTAINER_SCHEMA_H

#include "metaobj/container.h"

#include <sqlite3.h>
#include <stddef.h>

// Keys of meta: how the accuracies were measured (prom_measured).
#define PROM_META_METRIC "accuracy.metric"
#define PROM_META_PPD "accuracy.ppd"
#define PROM_META_BACKGROUND_1 "accuracy.background_1"
#define PROM_META_BACKGROUND_2 "accuracy.background_2"
#define PROM_META_VETO_PERCENTILE "accuracy.veto_percentile"
#define PROM_META_VETO_ERROR "accuracy.veto_error"

typedef enum prom_table {
    PROM_TABLE_META,
    PROM_TABLE_NODE,
    PROM_TABLE_PROTOTYPE,
    PROM_TABLE_REPRESENTATION,
    PROM_TABLE_ACCURACY,
    PROM_TABLE_MESH,
    PROM_TABLE_TEXTURE,
    PROM_TABLE_MATERIAL,
    PROM_TABLE_COST_PROFILE,
    PROM_TABLE_STAGE,
    PROM_TABLE_VIEW_GRID, // no row, or one
    PROM_TABLE_VIEW_CELL,
    PROM_TABLE_ROWS, // the tables above count and hash their rows here
    PROM_TABLE_CHUNK,
    PROM_TABLE_COUNT,
    PROM_TABLE_HASHED = PROM_TABLE_ROWS // tables with an entry in it
} prom_table;

typedef struct prom_table_schema {
    const char *name;
    const char *create;  // exactly as SQLite keeps it; the reader takes no other
    const char *content; // the columns that count for the content hash; NULL: all
} prom_table_schema;

extern const prom_table_schema prom_tables[PROM_TABLE_COUNT];

// Hash of a row's values (types included), chained from `seed`.
uint64_t prom_row_hash(sqlite3_stmt *row, uint64_t seed);
// Bytes of a row's texts and blobs.
uint64_t prom_row_bytes(sqlite3_stmt *row);
// Counts and hashes all rows of a table in the order of their ids; `columns` NULL for all.
// Returns an SQLite result code: SQLITE_TOOBIG when texts and blobs have over `most_bytes`
// together, as rows that share their pages could claim.
int prom_table_hash(sqlite3 *db, prom_table table, const char *columns, uint64_t most_bytes,
                    uint64_t *rows, uint64_t *hash);
// A name for SQLite that it cannot take for ":memory:" or a URI; free it.
char *prom_sqlite_path(const char *path);

// ---- bulk data: a stream of elements, cut into chunks of a fixed number of elements

typedef enum prom_codec {
    PROM_CODEC_RAW = 0,
    PROM_CODEC_VERTEX = 1, // meshopt_encodeVertexBuffer
    PROM_CODEC_INDEX = 2,  // meshopt_encodeIndexBuffer
    PROM_CODEC_ZSTD = 3,
} prom_codec;

typedef struct prom_stream {
    prom_codec codec; // the preferred one; a chunk that it does not make smaller is stored raw
    uint32_t stride;  // bytes of an element
    uint64_t count;   // elements in all
} prom_stream;

// Streams of a mesh, in the order of their chunks: vertices, indices, submeshes.
#define PROM_MESH_STREAMS 3
void prom_mesh_streams(const prom_mesh_info *info, prom_stream streams[PROM_MESH_STREAMS]);
prom_stream prom_texture_stream(size_t bytes);
// Streams of all view cells together: leaves, shares. (Neighbours are so much alike that cell
// by cell would take 1.5 times the bytes: 500 cells of a plan with 2341 leaves.)
#define PROM_VIEW_CELL_STREAMS 2
void prom_view_cell_streams(uint32_t entry_count, prom_stream streams[PROM_VIEW_CELL_STREAMS]);

uint64_t prom_stream_chunk_elements(const prom_stream *stream);
uint64_t prom_stream_chunks(const prom_stream *stream);
// Elements of chunk i.
uint64_t prom_stream_chunk_count(const prom_stream *stream, uint64_t i);

// Encodes `count` elements; the result is in *buffer (grown as needed) or, for PROM_CODEC_RAW,
// is `data` itself.
typedef PROM_ARRAY(uint8_t) prom_bytes;
prom_codec prom_chunk_encode(const prom_stream *stream, const void *data, uint64_t count,
                             prom_bytes *buffer);
// Decodes into exactly `count` elements; false if the bytes are no such chunk.
bool prom_chunk_decode(const prom_stream *stream, int64_t codec, const void *bytes,
                       size_t byte_count, void *data, uint64_t count);
// The fewest bytes that a codec needs for that many bytes of data: more is a false claim.
uint64_t prom_codec_least_bytes(int64_t codec, uint64_t raw_bytes);

#endif

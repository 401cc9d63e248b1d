// A finished container, taken up again: copied under the writer's lock, from the very
// descriptor that the reader has checked.
#include "metaobj/container_reader.h"
#include "metaobj/container_writer.h"

#include <errno.h>
#include <unistd.h>

#define COPY_BYTES (1u << 20) // by taste

static void take_nothing(void *user, prom_row_in *row)
{
    (void)user, (void)row;
}

// What is written gets new hashes: damage must not get a right one.
static prom_status check_tables(prom_container *c, prom_error *error)
{
    prom_status status = PROM_OK;
    for (int t = 0; t < PROM_TABLE_HASHED && !status; t++)
        status = prom_container_scan(c, (prom_table)t, take_nothing, NULL, error);
    if (!status && !c->rows[PROM_TABLE_NODE])
        status = prom_container_refuse(c, prom_tables[PROM_TABLE_NODE].name, 0,
                                       "there is no model", error);
    return status;
}

static bool write_all(int fd, const uint8_t *bytes, size_t count)
{
    while (count) {
        ssize_t n = write(fd, bytes, count);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        bytes += n;
        count -= (size_t)n;
    }
    return true;
}

static prom_status copy_bytes(prom_writer *w, const prom_container *c, uint8_t *buffer,
                              prom_error *error)
{
    for (uint64_t at = 0; at < c->file_bytes;) {
        ssize_t n = pread(c->fd, buffer, COPY_BYTES, (off_t)at);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0)
            return prom_fail(error, PROM_ERR_INPUT, "cannot read %s: %s", c->path,
                             n ? strerror(errno) : "it was cut short meanwhile");
        if (!write_all(w->lock_fd, buffer, (size_t)n))
            return prom_writer_fail_errno(w, errno, error);
        at += (uint64_t)n;
    }
    return PROM_OK;
}

static prom_status copy_file(prom_writer *w, const prom_container *c, prom_error *error)
{
    uint8_t *buffer = prom_alloc(COPY_BYTES, 1);
    prom_status status = copy_bytes(w, c, buffer, error);
    prom_free(buffer);
    return status;
}

static prom_status take_over(prom_writer *w, const prom_container *c, prom_error *error)
{
    for (uint32_t i = 0; i < c->meta_count; i++)
        prom_writer_set_meta(w, c->meta[i][0], c->meta[i][1], error);
    for (int t = 0; t < PROM_TABLE_HASHED; t++) w->rows[t] = c->rows[t];
    w->rows[PROM_TABLE_META] = 0; // and table_rows: written anew at the end
    w->has_model = true;
    int64_t chunks;
    prom_status status = prom_writer_query(w, "SELECT max(id)+1 FROM chunk", 0, &chunks, error);
    w->rows[PROM_TABLE_CHUNK] = (uint64_t)chunks;
    return status ? status
                  : prom_writer_exec(w, "DELETE FROM meta; DELETE FROM table_rows", error);
}

static prom_status reopen(prom_writer *w, const char *path, prom_error *error)
{
    prom_container *c = prom_container_open(path, error);
    if (!c) return PROM_ERR_INPUT;
    prom_status status = check_tables(c, error);
    if (!status) status = copy_file(w, c, error);
    if (!status) status = prom_writer_open_database(w, error);
    if (!status) status = take_over(w, c, error);
    prom_container_close(c);
    return status;
}

prom_writer *prom_writer_reopen(const char *path, prom_error *error)
{
    // The lock first: then no other build can put a newer file at PATH meanwhile.
    prom_writer *w = prom_writer_start(path, error);
    if (w && !reopen(w, path, error)) return w;
    prom_writer_destroy(w);
    return NULL;
}

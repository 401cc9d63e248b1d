// View cells, written to the container after the model: the last of its chunks.
#include "metaobj/container_writer.h"

typedef PROM_ARRAY(uint32_t) counts;

// The tree as the file holds it, for the check: each node's number of children.
static prom_status read_tree(prom_writer *w, counts *children, prom_error *error)
{
    sqlite3_stmt *rows;
    const char *sql = "SELECT child_count FROM node WHERE background=0 ORDER BY id";
    if (sqlite3_prepare_v2(w->db, sql, -1, &rows, NULL) != SQLITE_OK)
        return prom_writer_fail(w, error);
    int rc;
    while ((rc = sqlite3_step(rows)) == SQLITE_ROW)
        prom_array_push(children, (uint32_t)sqlite3_column_int64(rows, 0));
    prom_status status = rc == SQLITE_DONE ? PROM_OK : prom_writer_fail(w, error);
    sqlite3_finalize(rows);
    return status;
}

static prom_status check(prom_writer *w, const prom_view_cells *cells, prom_error *error)
{
    counts children = {0};
    uint64_t cell;
    prom_status status = read_tree(w, &children, error);
    if (!status) {
        const prom_model tree = {.tree_count = (uint32_t)children.count,
                                 .child_count = children.data};
        const char *wrong = prom_view_cells_check(cells, &tree, &cell);
        if (wrong)
            status = prom_fail(error, PROM_ERR_OUTPUT,
                               "%s: the view cells cannot be stored: %s (cell %llu)", w->path,
                               wrong, (unsigned long long)cell);
    }
    prom_array_finish(&children);
    return status;
}

static prom_status drop(prom_writer *w, prom_error *error)
{
    int64_t first;
    prom_status status = prom_writer_query(w, "SELECT first_chunk FROM view_grid",
                                           (int64_t)w->rows[PROM_TABLE_CHUNK], &first, error);
    if (status) return status;
    char *sql = prom_format("DELETE FROM chunk WHERE id>=%lld; DELETE FROM view_grid;"
                            "DELETE FROM view_cell",
                            (long long)first);
    status = prom_writer_exec(w, sql, error);
    prom_free(sql);
    w->rows[PROM_TABLE_CHUNK] = (uint64_t)first;
    w->rows[PROM_TABLE_VIEW_GRID] = w->rows[PROM_TABLE_VIEW_CELL] = 0;
    return status;
}

static prom_status put_grid(prom_writer *w, const prom_view_cells *cells, prom_error *error)
{
    uint64_t first_chunk = w->rows[PROM_TABLE_CHUNK];
    prom_stream streams[PROM_VIEW_CELL_STREAMS];
    prom_view_cell_streams(cells->entry_count, streams);
    const void *data[PROM_VIEW_CELL_STREAMS] = {cells->leaves, cells->shares};
    for (int s = 0; s < PROM_VIEW_CELL_STREAMS; s++) {
        prom_status status = prom_writer_add_stream(w, &streams[s], data[s], error);
        if (status) return status;
    }
    prom_row_out row = prom_row_begin(w, PROM_TABLE_VIEW_GRID);
    for (int a = 0; a < 3; a++) prom_put_real(&row, cells->origin[a]);
    prom_put_real(&row, cells->size);
    prom_put_int(&row, (int64_t)prom_view_cells_hash(cells, 0));
    prom_put_int(&row, (int64_t)first_chunk);
    return prom_row_end(&row, error);
}

static prom_status put_cells(prom_writer *w, const prom_view_cells *cells, prom_error *error)
{
    for (uint32_t i = 0; i < cells->cell_count; i++) {
        prom_row_out row = prom_row_begin(w, PROM_TABLE_VIEW_CELL);
        for (int a = 0; a < 3; a++) prom_put_int(&row, cells->cells[i].at[a]);
        prom_put_int(&row, cells->cells[i].count);
        prom_status status = prom_row_end(&row, error);
        if (status) return status;
    }
    return PROM_OK;
}

prom_status prom_writer_put_view_cells(prom_writer *writer, const prom_view_cells *cells,
                                       prom_error *error)
{
    if (prom_writer_ready(writer, error)) return PROM_ERR_OUTPUT;
    if (!writer->has_model)
        return prom_fail(error, PROM_ERR_OUTPUT,
                         "%s: view cells cannot be stored: there is no model yet",
                         writer->path);
    prom_status status = check(writer, cells, error);
    if (status) return status;
    status = drop(writer, error);
    if (!status && cells->cell_count) {
        status = put_grid(writer, cells, error);
        if (!status) status = put_cells(writer, cells, error);
    }
    if (!status) status = prom_writer_exec(writer, "COMMIT; BEGIN", error);
    if (status) writer->broken = true; // rows of some of the cells
    return status;
}

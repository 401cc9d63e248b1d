// View cells from the container: the cubes by rows, what they show as bulk data.
#include "metaobj/container_reader.h"

typedef struct cell_reader {
    prom_view_cells *cells;
    prom_bulk_ref bulk;
} cell_reader;

static void take_grid(void *user, prom_row_in *row)
{
    cell_reader *r = user;
    prom_take_reals(row, r->cells->origin, 3);
    r->cells->size = prom_take_real(row);
    r->bulk.content_hash = (uint64_t)prom_take_int(row, INT64_MIN, INT64_MAX);
    r->bulk.first_chunk = (uint64_t)prom_take_int(row, 0, INT64_MAX / 2);
}

static void take_cell(void *user, prom_row_in *row)
{
    prom_view_cells *cells = ((cell_reader *)user)->cells;
    prom_view_cell *cell = &cells->cells[row->id];
    for (int a = 0; a < 3; a++) cell->at[a] = (int32_t)prom_take_int(row, INT32_MIN, INT32_MAX);
    cell->first = cells->entry_count;
    cell->count = prom_take_u32(row);
    if (cell->count > UINT32_MAX - cells->entry_count)
        prom_row_refuse(row, "the cells have too many leaves");
    else
        cells->entry_count += cell->count;
}

static prom_status read_rows(cell_reader *r, prom_container *c, prom_error *error)
{
    const char *grid = prom_tables[PROM_TABLE_VIEW_GRID].name;
    uint64_t grids = c->rows[PROM_TABLE_VIEW_GRID], cells = c->rows[PROM_TABLE_VIEW_CELL];
    if (grids != (cells > 0))
        return prom_container_refuse(c, grid, 0, "it does not go with the cells", error);
    prom_status status = prom_container_scan(c, PROM_TABLE_VIEW_GRID, take_grid, r, error);
    if (status) return status;
    r->cells->cell_count = (uint32_t)cells;
    r->cells->cells = prom_alloc(cells, sizeof *r->cells->cells);
    return prom_container_scan(c, PROM_TABLE_VIEW_CELL, take_cell, r, error);
}

static prom_status read_entries(cell_reader *r, prom_container *c, prom_error *error)
{
    const char *grid = prom_tables[PROM_TABLE_VIEW_GRID].name;
    prom_view_cells *cells = r->cells;
    prom_stream streams[PROM_VIEW_CELL_STREAMS];
    prom_view_cell_streams(cells->entry_count, streams);
    prom_status status =
        prom_container_check_streams(c, grid, 0, streams, PROM_VIEW_CELL_STREAMS,
                                     r->bulk.first_chunk, &c->view_cell_bytes, error);
    if (status) return status;
    cells->leaves = prom_alloc(cells->entry_count, sizeof *cells->leaves);
    cells->shares = prom_alloc(cells->entry_count, sizeof *cells->shares);
    void *const out[PROM_VIEW_CELL_STREAMS] = {cells->leaves, cells->shares};
    return prom_container_decode_streams(c, streams, PROM_VIEW_CELL_STREAMS,
                                         r->bulk.first_chunk, out, error);
}

static prom_status check(const cell_reader *r, prom_container *c, const prom_model *model,
                         prom_error *error)
{
    uint64_t cell;
    const char *wrong = prom_view_cells_check(r->cells, model, &cell);
    if (wrong)
        return prom_container_refuse(c, prom_tables[PROM_TABLE_VIEW_CELL].name, cell, wrong,
                                     error);
    if (prom_view_cells_hash(r->cells, 0) != r->bulk.content_hash)
        return prom_container_refuse(c, prom_tables[PROM_TABLE_VIEW_GRID].name, 0,
                                     "the cells do not match their hash", error);
    return PROM_OK;
}

prom_status prom_container_read_view_cells(prom_container *container, const prom_model *model,
                                           prom_view_cells *cells, prom_error *error)
{
    *cells = (prom_view_cells){0};
    cell_reader reader = {.cells = cells};
    container->view_cell_bytes = 0;
    prom_status status = read_rows(&reader, container, error);
    if (!status && cells->cell_count) {
        status = read_entries(&reader, container, error);
        if (!status) status = check(&reader, container, model, error);
    }
    if (status || !cells->cell_count) prom_view_cells_finish(cells);
    return status;
}

uint64_t prom_container_view_cell_bytes(prom_container *container)
{
    return container->view_cell_bytes;
}

#include "builder/cell_view.h"

// Codes between a share and half of it: see prom_view_share_decode.
#define HALF 16

static void set_count(prom_cell_view *v, uint32_t count)
{
    v->count = count;
    v->leaves = prom_alloc(count, sizeof *v->leaves);
    v->codes = prom_alloc(count, 1);
}

static bool is_leaf(const prom_model *model, uint32_t node)
{
    return node < model->tree_count && !model->child_count[node];
}

void prom_cell_view_set(prom_cell_view *view, const prom_model *model, const float *shares)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < model->tree_count; n++)
        count += is_leaf(model, n) && shares[n] > 0;
    set_count(view, count);
    count = 0;
    for (uint32_t n = 0; n < model->tree_count; n++) {
        if (!is_leaf(model, n) || !(shares[n] > 0)) continue;
        view->leaves[count] = n;
        view->codes[count++] = prom_view_share_encode((double)shares[n]);
    }
}

void prom_cell_view_finish(prom_cell_view *view)
{
    prom_free(view->leaves);
    prom_free(view->codes);
    *view = (prom_cell_view){0};
}

void prom_cell_view_pack(const prom_cell_view *view, prom_pack *pack)
{
    prom_pack_bytes(pack, &view->count, sizeof view->count);
    prom_pack_bytes(pack, view->leaves, view->count * sizeof *view->leaves);
    prom_pack_bytes(pack, view->codes, view->count);
}

bool prom_cell_view_unpack(prom_cell_view *view, const prom_model *model, const prom_pack *pack)
{
    prom_unpack unpack = {pack->data, pack->count, false};
    set_count(view, prom_unpack_u32(&unpack, model->tree_count));
    prom_unpack_bytes(&unpack, view->leaves, view->count * sizeof *view->leaves);
    prom_unpack_bytes(&unpack, view->codes, view->count);
    bool good = prom_unpack_end(&unpack);
    for (uint32_t i = 0; i < view->count && good; i++)
        good = is_leaf(model, view->leaves[i]) && (!i || view->leaves[i - 1] < view->leaves[i]);
    if (!good) prom_cell_view_finish(view);
    return good;
}

// ---- all cells

// codes: per node 1 + the code of its share, 0 for nothing.
static void add_view(const prom_cell_view *v, int less, uint16_t *codes)
{
    for (uint32_t i = 0; i < v->count; i++) {
        int code = v->codes[i] > less ? v->codes[i] - less : 0;
        if (codes[v->leaves[i]] < code + 1) codes[v->leaves[i]] = (uint16_t)(code + 1);
    }
}

// What a cell shows, and half of what those around it do: an eye near the border may see it.
static void dilate(const prom_cell_view *views, const prom_view_cells *cells, uint32_t cell,
                   uint16_t *codes)
{
    const int32_t *center = cells->cells[cell].at;
    add_view(&views[cell], 0, codes);
    for (int i = 0; i < 27; i++) {
        const int32_t at[3] = {center[0] + i % 3 - 1, center[1] + i / 3 % 3 - 1,
                               center[2] + i / 9 - 1};
        const prom_view_cell *other = i != 13 ? prom_view_cells_find(cells, at) : NULL;
        if (other) add_view(&views[other - cells->cells], HALF, codes);
    }
}

void prom_cell_views_join(const prom_cell_view *views, const prom_eye_cells *cells,
                          const prom_model *model, prom_view_cells *joined)
{
    const uint32_t tree_count = model->tree_count;
    PROM_ARRAY(uint32_t) leaves = {0};
    PROM_ARRAY(uint8_t) shares = {0};
    uint16_t *codes = prom_alloc(tree_count, sizeof *codes);
    *joined = cells->grid;
    joined->cell_count = (uint32_t)cells->cells.count;
    joined->cells = prom_calloc(joined->cell_count, sizeof *joined->cells);
    for (uint32_t c = 0; c < joined->cell_count; c++)
        memcpy(joined->cells[c].at, cells->cells.data[c].at, sizeof joined->cells[c].at);
    for (uint32_t c = 0; c < joined->cell_count; c++) {
        prom_view_cell *made = &joined->cells[c];
        made->first = (uint32_t)leaves.count;
        memset(codes, 0, tree_count * sizeof *codes);
        dilate(views, joined, c, codes);
        for (uint32_t n = 0; n < tree_count; n++) {
            if (!codes[n]) continue;
            prom_array_push(&leaves, n);
            prom_array_push(&shares, (uint8_t)(codes[n] - 1));
        }
        made->count = (uint32_t)leaves.count - made->first;
    }
    prom_free(codes);
    joined->entry_count = (uint32_t)leaves.count;
    joined->leaves = leaves.data;
    joined->shares = shares.data;
}

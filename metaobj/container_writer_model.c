// The tree and its tables, written to the container.
#include "metaobj/container_writer.h"

#include <assert.h>
#include <stdio.h>

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "blobs are little-endian");

static prom_status put_nodes(prom_writer *w, const prom_model *m, prom_error *error)
{
    for (uint32_t n = 0; n < m->node_count; n++) {
        prom_row_out row = prom_row_begin(w, PROM_TABLE_NODE);
        prom_put_index(&row, m->parent[n]);
        prom_put_index(&row, m->first_child[n]);
        prom_put_int(&row, m->child_count[n]);
        prom_put_int(&row, m->prototype[n]);
        prom_put_int(&row, n >= m->tree_count);
        prom_put_text(&row, m->names + m->name[n]);
        for (int a = 0; a < 3; a++) prom_put_real(&row, m->placement[n].origin[a]);
        prom_put_floats(&row, m->placement[n].basis, 9);
        for (int a = 0; a < 3; a++) prom_put_real(&row, m->center[n][a]);
        prom_put_floats(&row, m->half[n], 3);
        prom_put_real(&row, m->radius[n]);
        prom_put_real(&row, m->weight[n]);
        prom_status status = prom_row_end(&row, error);
        if (status) return status;
    }
    return PROM_OK;
}

static prom_status put_prototypes(prom_writer *w, const prom_model *m, prom_error *error)
{
    for (uint32_t i = 0; i < m->prototype_count; i++) {
        const prom_prototype *p = &m->prototypes[i];
        uint64_t share_bytes = (uint64_t)p->child_count * sizeof *m->shares;
        if (share_bytes > PROM_CONTAINER_CHUNK_BYTES)
            return prom_fail(error, PROM_ERR_OUTPUT,
                             "%s: prototype %u has %u children, more than a row can hold; "
                             "allow fewer children of a node",
                             w->path, i, p->child_count);
        prom_row_out row = prom_row_begin(w, PROM_TABLE_PROTOTYPE);
        prom_put_int(&row, p->flags);
        prom_put_int(&row, p->child_count);
        prom_put_floats(&row, p->center, 3);
        prom_put_floats(&row, p->half, 3);
        prom_put_real(&row, p->radius);
        prom_put_int(&row, (int64_t)p->triangles);
        prom_put_blob(&row, m->coverage[i], sizeof *m->coverage);
        prom_put_blob(&row, share_bytes ? m->shares[p->first_share] : NULL, share_bytes);
        prom_status status = prom_row_end(&row, error);
        if (status) return status;
    }
    return PROM_OK;
}

static prom_status put_rep(prom_writer *w, const prom_representation *r, uint32_t owner,
                           prom_error *error)
{
    prom_row_out row = prom_row_begin(w, PROM_TABLE_REPRESENTATION);
    prom_put_int(&row, owner);
    prom_put_int(&row, r->kind);
    prom_put_int(&row, r->mesh);
    prom_put_index(&row, r->texture);
    prom_put_int(&row, r->flags);
    prom_put_int(&row, r->shading);
    prom_put_int(&row, r->level);
    prom_put_real(&row, r->error);
    prom_put_limit(&row, r->max_size_px);
    prom_put_real(&row, r->near_k);
    prom_put_limit(&row, r->switch_distance);
    prom_put_int(&row, r->draws);
    prom_put_int(&row, r->vertices);
    prom_put_int(&row, r->triangles);
    prom_put_real(&row, r->layers);
    return prom_row_end(&row, error);
}

static prom_status put_reps(prom_writer *w, const prom_model *m, prom_error *error)
{
    uint32_t *owner = prom_alloc(m->rep_count, sizeof *owner);
    for (uint32_t p = 0; p < m->prototype_count; p++)
        for (uint32_t k = 0; k < m->prototypes[p].rep_count; k++)
            owner[m->prototypes[p].first_rep + k] = p;
    prom_status status = PROM_OK;
    for (uint32_t r = 0; r < m->rep_count && !status; r++) {
        status = put_rep(w, &m->reps[r], owner[r], error);
        if (status) break;
        prom_row_out row = prom_row_begin(w, PROM_TABLE_ACCURACY);
        prom_put_blob(&row, &m->accuracy[r], sizeof *m->accuracy);
        status = prom_row_end(&row, error);
    }
    prom_free(owner);
    return status;
}

static prom_status put_materials(prom_writer *w, const prom_model *m, prom_error *error)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        const prom_material *material = &m->materials[i];
        prom_row_out row = prom_row_begin(w, PROM_TABLE_MATERIAL);
        prom_put_floats(&row, material->base_color, 4);
        prom_put_index(&row, material->texture);
        prom_put_int(&row, material->alpha_mode);
        prom_put_real(&row, material->alpha_cutoff);
        prom_put_int(&row, material->double_sided);
        prom_status status = prom_row_end(&row, error);
        if (status) return status;
    }
    return PROM_OK;
}

static prom_status put_measured(prom_writer *w, const prom_measured *m, prom_error *error)
{
    const struct {
        const char *key;
        float value;
    } numbers[] = {
        {PROM_META_PPD, m->ppd},
        {PROM_META_BACKGROUND_1, m->background[0]},
        {PROM_META_BACKGROUND_2, m->background[1]},
        {PROM_META_VETO_PERCENTILE, m->veto_percentile},
        {PROM_META_VETO_ERROR, m->veto_error},
    };
    prom_status status = prom_writer_set_meta(w, PROM_META_METRIC, m->metric, error);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers && !status; i++) {
        char text[32];
        snprintf(text, sizeof text, "%.9g", (double)numbers[i].value);
        status = prom_writer_set_meta(w, numbers[i].key, text, error);
    }
    return status;
}

// The model must speak of exactly the meshes and textures that were added.
static const char *check_bulk(const prom_writer *w, const prom_model *m)
{
    if (m->mesh_count != w->meshes.count) return "it has not the meshes that were added";
    if (m->texture_count != w->textures.count) return "it has not the textures that were added";
    if (m->mesh_count && memcmp(m->meshes, w->meshes.data, m->mesh_count * sizeof *m->meshes))
        return "a mesh's counts are not those of the mesh that was added";
    if (m->texture_count &&
        memcmp(m->textures, w->textures.data, m->texture_count * sizeof *m->textures))
        return "a texture's sizes are not those of the texture that was added";
    if (m->material_count < w->material_count) return "a mesh names a material that it lacks";
    return NULL;
}

prom_status prom_writer_put_model(prom_writer *writer, const prom_model *model,
                                  prom_error *error)
{
    uint64_t row = 0;
    if (prom_writer_ready(writer, error)) return PROM_ERR_OUTPUT;
    const char *wrong = prom_model_check(model, &row);
    if (wrong)
        return prom_fail(error, PROM_ERR_OUTPUT,
                         "%s: the model cannot be stored: %s (row %llu)", writer->path, wrong,
                         (unsigned long long)row);
    wrong = writer->has_model ? "there is one already" : check_bulk(writer, model);
    if (wrong)
        return prom_fail(error, PROM_ERR_OUTPUT, "%s: the model cannot be stored: %s",
                         writer->path, wrong);
    prom_status status = put_nodes(writer, model, error);
    if (!status) status = put_prototypes(writer, model, error);
    if (!status) status = put_reps(writer, model, error);
    if (!status) status = put_materials(writer, model, error);
    if (!status) status = put_measured(writer, &model->measured, error);
    if (!status) status = prom_writer_exec(writer, "COMMIT; BEGIN", error);
    if (status)
        writer->broken = true; // rows of half a model
    else
        writer->has_model = true;
    return status;
}

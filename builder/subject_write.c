// A settled subject into the model: what is kept of its candidates, from fine to cheap.
#include "builder/subject.h"

// A picture as what it is in the model: a box's texture, or an atlas, with its material.
static prom_status write_picture(prom_build_state *b, prom_candidate *c, prom_mesh *mesh,
                                 prom_submesh *submesh, prom_error *error)
{
    uint32_t texture;
    prom_status status = prom_build_write_texture(b, c->picture, &texture, error);
    if (status) return status;
    if (!prom_candidate_has_atlas(c)) {
        c->rep.texture = texture;
        return PROM_OK;
    }
    size_t material = b->source.materials.count + b->atlas_materials.count;
    prom_array_push(&b->atlas_materials, prom_atlas_material(&c->rep, texture));
    *mesh = prom_mesh_with_material(c->mesh, (uint32_t)material, submesh);
    return PROM_OK;
}

static prom_status write_candidate(prom_subject *s, prom_candidate *c, prom_error *error)
{
    prom_build_state *b = s->build;
    if (!c->kept) {
        if (!c->outdone) b->gap_meshes++;
        return PROM_OK;
    }
    prom_mesh mesh = *c->mesh;
    prom_submesh submesh;
    prom_status status = PROM_OK;
    if (c->picture) status = write_picture(b, c, &mesh, &submesh, error);
    if (!status) status = prom_writer_add_mesh(b->writer, &mesh, &c->rep.mesh, error);
    if (status) return status;
    prom_array_push(
        &b->mesh_infos,
        (prom_mesh_info){c->mesh->vertex_count, c->mesh->index_count, c->mesh->submesh_count});
    prom_prototype *proto = &b->prototypes[s->prototype];
    if (proto->rep_count == 0) proto->first_rep = (uint32_t)b->reps.count;
    proto->rep_count++;
    prom_array_push(&b->reps, c->rep);
    prom_array_push(&b->accuracy, c->result.accuracy);
    return PROM_OK;
}

// What is kept of a level with an atlas.
static prom_candidate *with_atlas_at(prom_subject *s, uint32_t level)
{
    for (uint32_t i = s->first_made; i < s->count; i++) {
        prom_candidate *c = &s->candidates[i];
        if (prom_candidate_has_atlas(c) && c->rep.level == level && c->kept) return c;
    }
    return NULL;
}

prom_status prom_subject_write(prom_subject *s, prom_error *error)
{
    prom_build_state *b = s->build;
    prom_prototype *proto = &b->prototypes[s->prototype];
    memcpy(b->coverage[s->prototype], s->coverage, sizeof s->coverage);
    proto->first_share = PROM_NONE;
    if (s->child_count) {
        proto->first_share = (uint32_t)b->shares.count;
        proto->child_count = s->child_count;
        struct prom_share_row *rows = prom_array_extend(&b->shares, s->child_count);
        memcpy(rows, s->shares, s->child_count * sizeof *rows);
    }
    prom_status status = PROM_OK;
    for (uint32_t i = 0; i < s->count && !status; i++) {
        prom_candidate *c = &s->candidates[i];
        if (prom_candidate_has_atlas(c)) continue; // written where its level stands
        prom_candidate *instead = NULL;
        if (!c->kept && c->rep.kind == PROM_REP_MESH) instead = with_atlas_at(s, c->rep.level);
        status = write_candidate(s, instead ? instead : c, error);
    }
    return status;
}

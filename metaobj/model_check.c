// What a model must hold before anybody walks it. Everything that follows an index or trusts a
// count rests on these checks, so they repeat no trust in where the model came from.
#include "metaobj/model.h"

#include "metaobj/texture.h"

// Squares of lengths up to this are finite floats, and sums and differences of places finite
// doubles, so that who computes with a model meets no infinities. (By taste.)
#define LENGTH_MAX 1e18
// Choices of a prototype: the walk's memory is one for each, at every node that is drawn with
// it, so that a small file could ask for any amount. Builds make a dozen. (By taste.)
#define REPS_MAX 256

static bool good_lengths(const float *v, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!((double)fabsf(v[i]) <= LENGTH_MAX)) return false;
    return true;
}

static bool good_place(const double v[3])
{
    return fabs(v[0]) <= LENGTH_MAX && fabs(v[1]) <= LENGTH_MAX && fabs(v[2]) <= LENGTH_MAX;
}

static bool finite_floats(const float *v, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(v[i])) return false;
    return true;
}

static bool good_bounds(const float half[3], float radius)
{
    return half[0] >= 0 && half[1] >= 0 && half[2] >= 0 && radius >= 0 &&
           good_lengths(half, 3) && good_lengths(&radius, 1);
}

static const char *check_arrays(const prom_model *m)
{
    if (!m->tree_count || m->tree_count > m->node_count)
        return "the tree has no root or more nodes than there are";
    if (!m->parent || !m->first_child || !m->child_count || !m->prototype || !m->name ||
        !m->placement || !m->center || !m->half || !m->radius || !m->weight)
        return "a node array is missing";
    if (m->prototype_count && (!m->prototypes || !m->coverage))
        return "a prototype array is missing";
    if (m->rep_count && (!m->reps || !m->accuracy)) return "a representation array is missing";
    if ((m->share_count && !m->shares) || (m->material_count && !m->materials) ||
        (m->mesh_count && !m->meshes) || (m->texture_count && !m->textures))
        return "an array is missing";
    if (!m->names || !m->names_bytes || m->names[0] || m->names[m->names_bytes - 1])
        return "the names do not start with the empty name or do not end with a zero";
    return NULL;
}

static bool is_share(float v)
{
    return v >= 0 && v <= 1;
}

static const char *check_measured(const prom_measured *m)
{
    if (!m->metric[0] || !memchr(m->metric, 0, sizeof m->metric))
        return "it is not said by which metric the accuracies were measured";
    if (!(m->ppd >= PROM_PPD_MIN && m->ppd <= PROM_PPD_MAX))
        return "the pixels per degree of the accuracies are out of range";
    if (!is_share(m->background[0]) || !is_share(m->background[1]) ||
        !is_share(m->veto_percentile) || !is_share(m->veto_error))
        return "how the accuracies were measured is not said";
    return NULL;
}

static const char *check_texture(const prom_texture_info *t)
{
    prom_texture whole = {t->kind, t->width, t->height, t->layers, t->levels, NULL};
    return prom_texture_bytes(&whole) ? NULL : "a texture's kind or size is out of range";
}

static const char *check_material(const prom_model *m, const prom_material *material)
{
    if (!finite_floats(material->base_color, 4) || !isfinite(material->alpha_cutoff))
        return "a material holds a number that is not finite";
    if (material->alpha_mode > PROM_ALPHA_BLEND || material->double_sided > 1)
        return "a material's alpha mode or sidedness is out of range";
    if (material->texture == PROM_NONE) return NULL;
    if (material->texture >= m->texture_count) return "a material's texture is out of range";
    if (m->textures[material->texture].kind != PROM_TEXTURE_COLOR)
        return "a material's texture is no colour texture";
    return NULL;
}

// What the renderer would take for pictures must be some, of the kind that the light asks for.
static const char *check_pictures(const prom_model *m, const prom_representation *r)
{
    if (r->texture != PROM_NONE && r->texture >= m->texture_count)
        return "a representation's texture is out of range";
    if (r->kind != PROM_REP_TEXTURED_BOX)
        return r->texture == PROM_NONE ? NULL : "a mesh or an average-colour box has pictures";
    if (r->texture == PROM_NONE) return "a textured box has no texture";
    uint32_t kind = m->textures[r->texture].kind;
    if (kind == PROM_TEXTURE_COLOR) return "a textured box has no impostor texture";
    bool unlit = r->flags & PROM_REP_UNLIT;
    if (unlit != (kind == PROM_TEXTURE_IMPOSTOR_LIT))
        return "a textured box's pictures hold the light and its flags say no, or the reverse";
    return NULL;
}

static const char *check_rep(const prom_model *m, const prom_representation *r)
{
    if (r->kind >= PROM_REP_KIND_COUNT) return "a representation's kind is unknown";
    if (r->shading >= PROM_SHADE_COUNT) return "a representation's shading is unknown";
    if (r->mesh >= m->mesh_count) return "a representation's mesh is out of range";
    const char *wrong = check_pictures(m, r);
    if (wrong) return wrong;
    if (!(r->error >= 0) || !good_lengths(&r->error, 1))
        return "a representation's error is no length";
    if (!(r->max_size_px > 0)) return "a representation's largest size is not above 0";
    if (!(r->switch_distance > 0)) return "a representation's switch_distance is not above 0";
    if (!(r->near_k >= 0) || !isfinite(r->near_k))
        return "a representation's near_k is not at least 0";
    if (!(r->layers >= 1) || !isfinite(r->layers))
        return "a representation's layers are not at least 1";
    return NULL;
}

// The finest mesh, which serves where nothing else is valid.
static bool has_mesh(const prom_model *m, const prom_prototype *p)
{
    if (!p->rep_count) return false;
    const prom_representation *finest = &m->reps[p->first_rep];
    return finest->kind == PROM_REP_MESH && isinf(finest->max_size_px);
}

static const char *check_prototype(const prom_model *m, const prom_prototype *p, uint8_t *owned)
{
    if (p->first_rep > m->rep_count || p->rep_count > m->rep_count - p->first_rep)
        return "a prototype's representations are out of range";
    for (uint32_t r = 0; r < p->rep_count; r++)
        if (owned[p->first_rep + r]++) return "a representation belongs to two prototypes";
    if (p->rep_count > REPS_MAX) return "a prototype has too many representations";
    if (!good_lengths(p->center, 3) || !good_bounds(p->half, p->radius))
        return "a prototype's bounds are out of range or negative";
    if (!(p->flags & PROM_PROTO_CLUSTER) != !p->child_count)
        return "a prototype's cluster flag does not fit its child count";
    if (!p->child_count) {
        if (p->first_share != PROM_NONE) return "a leaf prototype has shares";
        return has_mesh(m, p) ? NULL : "a leaf prototype has no mesh";
    }
    if (p->first_share > m->share_count || p->child_count > m->share_count - p->first_share)
        return "a prototype's shares are out of range";
    return NULL;
}

// `next_child` is where a breadth-first order puts the next children.
static const char *check_links(const prom_model *m, uint32_t n, uint32_t *next_child)
{
    uint32_t parent = m->parent[n], count = m->child_count[n];
    if (n == 0 || n >= m->tree_count) {
        if (parent != PROM_NONE) return "the root or a background node has a parent";
    } else if (parent >= n || n < m->first_child[parent] ||
               n - m->first_child[parent] >= m->child_count[parent]) {
        return "a node is not among its parent's children";
    }
    if (!count) return m->first_child[n] == PROM_NONE ? NULL : "a leaf has a first child";
    if (n >= m->tree_count) return "a background node has children";
    if (m->first_child[n] != *next_child) return "nodes are not in breadth-first order";
    if (count > m->tree_count - *next_child) return "a node's children are out of range";
    *next_child += count;
    return NULL;
}

static const char *check_node(const prom_model *m, uint32_t n, uint32_t *next_child)
{
    const char *wrong = check_links(m, n, next_child);
    if (wrong) return wrong;
    if (m->prototype[n] >= m->prototype_count) return "a node's prototype is out of range";
    if (m->prototypes[m->prototype[n]].child_count != m->child_count[n])
        return "a node has not as many children as its prototype";
    if (m->name[n] >= m->names_bytes) return "a node's name is out of range";
    if (!good_place(m->placement[n].origin) || !good_lengths(m->placement[n].basis, 9))
        return "a node's placement is out of range";
    if (!good_place(m->center[n]) || !good_bounds(m->half[n], m->radius[n]))
        return "a node's bounds are out of range or negative";
    if (!(m->weight[n] >= 0 && m->weight[n] <= PROM_WEIGHT_MAX))
        return "a node's weight is out of range";
    return NULL;
}

static const char *check_prototypes(const prom_model *m, uint64_t *row)
{
    const char *wrong = NULL;
    uint8_t *owned = prom_calloc(m->rep_count, 1);
    for (*row = 0; *row < m->prototype_count; ++*row)
        if ((wrong = check_prototype(m, &m->prototypes[*row], owned))) goto done;
    for (*row = 0; *row < m->rep_count; ++*row)
        if (!owned[*row]) {
            wrong = "a representation belongs to no prototype";
            goto done;
        }
done:
    prom_free(owned);
    return wrong;
}

const char *prom_model_check(const prom_model *model, uint64_t *row)
{
    const prom_model *m = model;
    uint64_t unused;
    if (!row) row = &unused;
    *row = 0;
    const char *wrong = check_arrays(m);
    if (!wrong) wrong = check_measured(&m->measured);
    if (wrong) return wrong;
    for (*row = 0; *row < m->mesh_count; ++*row)
        if (m->meshes[*row].index_count % 3) return "a mesh's index count is no multiple of 3";
    for (*row = 0; *row < m->texture_count; ++*row)
        if ((wrong = check_texture(&m->textures[*row]))) return wrong;
    for (*row = 0; *row < m->material_count; ++*row)
        if ((wrong = check_material(m, &m->materials[*row]))) return wrong;
    for (*row = 0; *row < m->rep_count; ++*row)
        if ((wrong = check_rep(m, &m->reps[*row]))) return wrong;
    if ((wrong = check_prototypes(m, row))) return wrong;
    uint32_t next_child = 1;
    for (*row = 0; *row < m->node_count; ++*row)
        if ((wrong = check_node(m, (uint32_t)*row, &next_child))) return wrong;
    *row = 0;
    if (next_child != m->tree_count) return "a node of the tree has no parent";
    return NULL;
}

// What the measurements make of the candidates.
#include "builder/subject.h"

#include "benefit/accuracy.h"

// A mesh with gaps may be shown up to the size at which they cover this many pixels: few enough
// that all of a frame's gaps stay under half a percent of it (by taste, then seen on the
// scenes).
#define GAPS_SHOWN_PX 64.0f
// One whose gaps allow less than this is of no use.
#define LEAST_SIZE_PX 16.0f
// More than this is a speck that is hardly seen.
#define MOST_LAYERS 64.0

// By taste: so much more accurate, in the mean over its bins, a mesh with an atlas must be than
// one without; and a level than the next, at some size.
#define ATLAS_GAIN 0.02f
#define LEVEL_GAIN 0.01f

// The shading of most of a mesh's triangles.
static uint32_t main_shading(const prom_build_state *b, const prom_mesh *mesh)
{
    uint64_t triangles[PROM_SHADE_COUNT] = {0};
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        uint32_t shading = PROM_SHADE_PLAIN, m = mesh->submeshes[s].material;
        if (m != PROM_NONE) {
            const prom_material *material = &b->source.materials.data[m];
            if (material->alpha_mode == PROM_ALPHA_BLEND)
                shading = PROM_SHADE_BLENDED;
            else if (material->texture != PROM_NONE)
                shading = material->alpha_mode == PROM_ALPHA_MASK ? PROM_SHADE_MASKED
                                                                  : PROM_SHADE_TEXTURED;
        }
        triangles[shading] += mesh->submeshes[s].index_count / 3;
    }
    uint32_t most = 0;
    for (uint32_t k = 1; k < PROM_SHADE_COUNT; k++)
        if (triangles[k] > triangles[most]) most = k;
    return most;
}

// Over the directions that were looked from at a size.
static float mean_of_size(const prom_accuracy_row *row, uint32_t size)
{
    const bool large = size >= PROM_SIZES;
    const uint32_t dirs = large ? PROM_DIRS_LARGE : PROM_DIRS;
    float sum = 0.0f;
    for (uint32_t d = 0; d < dirs; d++)
        sum += prom_accuracy_of_byte(large ? row->large[d][size - PROM_SIZES]
                                           : row->bins[d][size]);
    return sum / (float)dirs;
}

// The near-field function through the rows of a mesh. What is measured along the axes alone
// counts by how much lower it is than there at the largest of the other sizes.
static float fit_near(const prom_accuracy_row *row, float error, float radius)
{
    enum { SIZES = PROM_SIZES + PROM_SIZES_LARGE };
    float e_px[SIZES], mean[SIZES], axes = 0.0f;
    for (uint32_t s = 0; s < SIZES; s++) mean[s] = mean_of_size(row, s);
    for (uint32_t d = 0; d < PROM_DIRS_LARGE; d++)
        axes += prom_accuracy_of_byte(row->bins[d][PROM_SIZES - 1]) / PROM_DIRS_LARGE;
    for (uint32_t s = 0; s < SIZES; s++) {
        e_px[s] = error * prom_size_of_bin(s) / (2.0f * radius);
        if (s >= PROM_SIZES) mean[s] = mean[PROM_SIZES - 1] - fmaxf(axes - mean[s], 0.0f);
    }
    for (uint32_t s = 0; s < SIZES; s++) mean[s] = fmaxf(mean[s], 0.0f);
    return prom_accuracy_fit_near(e_px, mean, SIZES);
}

// Area that the triangles of a mesh fill, seen from afar: mean over all directions. A triangle
// shows a quarter of its area on each side (Cauchy 1832).
static double mean_filled_area(const prom_build_state *b, const prom_mesh *mesh)
{
    double area = 0.0;
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const prom_submesh *submesh = &mesh->submeshes[s];
        bool both = submesh->material != PROM_NONE &&
                    b->source.materials.data[submesh->material].double_sided;
        const uint32_t *corners = mesh->indices + submesh->first_index;
        for (uint32_t i = 0; i + 2 < submesh->index_count; i += 3) {
            vec3 u, v, normal;
            const float *p = mesh->vertices[corners[i]].position;
            glm_vec3_sub((float *)mesh->vertices[corners[i + 1]].position, (float *)p, u);
            glm_vec3_sub((float *)mesh->vertices[corners[i + 2]].position, (float *)p, v);
            glm_vec3_cross(u, v, normal);
            area += (both ? 0.25 : 0.125) * (double)glm_vec3_norm(normal);
        }
    }
    return area;
}

static float layers_of(const prom_subject *s, const prom_mesh *mesh)
{
    double covered = 0.0,
           disc = GLM_PI * (double)prom_subject_radius(s) * (double)prom_subject_radius(s);
    for (uint32_t d = 0; d < PROM_DIRS; d++) covered += s->coverage[d] / (65535.0 * PROM_DIRS);
    double layers = covered > 0.0 ? mean_filled_area(s->build, mesh) / (covered * disc) : 1.0;
    return (float)fmin(fmax(layers, 1.0), MOST_LAYERS);
}

static void settle(prom_subject *s, prom_candidate *c)
{
    prom_representation *rep = &c->rep;
    bool mesh = rep->kind == PROM_REP_MESH;
    if (!prom_candidate_has_atlas(c)) // which has its own
        rep->shading = c->picture ? PROM_SHADE_IMPOSTOR : main_shading(s->build, c->mesh);
    rep->max_size_px = mesh ? INFINITY : PROM_SIZE_MAX_PX;
    rep->draws = c->mesh->submesh_count;
    rep->vertices = c->mesh->vertex_count;
    rep->triangles = c->mesh->index_count / 3;
    rep->layers = mesh ? layers_of(s, c->mesh) : 1.0f;
    c->kept = true;
    c->outdone = false;
    if (c->admission != PROM_ADMIT_MEASURED) {
        memset(&c->result.accuracy, 255, sizeof c->result.accuracy);
        return;
    }
    uint32_t gaps = 0;
    for (uint32_t d = 0; d < PROM_DIRS; d++) {
        if (c->result.gaps[d] > gaps) gaps = c->result.gaps[d];
        s->build->views_compared += c->result.compared[d];
    }
    s->build->views += PROM_DIRS;
    if (mesh && rep->error > 0)
        rep->near_k = fit_near(&c->result.accuracy, rep->error, prom_subject_radius(s));
    if (mesh && gaps > 0) rep->max_size_px = PROM_GAP_PX * sqrtf(GAPS_SHOWN_PX / (float)gaps);
    c->kept = rep->max_size_px >= LEAST_SIZE_PX;
}

// What its bins promise; where it spoils its surroundings it is not shown.
static float mean_accuracy(const prom_candidate *c)
{
    const prom_accuracy_row *row = &c->result.accuracy;
    float sum = 0;
    for (uint32_t d = 0; d < PROM_DIRS; d++)
        for (uint32_t s = 0; s < PROM_SIZES; s++)
            sum += fmaxf(prom_accuracy_of_byte(row->bins[d][s]), 0);
    return sum / (PROM_DIRS * PROM_SIZES);
}

// Of a mesh and the same with an atlas one is kept.
static void choose_atlases(prom_subject *s)
{
    for (uint32_t i = s->first_made; i < s->count; i++) {
        prom_candidate *made = &s->candidates[i];
        if (!prom_candidate_has_atlas(made) || !made->kept) continue;
        prom_candidate *plain = &s->candidates[made->rep.level];
        if (!plain->kept) continue;
        bool better = mean_accuracy(made) >= mean_accuracy(plain) + ATLAS_GAIN;
        prom_candidate *loser = better ? plain : made;
        loser->outdone = true;
        loser->kept = false;
    }
}

static bool shows_as_well(const prom_candidate *c, const prom_candidate *other)
{
    for (uint32_t s = 0; s < PROM_SIZES + PROM_SIZES_LARGE; s++)
        if (mean_of_size(&c->result.accuracy, s) + LEVEL_GAIN <
            mean_of_size(&other->result.accuracy, s))
            return false;
    return c->rep.max_size_px >= other->rep.max_size_px;
}

// A level of ours is of no use where the next, which costs less, shows as well.
static void thin_levels(prom_subject *s)
{
    const prom_candidate *next = NULL;
    for (uint32_t i = s->count < s->first_made ? s->count : s->first_made; i-- > 0;) {
        prom_candidate *c = &s->candidates[i];
        if (!c->kept) continue;
        c->outdone = next && prom_candidate_is_measured_mesh(c) &&
                     !(c->rep.flags & PROM_REP_ARTIST) && shows_as_well(next, c);
        c->kept = !c->outdone;
        if (c->kept) next = c;
    }
}

void prom_subject_settle(prom_subject *s, uint32_t first)
{
    for (uint32_t i = first; i < s->count; i++) settle(s, &s->candidates[i]);
}

void prom_subject_choose(prom_subject *s)
{
    choose_atlases(s);
    thin_levels(s);
}

// The charted mesh: every vertex once for each chart that has it.
#include "builder/atlas.h"

#include "builder/simplify/work.h"

// Where a point stands in the texture: the corner (min, max) of the chart's faces is a gutter
// away from the upper left of its place.
static void set_uv(const prom_atlas *atlas, const prom_chart *chart, prom_vertex *v)
{
    float x = glm_vec3_dot((float *)chart->right, v->position) - chart->min[0];
    float y = chart->max[1] - glm_vec3_dot((float *)chart->up, v->position);
    float scale = atlas->texels_per_unit, side = (float)atlas->side;
    v->uv[0] = ((float)(chart->x + PROM_ATLAS_GUTTER) + x * scale) / side;
    v->uv[1] = ((float)(chart->y + PROM_ATLAS_GUTTER) + y * scale) / side;
}

void prom_atlas_unwrap(const prom_atlas *atlas, const prom_mesh *mesh, prom_mesh *out)
{
    prom_mesh_init(out, mesh->index_count, mesh->index_count, 1);
    uint32_t *copy = prom_alloc(mesh->vertex_count, sizeof *copy);     // of a vertex, and
    uint32_t *copied = prom_alloc(mesh->vertex_count, sizeof *copied); // for which chart
    for (uint32_t i = 0; i < mesh->vertex_count; i++) copied[i] = PROM_NONE;
    out->vertex_count = out->index_count = 0;
    for (uint32_t c = 0; c < atlas->chart_count; c++) {
        const prom_chart *chart = &atlas->charts[c];
        for (uint32_t i = 0; i < chart->count * 3; i++) {
            uint32_t from = mesh->indices[atlas->faces[chart->first + i / 3] * 3 + i % 3];
            if (copied[from] != c) {
                copied[from] = c;
                copy[from] = out->vertex_count;
                prom_vertex *v = &out->vertices[out->vertex_count++];
                *v = mesh->vertices[from];
                memset(v->color, 255, sizeof v->color);
                set_uv(atlas, chart, v);
            }
            out->indices[out->index_count++] = copy[from];
        }
    }
    prom_free(copy);
    prom_free(copied);
    out->submeshes[0] = (prom_submesh){0, out->index_count, PROM_NONE};
    prom_mesh_optimize(out);
}

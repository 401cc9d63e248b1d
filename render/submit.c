// Drawing a prepared list: device state by phase and run.
#include "render/renderer_private.h"
#include "render/target.h"

#include <math.h>

typedef struct submission {
    prom_renderer *renderer;
    const prom_draw_list *list;
    const prom_target *target;
    const prom_pass *pass;
    look look;
    bool ids;          // are written, by some
    size_t first, end; // of the draws
    float eye[4];
} submission;

// Determinant of the 3x3 matrix that rows 0, 1 and 3 of a projection form without one column.
static double minor(vec4 *m, int without)
{
    static const int rows[3] = {0, 1, 3};
    double a[3][3];
    for (int i = 0, column = 0; i < 4; i++) {
        if (i == without) continue;
        for (int row = 0; row < 3; row++) a[row][column] = (double)m[i][rows[row]];
        column++;
    }
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
           a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

// Where the viewer is: the one homogeneous point that x, y and w of clip space all map to 0.
// For a parallel projection it lies at infinity (w = 0): a direction, towards rising reverse z.
static void find_eye(const prom_pass *pass, float eye[4])
{
    vec4 *m = (vec4 *)pass->projection;
    double e[4], length = 0;
    for (int i = 0; i < 4; i++) e[i] = (i & 1 ? -1 : 1) * minor(m, i);
    for (int i = 0; i < 4; i++) length += e[i] * e[i];
    length = sqrt(length);
    bool parallel = fabs(e[3]) <= 1e-9 * length;
    double rising = 0;
    for (int i = 0; i < 3; i++) rising += e[i] * (double)m[i][2];
    double sign = parallel ? (rising < 0 ? -1 : 1) : (e[3] < 0 ? -1 : 1);
    for (int i = 0; i < 4; i++) eye[i] = length > 0 ? (float)(sign * e[i] / length) : 0;
    if (parallel) eye[3] = 0;
}

static void use_program(const submission *s, pipeline p)
{
    program *chosen = programs_get(&s->renderer->programs, p, s->look, s->ids);
    glUseProgram(chosen->name);
    if (chosen->submit == s->renderer->submits) return;
    chosen->submit = s->renderer->submits;
    glUniformMatrix4fv(UNIFORM_PROJECTION, 1, GL_FALSE, (const float *)s->pass->projection);
    glUniform4fv(UNIFORM_EYE, 1, s->eye);
    glUniform1f(UNIFORM_LIT, s->pass->output == PROM_OUTPUT_ALBEDO ? 0.0f : 1.0f);
}

// Unit 0 repeats, unit 1 ends at the edge.
static void use_texture(const submission *s, const draw_state *state)
{
    bool picture =
        state->pipeline == PIPELINE_IMPOSTOR_LIT || state->pipeline == PIPELINE_IMPOSTOR_UNLIT;
    if (state->pipeline != PIPELINE_PLAIN)
        glBindTextureUnit(picture, s->renderer->textures.pools.data[state->pool].name);
}

static void set_switch(GLenum what, bool on)
{
    if (on)
        glEnable(what);
    else
        glDisable(what);
}

static void bind_framebuffer(const submission *s)
{
    glBindFramebuffer(GL_FRAMEBUFFER, s->ids ? s->target->framebuffer : s->target->plain);
}

// What of the run is in the part that is drawn.
static void draw_run_as(const submission *s, const draw_run *run, pipeline p)
{
    size_t first = run->first > s->first ? run->first : s->first;
    size_t end = run->first + run->count < s->end ? run->first + run->count : s->end;
    if (first >= end) return;
    use_program(s, p);
    use_texture(s, &run->state);
    set_switch(GL_CULL_FACE, !run->state.double_sided);
    glFrontFace(run->state.mirrored ? GL_CW : GL_CCW);
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                                (const void *)(first * sizeof(draw_command)),
                                (GLsizei)(end - first), 0);
    s->renderer->stats.calls++;
}

// Draws the runs [first, last), which are of one blended phase. The second source of blending
// excludes a second attachment, so the ids are written by a pass of their own.
static void draw_blended(const submission *s, size_t first, size_t last, bool background)
{
    const draw_run *runs = s->list->runs.data;
    bool blends = s->look != LOOK_NORMAL;
    glDepthMask(GL_FALSE);
    if (blends) {
        glBindFramebuffer(GL_FRAMEBUFFER, s->target->plain);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, !background);
        glEnable(GL_BLEND);
        glBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC1_COLOR, GL_ONE, GL_ZERO);
        for (size_t i = first; i < last; i++) draw_run_as(s, &runs[i], PIPELINE_BLENDED);
        glDisable(GL_BLEND);
        // Mesa refuses to draw to two attachments as long as the factors name a second source.
        glBlendFunc(GL_ONE, GL_ZERO);
        bind_framebuffer(s);
    }
    bool needs_ids = s->ids && !background && s->pass->ids != PROM_IDS_OPAQUE;
    if (!blends || needs_ids) {
        glColorMaski(0, !blends, !blends, !blends, !blends && !background);
        glColorMaski(1, needs_ids, needs_ids, needs_ids, needs_ids);
        for (size_t i = first; i < last; i++) draw_run_as(s, &runs[i], PIPELINE_MASKED);
    }
    glDepthMask(GL_TRUE);
}

static void draw_opaque(const submission *s, size_t first, size_t last, bool background)
{
    bool ids = !background && s->pass->ids != PROM_IDS_BLENDED;
    glColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, !background);
    glColorMaski(1, ids, ids, ids, ids);
    for (size_t i = first; i < last; i++)
        draw_run_as(s, &s->list->runs.data[i], s->list->runs.data[i].state.pipeline);
}

static void draw_phase(const submission *s, phase which, size_t first, size_t last)
{
    switch (which) {
    case PHASE_OPAQUE:
        draw_opaque(s, first, last, false);
        break;
    case PHASE_BACKGROUND:
        draw_opaque(s, first, last, true);
        break;
    case PHASE_BACKGROUND_BLENDED:
        draw_blended(s, first, last, true);
        break;
    case PHASE_BLENDED:
        draw_blended(s, first, last, false);
        break;
    }
}

static void set_common_state(const submission *s)
{
    const prom_renderer *r = s->renderer;
    bind_framebuffer(s);
    glViewport((GLint)s->pass->x, (GLint)s->pass->y, (GLsizei)s->pass->width,
               (GLsizei)s->pass->height);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glPolygonMode(GL_FRONT_AND_BACK, s->pass->wireframe ? GL_LINE : GL_FILL);
    glBindSampler(0, r->repeat);
    glBindSampler(1, r->clamp);
    glVertexArrayVertexBuffer(r->vertex_array, 0, r->meshes.vertices.name, 0,
                              sizeof(prom_vertex));
    glVertexArrayVertexBuffer(r->vertex_array, 1, s->list->record_buffer.name, 0,
                              sizeof(draw_record));
    glVertexArrayElementBuffer(r->vertex_array, r->meshes.indices.name);
    glBindVertexArray(r->vertex_array);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, s->list->command_buffer.name);
}

// Vertices are those of whole meshes: the first part counts them all.
static void count_stats(const submission *s)
{
    prom_draw_stats *stats = &s->renderer->stats;
    stats->draws += s->end - s->first;
    if (!s->first) stats->vertices += s->list->vertices;
    for (size_t i = s->first; i < s->end; i++)
        stats->triangles += s->list->commands.data[i].count / 3;
}

void prom_draw_list_submit(prom_draw_list *list, prom_target *target, const prom_pass *pass)
{
    if (!list->runs.count) return;
    submission s = {.renderer = list->renderer,
                    .list = list,
                    .target = target,
                    .pass = pass,
                    .look = look_of_output(pass->output),
                    .ids = target->has_ids && pass->ids != PROM_IDS_NONE,
                    .first = pass->first,
                    .end = pass->end ? pass->end : list->commands.count};
    list->renderer->submits++;
    find_eye(pass, s.eye);
    set_common_state(&s);
    for (size_t first = 0, last; first < list->runs.count; first = last) {
        uint8_t current = list->runs.data[first].state.phase;
        for (last = first; last < list->runs.count; last++)
            if (list->runs.data[last].state.phase != current) break;
        draw_phase(&s, current, first, last);
    }
    // Whatever else is drawn or cleared later finds ordinary state.
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glBindVertexArray(0);
    count_stats(&s);
}

#include "render/id_counter.h"

#include "metaobj/base/alloc.h"
#include "render/programs.h"
#include "render/shaders.h"
#include "render/target.h"

#include <assert.h>

#define PHASES (PROM_ID_STEP * PROM_ID_STEP)
#define GROUP 64 // of the shader
#define WAIT_NS 1000000000u

enum { UNIFORM_COLUMNS = 0, UNIFORM_OFFSET = 1 }; // of the shader

static_assert(PROM_ID_STEP == 4, "the shader and phase_offset know it");

// One counting under way. The buffer stays mapped, and grows only.
typedef struct slot {
    GLuint buffer;
    size_t capacity; // in samples
    const uint32_t *ids;
    size_t count; // of the samples
    uint64_t frame;
    GLsync fence;
} slot;

struct prom_id_counter {
    GLuint program;
    slot slots[PROM_ID_RING];
    uint32_t oldest, under_way; // of the slots
    uint32_t phase;
    uint32_t id_count;
    uint32_t *samples; // per id; 0 between the calls
    PROM_ARRAY(prom_id_count) seen;
};

prom_id_counter *prom_id_counter_create(uint32_t id_count, prom_error *error)
{
    GLuint name = programs_make_compute(prom_glsl_gather_ids_comp, error);
    if (!name) return NULL;
    prom_id_counter *counter = prom_calloc(1, sizeof *counter);
    counter->program = name;
    counter->id_count = id_count;
    counter->samples = prom_calloc(id_count, sizeof *counter->samples);
    return counter;
}

static void release_oldest(prom_id_counter *c)
{
    slot *s = &c->slots[c->oldest];
    glDeleteSync(s->fence);
    s->fence = NULL;
    c->oldest = (c->oldest + 1) % PROM_ID_RING;
    c->under_way--;
}

void prom_id_counter_destroy(prom_id_counter *counter)
{
    if (!counter) return;
    while (counter->under_way) release_oldest(counter);
    for (int i = 0; i < PROM_ID_RING; i++) glDeleteBuffers(1, &counter->slots[i].buffer);
    glDeleteProgram(counter->program);
    prom_array_finish(&counter->seen);
    prom_free(counter->samples);
    prom_free(counter);
}

// ---- starting

static bool reserve(slot *s, size_t samples)
{
    if (samples <= s->capacity) return true;
    const GLbitfield access = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    GLsizeiptr bytes = (GLsizeiptr)(samples * sizeof *s->ids);
    while (glGetError() != GL_NO_ERROR) {
    } // what is checked below is ours
    glDeleteBuffers(1, &s->buffer);
    *s = (slot){0};
    glCreateBuffers(1, &s->buffer);
    glNamedBufferStorage(s->buffer, bytes, NULL, access | GL_CLIENT_STORAGE_BIT);
    if (glGetError() != GL_NO_ERROR) return false;
    s->ids = glMapNamedBufferRange(s->buffer, 0, bytes, access);
    if (s->ids) s->capacity = samples;
    return s->ids;
}

// In the order of Bayer's matrix, so that the next pixels are far from the last ones: of two
// bits at a time, the first two place the sample in halves of the block, the others in halves
// of these.
static void phase_offset(uint32_t phase, uint32_t offset[2])
{
    uint32_t half = phase & 3, quarter = phase >> 2;
    offset[0] = 2 * ((half ^ half >> 1) & 1) + ((quarter ^ quarter >> 1) & 1);
    offset[1] = 2 * (half & 1) + (quarter & 1);
}

// Blocks that have a pixel at an offset, along one side.
static uint32_t blocks_of(uint32_t size, uint32_t offset)
{
    return size > offset ? (size - offset + PROM_ID_STEP - 1) / PROM_ID_STEP : 0;
}

static void gather(const prom_id_counter *c, const slot *s, const prom_target *target,
                   const uint32_t offset[2], uint32_t columns, uint32_t rows)
{
    glUseProgram(c->program);
    glUniform1ui(UNIFORM_COLUMNS, columns);
    glUniform2uiv(UNIFORM_OFFSET, 1, offset);
    glBindTextureUnit(0, target->ids);
    glBindSampler(0, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, s->buffer);
    glDispatchCompute((columns + GROUP - 1) / GROUP, rows, 1);
    // The storage bit: a counting that was given up may still be writing when the next begins.
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

bool prom_id_counter_start(prom_id_counter *counter, prom_target *target, uint64_t frame)
{
    assert(target->has_ids);
    if (counter->under_way == PROM_ID_RING) return false;
    slot *s = &counter->slots[(counter->oldest + counter->under_way) % PROM_ID_RING];
    uint32_t offset[2];
    phase_offset(counter->phase, offset);
    uint32_t columns = blocks_of(target->width, offset[0]);
    uint32_t rows = blocks_of(target->height, offset[1]);
    // As many as any offset needs, so that the first one settles the size.
    size_t most = (size_t)blocks_of(target->width, 0) * blocks_of(target->height, 0);
    if (!reserve(s, most)) return false;
    s->count = (size_t)columns * rows;
    s->frame = frame;
    if (s->count) gather(counter, s, target, offset, columns, rows);
    s->fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    counter->phase = (counter->phase + 1) % PHASES;
    counter->under_way++;
    return true;
}

// ---- taking

static GLenum wait_for(const slot *s, bool wait)
{
    GLenum result;
    do result = glClientWaitSync(s->fence, GL_SYNC_FLUSH_COMMANDS_BIT, wait ? WAIT_NS : 0);
    while (wait && result == GL_TIMEOUT_EXPIRED);
    return result;
}

static void add(prom_id_counter *c, uint32_t id, size_t samples)
{
    if (id >= c->id_count) return;
    if (!c->samples[id]) prom_array_push(&c->seen, (prom_id_count){.id = id});
    c->samples[id] += (uint32_t)samples;
}

static void count(prom_id_counter *c, const slot *s)
{
    c->seen.count = 0;
    for (size_t first = 0, last; first < s->count; first = last) {
        uint32_t id = s->ids[first];
        for (last = first + 1; last < s->count && s->ids[last] == id;) last++;
        add(c, id, last - first);
    }
    for (size_t i = 0; i < c->seen.count; i++) {
        prom_id_count *seen = &c->seen.data[i];
        seen->px = (float)(PHASES * c->samples[seen->id]);
        c->samples[seen->id] = 0;
    }
}

bool prom_id_counter_take(prom_id_counter *counter, bool wait, prom_id_counts *counts)
{
    if (!counter->under_way) return false;
    const slot *s = &counter->slots[counter->oldest];
    GLenum result = wait_for(s, wait);
    if (result == GL_TIMEOUT_EXPIRED) return false;
    bool arrived = result != GL_WAIT_FAILED; // it fails when the device is lost
    if (arrived) {
        count(counter, s);
        *counts = (prom_id_counts){s->frame, counter->seen.data, counter->seen.count};
    }
    release_oldest(counter);
    return arrived;
}

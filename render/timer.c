#include "render/timer.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"
#include "metaobj/base/threads.h"
#include "render/renderer_private.h"

#include <math.h>
#include <time.h>

#define TEST_SIZE 512u
#define TEST_MS 4.0 // work long enough to be told from call overhead
#define TEST_MAX_LAYERS 65536u
#define TEST_ROUNDS 3
#define AGREEMENT 0.30 // queries are trusted within this of the wall clock

struct prom_timer {
    prom_renderer *renderer;
    GLuint query;
    bool uses_queries, software;
    double start_ms, busy_start_ms, busy_ms;
};

// ---- the self-test: opaque layers, back to front, over a small picture, as many as take a few
// milliseconds

typedef struct trial {
    prom_draw_list *list;
    prom_target *target;
    uint32_t mesh;
} trial;

static uint32_t add_square(prom_renderer *r)
{
    static const float corners[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    prom_mesh mesh;
    prom_mesh_init(&mesh, 4, 6, 1);
    for (int i = 0; i < 4; i++)
        mesh.vertices[i] = (prom_vertex){
            .position = {corners[i][0], corners[i][1], corners[i][2]}, .normal = {0, 0, 127}};
    memcpy(mesh.indices, order, sizeof order);
    mesh.submeshes[0] = (prom_submesh){0, 6, PROM_NONE};
    uint32_t id = prom_renderer_add_mesh(r, &mesh);
    prom_mesh_finish(&mesh);
    return id;
}

static void fill_layers(trial *t, uint32_t layers)
{
    prom_draw_list_reset(t->list);
    for (uint32_t i = 0; i < layers; i++) {
        // Each layer is nearer than the one before and drawn after it, so that all are shaded.
        prom_draw_item item = {.mesh = t->mesh,
                               .texture = PROM_NONE,
                               .origin = {0, 0, (float)(i + 1) / (float)(layers + 1)},
                               .basis = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                               .depth = 1};
        prom_draw_list_add(t->list, &item);
    }
    prom_draw_list_prepare(t->list);
}

static void draw_layers(const trial *t)
{
    static const uint8_t black[4] = {0};
    const prom_pass pass = {
        .projection = GLM_MAT4_IDENTITY_INIT, .width = TEST_SIZE, .height = TEST_SIZE};
    prom_target_clear(t->target, black);
    prom_draw_list_submit(t->list, t->target, &pass);
}

static double wall_ms(const trial *t)
{
    glFinish();
    double start = prom_clock_ms();
    draw_layers(t);
    glFinish();
    return prom_clock_ms() - start;
}

static double query_ms(const trial *t, GLuint query)
{
    GLuint64 ns = 0;
    glFinish();
    glBeginQuery(GL_TIME_ELAPSED, query);
    draw_layers(t);
    glEndQuery(GL_TIME_ELAPSED);
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &ns);
    return (double)ns * 1e-6;
}

static bool queries_agree(const trial *t, GLuint query)
{
    for (uint32_t layers = 8; layers <= TEST_MAX_LAYERS; layers *= 2) {
        trial growing = *t;
        fill_layers(&growing, layers);
        wall_ms(&growing); // warm
        if (wall_ms(&growing) >= TEST_MS) break;
    }
    for (int i = 0; i < TEST_ROUNDS; i++) {
        double wall = wall_ms(t), queried = query_ms(t, query);
        prom_log(PROM_LOG_DEBUG, "timer self-test: wall %.2f ms, query %.2f ms", wall, queried);
        if (fabs(queried - wall) > AGREEMENT * wall) return false;
    }
    return true;
}

static bool self_test(prom_renderer *r, GLuint query)
{
    GLint bits = 0;
    glGetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &bits);
    if (bits < 32) return false;
    uint32_t meshes = prom_renderer_mesh_count(r), textures = prom_renderer_texture_count(r);
    prom_draw_stats stats = r->stats;
    trial t = {.target = prom_target_create(TEST_SIZE, TEST_SIZE, false, NULL)};
    if (!t.target) return false;
    t.list = prom_draw_list_create(r);
    t.mesh = add_square(r);
    bool agree = t.mesh != PROM_NONE && queries_agree(&t, query);
    prom_draw_list_destroy(t.list);
    prom_target_destroy(t.target);
    prom_renderer_truncate(r, meshes, textures);
    r->stats = stats;
    return agree;
}

// ---- the timer

prom_timer *prom_timer_create(prom_renderer *renderer)
{
    prom_timer *timer = prom_calloc(1, sizeof *timer);
    timer->renderer = renderer;
    timer->software = prom_context_is_software(renderer->context);
    glCreateQueries(GL_TIME_ELAPSED, 1, &timer->query);
    timer->uses_queries = self_test(renderer, timer->query);
    prom_log(PROM_LOG_DEBUG, "timing by %s",
             timer->uses_queries ? "timer queries" : "the wall clock");
    return timer;
}

void prom_timer_destroy(prom_timer *timer)
{
    if (!timer) return;
    glDeleteQueries(1, &timer->query);
    prom_free(timer);
}

bool prom_timer_uses_queries(const prom_timer *timer)
{
    return timer->uses_queries;
}

static double clock_of(clockid_t id)
{
    struct timespec t;
    clock_gettime(id, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static double busy_clock(const prom_timer *timer)
{
    if (!timer->software) return 0;
    double own = clock_of(CLOCK_THREAD_CPUTIME_ID), all = clock_of(CLOCK_PROCESS_CPUTIME_ID);
    return own + (all - own) / prom_thread_count();
}

double prom_timer_busy_ms(const prom_timer *timer)
{
    return timer->busy_ms;
}

void prom_timer_begin(prom_timer *timer)
{
    glFinish();
    timer->busy_start_ms = busy_clock(timer);
    timer->start_ms = prom_clock_ms();
    if (timer->uses_queries) glBeginQuery(GL_TIME_ELAPSED, timer->query);
}

double prom_timer_end(prom_timer *timer)
{
    if (!timer->uses_queries) {
        glFinish();
        double end_ms = prom_clock_ms();
        timer->busy_ms = busy_clock(timer) - timer->busy_start_ms;
        return end_ms - timer->start_ms;
    }
    GLuint64 ns = 0;
    glEndQuery(GL_TIME_ELAPSED);
    glGetQueryObjectui64v(timer->query, GL_QUERY_RESULT, &ns);
    return (double)ns * 1e-6;
}

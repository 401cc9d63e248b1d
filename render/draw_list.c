#include "render/renderer_private.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// The sort key, from the top: phase 2 bits, slice 4, state 21 (and room), depth 16 for what is
// drawn opaque; phase 2, falling depth 32 for what is blended.
#define PHASE_SHIFT 62
#define SLICE_SHIFT 58
#define STATE_SHIFT 16
#define BLENDED_DEPTH_SHIFT 16
#define SLICES 8
#define HIDDEN_SLICE SLICES // after all of them
// Depths below this part of the greatest share the nearest slice: the eye often stands on
// something, and that should not stretch the slices of all the rest.
#define MIN_DEPTH_RATIO (1.0f / 4096.0f)
// An alpha below which a see-through pixel is taken as not there, x 65535.
#define BLENDED_CUTOFF 257u

prom_draw_list *prom_draw_list_create(prom_renderer *renderer)
{
    prom_draw_list *list = prom_calloc(1, sizeof *list);
    list->renderer = renderer;
    return list;
}

void prom_draw_list_destroy(prom_draw_list *list)
{
    if (!list) return;
    gpu_buffer_finish(&list->record_buffer);
    gpu_buffer_finish(&list->command_buffer);
    prom_array_finish(&list->items);
    prom_array_finish(&list->entries);
    prom_array_finish(&list->scratch);
    prom_array_finish(&list->records);
    prom_array_finish(&list->commands);
    prom_array_finish(&list->runs);
    prom_free(list);
}

void prom_draw_list_reset(prom_draw_list *list)
{
    list->items.count = 0;
    list->entries.count = 0;
    list->records.count = 0;
    list->commands.count = 0;
    list->runs.count = 0;
    list->vertices = 0;
}

void prom_draw_list_add(prom_draw_list *list, const prom_draw_item *item)
{
    assert(item->mesh < list->renderer->meshes.meshes.count);
    assert(item->texture == PROM_NONE ||
           item->texture < list->renderer->textures.textures.count);
    prom_array_push(&list->items, *item);
}

// ---- what each draw needs

static const prom_material *material_of(const prom_renderer *r, uint32_t index)
{
    return index < r->materials.count ? &r->materials.data[index] : NULL;
}

static const stored_texture *texture_of(const prom_renderer *r, const prom_material *material)
{
    if (!material || material->texture >= r->textures.textures.count) return NULL;
    return &r->textures.textures.data[material->texture];
}

static pipeline material_pipeline(const prom_renderer *r, const prom_material *material)
{
    if (!material) return PIPELINE_PLAIN;
    if (material->alpha_mode == PROM_ALPHA_BLEND) return PIPELINE_BLENDED;
    if (material->alpha_mode == PROM_ALPHA_MASK) return PIPELINE_MASKED;
    return texture_of(r, material) ? PIPELINE_TEXTURED : PIPELINE_PLAIN;
}

static draw_state impostor_state(const prom_renderer *r, const prom_draw_item *item)
{
    const stored_texture *t = &r->textures.textures.data[item->texture];
    bool lit = t->kind == PROM_TEXTURE_IMPOSTOR_ALBEDO && !(item->flags & PROM_REP_UNLIT);
    return (draw_state){
        .pipeline = lit ? PIPELINE_IMPOSTOR_LIT : PIPELINE_IMPOSTOR_UNLIT,
        .pool = (uint16_t)t->pool,
    };
}

static draw_state submesh_state(const prom_renderer *r, const prom_material *material)
{
    pipeline p = material_pipeline(r, material);
    const stored_texture *t = texture_of(r, material);
    if (!t) t = &r->textures.white;
    return (draw_state){
        .pipeline = (uint8_t)p,
        .double_sided = material && material->double_sided,
        .pool = (uint16_t)(p == PIPELINE_PLAIN ? 0 : t->pool),
    };
}

static draw_state state_of(const prom_renderer *r, const prom_draw_item *item,
                           const prom_submesh *submesh)
{
    draw_state s = item->texture != PROM_NONE
                       ? impostor_state(r, item)
                       : submesh_state(r, material_of(r, submesh->material));
    bool blended = s.pipeline == PIPELINE_BLENDED;
    s.mirrored = prom_basis_determinant(item->basis) < 0;
    s.phase = item->background ? (blended ? PHASE_BACKGROUND_BLENDED : PHASE_BACKGROUND)
                               : (blended ? PHASE_BLENDED : PHASE_OPAQUE);
    return s;
}

static void fill_record(const prom_renderer *r, const prom_draw_item *item,
                        const sort_entry *entry, draw_record *out)
{
    static const draw_color white = {{1, 1, 1, 1}};
    const prom_submesh *submesh = &r->meshes.submeshes.data[entry->submesh];
    const prom_material *m =
        item->texture == PROM_NONE ? material_of(r, submesh->material) : NULL;
    const stored_texture *t = item->texture != PROM_NONE
                                  ? &r->textures.textures.data[item->texture]
                                  : texture_of(r, m);
    if (!t) t = &r->textures.white;
    float cutoff = m && m->alpha_mode == PROM_ALPHA_MASK ? m->alpha_cutoff : 0;
    uint32_t cutoff16 = (uint32_t)(glm_clamp(cutoff, 0, 1) * 65535.0f + 0.5f);
    if (entry->state.pipeline == PIPELINE_BLENDED) cutoff16 = BLENDED_CUTOFF;
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            out->rows[row][column] = item->basis[column * 3 + row];
        out->rows[row][3] = item->origin[row];
    }
    out->color = m ? r->colors.data[m - r->materials.data] : white;
    out->layer = t->layer;
    out->flags = (item->flags & PROM_REP_UNLIT ? DRAW_UNLIT : 0) |
                 (entry->state.double_sided ? DRAW_DOUBLE_SIDED : 0) |
                 (entry->state.mirrored ? DRAW_MIRRORED : 0) |
                 (item->background ? DRAW_BACKGROUND : 0) | cutoff16 << 16;
    out->id = item->id;
    memcpy(out->tint, item->tint, sizeof out->tint);
}

// ---- order

typedef struct depth_slices {
    float min, scale; // slice = log2(depth / min) * scale
} depth_slices;

static depth_slices find_slices(const prom_draw_list *list)
{
    float near = INFINITY, far = 0;
    for (size_t i = 0; i < list->items.count; i++) {
        const prom_draw_item *item = &list->items.data[i];
        float depth = item->depth;
        if (item->background || item->hidden || !isfinite(depth)) continue;
        if (depth < near) near = depth;
        if (depth > far) far = depth;
    }
    if (!(near > far * MIN_DEPTH_RATIO)) near = far * MIN_DEPTH_RATIO;
    if (!(far > near)) return (depth_slices){1, 0};
    return (depth_slices){near, (float)SLICES / log2f(far / near)};
}

static uint64_t slice_of(const depth_slices *slices, const prom_draw_item *item)
{
    if (item->hidden) return HIDDEN_SLICE;
    if (!(item->depth > slices->min)) return 0;
    float slice = log2f(item->depth / slices->min) * slices->scale;
    return slice < SLICES - 1 ? (uint64_t)slice : SLICES - 1;
}

// The bits of a depth, which order as the depths do; negative ones count as 0.
static uint32_t depth_bits(float depth)
{
    uint32_t bits;
    if (!(depth > 0)) return 0;
    memcpy(&bits, &depth, sizeof bits);
    return bits;
}

static uint64_t state_bits(const draw_state *s)
{
    return (uint64_t)s->pipeline << 18 | (uint64_t)s->double_sided << 17 |
           (uint64_t)s->mirrored << 16 | s->pool;
}

static uint64_t key_of(const draw_state *s, const depth_slices *slices,
                       const prom_draw_item *item)
{
    uint64_t key = (uint64_t)s->phase << PHASE_SHIFT;
    uint32_t bits = depth_bits(item->depth);
    if (s->phase == PHASE_BLENDED || s->phase == PHASE_BACKGROUND_BLENDED)
        return key | (uint64_t)(uint32_t)~bits << BLENDED_DEPTH_SHIFT;
    if (s->phase == PHASE_OPAQUE) key |= slice_of(slices, item) << SLICE_SHIFT;
    return key | state_bits(s) << STATE_SHIFT | bits >> 16;
}

// One pass of a stable radix sort; false if it would change nothing.
static bool sort_pass(const sort_entry *from, sort_entry *to, size_t count, int shift)
{
    uint32_t starts[256] = {0};
    for (size_t i = 0; i < count; i++) starts[from[i].key >> shift & 255]++;
    if (starts[from[0].key >> shift & 255] == count) return false;
    uint32_t sum = 0;
    for (int digit = 0; digit < 256; digit++) {
        uint32_t here = starts[digit];
        starts[digit] = sum;
        sum += here;
    }
    for (size_t i = 0; i < count; i++) to[starts[from[i].key >> shift & 255]++] = from[i];
    return true;
}

// By key, equal keys in the order of adding. (qsort is not stable and may allocate.)
static void sort_entries(prom_draw_list *list)
{
    size_t count = list->entries.count;
    if (!count) return;
    prom_array_reserve(&list->scratch, list->entries.capacity);
    sort_entry *from = list->entries.data, *to = list->scratch.data;
    for (int shift = 0; shift < 64; shift += 8)
        if (sort_pass(from, to, count, shift)) {
            sort_entry *swap = from;
            from = to;
            to = swap;
        }
    if (from != list->entries.data) memcpy(list->entries.data, from, count * sizeof *from);
}

// ---- the list

static void collect_entries(prom_draw_list *list)
{
    const prom_renderer *r = list->renderer;
    depth_slices slices = find_slices(list);
    for (uint32_t i = 0; i < list->items.count; i++) {
        const prom_draw_item *item = &list->items.data[i];
        const stored_mesh *mesh = &r->meshes.meshes.data[item->mesh];
        list->vertices += mesh->vertex_count;
        for (uint32_t s = 0; s < mesh->submesh_count; s++) {
            uint32_t submesh = mesh->first_submesh + s;
            draw_state state = state_of(r, item, &r->meshes.submeshes.data[submesh]);
            prom_array_push(&list->entries, (sort_entry){.key = key_of(&state, &slices, item),
                                                         .item = i,
                                                         .submesh = submesh,
                                                         .state = state});
        }
    }
}

static bool same_state(const draw_state *a, const draw_state *b)
{
    return a->phase == b->phase && state_bits(a) == state_bits(b);
}

static void emit(prom_draw_list *list, const sort_entry *entry)
{
    const prom_renderer *r = list->renderer;
    const prom_draw_item *item = &list->items.data[entry->item];
    const prom_submesh *submesh = &r->meshes.submeshes.data[entry->submesh];
    uint32_t index = (uint32_t)list->commands.count;
    draw_run *last = list->runs.count ? &list->runs.data[list->runs.count - 1] : NULL;
    if (!last || !same_state(&last->state, &entry->state)) {
        prom_array_push(&list->runs, (draw_run){.state = entry->state, .first = index});
        last = &list->runs.data[list->runs.count - 1];
    }
    last->count++;
    prom_array_push(&list->commands,
                    (draw_command){
                        .count = submesh->index_count,
                        .instance_count = 1,
                        .first_index = submesh->first_index,
                        .base_vertex = (GLint)r->meshes.meshes.data[item->mesh].first_vertex,
                        .base_instance = index,
                    });
    prom_array_reserve(&list->records, list->records.count + 1);
    fill_record(r, item, entry, &list->records.data[list->records.count++]);
}

void prom_draw_list_prepare(prom_draw_list *list)
{
    assert(!list->commands.count && "reset the list before preparing it again");
    collect_entries(list);
    sort_entries(list);
    for (size_t i = 0; i < list->entries.count; i++) emit(list, &list->entries.data[i]);
    gpu_buffer_stream(&list->record_buffer, list->records.data,
                      list->records.count * sizeof *list->records.data);
    gpu_buffer_stream(&list->command_buffer, list->commands.data,
                      list->commands.count * sizeof *list->commands.data);
}

bool prom_draw_list_has_blended(const prom_draw_list *list)
{
    // The phase that is drawn last.
    return list->runs.count &&
           list->runs.data[list->runs.count - 1].state.phase == PHASE_BLENDED;
}

size_t prom_draw_list_length(const prom_draw_list *list)
{
    return list->commands.count;
}

// An item's cost goes to its submeshes by their triangles.
static double cost_of(const prom_draw_list *list, const sort_entry *entry)
{
    const mesh_store *store = &list->renderer->meshes;
    const prom_draw_item *item = &list->items.data[entry->item];
    uint32_t all = store->meshes.data[item->mesh].index_count;
    uint32_t own = store->submeshes.data[entry->submesh].index_count;
    return all ? (double)item->cost_ms * own / all : 0;
}

size_t prom_draw_list_part(const prom_draw_list *list, size_t first, double cost_ms)
{
    double cost = 0;
    size_t end = first;
    while (end < list->entries.count) {
        cost += cost_of(list, &list->entries.data[end]);
        if (end > first && cost > cost_ms) break;
        end++;
    }
    return end;
}

// Levels of detail that import_gltf_lod.c hung into the scene become levels of their nodes. A
// level stands for the node's own meshes, so where a node or a level is a whole hierarchy, its
// meshes are brought into the node's frame.
#include "builder/import_gltf.h"
#include "builder/import_parts.h"
#include "metaobj/base/hash.h"

// Shares of the picture become distances for a vertical field of view of 60 degrees and a
// picture of 16:9: that of the disc that the bounding sphere projects to.
#define COT_HALF_FOV 1.7320508075688772
#define PICTURE_AREA (4 * 16.0 / 9) // in half heights
#define PI 3.14159265358979323846
#define BUCKETS 1024u

typedef struct baked {
    uint32_t from, mesh, next;
    double matrix[16];
} baked;

typedef struct new_level {
    uint32_t first, count; // in refs
    float until;
} new_level;

typedef struct attacher {
    prom_import *import;
    prom_source *source;
    const prom_gltf *gltf;
    uint32_t *node_of; // by the file's number; PROM_NONE: not in the scene
    bool *hidden;      // per node: inside a level
    bool *folded;      // per node: its meshes are part of a node above
    uint32_t *lod_of;  // per node: index into levelled, or PROM_NONE
    PROM_ARRAY(uint32_t) refs;
    PROM_ARRAY(new_level) levels;   // of a levelled node: itself, then the coarser ones
    PROM_ARRAY(new_level) levelled; // first, count in levels
    PROM_ARRAY(baked) baked;
    uint32_t bucket[BUCKETS];
    uint32_t lost;
} attacher;

// ---- meshes brought into another frame

static bool is_identity(const double m[16])
{
    for (int i = 0; i < 16; i++)
        if (m[i] != (i % 5 ? 0.0 : 1.0)) return false;
    return true;
}

static uint32_t bake(attacher *a, uint32_t mesh, const double m[16])
{
    if (is_identity(m)) return mesh;
    uint64_t hash = prom_hash(m, 16 * sizeof *m, mesh);
    uint32_t *head = &a->bucket[hash % BUCKETS];
    for (uint32_t i = *head; i != PROM_NONE; i = a->baked.data[i].next)
        if (a->baked.data[i].from == mesh && !memcmp(a->baked.data[i].matrix, m, 128))
            return a->baked.data[i].mesh;
    prom_mesh out;
    prom_mesh_copy(&out, &a->source->meshes.data[mesh]);
    prom_import_mesh_transform(&out, m);
    baked b = {.from = mesh, .mesh = (uint32_t)a->source->meshes.count, .next = *head};
    memcpy(b.matrix, m, sizeof b.matrix);
    *head = (uint32_t)a->baked.count;
    prom_array_push(&a->baked, b);
    prom_array_push(&a->source->meshes, out);
    return b.mesh;
}

// ---- frames

static bool invert(const double m[16], double out[16])
{
    double c[9]; // rows of the inverse of the upper left, times the determinant
    for (int i = 0; i < 3; i++)
        for (int r = 0; r < 3; r++) {
            const double *p = m + 4 * ((i + 1) % 3), *q = m + 4 * ((i + 2) % 3);
            int s = (r + 1) % 3, t = (r + 2) % 3;
            c[i * 3 + r] = p[s] * q[t] - p[t] * q[s];
        }
    double det = m[0] * c[0] + m[1] * c[1] + m[2] * c[2];
    memset(out, 0, 16 * sizeof *out);
    out[15] = 1;
    if (!(fabs(det) > 1e-30)) return false;
    for (int i = 0; i < 3; i++) {
        for (int r = 0; r < 3; r++) {
            out[r * 4 + i] = c[i * 3 + r] / det;
            out[12 + i] -= c[i * 3 + r] / det * m[12 + r];
        }
    }
    return true;
}

// Rounded, so that equal arrangements stay equal whatever their place in the world.
static void round_frame(double m[16])
{
    for (int part = 0; part < 2; part++) {
        int first = part ? 12 : 0, last = part ? 15 : 12;
        double largest = part ? 1e-6 : 0;
        for (int i = first; i < last; i++) largest = fmax(largest, fabs(m[i]));
        double step = largest * 0x1p-20;
        for (int i = first; i < last && step > 0; i++) m[i] = rint(m[i] / step) * step + 0.0;
    }
}

// From the level's frame to the node's. False when there is no way back.
static bool level_frame(const prom_source_node *node, const prom_source_node *level,
                        bool in_frame, double out[16])
{
    static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    double back[16];
    memcpy(out, identity, sizeof identity);
    if (in_frame || !memcmp(node->local, level->local, sizeof node->local)) return true;
    if (!invert(node->local, back)) return false;
    prom_import_multiply(back, level->local, out);
    round_frame(out);
    return true;
}

// ---- what a node or a level holds

static uint32_t subtree_end(const attacher *a, uint32_t root)
{
    const prom_source_node *nodes = a->source->nodes.data;
    uint32_t end = root + 1;
    while (end < a->source->nodes.count && nodes[end].parent != PROM_NONE &&
           nodes[end].parent >= root)
        end++;
    return end;
}

// Appends the meshes of a subtree to refs, in the frame that `at` leads to.
static uint32_t gather(attacher *a, uint32_t root, const double at[16])
{
    uint32_t end = subtree_end(a, root), first = (uint32_t)a->refs.count;
    double(*frames)[16] = prom_alloc(end - root, sizeof *frames);
    memcpy(frames[0], at, sizeof *frames);
    for (uint32_t i = root; i < end; i++) {
        const prom_source_node node = a->source->nodes.data[i];
        double *frame = frames[i - root];
        if (i > root) prom_import_multiply(frames[node.parent - root], node.local, frame);
        for (uint32_t k = 0; k < node.mesh_count; k++) {
            uint32_t mesh = a->source->mesh_refs.data[node.first_mesh + k];
            prom_array_push(&a->refs, bake(a, mesh, frame));
        }
    }
    prom_free(frames);
    return (uint32_t)a->refs.count - first;
}

// ---- limits

// Half the diagonal of the meshes' box, with the node's scale in the world.
static double world_radius(const attacher *a, const prom_source_node *node, uint32_t first,
                           uint32_t count)
{
    prom_box all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = first; i < first + count; i++) {
        prom_box b = prom_mesh_bounds(&a->source->meshes.data[a->refs.data[i]]);
        for (int k = 0; k < 3; k++) {
            all.min[k] = fminf(all.min[k], b.min[k]);
            all.max[k] = fmaxf(all.max[k], b.max[k]);
        }
    }
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double *column = node->world + 4 * k;
        double half = 0.5 * ((double)all.max[k] - (double)all.min[k]);
        sum += half * half *
               (column[0] * column[0] + column[1] * column[1] + column[2] * column[2]);
    }
    return sqrt(sum);
}

// Three digits, so that rounding errors in turned matrices do not tell instances apart.
static double three_digits(double v)
{
    if (!(v > 0) || !isfinite(v)) return v;
    double step = pow(10, floor(log10(v)) - 2);
    return rint(v / step) * step;
}

static float limit(double until, bool coverage, double radius, double unit, float before)
{
    double d = coverage ? radius * COT_HALF_FOV * sqrt(PI / (PICTURE_AREA * until)) // 0: no end
                        : until * unit;
    if (coverage) d = three_digits(d);
    return isfinite(d) && d < 1e30 ? fmaxf((float)d, before) : INFINITY;
}

// ---- attaching

static bool add_lod(attacher *a, const prom_gltf_lod *lod, uint32_t index)
{
    const prom_source_node *node = &a->source->nodes.data[index];
    static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    size_t refs = a->refs.count, levels = a->levels.count;
    uint32_t count = gather(a, index, identity);
    if (!count) return false;
    double radius = world_radius(a, node, (uint32_t)refs, count), unit = a->import->unit;
    float until = limit(lod->until, lod->coverage, radius, unit, 1e-6f);
    prom_array_push(&a->levels, (new_level){(uint32_t)refs, count, until});
    for (uint32_t k = 0; k < lod->level_count; k++) {
        const prom_gltf_level *level = &a->gltf->levels.data[lod->first_level + k];
        uint32_t at = a->node_of[level->node], first = (uint32_t)a->refs.count;
        double frame[16];
        if (at == PROM_NONE) continue;
        if (!level_frame(node, &a->source->nodes.data[at], lod->in_frame, frame)) continue;
        until = limit(level->until, lod->coverage, radius, unit, until);
        count = gather(a, at, frame);
        if (count) prom_array_push(&a->levels, (new_level){first, count, until});
    }
    if (a->levels.count - levels < 2) {
        a->levels.count = levels;
        a->refs.count = refs;
        return false;
    }
    a->lod_of[index] = (uint32_t)a->levelled.count;
    prom_array_push(&a->levelled,
                    (new_level){(uint32_t)levels, (uint32_t)(a->levels.count - levels), 0});
    uint32_t end = subtree_end(a, index);
    for (uint32_t i = index + 1; i < end; i++) a->folded[i] = true;
    return true;
}

// Level nodes and all below them.
static void hide_levels(attacher *a)
{
    for (size_t k = 0; k < a->gltf->levels.count; k++) {
        uint32_t at = a->node_of[a->gltf->levels.data[k].node];
        if (at != PROM_NONE) a->hidden[at] = true;
    }
    for (size_t i = 0; i < a->source->nodes.count; i++) {
        uint32_t parent = a->source->nodes.data[i].parent;
        if (parent != PROM_NONE && a->hidden[parent]) a->hidden[i] = true;
    }
}

static int by_node(const void *pa, const void *pb)
{
    const uint32_t *a = pa, *b = pb;
    return a[0] < b[0] ? -1 : a[0] > b[0];
}

// Nodes above come first: what is below is folded into them.
static void add_lods(attacher *a)
{
    size_t n = a->gltf->lods.count;
    uint32_t(*order)[2] = prom_alloc(n, sizeof *order);
    for (uint32_t k = 0; k < n; k++) {
        order[k][0] = a->node_of[a->gltf->lods.data[k].node];
        order[k][1] = k;
    }
    qsort(order, n, sizeof *order, by_node);
    for (size_t k = 0; k < n && order[k][0] != PROM_NONE; k++) {
        uint32_t at = order[k][0];
        if (a->hidden[at] || a->folded[at]) continue;
        if (!add_lod(a, &a->gltf->lods.data[order[k][1]], at)) a->lost++;
    }
    prom_free(order);
}

static void push_refs(prom_source *s, const uint32_t *refs, uint32_t count)
{
    if (count) memcpy(prom_array_extend(&s->mesh_refs, count), refs, count * sizeof *refs);
}

// The nodes again, without those of levels, with references in order: a node's own, then its
// levels'.
static void rebuild(attacher *a)
{
    prom_source *s = a->source;
    uint32_t *old = s->mesh_refs.data, *number = prom_alloc(s->nodes.count, sizeof *number);
    memset(&s->mesh_refs, 0, sizeof s->mesh_refs);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->nodes.count; i++) {
        prom_source_node node = s->nodes.data[i];
        const uint32_t *own = old + node.first_mesh;
        number[i] = kept;
        if (a->hidden[i]) continue;
        if (node.parent != PROM_NONE) node.parent = number[node.parent];
        if (a->folded[i]) node.mesh_count = 0;
        node.first_mesh = (uint32_t)s->mesh_refs.count;
        node.first_level = (uint32_t)s->levels.count;
        if (a->lod_of[i] == PROM_NONE) {
            push_refs(s, own, node.mesh_count);
        } else {
            new_level set = a->levelled.data[a->lod_of[i]];
            for (uint32_t k = 0; k < set.count; k++) {
                new_level l = a->levels.data[set.first + k];
                uint32_t first = (uint32_t)s->mesh_refs.count;
                push_refs(s, a->refs.data + l.first, l.count);
                if (k) {
                    prom_array_push(&s->levels, (prom_source_level){first, l.count, l.until});
                } else {
                    node.mesh_count = l.count;
                    node.until = l.until;
                }
            }
            node.level_count = set.count - 1;
        }
        s->nodes.data[kept++] = node;
    }
    s->nodes.count = kept;
    prom_free(old);
    prom_free(number);
}

void prom_import_levels_attach(prom_import *import)
{
    const prom_gltf *gltf = &import->gltf_file;
    prom_source *source = import->source;
    attacher a = {.import = import, .source = source, .gltf = gltf};
    if (!gltf->lods.count) return;
    size_t nodes = source->nodes.count, numbers = gltf->names.count;
    a.node_of = prom_alloc(numbers, sizeof *a.node_of);
    a.lod_of = prom_alloc(nodes, sizeof *a.lod_of);
    memset(a.node_of, 0xff, numbers * sizeof *a.node_of);
    memset(a.lod_of, 0xff, nodes * sizeof *a.lod_of);
    memset(a.bucket, 0xff, sizeof a.bucket);
    a.hidden = prom_calloc(nodes, sizeof *a.hidden);
    a.folded = prom_calloc(nodes, sizeof *a.folded);
    for (uint32_t i = 0; i < nodes; i++) {
        uint32_t number = import->node_numbers.data[i];
        if (number < numbers) a.node_of[number] = i;
    }
    hide_levels(&a);
    add_lods(&a);
    rebuild(&a);
    if (a.lost)
        prom_import_warn(
            import, "the levels of detail of %u nodes hold nothing and are ignored", a.lost);
    prom_free(a.node_of);
    prom_free(a.lod_of);
    prom_free(a.hidden);
    prom_free(a.folded);
    prom_array_finish(&a.refs);
    prom_array_finish(&a.levels);
    prom_array_finish(&a.levelled);
    prom_array_finish(&a.baked);
}

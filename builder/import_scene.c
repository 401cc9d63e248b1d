#include "builder/import_parts.h"

#include <assimp/GltfMaterial.h>
#include <assimp/postprocess.h>
#include <limits.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <strings.h>

// Beyond this a file is taken for damaged (by taste).
#define MAX_NODES (1u << 26)

void prom_import_doing(prom_import *import, const char *format, ...)
{
    static pthread_mutex_t lock =
        PTHREAD_MUTEX_INITIALIZER; // pictures are decoded side by side
    va_list args;
    va_start(args, format);
    pthread_mutex_lock(&lock);
    vsnprintf(import->doing, PROM_CHILD_DOING, format, args);
    pthread_mutex_unlock(&lock);
    va_end(args);
}

void prom_import_warn(prom_import *import, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    prom_array_push(&import->warnings, prom_strdup(text));
}

static prom_status damaged(const prom_import *import, const char *why, prom_error *error)
{
    return prom_fail(error, PROM_ERR_INPUT, "%s: cannot be read: %s", import->path, why);
}

// ---- what assimp gives is checked before anything walks it

static bool mesh_sound(const struct aiMesh *mesh)
{
    if (mesh->mNumFaces && (!mesh->mFaces || !mesh->mVertices)) return false;
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        const struct aiFace *face = &mesh->mFaces[f];
        for (unsigned k = 0; k < face->mNumIndices; k++)
            if (face->mIndices[k] >= mesh->mNumVertices) return false;
    }
    return true;
}

static prom_status check_meshes(const prom_import *import, prom_error *error)
{
    const struct aiScene *scene = import->scene;
    if (!scene->mRootNode) return damaged(import, "it holds no scene", error);
    for (unsigned m = 0; m < scene->mNumMeshes; m++)
        if (!mesh_sound(scene->mMeshes[m]))
            return prom_fail(error, PROM_ERR_INPUT,
                             "%s: a face of mesh %u ('%s') names a vertex that does not exist; "
                             "the file is damaged",
                             import->path, m, scene->mMeshes[m]->mName.data);
    return PROM_OK;
}

static const char *extension(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    return dot ? dot : "";
}

static prom_status refused(const prom_import *import, prom_error *error)
{
    const char *why = aiGetErrorString(), *dot = extension(import->path);
    if (!why || !*why) why = "the loader gives no reason";
    if (strstr(why, "bad_alloc")) why = "the loader ran out of memory";
    if (strstr(why, "No suitable reader")) why = "it is not of the format that its name says";
    if (!aiIsExtensionSupported(*dot ? dot : "."))
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: is of no known scene format; give glTF, GLB, OBJ, PLY, FBX, "
                         "Collada, 3DS, STL or AC3D",
                         import->path);
    return damaged(import, why, error);
}

static const struct aiScene *read_file(prom_import *import)
{
    struct aiFileIO files = prom_import_files(import);
    struct aiPropertyStore *settings = aiCreatePropertyStore();
    if (settings) prom_import_axes_prepare(import, settings);
    const struct aiScene *scene =
        aiImportFileExWithProperties(import->path, 0, &files, settings);
    if (settings) aiReleasePropertyStore(settings);
    return scene;
}

static prom_status open_scene(prom_import *import, prom_error *error)
{
    prom_status status = prom_gltf_read(import, &import->gltf_file, error);
    if (status) return status;
    prom_import_doing(import, "reading the file");
    import->scene = read_file(import);
    if (!import->scene) return refused(import, error);
    prom_free(import->gltf_file.text.data);
    import->gltf_file.text = (prom_bytes){0};
    status = check_meshes(import, error);
    if (status) return status;
    prom_import_doing(import, "splitting its polygons into triangles");
    import->scene =
        aiApplyPostProcessing(import->scene, aiProcess_Triangulate | aiProcess_GenUVCoords |
                                                 aiProcess_TransformUVCoords);
    if (!import->scene) return damaged(import, aiGetErrorString(), error);
    return check_meshes(import, error);
}

// Known by its ending, or by the alpha modes that only its loader gives.
static bool is_gltf(const prom_import *import)
{
    const char *dot = extension(import->path);
    struct aiString mode;
    if (!strcasecmp(dot, ".gltf") || !strcasecmp(dot, ".glb")) return true;
    for (unsigned i = 0; i < import->scene->mNumMaterials; i++)
        if (aiGetMaterialString(import->scene->mMaterials[i], AI_MATKEY_GLTF_ALPHAMODE,
                                &mode) == aiReturn_SUCCESS)
            return true;
    return false;
}

// ---- nodes

static void matrix_from(const struct aiMatrix4x4 *m, double out[16])
{
    const double rows[16] = {m->a1, m->b1, m->c1, m->d1, m->a2, m->b2, m->c2, m->d2,
                             m->a3, m->b3, m->c3, m->d3, m->a4, m->b4, m->c4, m->d4};
    memcpy(out, rows, sizeof rows);
}

void prom_import_multiply(const double a[16], const double b[16], double out[16])
{
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++) {
            double sum = 0;
            for (int k = 0; k < 4; k++) sum += a[k * 4 + r] * b[c * 4 + k];
            out[c * 4 + r] = sum;
        }
}

static bool finite_matrix(const double m[16])
{
    for (int i = 0; i < 16; i++)
        if (!(fabs(m[i]) < 1e30)) return false;
    return true;
}

typedef struct pending {
    const struct aiNode *node;
    uint32_t parent;
} pending;

// What the file calls a node. Those of glTF may carry a number in its place.
static const char *node_name(prom_import *import, const struct aiNode *node)
{
    static const char prefix[] = PROM_GLTF_NODE;
    const prom_gltf *gltf = &import->gltf_file;
    if (!gltf->numbered) return node->mName.data;
    bool marked = !strncmp(node->mName.data, prefix, sizeof prefix - 1);
    unsigned long number =
        marked ? strtoul(node->mName.data + sizeof prefix - 1, NULL, 10) : ULONG_MAX;
    bool known = number < gltf->names.count;
    prom_array_push(&import->node_numbers, known ? (uint32_t)number : PROM_NONE);
    return known ? gltf->names.data[number] : node->mName.data;
}

// Appends one node; mesh_refs hold the scene's own mesh numbers for now.
static prom_status add_node(prom_import *import, pending at, prom_error *error)
{
    prom_source *source = import->source;
    const struct aiNode *node = at.node;
    prom_source_node out = {.parent = at.parent,
                            .name =
                                prom_arena_strdup(&source->strings, node_name(import, node)),
                            .until = INFINITY,
                            .first_mesh = (uint32_t)source->mesh_refs.count,
                            .mesh_count = node->mNumMeshes};
    matrix_from(&node->mTransformation, out.local);
    if (at.parent == PROM_NONE) prom_import_axes_apply(import, out.local);
    if (at.parent == PROM_NONE)
        memcpy(out.world, out.local, sizeof out.world);
    else
        prom_import_multiply(source->nodes.data[at.parent].world, out.local, out.world);
    if (!finite_matrix(out.local) || !finite_matrix(out.world))
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: the transform of node '%s' is not finite; the file is damaged",
                         import->path, out.name);
    for (unsigned k = 0; k < node->mNumMeshes; k++) {
        if (node->mMeshes[k] >= import->scene->mNumMeshes)
            return damaged(import, "a node names a mesh that does not exist", error);
        prom_array_push(&source->mesh_refs, node->mMeshes[k]);
    }
    prom_array_push(&source->nodes, out);
    return PROM_OK;
}

// Depth first, in the file's order, without recursion.
static prom_status read_nodes(prom_import *import, prom_error *error)
{
    PROM_ARRAY(pending) stack = {0};
    prom_status status = PROM_OK;
    prom_array_push(&stack, (pending){import->scene->mRootNode, PROM_NONE});
    while (stack.count && !status) {
        pending at = stack.data[--stack.count];
        uint32_t index = (uint32_t)import->source->nodes.count;
        status = index < MAX_NODES ? add_node(import, at, error)
                                   : damaged(import, "it has too many nodes", error);
        for (unsigned c = at.node->mNumChildren; c-- > 0;)
            prom_array_push(&stack, (pending){at.node->mChildren[c], index});
    }
    prom_array_finish(&stack);
    return status;
}

// ---- meshes and their materials

static void note_use(const struct aiMesh *mesh, prom_import_use *use)
{
    if (!use->used) use->min_alpha = 1;
    use->used = true;
    use->colored = use->colored || mesh->mColors[0];
    use->uncolored = use->uncolored || !mesh->mColors[0];
    for (unsigned v = 0; mesh->mColors[0] && v < mesh->mNumVertices; v++)
        if (mesh->mColors[0][v].a < use->min_alpha)
            use->min_alpha = fmaxf(mesh->mColors[0][v].a, 0);
}

static void read_meshes(prom_import *import, const bool *placed,
                        const prom_import_material_map *map, uint32_t *mesh_map)
{
    const struct aiScene *scene = import->scene;
    uint64_t dropped = 0;
    prom_import_doing(import, "converting its meshes");
    for (unsigned m = 0; m < scene->mNumMeshes; m++) {
        const struct aiMesh *mesh = scene->mMeshes[m];
        mesh_map[m] = PROM_NONE;
        if (!placed[m]) continue;
        bool known = mesh->mMaterialIndex < scene->mNumMaterials;
        const prom_import_material_map *material = known ? &map[mesh->mMaterialIndex] : NULL;
        prom_import_mesh_options options = {.uv_channel = material ? material->uv_channel : 0,
                                            .linear_colors = import->gltf,
                                            .material =
                                                material ? material->material : PROM_NONE};
        prom_mesh out;
        if (!prom_import_mesh_read(mesh, &options, &out, &dropped)) continue;
        mesh_map[m] = (uint32_t)import->source->meshes.count;
        prom_array_push(&import->source->meshes, out);
    }
    if (dropped)
        prom_import_warn(import, "%llu triangles with unusable coordinates are left out",
                         (unsigned long long)dropped);
}

// Renumbers the references and leaves out those to meshes without triangles.
static void renumber(prom_source *source, const uint32_t *mesh_map)
{
    uint32_t kept = 0;
    for (size_t n = 0; n < source->nodes.count; n++) {
        prom_source_node *node = &source->nodes.data[n];
        uint32_t first = node->first_mesh, count = node->mesh_count;
        node->first_mesh = kept;
        for (uint32_t k = first; k < first + count; k++) {
            uint32_t mesh = mesh_map[source->mesh_refs.data[k]];
            if (mesh != PROM_NONE) source->mesh_refs.data[kept++] = mesh;
        }
        node->mesh_count = kept - node->first_mesh;
    }
    source->mesh_refs.count = kept;
}

static void read_content(prom_import *import)
{
    const struct aiScene *scene = import->scene;
    prom_source *source = import->source;
    bool *placed = prom_calloc(scene->mNumMeshes, sizeof *placed);
    prom_import_use *uses = prom_calloc(scene->mNumMaterials, sizeof *uses);
    prom_import_material_map *map = prom_calloc(scene->mNumMaterials, sizeof *map);
    uint32_t *mesh_map = prom_calloc(scene->mNumMeshes, sizeof *mesh_map);
    for (size_t i = 0; i < source->mesh_refs.count; i++)
        placed[source->mesh_refs.data[i]] = true;
    for (unsigned m = 0; m < scene->mNumMeshes; m++)
        if (placed[m] && scene->mMeshes[m]->mMaterialIndex < scene->mNumMaterials)
            note_use(scene->mMeshes[m], &uses[scene->mMeshes[m]->mMaterialIndex]);
    prom_import_materials(import, uses, map);
    read_meshes(import, placed, map, mesh_map);
    renumber(source, mesh_map);
    prom_import_levels_attach(import);
    prom_free(placed);
    prom_free(uses);
    prom_free(map);
    prom_free(mesh_map);
}

prom_status prom_import_run(prom_import *import, prom_error *error)
{
    prom_status status = open_scene(import, error);
    if (status) return status;
    import->gltf = is_gltf(import);
    import->both_sides = prom_import_ac3d_both_sides(import->path);
    status = read_nodes(import, error);
    if (status) return status;
    read_content(import);
    if (!import->source->mesh_refs.count)
        return prom_fail(error, PROM_ERR_INPUT, "%s: has no triangles", import->path);
    return PROM_OK;
}

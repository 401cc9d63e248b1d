#include "builder/import_parts.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <ctype.h>

// Alpha below this is a hole where a format has no alpha mode of its own (glTF's default too).
#define CUTOFF 0.5f

typedef PROM_ARRAY(prom_import_picture) picture_list;

// A material on its way: what the file says, before the pictures are looked at.
typedef struct draft {
    bool done;
    float color[3]; // linear
    float opacity;
    uint32_t picture; // into the list, or PROM_NONE
    uint32_t uv_channel;
    enum { DRAFT_OPAQUE, DRAFT_MASK, DRAFT_BLEND, DRAFT_GUESS } mode;
    float cutoff;
    bool two_sided;
} draft;

static char *keep_string(prom_import *import, const struct aiString *s)
{
    char text[MAXLEN + 1] = {0};
    size_t n = s->length < MAXLEN ? s->length : MAXLEN, begin = 0;
    memcpy(text, s->data, n);
    n = strlen(text);
    while (n && isspace((unsigned char)text[n - 1])) text[--n] = 0;
    while (isspace((unsigned char)text[begin])) begin++;
    return prom_arena_strdup(&import->source->strings, text + begin);
}

// The name of the first texture of a kind, NULL if there is none.
static const char *texture_name(prom_import *import, const struct aiMaterial *material,
                                enum aiTextureType type, uint32_t *uv_channel)
{
    struct aiString path;
    unsigned channel = 0;
    if (aiGetMaterialTexture(material, type, 0, &path, NULL, &channel, NULL, NULL, NULL,
                             NULL) != aiReturn_SUCCESS)
        return NULL;
    const char *name = keep_string(import, &path);
    if (!*name) return NULL;
    if (uv_channel) *uv_channel = channel;
    return name;
}

static bool same_name(const char *a, const char *b)
{
    return a == b || (a && b && !strcmp(a, b));
}

static uint32_t picture_of(picture_list *list, const char *color, const char *mask,
                           const char *material)
{
    if (same_name(color, mask)) mask = NULL; // the picture's own alpha
    for (size_t i = 0; i < list->count; i++)
        if (same_name(list->data[i].color, color) && same_name(list->data[i].mask, mask))
            return (uint32_t)i;
    prom_array_push(list,
                    (prom_import_picture){.color = color, .mask = mask, .material = material});
    return (uint32_t)list->count - 1;
}

static float unit(float v)
{
    return v >= 1 ? 1 : v > 0 ? v : 0; // 0 for NaN
}

static bool get_color(const struct aiMaterial *material, const char *key, unsigned type,
                      unsigned index, float out[4])
{
    struct aiColor4D c;
    if (aiGetMaterialColor(material, key, type, index, &c) != aiReturn_SUCCESS) return false;
    out[0] = unit(c.r);
    out[1] = unit(c.g);
    out[2] = unit(c.b);
    out[3] = unit(c.a);
    return true;
}

// The light that a material gives off, linear; 0 where it is not of the picture that colours
// it. There is no emission here, only colour under a light that is much the same everywhere, so
// what glows becomes brighter, up to white, and takes its colours from the material's own
// picture.
static void get_emission(prom_import *import, const struct aiMaterial *material,
                         const char *color, float out[3])
{
    float glow[4] = {0}, strength = 1;
    const char *own = texture_name(import, material, aiTextureType_EMISSIVE, NULL);
    memset(out, 0, 3 * sizeof *out);
    if (own && !same_name(own, color)) return;
    if (!get_color(material, AI_MATKEY_COLOR_EMISSIVE, glow)) return;
    if (aiGetMaterialFloatArray(material, AI_MATKEY_EMISSIVE_INTENSITY, &strength, NULL) !=
            aiReturn_SUCCESS ||
        !(strength >= 0))
        strength = 1;
    for (int k = 0; k < 3; k++)
        out[k] = unit((import->gltf ? glow[k] : prom_srgb_to_linear(glow[k])) * strength);
}

static void draft_gltf(const struct aiMaterial *material, draft *d)
{
    float color[4] = {1, 1, 1, 1}, cutoff;
    if (!get_color(material, AI_MATKEY_BASE_COLOR, color))
        get_color(material, AI_MATKEY_COLOR_DIFFUSE, color);
    memcpy(d->color, color, sizeof d->color);
    d->opacity = color[3];
    struct aiString mode;
    d->mode = DRAFT_OPAQUE;
    if (aiGetMaterialString(material, AI_MATKEY_GLTF_ALPHAMODE, &mode) == aiReturn_SUCCESS) {
        if (!strcmp(mode.data, "MASK")) d->mode = DRAFT_MASK;
        if (!strcmp(mode.data, "BLEND")) d->mode = DRAFT_BLEND;
    }
    if (aiGetMaterialFloatArray(material, AI_MATKEY_GLTF_ALPHACUTOFF, &cutoff, NULL) ==
        aiReturn_SUCCESS)
        d->cutoff = unit(cutoff);
}

// Other formats: sRGB-encoded diffuse colour, no alpha mode.
static void draft_other(const struct aiMaterial *material, const prom_import_use *use, draft *d)
{
    float color[4] = {1, 1, 1, 1}, opacity;
    get_color(material, AI_MATKEY_COLOR_DIFFUSE, color);
    bool black = color[0] + color[1] + color[2] <= 0;
    // Exporters leave the colour black beside a texture; vertex colours replace it.
    if ((black && d->picture != PROM_NONE) || (use->colored && !use->uncolored))
        color[0] = color[1] = color[2] = 1;
    for (int k = 0; k < 3; k++) d->color[k] = prom_srgb_to_linear(color[k]);
    d->mode = DRAFT_GUESS;
    if (aiGetMaterialFloatArray(material, AI_MATKEY_OPACITY, &opacity, NULL) ==
        aiReturn_SUCCESS)
        d->opacity = unit(opacity);
    // Wholly invisible materials are an exporter's mix-up of opacity and transparency.
    if (d->opacity <= 0) d->opacity = 1;
}

static bool is_black(const struct aiMaterial *material, bool gltf)
{
    float color[4] = {1, 1, 1, 1};
    if (!gltf || !get_color(material, AI_MATKEY_BASE_COLOR, color))
        get_color(material, AI_MATKEY_COLOR_DIFFUSE, color);
    return color[0] + color[1] + color[2] <= 0;
}

static draft make_draft(prom_import *import, const struct aiMaterial *material,
                        const prom_import_use *use, picture_list *pictures)
{
    draft d = {
        .done = true, .opacity = 1, .picture = PROM_NONE, .cutoff = CUTOFF, .color = {1, 1, 1}};
    static const enum aiTextureType order[2][2] = {
        {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR},
        {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}};
    struct aiString given;
    const char *name = "";
    if (aiGetMaterialString(material, AI_MATKEY_NAME, &given) == aiReturn_SUCCESS)
        name = keep_string(import, &given);
    const char *color = texture_name(import, material, order[import->gltf][0], &d.uv_channel);
    if (!color) color = texture_name(import, material, order[import->gltf][1], &d.uv_channel);
    if (!color && is_black(material, import->gltf)) // a screen, a lamp
        color = texture_name(import, material, aiTextureType_EMISSIVE, &d.uv_channel);
    const char *mask = NULL;
    if (!import->gltf)
        mask =
            texture_name(import, material, aiTextureType_OPACITY, color ? NULL : &d.uv_channel);
    if (color || mask) d.picture = picture_of(pictures, color, mask, name);
    if (import->gltf)
        draft_gltf(material, &d);
    else
        draft_other(material, use, &d);
    // In other formats the emission of what has a colour is too often an exporter's whim.
    float glow[3];
    get_emission(import, material, color, glow);
    if (import->gltf || is_black(material, false))
        for (int k = 0; k < 3; k++) d.color[k] = fminf(d.color[k] + glow[k], 1);
    int two_sided = 0;
    unsigned one = 1;
    d.two_sided = import->both_sides ||
                  (aiGetMaterialIntegerArray(material, AI_MATKEY_TWOSIDED, &two_sided, &one) ==
                       aiReturn_SUCCESS &&
                   two_sided);
    return d;
}

// Decides the alpha mode by what the picture really holds, and leaves only fields that count,
// so that equal materials compare equal.
static prom_material settle(const draft *d, const prom_import_picture *picture, bool gltf,
                            float vertex_alpha)
{
    float texels = picture ? (float)picture->min_alpha / 255.0f : 1.0f;
    float least = d->opacity * texels * (gltf ? vertex_alpha : 1.0f);
    prom_material m = {.base_color = {d->color[0], d->color[1], d->color[2], 1},
                       .texture = d->picture,
                       .double_sided = d->two_sided};
    bool blend = d->mode == DRAFT_BLEND && least < 1;
    bool mask = d->mode == DRAFT_MASK && least < d->cutoff;
    if (d->mode == DRAFT_GUESS) {
        mask = texels < d->cutoff;
        blend = !mask && d->opacity < 1;
    }
    if (mask || blend) {
        m.alpha_mode = mask ? PROM_ALPHA_MASK : PROM_ALPHA_BLEND;
        m.base_color[3] = mask && !gltf ? 1 : d->opacity;
        m.alpha_cutoff = mask ? d->cutoff : 0;
        // Formats without a flag: leaves and grilles are seen from both sides.
        if (mask && !gltf) m.double_sided = 1;
    }
    return m;
}

static uint32_t merge(prom_source *source, const prom_material *m)
{
    for (size_t i = source->materials.count; i-- > 0;)
        if (!memcmp(&source->materials.data[i], m, sizeof *m)) return (uint32_t)i;
    prom_array_push(&source->materials, *m);
    return (uint32_t)source->materials.count - 1;
}

void prom_import_materials(prom_import *import, const prom_import_use *uses,
                           prom_import_material_map *map)
{
    const struct aiScene *scene = import->scene;
    picture_list pictures = {0};
    draft *drafts = prom_calloc(scene->mNumMaterials, sizeof *drafts);
    for (unsigned i = 0; i < scene->mNumMaterials; i++)
        if (uses[i].used)
            drafts[i] = make_draft(import, scene->mMaterials[i], &uses[i], &pictures);
    prom_import_pictures(import, pictures.data, pictures.count);
    for (unsigned i = 0; i < scene->mNumMaterials; i++) {
        const draft *d = &drafts[i];
        if (!d->done) continue;
        const prom_import_picture *p =
            d->picture == PROM_NONE ? NULL : &pictures.data[d->picture];
        prom_material m = settle(d, p, import->gltf, uses[i].min_alpha);
        map[i] = (prom_import_material_map){merge(import->source, &m), d->uv_channel};
    }
    for (size_t i = 0; i < pictures.count; i++) {
        prom_import_picture *p = &pictures.data[i];
        prom_array_push(&import->source->images,
                        (prom_source_image){.name = (char *)(p->color ? p->color : p->mask),
                                            .mask = (char *)(p->mask ? p->mask : ""),
                                            .width = p->width,
                                            .height = p->height,
                                            .rgba = p->rgba,
                                            .missing = p->missing});
    }
    prom_free(drafts);
    prom_array_finish(&pictures);
}

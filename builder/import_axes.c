// Up axis and unit: the source is y up and in metres where the file says its unit.
//
// What loaders do (assimp 5.2): Collada applies both; 3DS turns z to y; FBX leaves both to the
// reader of its metadata; the others have neither, and what they hold is taken as y up.
#include "builder/import_parts.h"

#include <assimp/config.h>
#include <strings.h>

static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
// Turns z up to y up, and x stays.
static const double z_to_y[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
static const double y_to_z[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};

static bool ends_in(const char *path, const char *ending)
{
    size_t n = strlen(path), m = strlen(ending);
    return n > m && !strcasecmp(path + n - m, ending);
}

void prom_import_axes_prepare(const prom_import *import, struct aiPropertyStore *settings)
{
    // One node for each of the file's, rather than one for each pivot.
    aiSetImportPropertyInteger(settings, AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, 0);
    aiSetImportPropertyInteger(settings, AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, 0);
    // Triangles that show the bones of a file without any are none of its own.
    aiSetImportPropertyInteger(settings, AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);
    if (import->options.up != PROM_UP_FROM_FILE)
        aiSetImportPropertyInteger(settings, AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, 1);
}

static const struct aiMetadataEntry *find(const struct aiScene *scene, const char *key)
{
    const struct aiMetadata *m = scene->mMetaData;
    for (unsigned i = 0; m && i < m->mNumProperties; i++)
        if (!strcmp(m->mKeys[i].data, key) && m->mValues[i].mData) return &m->mValues[i];
    return NULL;
}

static double number(const struct aiScene *scene, const char *key, double otherwise)
{
    const struct aiMetadataEntry *e = find(scene, key);
    double value = otherwise;
    if (e && e->mType == AI_INT32) value = *(const int32_t *)e->mData;
    if (e && e->mType == AI_FLOAT) value = *(const float *)e->mData;
    if (e && e->mType == AI_DOUBLE) value = *(const double *)e->mData;
    return isfinite(value) ? value : otherwise;
}

// FBX: which of its axes is up, towards the viewer, and to the right, each with a sign. False
// when that is no frame.
static bool fbx_axes(const struct aiScene *scene, double out[16])
{
    static const char *const keys[3][2] = {{"CoordAxis", "CoordAxisSign"},
                                           {"UpAxis", "UpAxisSign"},
                                           {"FrontAxis", "FrontAxisSign"}};
    static const int usual[3] = {0, 1, 2};
    bool used[3] = {false};
    memset(out, 0, 16 * sizeof *out);
    out[15] = 1;
    for (int row = 0; row < 3; row++) {
        double axis = number(scene, keys[row][0], usual[row]);
        double sign = number(scene, keys[row][1], 1);
        int column = axis >= 0 && axis <= 2 ? (int)axis : -1;
        if (column < 0 || used[column] || sign == 0) return false;
        used[column] = true;
        out[column * 4 + row] = sign < 0 ? -1 : 1;
    }
    return true;
}

static void turn(double m[16], const double by[16])
{
    double out[16];
    prom_import_multiply(by, m, out);
    memcpy(m, out, sizeof out);
}

void prom_import_axes_apply(prom_import *import, double root[16])
{
    const prom_import_options *o = &import->options;
    const struct aiScene *scene = import->scene;
    bool fbx = ends_in(import->path, ".fbx"), max = ends_in(import->path, ".3ds");
    double own[16], unit = 1;
    if (fbx) unit = 0.01 * number(scene, "UnitScaleFactor", 100);
    if (o->unit_m > 0) unit = o->unit_m;
    if (o->unit_m > 0 && ends_in(import->path, ".dae")) {
        double had = sqrt(root[0] * root[0] + root[1] * root[1] + root[2] * root[2]);
        if (had > 0) unit /= had; // the file's own unit, which the loader has put there
    }
    if (!(unit > 1e-9) || !(unit < 1e9)) unit = 1;
    if (o->up == PROM_UP_FROM_FILE) {
        if (fbx && fbx_axes(scene, own)) turn(root, own);
    } else {
        if (max) turn(root, y_to_z);
        if (o->up == PROM_UP_Z) turn(root, z_to_y);
    }
    double scale[16];
    memcpy(scale, identity, sizeof scale);
    scale[0] = scale[5] = scale[10] = unit;
    turn(root, scale);
    import->unit = unit;
}

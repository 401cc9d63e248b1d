// LINK: prom_builder prom_metaobj PkgConfig::ASSIMP
// One small scene in every format that assimp writes, and what comes back: names, sizes,
// colours, pictures, up axis and unit. And its picture in every format.
#include "scene_files.h"

#include "builder/image_io.h"
#include "builder/import_parts.h"
#include "metaobj/base/log.h"

#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <signal.h>

// A wall of 4 x 2 x 1, and on it a sign up to y = 3; counter-clockwise seen from outside.
#define FACES(a, b, c, d, e, f, g, h)                                                          \
    "f " #a "/1 " #c "/2 " #d "/3 " #b "/4\nf " #e "/1 " #f "/2 " #h "/3 " #g "/4\n"           \
    "f " #a "/1 " #b "/2 " #f "/3 " #e "/4\nf " #c "/1 " #g "/2 " #h "/3 " #d "/4\n"           \
    "f " #a "/1 " #e "/2 " #g "/3 " #c "/4\nf " #b "/1 " #d "/2 " #h "/3 " #f "/4\n"
static const char scene_obj[] =
    "mtllib m.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "o wall\nusemtl brick\nv 0 0 0\nv 4 0 0\nv 0 2 0\nv 4 2 0\nv 0 0 1\nv 4 0 1\nv 0 2 1\n"
    "v 4 2 1\n" FACES(1, 2, 3, 4, 5, 6, 7, 8) //
    "o sign\nusemtl painted\nv 1 2 0\nv 2 2 0\nv 1 3 0\nv 2 3 0\nv 1 2 0.5\nv 2 2 0.5\n"
    "v 1 3 0.5\nv 2 3 0.5\n" FACES(9, 10, 11, 12, 13, 14, 15, 16);
static const char scene_mtl[] = "newmtl brick\nKd 0.5 0.25 0.125\nnewmtl painted\nKd 1 1 1\n"
                                "map_Kd tiles.png\n";

static void write_scene(void)
{
    uint8_t tiles[4 * 4 * 3];
    for (int i = 0; i < 16; i++) memcpy(tiles + 3 * i, (uint8_t[3]){200, 30, 60}, 3);
    assert_int_equal(prom_image_write_png(scene_path("tiles.png"), 4, 4, 3, tiles, NULL), 0);
    scene_write("m.mtl", scene_mtl);
    scene_write("m.obj", scene_obj);
}

static const char *export_as(const char *format, const char *name)
{
    write_scene();
    const struct aiScene *scene =
        aiImportFile(scene_path("m.obj"), aiProcess_Triangulate | aiProcess_GenNormals);
    assert_non_null(scene);
    const char *path = scene_path(name);
    assert_int_equal(aiExportScene(scene, format, path, 0), aiReturn_SUCCESS);
    aiReleaseImport(scene);
    return path;
}

static prom_source import_with(const char *path, const prom_import_options *options)
{
    prom_source source;
    prom_error error = {0};
    if (prom_source_import(path, options, &source, &error)) fail_msg("%s", error.text);
    return source;
}

// The box in the world; the sign shows where up is.
static void world_box(const prom_source *s, double box[6])
{
    for (int k = 0; k < 6; k++) box[k] = k < 3 ? INFINITY : -INFINITY;
    for (size_t n = 0; n < s->nodes.count; n++) {
        const prom_source_node *node = &s->nodes.data[n];
        for (uint32_t r = 0; r < node->mesh_count; r++) {
            const prom_mesh *m = &s->meshes.data[s->mesh_refs.data[node->first_mesh + r]];
            for (uint32_t v = 0; v < m->vertex_count; v++)
                for (int k = 0; k < 3; k++) {
                    double p = node->world[12 + k];
                    for (int c = 0; c < 3; c++)
                        p += node->world[4 * c + k] * (double)m->vertices[v].position[c];
                    box[k] = fmin(box[k], p);
                    box[3 + k] = fmax(box[3 + k], p);
                }
        }
    }
}

static void expect_box(const prom_source *s, double unit, const double expected[6])
{
    double box[6];
    world_box(s, box);
    for (int k = 0; k < 6; k++)
        if (fabs(box[k] - unit * expected[k]) > 1e-4 * unit)
            fail_msg("side %d of the box is at %g, not %g", k, box[k], unit * expected[k]);
}

static const double upright[6] = {0, 0, 0, 4, 3, 1};
static const double was_z_up[6] = {0, 0, -3, 4, 1, 0}; // z of the file is now y

static uint32_t triangles_of(const prom_source *s)
{
    uint32_t count = 0;
    for (size_t i = 0; i < s->mesh_refs.count; i++)
        count += s->meshes.data[s->mesh_refs.data[i]].index_count / 3;
    return count;
}

static bool has_node(const prom_source *s, const char *name)
{
    for (size_t i = 0; i < s->nodes.count; i++)
        if (!strcmp(s->nodes.data[i].name, name)) return true;
    return false;
}

// Which way the triangles look: the volume that they enclose, in the frame of their meshes.
static double volume_of(const prom_source *s)
{
    double sum = 0;
    for (size_t i = 0; i < s->mesh_refs.count; i++) {
        const prom_mesh *m = &s->meshes.data[s->mesh_refs.data[i]];
        for (uint32_t t = 0; t < m->index_count; t += 3) {
            const float *a = m->vertices[m->indices[t]].position;
            const float *b = m->vertices[m->indices[t + 1]].position;
            const float *c = m->vertices[m->indices[t + 2]].position;
            sum += (double)(a[0] * (b[1] * c[2] - b[2] * c[1]) +
                            a[1] * (b[2] * c[0] - b[0] * c[2]) +
                            a[2] * (b[0] * c[1] - b[1] * c[0])) /
                   6;
        }
    }
    return sum;
}

// ---- what each format keeps

enum { NAMES = 1, COLORS = 2, PICTURE = 4, LIES = 8, CENTIMETRES = 16, ALL = 7 };

static void every_format_arrives(void **state)
{
    (void)state;
    static const struct {
        const char *format, *file;
        int keeps;
    } formats[] = {
        {"obj", "a.obj", ALL},
        {"stl", "a.stl", 0},
        {"stlb", "b.stl", 0},
        {"ply", "a.ply", PICTURE},
        {"plyb", "b.ply", PICTURE},
        {"collada", "a.dae", ALL},
        {"3ds", "a.3ds", ALL | LIES},         // z up by custom, as written here y up
        {"fbxa", "a.fbx", ALL | CENTIMETRES}, // assimp says so and does not scale
        {"x", "a.x", NAMES | PICTURE},        // assimp writes every colour white
        {"glb2", "a.glb", ALL},
        {"gltf2", "a.gltf", ALL},
        {"3mf", "a.3mf", 0},
    };
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        int keeps = formats[i].keeps;
        print_message("%s\n", formats[i].file);
        prom_source s = import_with(export_as(formats[i].format, formats[i].file), NULL);
        assert_int_equal(triangles_of(&s), 24);
        expect_box(&s, keeps & CENTIMETRES ? 0.01 : 1, keeps & LIES ? was_z_up : upright);
        double unit3 = volume_of(&s) / 8.5; // 8 and 0.5 where the frame is that of the file
        assert_true(unit3 > 0.99 && unit3 < 1.01);
        if (keeps & NAMES) assert_true(has_node(&s, "wall") && has_node(&s, "sign"));
        bool brick = false, tiles = false;
        for (size_t k = 0; k < s.materials.count; k++) {
            const prom_material *m = &s.materials.data[k];
            // glTF's factors are linear and assimp writes the numbers as they are.
            float red = m->base_color[0];
            brick = brick || (m->texture == PROM_NONE &&
                              (fabsf(red - 0.214f) < 0.01f || fabsf(red - 0.5f) < 0.01f));
            tiles = tiles || (m->texture != PROM_NONE && !s.images.data[m->texture].missing &&
                              s.images.data[m->texture].rgba[0] == 200);
        }
        if (keeps & COLORS) assert_true(brick);
        if (keeps & PICTURE) assert_true(tiles);
        prom_source_finish(&s);
    }
}

// ---- up axis and unit

static char *read_text(const char *path)
{
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 20) - 1, f) > 0);
    fclose(f);
    return text;
}

// Replaces text that must be there.
static void change(const char *path, const char *from, const char *to)
{
    char *text = read_text(path), *at = strstr(text, from);
    if (!at) fail_msg("'%s' is not in %s", from, path);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fprintf(f, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    fclose(f);
    free(text);
}

static void files_say_their_unit_and_axis(void **state)
{
    (void)state;
    const char *fbx = export_as("fbxa", "u.fbx"), *dae = export_as("collada", "u.dae");
    change(fbx, "\"UnitScaleFactor\", \"double\", \"Number\", \"\", 1",
           "\"UnitScaleFactor\", \"double\", \"Number\", \"\", 2.54");
    change(fbx, "\"UpAxis\", \"int\", \"Integer\", \"\", 1",
           "\"UpAxis\", \"int\", \"Integer\", \"\", 2");
    change(fbx, "\"FrontAxis\", \"int\", \"Integer\", \"\", 2",
           "\"FrontAxis\", \"int\", \"Integer\", \"\", 1");
    change(fbx, "\"FrontAxisSign\", \"int\", \"Integer\", \"\", 1",
           "\"FrontAxisSign\", \"int\", \"Integer\", \"\", -1");
    change(dae, "meter=\"1\"", "meter=\"0.0254\"");
    change(dae, "Y_UP", "Z_UP");
    const char *paths[] = {fbx, dae};
    for (int i = 0; i < 2; i++) {
        prom_source s = import_with(paths[i], NULL);
        expect_box(&s, 0.0254, was_z_up);
        prom_source_finish(&s);
        // Whoever knows better says so.
        prom_import_options better = {.up = PROM_UP_Y, .unit_m = 0.5};
        s = import_with(paths[i], &better);
        expect_box(&s, 0.5, upright);
        prom_source_finish(&s);
    }
}

static void options_set_unit_and_axis(void **state)
{
    (void)state;
    static const char *const formats[][2] = {{"obj", "o.obj"},     {"stl", "o.stl"},
                                             {"3ds", "o.3ds"},     {"glb2", "o.glb"},
                                             {"collada", "o.dae"}, {"ply", "o.ply"}};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        const char *path = export_as(formats[i][0], formats[i][1]);
        prom_import_options y = {.up = PROM_UP_Y}, z = {.up = PROM_UP_Z, .unit_m = 0.001};
        prom_source a = import_with(path, &y), b = import_with(path, &z);
        expect_box(&a, 1, upright);
        expect_box(&b, 0.001, was_z_up);
        assert_int_not_equal(a.content_hash, b.content_hash);
        prom_source_finish(&a);
        prom_source_finish(&b);
    }
    prom_source s;
    prom_error error;
    const double wrong[] = {-1, NAN, INFINITY, 1e-300};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        prom_import_options bad = {.unit_m = wrong[i]};
        assert_int_equal(prom_source_import(scene_path("o.obj"), &bad, &s, &error),
                         PROM_ERR_USAGE);
    }
}

// ---- AC3D, which assimp does not write

static void an_ac3d_file_arrives(void **state)
{
    (void)state;
    write_scene();
    // A quad with a picture, seen from both sides (0x20), below a group that is moved.
    prom_source s = import_with(
        scene_write("a.ac",
                    "AC3Db\nMATERIAL \"m\" rgb 1 0.5 0.25  amb 0.2 0.2 0.2  emis 0 0 0  "
                    "spec 0 0 0  shi 10  trans 0\nOBJECT world\nkids 1\n"
                    "OBJECT group\nname \"town\"\nloc 10 0 0\nkids 1\n"
                    "OBJECT poly\nname \"board\"\ntexture \"TILES.PNG\"\nnumvert 4\n"
                    "0 0 0\n1 0 0\n1 2 0\n0 2 0\nnumsurf 1\nSURF 0x20\nmat 0\n"
                    "refs 4\n0 0 0\n1 1 0\n2 1 1\n3 0 1\nkids 0\n"),
        NULL);
    assert_int_equal(triangles_of(&s), 2);
    assert_true(has_node(&s, "town"));
    assert_true(has_node(&s, "board"));
    expect_box(&s, 1, (double[6]){10, 0, 0, 11, 2, 0});
    const prom_material *m =
        &s.materials.data[s.meshes.data[s.mesh_refs.data[0]].submeshes[0].material];
    assert_int_equal(m->double_sided, 1);
    assert_true(m->texture != PROM_NONE && !s.images.data[m->texture].missing);
    prom_source_finish(&s);
}

// ---- emission

static void what_glows_is_bright(void **state)
{
    (void)state;
    prom_source s = import_with(
        scene_write_gltf(
            "glow.gltf",
            "\"scenes\":[{\"nodes\":[0]}],\"scene\":0,\"nodes\":[{\"mesh\":0}],\"materials\":["
            "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.4,0.4,0.1,1]},"
            "\"emissiveFactor\":[0.4,0.9,0]}],"
            "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}]"),
        NULL);
    const float *c = s.materials.data[0].base_color;
    assert_float_equal(c[0], 0.8, 1e-6);
    assert_float_equal(c[1], 1, 1e-6);
    assert_float_equal(c[2], 0.1, 1e-6);
    prom_source_finish(&s);
}

// ---- pictures

static size_t decode64(const char *text, uint8_t *out)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint32_t bits = 0;
    size_t n = 0, filled = 0;
    for (; *text && *text != '='; text++) {
        bits = bits << 6 | (uint32_t)(strchr(digits, *text) - digits);
        filled += 6;
        if (filled < 8) continue;
        filled -= 8;
        out[n++] = (uint8_t)(bits >> filled);
    }
    return n;
}

// 4 x 4: red on the left half, green half up on the upper half, blue a quarter everywhere.
static const char jpeg64[] =
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDAAEBAQEBAQEBAQEBAQECAgMCAgICAgQDAwIDBQQFBQUEBAQFBgcGBQUH"
    "BgQEBgkGBwgICAgIBQYJCgkICgcICAj/2wBDAQEBAQICAgQCAgQIBQQFCAgICAgICAgICAgICAgICAgICAgICAgI"
    "CAgICAgICAgICAgICAgICAgICAgICAgICAj/wAARCAAEAAQDAREAAhEBAxEB/8QAFAABAAAAAAAAAAAAAAAAAAAA"
    "Cv/EABwQAAEDBQAAAAAAAAAAAAAAAAgABFQHGCdFY//EABQBAQAAAAAAAAAAAAAAAAAAAAf/xAAlEQAAAgcJAAAA"
    "AAAAAAAAAAAAAwIEBgckVGIFCAkWF0JDUlP/2gAMAwEAAhEDEQA/ACzmKYBF3HVFyJA1DGA34pWci5NmMrqsN33m"
    "eidYa8Ua7qxuu1uwcryGyavWP//Z";
// The same in half floats, uncompressed, with blue at 3.
static const char exr64[] =
    "di8xAQIAAABjaGFubmVscwBjaGxpc3QANwAAAEIAAQAAAAAAAAABAAAAAQAAAEcAAQAAAAAAAAABAAAAAQAAAFIA"
    "AQAAAAAAAAABAAAAAQAAAABjb21wcmVzc2lvbgBjb21wcmVzc2lvbgABAAAAAGRhdGFXaW5kb3cAYm94MmkAEAAA"
    "AAAAAAAAAAAAAwAAAAMAAABkaXNwbGF5V2luZG93AGJveDJpABAAAAAAAAAAAAAAAAMAAAADAAAAbGluZU9yZGVy"
    "AGxpbmVPcmRlcgABAAAAAHBpeGVsQXNwZWN0UmF0aW8AZmxvYXQABAAAAAAAgD9zY3JlZW5XaW5kb3dDZW50ZXIA"
    "djJmAAgAAAAAAAAAAAAAAHNjcmVlbldpbmRvd1dpZHRoAGZsb2F0AAQAAAAAAIA/AFkBAAAAAAAAeQEAAAAAAACZ"
    "AQAAAAAAALkBAAAAAAAAAAAAABgAAAAAQgBCAEIAQgA4ADgAOAA4ADwAPAAAAAABAAAAGAAAAABCAEIAQgBCADgA"
    "OAA4ADgAPAA8AAAAAAIAAAAYAAAAAEIAQgBCAEIAAAAAAAAAAAA8ADwAAAAAAwAAABgAAAAAQgBCAEIAQgAAAAAA"
    "AAAAADwAPAAAAAA=";

static void put16(uint8_t *at, uint32_t v)
{
    at[0] = (uint8_t)v;
    at[1] = (uint8_t)(v >> 8);
}

static void put32(uint8_t *at, uint32_t v)
{
    put16(at, v);
    put16(at + 2, v >> 16);
}

static void rgb_at(int x, int y, uint8_t rgb[3])
{
    rgb[0] = x < 2 ? 255 : 0;
    rgb[1] = y < 2 ? 128 : 0;
    rgb[2] = 64;
}

static size_t make_tga(uint8_t *out)
{
    memset(out, 0, 18);
    out[2] = 2; // true colour
    out[12] = out[14] = 4;
    out[16] = 24;
    for (int i = 0; i < 16; i++) { // rows from below, blue first
        uint8_t rgb[3];
        rgb_at(i % 4, 3 - i / 4, rgb);
        for (int k = 0; k < 3; k++) out[18 + 3 * i + k] = rgb[2 - k];
    }
    return 18 + 48;
}

static size_t make_bmp(uint8_t *out)
{
    uint8_t tga[128];
    make_tga(tga);
    memset(out, 0, 54);
    memcpy(out, "BM", 2);
    put32(out + 2, 54 + 48);
    put32(out + 10, 54);
    put32(out + 14, 40);
    put32(out + 18, 4);
    put32(out + 22, 4);
    put16(out + 26, 1);
    put16(out + 28, 24);
    memcpy(out + 54, tga + 18, 48); // rows of 12 bytes need no filling
    return 54 + 48;
}

static size_t make_tiff(uint8_t *out)
{
    static const uint32_t tags[][3] = {{256, 4, 0},  {257, 4, 0}, {258, 8, 3}, {259, 1, 0},
                                       {262, 2, 0},  {273, 8, 1}, {277, 3, 0}, {278, 4, 0},
                                       {279, 48, 0}, {284, 1, 0}};
    enum { COUNT = 10, ENTRY = 12, BITS = 10 + COUNT * ENTRY + 4, TEXELS = BITS + 8 };
    memset(out, 0, TEXELS);
    memcpy(out, "II*\0", 4);
    put32(out + 4, 8);
    put16(out + 8, COUNT);
    for (int i = 0; i < COUNT; i++) {
        uint8_t *e = out + 10 + i * ENTRY;
        bool three = tags[i][2] == 3, strip = tags[i][0] == 273;
        put16(e, tags[i][0]);
        put16(e + 2, strip ? 4 : 3);
        put32(e + 4, three ? 3 : 1);
        if (three || strip)
            put32(e + 8, three ? BITS : TEXELS);
        else
            put16(e + 8, tags[i][1]);
    }
    for (int k = 0; k < 3; k++) put16(out + BITS + 2 * k, 8);
    for (int i = 0; i < 16; i++) rgb_at(i % 4, i / 4, out + TEXELS + 3 * i);
    return TEXELS + 48;
}

// One block: two colours, the left half the first, the right half the second.
static size_t make_dds(uint8_t *out)
{
    memset(out, 0, 136);
    memcpy(out, "DDS ", 4);
    put32(out + 4, 124);
    put32(out + 8, 0x1007);
    put32(out + 12, 4);
    put32(out + 16, 4);
    put32(out + 76, 32);
    put32(out + 80, 4); // a four-letter code:
    memcpy(out + 84, "DXT1", 4);
    put32(out + 108, 0x1000);
    put16(out + 128, 0xf808); // red, and a quarter of blue
    put16(out + 130, 0x0008);
    memset(out + 132, 0x50, 4); // 0 0 1 1 in each row
    return 136;
}

static void expect_picture(const char *name, const uint8_t *data, size_t bytes, int green,
                           int blue, int slack)
{
    scene_write("p.mtl", "newmtl p\nKd 1 1 1\nmap_Kd p.pic\n");
    scene_write_bytes("p.pic", data, bytes);
    prom_source s = import_with(
        scene_write("p.obj", "mtllib p.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                             "usemtl p\nf 1/1 2/2 3/3\n"),
        NULL);
    const prom_source_image *image = &s.images.data[0];
    if (image->missing) fail_msg("%s is not read", name);
    assert_int_equal(image->width, 4);
    for (int corner = 0; corner < 4; corner++) {
        const uint8_t *p = image->rgba + 4 * ((corner & 1) * 3 + (corner >> 1) * 12);
        int wanted[3] = {corner & 1 ? 0 : 255, corner >> 1 ? 0 : green, blue};
        for (int k = 0; k < 3; k++)
            if (abs(p[k] - wanted[k]) > slack)
                fail_msg("%s: corner %d has %d in channel %d, not %d", name, corner, p[k], k,
                         wanted[k]);
        assert_int_equal(p[3], 255);
    }
    prom_source_finish(&s);
}

static void every_picture_is_read(void **state)
{
    (void)state;
    uint8_t data[2048], rgba[4 * 4 * 3], *png;
    expect_picture("TGA", data, make_tga(data), 128, 64, 0);
    expect_picture("BMP", data, make_bmp(data), 128, 64, 0);
    expect_picture("TIFF", data, make_tiff(data), 128, 64, 0);
    for (int i = 0; i < 16; i++) rgb_at(i % 4, i / 4, rgba + 3 * i);
    size_t bytes;
    assert_int_equal(prom_image_encode_png(4, 4, 3, rgba, &png, &bytes, NULL), 0);
    expect_picture("PNG", png, bytes, 128, 64, 0);
    prom_free(png);
    // Block compression knows no green here.
    expect_picture("DDS", data, make_dds(data), 0, 66, 1);
    // Linear light, clamped: 0.5 is sRGB 188, 3 is white.
    expect_picture("EXR", data, decode64(exr64, data), 188, 255, 0);
    expect_picture("JPEG", data, decode64(jpeg64, data), 128, 64, 6);
}

// ---- decoders that die

static void crash_on_bad(const char *name)
{
    if (strstr(name, "bad")) raise(SIGSEGV);
}

static void hang_on_bad(const char *name)
{
    while (strstr(name, "bad")) pause();
}

static void spin_on_bad(const char *name)
{
    while (strstr(name, "bad")) {
        for (volatile unsigned i = 0; i < 1000000; i++) {
        }
    }
}

static void a_picture_that_kills_its_decoder_is_lost_alone(void **state)
{
    (void)state;
    static void (*const hooks[])(const char *) = {crash_on_bad, hang_on_bad, spin_on_bad};
    char obj[4096] = "mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";
    char mtl[2048] = "";
    write_scene();
    uint8_t texels[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    for (int i = 0; i < 12; i++) {
        char name[32], row[128];
        snprintf(name, sizeof name, "%s%d.png", i % 5 == 2 ? "bad" : "good", i);
        prom_image_write_png(scene_path(name), 2, 2, 3, texels, NULL);
        snprintf(row, sizeof row, "newmtl m%d\nKd 1 1 1\nmap_Kd %s\n", i, name);
        strcat(mtl, row);
        snprintf(row, sizeof row, "usemtl m%d\nf 1/1 2/2 3/3\n", i);
        strcat(obj, row);
    }
    scene_write("many.mtl", mtl);
    const char *path = scene_write("many.obj", obj);
    for (size_t h = 0; h < sizeof hooks / sizeof *hooks; h++) {
        prom_import_options brief = {.time_s = 10};
        prom_import_picture_hook = hooks[h];
        prom_source s = import_with(path, &brief);
        prom_import_picture_hook = NULL;
        assert_int_equal(s.images.count, 12);
        for (size_t i = 0; i < 12; i++) {
            const prom_source_image *image = &s.images.data[i];
            assert_int_equal(image->missing, strstr(image->name, "bad") != NULL);
            if (!image->missing) assert_memory_equal(image->rgba, "\1\2\3\377\4\5\6\377", 8);
        }
        prom_source_finish(&s);
    }
}

int main(void)
{
    prom_log_set_level(PROM_LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_arrives),
        cmocka_unit_test(files_say_their_unit_and_axis),
        cmocka_unit_test(options_set_unit_and_axis),
        cmocka_unit_test(an_ac3d_file_arrives),
        cmocka_unit_test(what_glows_is_bright),
        cmocka_unit_test(every_picture_is_read),
        cmocka_unit_test(a_picture_that_kills_its_decoder_is_lost_alone),
    };
    return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}

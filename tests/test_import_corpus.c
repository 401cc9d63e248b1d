// LINK: prom_builder prom_metaobj PkgConfig::JANSSON
// LABEL: slow
// Import against files that others made: broken ones, and real scenes. Skipped without them.
// Leaves a table of the outcomes in malformed-outcomes.md in the working folder.
#include "builder/source.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"

#include <ftw.h>
#include <jansson.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#define LIMIT_S 60.0

typedef struct outcome {
    char *file; // below the corpus
    const char *kind;
    char *message;
    double seconds;
} outcome;

static struct {
    PROM_ARRAY(outcome) rows;
    size_t prefix; // length of the corpus's own path, with the slash
} corpus;

static const char *shared(const char *name)
{
    static char path[4096];
    const char *base = getenv("PROM_SHARED");
    snprintf(path, sizeof path, "%s/%s", base ? base : "../shared", name);
    if (!access(path, R_OK)) return path;
    print_message("skipped: %s is not there\n", path);
    skip();
    return NULL;
}

static int visit(const char *path, const struct stat *info, int kind, struct FTW *where)
{
    (void)info;
    (void)where;
    if (kind == FTW_F)
        prom_array_push(&corpus.rows, (outcome){.file = prom_strdup(path + corpus.prefix)});
    return 0;
}

static int by_file(const void *pa, const void *pb)
{
    const outcome *a = pa, *b = pb;
    return strcmp(a->file, b->file);
}

// What a refusal says, in a word.
static const char *kind_of(const char *message)
{
    static const char *const kinds[][2] = {
        {"no known scene format", "no scene"},    {"has no triangles", "no triangles"},
        {"mesh data is missing", "data missing"}, {"did not end within", "too slow"},
        {"ran out of memory", "out of memory"},   {"loader crashed", "loader crashed"},
        {"loader failed", "loader crashed"}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strstr(message, kinds[i][0])) return kinds[i][1];
    return "damaged";
}

// The message without the path, and fit for a table.
static char *plain(const char *message, const char *path)
{
    size_t n = strlen(path);
    char *text = prom_strdup(strncmp(message, path, n) ? message : message + n + 2);
    for (char *c = text; *c; c++)
        if (*c == '|' || *c == '`') *c = '/';
    return text;
}

static void try_file(const char *folder, outcome *row)
{
    prom_import_options options = {.time_s = 20, .memory_bytes = (uint64_t)2 << 30};
    prom_source source;
    prom_error error = {0};
    char *path = prom_format("%s/%s", folder, row->file);
    double start = prom_clock_ms();
    prom_status status = prom_source_import(path, &options, &source, &error);
    row->seconds = (prom_clock_ms() - start) / 1000;
    if (row->seconds > LIMIT_S) fail_msg("%s took %.1f s", row->file, row->seconds);
    if (status) {
        assert_int_equal(status, PROM_ERR_INPUT);
        assert_non_null(strstr(error.text, path));
        assert_null(strchr(error.text, '\n'));
        row->kind = kind_of(error.text);
        row->message = plain(error.text, path);
    } else {
        uint64_t triangles = 0;
        for (size_t m = 0; m < source.meshes.count; m++) {
            assert_null(
                prom_mesh_check(&source.meshes.data[m], (uint32_t)source.materials.count));
            triangles += source.meshes.data[m].index_count / 3;
        }
        row->kind = "imported";
        row->message = prom_format("%llu triangles", (unsigned long long)triangles);
        prom_source_finish(&source);
    }
    prom_free(path);
}

// Files that a validator finds no error in: nothing in them can be shown, and that is said.
static void check_sound(const char *folder, const outcome *row, unsigned *sound)
{
    char *path = prom_format("%s/%s.report.json", folder, row->file);
    json_t *report = json_load_file(path, 0, NULL);
    prom_free(path);
    if (!report) return;
    const json_t *errors = json_object_get(json_object_get(report, "issues"), "numErrors");
    if (json_is_integer(errors) && json_integer_value(errors) == 0) {
        ++*sound;
        if (strcmp(row->kind, "no triangles") && strcmp(row->kind, "data missing"))
            fail_msg("%s: %s, %s", row->file, row->kind, row->message);
    }
    json_decref(report);
}

static const char *const kind_order[] = {"imported", "no triangles", "data missing",
                                         "damaged",  "no scene",     "loader crashed",
                                         "too slow", "out of memory"};
enum { KINDS = sizeof kind_order / sizeof *kind_order };

// Lists all but what is no scene file by its name, which is only counted.
static void write_table(FILE *f)
{
    unsigned counts[KINDS] = {0};
    for (size_t i = 0; i < corpus.rows.count; i++)
        for (int k = 0; k < KINDS; k++)
            counts[k] += !strcmp(corpus.rows.data[i].kind, kind_order[k]);
    fprintf(
        f,
        "# Broken and edge-case files: what becomes of them\n\n"
        "Written by `test_import_corpus`, which tries every file of its corpus with 2 GiB "
        "and 20 s of\nprocessor time. Each ends with a scene or with one line that names "
        "the file. Where a loader reads\nbeyond the data of a damaged file, its end may differ "
        "from run to run.\n\n| outcome | files |\n| --- | ---: |\n");
    for (int k = 0; k < KINDS; k++)
        if (counts[k]) fprintf(f, "| %s | %u |\n", kind_order[k], counts[k]);
    for (int k = 0; k < KINDS; k++) {
        if (!counts[k] || !strcmp(kind_order[k], "no scene")) continue;
        fprintf(f, "\n## %s\n\n| file | s | message |\n| --- | ---: | --- |\n", kind_order[k]);
        for (size_t i = 0; i < corpus.rows.count; i++) {
            const outcome *row = &corpus.rows.data[i];
            if (strcmp(row->kind, kind_order[k])) continue;
            fprintf(f, "| %s | %.1f | %s |\n", row->file, ceil(row->seconds * 10) / 10,
                    row->message);
        }
    }
    fprintf(f, "\nNo scene by their names and contents: the corpus's own reports, licences, "
               "pictures, materials and\nbuffers.\n");
}

static void broken_files_never_end_the_program(void **state)
{
    (void)state;
    char *folder = prom_strdup(shared("malformed"));
    corpus.prefix = strlen(folder) + 1;
    assert_int_equal(nftw(folder, visit, 16, FTW_PHYS), 0);
    qsort(corpus.rows.data, corpus.rows.count, sizeof *corpus.rows.data, by_file);
    unsigned sound = 0;
    for (size_t i = 0; i < corpus.rows.count; i++) {
        try_file(folder, &corpus.rows.data[i]);
        check_sound(folder, &corpus.rows.data[i], &sound);
    }
    print_message("%zu files, %u of them sound\n", corpus.rows.count, sound);
    assert_int_equal(sound, 73);
    FILE *f = fopen("malformed-outcomes.md", "w");
    assert_non_null(f);
    write_table(f);
    fclose(f);
    for (size_t i = 0; i < corpus.rows.count; i++) {
        prom_free(corpus.rows.data[i].file);
        prom_free(corpus.rows.data[i].message);
    }
    prom_array_finish(&corpus.rows);
    prom_free(folder);
}

// Triangles as placed, those of them that have two equal corners, and what the artists made of
// levels (counted in the files).
static void real_scenes_arrive_whole(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint64_t triangles, degenerate;
        size_t levelled, levels;
    } scenes[] = {{"scenes/sponza/sponza.obj", 262267, 267, 0, 0},
                  {"scenes/candela_city/candela_city.gltf", 431630, 0, 111, 165},
                  {"scenes/black_forest/black_forest.gltf", 1105608, 7, 1251, 1286},
                  {"scenes/forza/forza.gltf", 71775, 0, 0, 0},
                  {"scenes/bunny/stanford-bunny.obj", 69451, 0, 0, 0},
                  {"scenes/dragon/dragon_vrip_res3.ply", 47794, 0, 0, 0}};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        prom_source s;
        prom_error error = {0};
        if (prom_source_import(shared(scenes[i].name), NULL, &s, &error))
            fail_msg("%s", error.text);
        uint64_t placed = 0;
        size_t levelled = 0;
        for (size_t n = 0; n < s.nodes.count; n++) {
            const prom_source_node *node = &s.nodes.data[n];
            levelled += node->level_count > 0;
            for (uint32_t r = 0; r < node->mesh_count; r++)
                placed += s.meshes.data[s.mesh_refs.data[node->first_mesh + r]].index_count / 3;
        }
        assert_int_equal(levelled, scenes[i].levelled);
        assert_int_equal(s.levels.count, scenes[i].levels);
        assert_int_equal(placed, scenes[i].triangles - scenes[i].degenerate);
        for (size_t k = 0; k < s.images.count; k++) assert_false(s.images.data[k].missing);
        prom_source_finish(&s);
    }
}

int main(void)
{
    prom_log_set_level(PROM_LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_files_never_end_the_program),
        cmocka_unit_test(real_scenes_arrive_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

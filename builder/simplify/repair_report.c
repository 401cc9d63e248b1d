// The numbers of a repair: summed up, and in words.
#include "builder/simplify/repair.h"

#include "metaobj/base/alloc.h"

#include <inttypes.h>
#include <stddef.h>

static const struct {
    const char *key, *one, *more; // one, more: NULL where the text leaves it out
    size_t offset;
} numbers[] = {
#define NUMBER(key, one, more)                                                                 \
    {                                                                                          \
#key, one, more, offsetof(prom_repair_report, key)                                     \
    }
    NUMBER(snapped, "vertex moved to a neighbour's place",
           "vertices moved to a neighbour's place"),
    NUMBER(welded, "vertex welded", "vertices welded"),
    NUMBER(degenerate, "face without area dropped", "faces without area dropped"),
    NUMBER(duplicate, "repeated face dropped", "repeated faces dropped"),
    NUMBER(turned, "face turned", "faces turned"),
    NUMBER(faces, NULL, NULL),
    NUMBER(two_sided, "two-sided face", "two-sided faces"),
    NUMBER(open_edges, "open edge", "open edges"),
    NUMBER(non_manifold_edges, "non-manifold edge", "non-manifold edges"),
    NUMBER(clashing_edges, "edge where sides clash", "edges where sides clash"),
    NUMBER(patches, "patch", "patches"),
    NUMBER(closed_patches, "closed one", "closed ones"),
#undef NUMBER
};

#define NUMBERS (sizeof numbers / sizeof *numbers)
_Static_assert(sizeof(prom_repair_report) == NUMBERS * sizeof(uint64_t), "all have a name");

static uint64_t get(const prom_repair_report *report, size_t i)
{
    return *(const uint64_t *)((const char *)report + numbers[i].offset);
}

static void set(prom_repair_report *report, size_t i, uint64_t value)
{
    *(uint64_t *)((char *)report + numbers[i].offset) = value;
}

void prom_repair_report_add(prom_repair_report *sum, const prom_repair_report *part)
{
    for (size_t i = 0; i < NUMBERS; i++) set(sum, i, get(sum, i) + get(part, i));
}

bool prom_repair_mended(const prom_repair_report *r)
{
    return r->snapped || r->welded || r->degenerate || r->duplicate || r->turned;
}

bool prom_repair_closed(const prom_repair_report *r)
{
    return r->patches && !r->open_edges && !r->non_manifold_edges;
}

void prom_repair_set(prom_repair_report *report, const char *key, uint64_t value)
{
    for (size_t i = 0; i < NUMBERS; i++)
        if (!strcmp(numbers[i].key, key)) set(report, i, value);
}

static char *append(char *text, char *part)
{
    char *both = prom_format("%s%s%s", text, *text ? ", " : "", part);
    prom_free(text);
    prom_free(part);
    return both;
}

char *prom_repair_text(const prom_repair_report *report)
{
    char *text = prom_strdup("");
    for (size_t i = 0; i < NUMBERS; i++) {
        uint64_t n = get(report, i);
        if (!n || !numbers[i].one) continue;
        const char *what = n == 1 ? numbers[i].one : numbers[i].more;
        text = append(text, prom_format("%" PRIu64 " %s", n, what));
    }
    return text;
}

char *prom_repair_json(const prom_repair_report *report)
{
    char *text = prom_strdup("");
    for (size_t i = 0; i < NUMBERS; i++)
        text = append(text, prom_format("\"%s\": %" PRIu64, numbers[i].key, get(report, i)));
    char *json = prom_format("{%s}", text);
    prom_free(text);
    return json;
}

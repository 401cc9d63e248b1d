#include "app/info_object.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <strings.h>

#define NEAR_NAMES 3
#define COMPARED_CHARS 63 // of a name, to tell how near it is

static const char *name_of(const prom_model *m, uint32_t node)
{
    return m->names + m->name[node];
}

char *prom_object_title(const prom_model *m, uint32_t node)
{
    const char *name = name_of(m, node), *blank = *name ? " " : "";
    char *number = prom_format(*name ? "(#%u)" : "#%u", m->prototype[node]);
    char *title = prom_format("%s%s%s", name, blank, number);
    prom_text_make_plain(title);
    prom_free(number);
    return title;
}

uint32_t *prom_first_nodes(const prom_model *m)
{
    uint32_t *first = prom_alloc(m->prototype_count, sizeof *first);
    memset(first, 0xff, m->prototype_count * sizeof *first); // PROM_NONE
    for (uint32_t n = m->node_count; n-- > 0;) first[m->prototype[n]] = n;
    return first;
}

// ---- names

static bool is_called(const char *name, const char *wanted)
{
    return !strcmp(name, wanted);
}

static bool fits(const char *name, const char *pattern)
{
    return !fnmatch(pattern, name, 0);
}

static void collect(const prom_model *m, const char *wanted,
                    bool (*means)(const char *name, const char *wanted), prom_node_list *nodes)
{
    bool *taken = prom_calloc(m->prototype_count, sizeof *taken);
    for (uint32_t n = 0; n < m->node_count; n++) {
        const char *name = name_of(m, n);
        if (!*name || taken[m->prototype[n]] || !means(name, wanted)) continue;
        taken[m->prototype[n]] = true;
        prom_array_push(nodes, n);
    }
    prom_free(taken);
}

static prom_status find_number(const prom_model *m, const char *name, prom_node_list *nodes,
                               prom_error *error)
{
    char *end;
    unsigned long long number = strtoull(name + 1, &end, 10);
    if (!name[1] || *end || number >= m->prototype_count)
        return prom_fail(error, PROM_ERR_INPUT, "--object %s: prototypes are #0 to #%u", name,
                         m->prototype_count - 1);
    for (uint32_t n = 0; n < m->node_count && !nodes->count; n++)
        if (m->prototype[n] == number) prom_array_push(nodes, n);
    if (nodes->count) return PROM_OK;
    return prom_fail(error, PROM_ERR_INPUT, "--object %s: nothing in the model is one", name);
}

// ---- near names

// Letters to insert, delete or change, whatever their case (Levenshtein 1966), between what is
// wanted and the start of a name that is nearest to it.
static unsigned edits(const char *name, const char *wanted)
{
    unsigned row[COMPARED_CHARS + 1];
    size_t length = strnlen(wanted, COMPARED_CHARS);
    for (unsigned k = 0; k <= length; k++) row[k] = k;
    unsigned least = row[length];
    for (unsigned i = 0; i < COMPARED_CHARS && name[i]; i++) {
        unsigned corner = row[0];
        row[0] = i + 1;
        for (size_t k = 0; k < length; k++) {
            unsigned change = corner + (strncasecmp(&name[i], &wanted[k], 1) != 0);
            unsigned other = 1 + (row[k] < row[k + 1] ? row[k] : row[k + 1]);
            corner = row[k + 1];
            row[k + 1] = change < other ? change : other;
        }
        if (row[length] < least) least = row[length];
    }
    return least;
}

typedef struct near_name {
    const char *name;
    unsigned distance;
} near_name;

// The nearest names, nearest first; those that hold what is wanted come before all others.
static void find_near(const prom_model *m, const char *wanted, near_name near[NEAR_NAMES])
{
    for (uint32_t n = 0; n < m->node_count; n++) {
        near_name here = {name_of(m, n), 0};
        if (!*here.name) continue;
        if (!strcasestr(here.name, wanted)) here.distance = 1 + edits(here.name, wanted);
        for (int i = 0; i < NEAR_NAMES; i++) {
            if (near[i].name && !strcmp(near[i].name, here.name)) break;
            if (near[i].name && near[i].distance <= here.distance) continue;
            near_name pushed = near[i];
            near[i] = here;
            here = pushed;
            if (!here.name) break;
        }
    }
}

static prom_status none_found(const prom_model *m, const char *name, prom_error *error)
{
    near_name near[NEAR_NAMES] = {0};
    char list[3 * (COMPARED_CHARS + 5) + 1] = "";
    find_near(m, name, near);
    for (int i = 0; i < NEAR_NAMES && near[i].name; i++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s`%.*s`", i ? ", " : "",
                 COMPARED_CHARS, near[i].name);
    prom_text_make_plain(list);
    return prom_fail(error, PROM_ERR_INPUT,
                     "--object: nothing is called `%.80s`; %s%s (#0 to #%u name prototypes)",
                     name, *list ? "near it: " : "the model has no names", list,
                     m->prototype_count - 1);
}

prom_status prom_find_objects(const prom_model *m, const char *name, prom_node_list *nodes,
                              prom_error *error)
{
    nodes->count = 0;
    collect(m, name, is_called, nodes);
    if (!nodes->count && *name == '#') return find_number(m, name, nodes, error);
    if (!nodes->count) collect(m, name, fits, nodes);
    return nodes->count ? PROM_OK : none_found(m, name, error);
}

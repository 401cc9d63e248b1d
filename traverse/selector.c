#include "traverse/selector.h"

#include "traverse/selectors.h"

#include <stdio.h>
#include <string.h>

struct prom_selector {
    const prom_selector_class *class;
    void *state;
};

static const prom_selector_class *const classes[] = {
    &prom_select_meta,        &prom_select_greedy,  &prom_select_lagrange,
    &prom_select_incremental, &prom_select_optimal, &prom_select_funkhouser,
    &prom_select_pixels,      &prom_select_sse,     &prom_select_feedback,
    &prom_select_distance,    &prom_select_full,    &prom_select_coarsest,
};
enum { CLASS_COUNT = sizeof classes / sizeof *classes };

size_t prom_selector_count(void)
{
    return CLASS_COUNT;
}

const prom_selector_class *prom_selector_at(size_t i)
{
    return i < CLASS_COUNT ? classes[i] : NULL;
}

const prom_selector_class *prom_selector_class_named(const char *name)
{
    for (size_t i = 0; i < CLASS_COUNT; i++)
        if (!strcmp(classes[i]->name, name)) return classes[i];
    return NULL;
}

prom_selector *prom_selector_create(const char *name, const prom_model *model,
                                    prom_error *error)
{
    const prom_selector_class *class = prom_selector_class_named(name);
    if (class) {
        prom_selector *selector = prom_alloc(1, sizeof *selector);
        *selector = (prom_selector){class, class->create(model)};
        return selector;
    }
    char list[256] = "";
    for (size_t i = 0, used = 0; i < CLASS_COUNT; i++) {
        int n =
            snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", classes[i]->name);
        used += (size_t)n < sizeof list - used ? (size_t)n : 0;
    }
    prom_fail(error, PROM_ERR_USAGE, "unknown selector '%s': choose one of %s", name, list);
    return NULL;
}

void prom_selector_destroy(prom_selector *selector)
{
    if (!selector) return;
    selector->class->destroy(selector->state);
    prom_free(selector);
}

void prom_selector_run(prom_selector *selector, const prom_selection *selection, prom_cut *cut)
{
    selector->class->select(selector->state, selection, cut);
}

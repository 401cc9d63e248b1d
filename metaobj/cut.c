#include "metaobj/cut.h"

void prom_cut_finish(prom_cut *cut)
{
    prom_array_finish(&cut->entries);
    *cut = (prom_cut){0};
}

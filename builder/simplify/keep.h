// Private to simplification: edge collapse that loses no part of note.
#ifndef PROM_SIMPLIFY_KEEP_H
#define PROM_SIMPLIFY_KEEP_H

#include "builder/simplify/collapse.h"

// As prom_work_collapse, but components that would vanish though they are large (a door of two
// parallel faces costs next to nothing to fold and then to eat up from its rim) are taken out,
// reduced one by one as far as they stand, and the rest makes room for them.
void prom_work_collapse_keeping(const prom_work *work, const prom_index_array *faces,
                                const prom_collapse_options *options, prom_index_array *out,
                                float *error);

#endif

// LINK: prom_builder prom_render prom_metaobj
// LABEL: slow
// NEEDS: promenade
#define BUILD_KILLS 20
#include "build_kills.h"

// LINK: prom_builder prom_render prom_metaobj
// NEEDS: promenade
#define BUILD_KILLS 2
#include "build_kills.h"

// LINK: prom_builder prom_render prom_metaobj
// NEEDS: promenade
#define BUILD_KILLS 3
#include "build_kills.h"

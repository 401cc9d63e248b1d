// LINK: prom_builder prom_render prom_traverse prom_benefit prom_metaobj PkgConfig::SQLITE
#define BUILD_FAILURES_STEP 29
#include "build_failures.h"

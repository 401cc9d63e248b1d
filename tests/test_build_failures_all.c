// LINK: prom_builder prom_render prom_traverse prom_benefit prom_metaobj PkgConfig::SQLITE
// LABEL: slow
#define BUILD_FAILURES_STEP 1
#include "build_failures.h"

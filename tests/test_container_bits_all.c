// LINK: prom_metaobj
// LABEL: slow
#define DAMAGE_CUTS 200
#define DAMAGE_FLIPS 2000
#include "container_bits.h"

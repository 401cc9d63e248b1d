// LINK: prom_metaobj
#define DAMAGE_CUTS 40
#define DAMAGE_FLIPS 200
#include "container_bits.h"

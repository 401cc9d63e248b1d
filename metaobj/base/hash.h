// Content hashes: 64-bit XXH3, for checksums and for telling equal inputs. Not cryptographic.
#ifndef PROM_METAOBJ_BASE_HASH_H
#define PROM_METAOBJ_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

// Hash of `bytes` bytes at `data`, chained from `seed` (0 to start).
uint64_t prom_hash(const void *data, size_t bytes, uint64_t seed);

#endif

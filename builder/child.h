// Work on a foreign file in a process that may die: with limits on its memory and time, its
// libraries' chatter kept off the terminal, and whatever becomes of it told in one line.
#ifndef PROM_BUILDER_CHILD_H
#define PROM_BUILDER_CHILD_H

#include "metaobj/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define PROM_CHILD_DOING 256u

typedef struct prom_child_task {
    const char *path;      // the file, for messages
    const char *who;       // works on it, for messages: "loader"
    uint64_t memory_bytes; // of addresses, beyond the parent's; not kept under sanitizers
    uint64_t result_bytes; // at most so much is handed over
    uint32_t time_s;       // of processor time; twice that and 2 s by the clock
    // In the child: writes the result. `doing`: PROM_CHILD_DOING bytes that a message quotes
    // after a crash ("reading the file"). False: the result could not be written.
    bool (*work)(void *user, FILE *result, char *doing);
    void *user;
} prom_child_task;

// What the child has handed over, to be trusted no more than the file itself.
typedef struct prom_child_result {
    const uint8_t *data;
    size_t bytes;
} prom_child_result;

// PROM_ERR_INPUT, with *result empty, when the child crashes, fails, meets a limit or hands
// over nothing; PROM_ERR_UNSUPPORTED when there is no process to be had. The child has one
// thread: call it where no other holds a lock that the work needs.
prom_status prom_child_run(const prom_child_task *task, prom_child_result *result,
                           prom_error *error);
void prom_child_result_finish(prom_child_result *result);

#endif

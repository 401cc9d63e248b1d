// Result codes and error messages. A function that can fail for a reason outside the program
// (a file, a device, a user's value) returns a prom_status and fills a prom_error; a wrong call
// by a programmer is an assertion.
#ifndef PROM_METAOBJ_BASE_STATUS_H
#define PROM_METAOBJ_BASE_STATUS_H

// The numbers are the program's exit codes.
typedef enum prom_status {
    PROM_OK = 0,
    PROM_ERR_USAGE = 1,       // a wrong option or value
    PROM_ERR_INPUT = 2,       // a missing, damaged or unusable input
    PROM_ERR_UNSUPPORTED = 3, // no GL, or something that this build cannot do
    PROM_ERR_OUTPUT = 4,      // the output cannot be written
    PROM_ERR_THRESHOLD = 5,   // a threshold asked for was missed
    PROM_ERR_STOPPED = 130,   // ended early by Ctrl-C or the like
} prom_status;

typedef struct prom_error {
    prom_status status;
    char text[512]; // one line: what, where, what to do; no newline
} prom_error;

// Fills *error (NULL is allowed) from a printf format and returns `status`.
prom_status prom_fail(prom_error *error, prom_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Names and texts come from foreign files: control characters, which could steer a terminal,
// become `?`, the ends of lines blanks.
void prom_text_make_plain(char *text);

#endif

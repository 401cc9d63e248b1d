#include "metaobj/base/status.h"

#include <stdarg.h>
#include <stdio.h>

prom_status prom_fail(prom_error *error, prom_status status, const char *format, ...)
{
    if (!error) return status;
    error->status = status;
    va_list args;
    va_start(args, format);
    vsnprintf(error->text, sizeof error->text, format, args);
    va_end(args);
    for (char *c = error->text; *c; c++)
        if (*c == '\n' || *c == '\r') *c = ' ';
    return status;
}

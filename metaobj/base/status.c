#include "metaobj/base/status.h"

#include <stdarg.h>
#include <stdio.h>

void prom_text_make_plain(char *text)
{
    for (unsigned char *c = (unsigned char *)text; *c; c++)
        if (*c < 0x20 || *c == 0x7f) *c = *c == '\n' || *c == '\r' ? ' ' : '?';
}

prom_status prom_fail(prom_error *error, prom_status status, const char *format, ...)
{
    if (!error) return status;
    error->status = status;
    va_list args;
    va_start(args, format);
    vsnprintf(error->text, sizeof error->text, format, args);
    va_end(args);
    prom_text_make_plain(error->text);
    return status;
}

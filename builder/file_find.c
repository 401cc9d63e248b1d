#include "builder/file_io.h"
#include "metaobj/base/alloc.h"

#include <ctype.h>
#include <dirent.h>
#include <stdbool.h>
#include <strings.h>
#include <sys/stat.h>

static bool is_file(const char *path)
{
    struct stat info;
    return !stat(path, &info) && S_ISREG(info.st_mode);
}

// The entry of `folder` whose name equals `name` but for the case of letters; the first in
// alphabetical order, so that the result does not depend on the file system. Free with
// prom_free.
static char *match_entry(const char *folder, const char *name)
{
    DIR *dir = opendir(*folder ? folder : ".");
    if (!dir) return NULL;
    char *best = NULL;
    for (struct dirent *e; (e = readdir(dir));) {
        if (strcasecmp(e->d_name, name) || (best && strcmp(best, e->d_name) <= 0)) continue;
        prom_free(best);
        best = prom_strdup(e->d_name);
    }
    closedir(dir);
    return best;
}

static char *join(const char *folder, const char *name)
{
    size_t n = strlen(folder);
    return prom_format("%s%s%s", folder, n && folder[n - 1] != '/' ? "/" : "", name);
}

// `relative` below `folder`, first as written, then component by component with any case.
static char *find_below(const char *folder, const char *relative)
{
    char *path = join(folder, relative);
    if (is_file(path)) return path;
    prom_free(path);
    char *rest = prom_strdup(relative), *state = NULL, *at = prom_strdup(folder);
    for (char *part = strtok_r(rest, "/", &state); part && at;
         part = strtok_r(NULL, "/", &state)) {
        bool plain = !strcmp(part, ".") || !strcmp(part, "..");
        char *entry = plain ? prom_strdup(part) : match_entry(at, part);
        char *next = entry ? join(at, entry) : NULL;
        prom_free(entry);
        prom_free(at);
        at = next;
    }
    prom_free(rest);
    if (at && is_file(at)) return at;
    prom_free(at);
    return NULL;
}

static char *find_named(const char *folder, const char *name)
{
    static const char *const places[] = {"",      "textures", "texture",  "maps",     "images",
                                         "image", "tex",      "Textures", "materials"};
    if (*name == '/') return is_file(name) ? prom_strdup(name) : NULL;
    char *found = find_below(folder, name);
    const char *slash = strrchr(name, '/'), *base = slash ? slash + 1 : name;
    for (size_t i = 0; !found && i < sizeof places / sizeof *places; i++) {
        char *below = join(folder, places[i]);
        found = find_below(below, base);
        prom_free(below);
    }
    return found;
}

static int hex(char c)
{
    return isdigit((unsigned char)c)    ? c - '0'
           : isxdigit((unsigned char)c) ? tolower((unsigned char)c) - 'a' + 10
                                        : -1;
}

static void percent_decode(char *text)
{
    char *out = text;
    for (const char *in = text; *in; in++) {
        int high = *in == '%' ? hex(in[1]) : -1, low = high >= 0 ? hex(in[2]) : -1;
        *out++ = low >= 0 && (high || low) ? (char)(high * 16 + low) : *in;
        if (low >= 0 && (high || low)) in += 2;
    }
    *out = 0;
}

char *prom_file_find(const char *scene_path, const char *name)
{
    const char *slash = strrchr(scene_path, '/');
    char *folder = slash ? prom_format("%.*s", (int)(slash - scene_path + 1), scene_path)
                         : prom_strdup("");
    char *plain = prom_strdup(name);
    for (char *c = plain; *c; c++)
        if (*c == '\\') *c = '/';
    const char *start = strncmp(plain, "file://", 7) ? plain : plain + 7;
    char *found = find_named(folder, start);
    if (!found && strchr(plain, '%')) {
        percent_decode(plain);
        found = find_named(folder, start);
    }
    const char *base = strrchr(start, '/');
    if (!found && *start == '/') found = find_named(folder, base + 1);
    prom_free(plain);
    prom_free(folder);
    return found;
}

#include "scenes/path.h"

#include "metaobj/base/alloc.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// How far a quaternion's length may be from 1: files carry six digits, by hand perhaps two.
#define LENGTH_TOLERANCE 0.02

void prom_path_finish(prom_path *path)
{
    prom_array_finish(&path->keys);
}

static prom_status line_error(prom_error *error, const char *file, size_t line,
                              const char *what)
{
    return prom_fail(error, PROM_ERR_INPUT, "%s:%zu: %s; a line is `t px py pz qx qy qz qw`",
                     file, line, what);
}

// Reads the eight numbers of a line; NULL, or what is wrong with it.
static const char *parse_numbers(const char *text, double values[8])
{
    for (int i = 0; i < 8; i++) {
        char *end;
        values[i] = strtod(text, &end);
        if (end == text)
            return text[strspn(text, " \t\r\n")] ? "not a number" : "fewer than 8 numbers";
        if (!isfinite(values[i])) return "a number that is not finite";
        if (*end && !strchr(" \t\r\n", *end)) return "not a number";
        text = end;
    }
    return text[strspn(text, " \t\r\n")] ? "more than 8 numbers" : NULL;
}

static const char *parse_key(const char *text, const prom_path *path, prom_path_key *key)
{
    double v[8];
    const char *wrong = parse_numbers(text, v);
    if (wrong) return wrong;
    if (path->keys.count && v[0] <= path->keys.data[path->keys.count - 1].t)
        return "the time is not after that of the line before";
    double length = sqrt(v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7]);
    if (!(fabs(length - 1.0) <= LENGTH_TOLERANCE)) return "the quaternion is not of length 1";
    *key = (prom_path_key){.t = v[0], .position = {v[1], v[2], v[3]}};
    for (int i = 0; i < 4; i++) key->orientation[i] = (float)(v[4 + i] / length);
    return NULL;
}

static prom_status parse_file(FILE *stream, const char *file, prom_path *path,
                              prom_error *error)
{
    char *text = NULL;
    size_t capacity = 0, line = 0;
    ssize_t length;
    prom_status status = PROM_OK;
    while (!status && (length = getline(&text, &capacity, stream)) >= 0) {
        prom_path_key key;
        line++;
        if (strlen(text) != (size_t)length) {
            status = line_error(error, file, line, "a zero byte (not a text file)");
            break;
        }
        const char *start = text + strspn(text, " \t\r\n");
        if (!*start || *start == '#') continue;
        const char *wrong = parse_key(start, path, &key);
        if (wrong)
            status = line_error(error, file, line, wrong);
        else
            prom_array_push(&path->keys, key);
    }
    free(text);
    if (!status && ferror(stream))
        status =
            prom_fail(error, PROM_ERR_INPUT, "%s: cannot be read: %s", file, strerror(errno));
    if (!status && !path->keys.count)
        status = line_error(error, file, line ? line : 1, "the path ends without a key");
    return status;
}

prom_status prom_path_load(const char *file, prom_path *path, prom_error *error)
{
    *path = (prom_path){0};
    FILE *stream = fopen(file, "r");
    if (!stream)
        return prom_fail(error, PROM_ERR_INPUT, "%s: cannot open the camera path: %s", file,
                         strerror(errno));
    prom_status status = parse_file(stream, file, path, error);
    fclose(stream);
    if (status) prom_path_finish(path);
    return status;
}

static void write_keys(FILE *stream, const prom_path *path, const char *title)
{
    fputs("# promenade camera path 1", stream);
    if (title) fputs("; ", stream);
    for (const char *c = title ? title : ""; *c; c++)
        fputc((unsigned char)*c < ' ' ? ' ' : *c, stream);
    fputs("; t[s] px py pz qx qy qz qw; y up, camera looks down -z\n", stream);
    for (size_t i = 0; i < path->keys.count; i++) {
        const prom_path_key *k = &path->keys.data[i];
        fprintf(stream, "%.6f %.6f %.6f %.6f %.8f %.8f %.8f %.8f\n", k->t, k->position[0],
                k->position[1], k->position[2], (double)k->orientation[0],
                (double)k->orientation[1], (double)k->orientation[2],
                (double)k->orientation[3]);
    }
}

prom_status prom_path_save(const char *file, const prom_path *path, const char *title,
                           prom_error *error)
{
    char *part = prom_format("%s.part", file);
    prom_status status = PROM_OK;
    FILE *stream = fopen(part, "w");
    if (stream) {
        write_keys(stream, path, title);
        bool wrong = fflush(stream) || ferror(stream) || fsync(fileno(stream));
        if (fclose(stream) || wrong || rename(part, file)) {
            status = prom_fail(error, PROM_ERR_OUTPUT, "%s: cannot write the camera path: %s",
                               file, strerror(errno));
            unlink(part);
        }
    } else {
        status = prom_fail(error, PROM_ERR_OUTPUT, "%s: cannot write the camera path: %s", file,
                           strerror(errno));
    }
    prom_free(part);
    return status;
}

void prom_path_add(prom_path *path, const double position[3], const double forward[3])
{
    // Yaw about y, then pitch about the camera's x; at rest the camera looks down -z.
    double yaw = atan2(-forward[0], -forward[2]);
    double pitch = atan2(forward[1], hypot(forward[0], forward[2]));
    double sy = sin(yaw / 2), cy = cos(yaw / 2), sp = sin(pitch / 2), cp = cos(pitch / 2);
    prom_path_key key = {
        .t = (double)path->keys.count / PROM_PATH_RATE,
        .position = {position[0], position[1], position[2]},
        .orientation = {(float)(cy * sp), (float)(sy * cp), (float)(-sy * sp),
                        (float)(cy * cp)},
    };
    prom_array_push(&path->keys, key);
}

void prom_path_pose(const prom_path *path, uint64_t frame, prom_camera *camera)
{
    assert(path->keys.count);
    uint64_t n = path->keys.count, period = n > 1 ? 2 * (n - 1) : 1;
    uint64_t i = frame % period;
    const prom_path_key *key = &path->keys.data[i < n ? i : period - i];
    memcpy(camera->eye, key->position, sizeof camera->eye);
    memcpy(camera->orientation, key->orientation, sizeof camera->orientation);
}

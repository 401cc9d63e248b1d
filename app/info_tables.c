#include "app/info_tables.h"

#include "app/output.h"
#include "benefit/accuracy.h"

#include <stdio.h>
#include <stdlib.h>

// Quoted, quotes doubled.
static void print_text(FILE *out, const char *text)
{
    char *plain = prom_strdup(text);
    prom_text_make_plain(plain);
    fputc('"', out);
    for (const char *c = plain; *c; c++) {
        if (*c == '"') fputc('"', out);
        fputc(*c, out);
    }
    fputc('"', out);
    prom_free(plain);
}

static void print_start(FILE *out, const prom_model *m, uint32_t node, uint32_t r)
{
    const prom_prototype *proto = &m->prototypes[m->prototype[node]];
    const prom_representation *rep = &m->reps[r];
    fprintf(out, "%u,", m->prototype[node]);
    print_text(out, m->names + m->name[node]);
    fprintf(out, ",%u,%s,%s,%u,%u", r, proto->flags & PROM_PROTO_CLUSTER ? "cluster" : "object",
            prom_rep_kind_name(rep->kind), rep->level, rep->triangles);
}

static uint64_t print_rep(FILE *out, const prom_model *m, uint32_t node, uint32_t r)
{
    uint64_t rows = 0;
    char *start = NULL;
    size_t bytes = 0;
    FILE *line = open_memstream(&start, &bytes);
    print_start(line, m, node, r);
    fclose(line);
    for (uint32_t dir = 0; dir < PROM_DIRS; dir++) {
        bool large = m->reps[r].kind == PROM_REP_MESH && dir < PROM_DIRS_LARGE;
        double coverage = m->coverage[m->prototype[node]][dir] / 65535.0;
        float d[3];
        prom_direction_of_bin(dir, d);
        double x = d[0] + 0.0f, y = d[1] + 0.0f, z = d[2] + 0.0f; // -0 becomes 0
        for (uint32_t s = 0; s < PROM_SIZES + (large ? PROM_SIZES_LARGE : 0); s++, rows++) {
            uint8_t accuracy = s < PROM_SIZES ? m->accuracy[r].bins[dir][s]
                                              : m->accuracy[r].large[dir][s - PROM_SIZES];
            fprintf(out, "%s,%u,%.4g,%.4g,%.4g,%.4g,%.4f,%.4f\n", start, dir, x, y, z,
                    prom_size_of_bin(s), (double)prom_accuracy_of_byte(accuracy), coverage);
        }
    }
    free(start); // of open_memstream
    return rows;
}

static uint64_t print_prototype(FILE *out, const prom_model *m, uint32_t node)
{
    const prom_prototype *proto = &m->prototypes[m->prototype[node]];
    uint64_t rows = 0;
    for (uint32_t i = 0; i < proto->rep_count; i++)
        rows += print_rep(out, m, node, proto->first_rep + i);
    return rows;
}

static uint64_t print_all(FILE *out, const prom_model *m)
{
    uint32_t *first = prom_first_nodes(m);
    uint64_t rows = 0;
    for (uint32_t p = 0; p < m->prototype_count; p++)
        if (first[p] != PROM_NONE) rows += print_prototype(out, m, first[p]);
    prom_free(first);
    return rows;
}

prom_status prom_info_write_tables(const prom_model *m, const prom_node_list *nodes,
                                   const char *path, uint64_t *rows, prom_error *error)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *out = open_memstream(&text, &bytes);
    fputs("prototype,object,representation,of,kind,level,triangles,direction,x,y,z,size_px,"
          "accuracy,coverage\n",
          out);
    *rows = nodes ? 0 : print_all(out, m);
    for (size_t i = 0; nodes && i < nodes->count; i++)
        *rows += print_prototype(out, m, nodes->data[i]);
    bool good = !ferror(out);
    good = fclose(out) == 0 && good;
    prom_status status = good ? prom_output_write(path, text, bytes, error)
                              : prom_fail(error, PROM_ERR_OUTPUT, "%s: no memory left", path);
    free(text); // of open_memstream
    return status;
}

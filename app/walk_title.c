#include "app/walk_title.h"

#include <stdio.h>

#define EVERY_MS 250.0

void prom_walk_title_add(prom_walk_title *title, double frame_ms, double triangles, bool miss)
{
    title->all++;
    title->misses += miss;
    title->frames++;
    title->frame_ms += frame_ms;
    title->triangles = triangles;
}

static void write_count(double count, char text[16])
{
    if (count < 10e3)
        snprintf(text, 16, "%.0f", count);
    else if (count < 10e6)
        snprintf(text, 16, "%.0f k", count / 1e3);
    else
        snprintf(text, 16, "%.1f M", count / 1e6);
}

static const char *rest_of(const prom_walk_title_facts *f)
{
    if (!f->at_rest) return "";
    return f->refined ? ", at rest, full detail" : ", at rest";
}

static void compose(const prom_walk_title *t, const prom_walk_title_facts *f,
                    char text[PROM_WALK_TITLE_BYTES])
{
    char triangles[16];
    write_count(t->told_triangles, triangles);
    snprintf(text, PROM_WALK_TITLE_BYTES,
             "%.80s | %.1f of %g ms%s | misses %llu of %llu (%.1f %%) | %s | %s triangles%s%s",
             f->name, t->told_ms, f->budget_ms, rest_of(f), (unsigned long long)t->misses,
             (unsigned long long)t->all,
             t->all ? 100.0 * (double)t->misses / (double)t->all : 0, f->selector, triangles,
             f->playing ? " | playing" : "", f->captured ? "" : " | click to look around");
}

bool prom_walk_title_due(prom_walk_title *title, const prom_walk_title_facts *facts,
                         double now_ms, char text[PROM_WALK_TITLE_BYTES])
{
    bool changed = title->frames || facts->at_rest != title->told_at_rest ||
                   facts->refined != title->told_refined ||
                   facts->captured != title->told_captured;
    if (!changed || now_ms - title->shown_ms < EVERY_MS) return false;
    if (title->frames) title->told_ms = title->frame_ms / title->frames;
    title->told_triangles = title->triangles;
    title->frames = 0;
    title->frame_ms = 0;
    title->shown_ms = now_ms;
    title->told_at_rest = facts->at_rest;
    title->told_refined = facts->refined;
    title->told_captured = facts->captured;
    compose(title, facts, text);
    return true;
}

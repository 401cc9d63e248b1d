// A street of boxes as an OBJ file: enough things for several clusters, none of them equal.
#ifndef PROM_TESTS_OBJ_STREET_H
#define PROM_TESTS_OBJ_STREET_H

#include <stdio.h>

// `taller` adds to the height of house number `which`.
static inline void write_street(const char *path, int houses, int which, double taller)
{
    FILE *f = fopen(path, "w");
    if (!f) return;
    fputs("mtllib missing.mtl\n", f);
    for (int i = 0, base = 1; i < houses; i++, base += 8) {
        double x = i % 10 * 8.0, z = i / 10 * 8.0;
        double h = 2 + i % 5 + 0.01 * i + (i == which ? taller : 0);
        fprintf(f, "o house_%d\n", i);
        for (int v = 0; v < 8; v++)
            fprintf(f, "v %g %g %g\n", x + (v & 1 ? 3 : 0), v & 2 ? h : 0.0,
                    z + (v & 4 ? 3 : 0));
        static const int quads[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                        {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
        for (int q = 0; q < 6; q++) {
            fputs("f", f);
            for (int k = 0; k < 4; k++) fprintf(f, " %d", base + quads[q][k] - 1);
            fputs("\n", f);
        }
    }
    fclose(f);
}

#endif

#include "scenes/city_parts.h"

#include <math.h>

#define FRAMES 600
#define SPEED 3.0 // m/s
#define EYE 1.7
#define CORNER 3.2     // radius of the turn
#define LOOK_AHEAD 5.0 // metres along the way

// The way comes along a street in -x, turns at the crossing and goes on in +z. `s` metres along
// it; before its start and past its end it goes straight on.
static void way_point(const prom_city_plan *plan, double s, double p[3])
{
    double x = (double)plan->street_x[plan->blocks / 2];
    double z = (double)plan->street_z[plan->blocks / 2];
    double before = SPEED * FRAMES / PROM_PATH_RATE / 2 - CORNER * M_PI / 4;
    double angle = (s - before) / CORNER;
    p[1] = EYE;
    if (angle <= 0) {
        p[0] = x + CORNER + before - s;
        p[2] = z;
    } else if (angle < M_PI / 2) {
        p[0] = x + CORNER - CORNER * sin(angle);
        p[2] = z + CORNER - CORNER * cos(angle);
    } else {
        p[0] = x;
        p[2] = z + CORNER + CORNER * (angle - M_PI / 2);
    }
}

void prom_city_walk(const prom_city_plan *plan, prom_path *path)
{
    for (int i = 0; i < FRAMES; i++) {
        double s = SPEED * i / PROM_PATH_RATE, here[3], ahead[3], forward[3];
        way_point(plan, s, here);
        way_point(plan, s + LOOK_AHEAD, ahead);
        // The walker looks about a little.
        double sway = 0.14 * sin(2 * M_PI * i / 240),
               nod = 0.035 + 0.02 * sin(2 * M_PI * i / 170);
        double dx = ahead[0] - here[0], dz = ahead[2] - here[2], length = hypot(dx, dz);
        forward[0] = dx * cos(sway) + dz * sin(sway);
        forward[1] = nod * length;
        forward[2] = dz * cos(sway) - dx * sin(sway);
        prom_path_add(path, here, forward);
    }
}

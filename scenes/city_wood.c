// What covers the hills: woods, many plain trees each, and terraces of vines.
#include "scenes/city_parts.h"

#include <cglm/cglm.h>
#include <math.h>

#define PI 3.14159265f
#define TREES 34
#define RADIUS 26.0f

// ---- woods

// A crown of three crossed pictures of leaves and some more on top: trees that nobody comes
// near to.
static void build_tuft(prom_solid *shape, const float at[3], float radius, float height,
                       int cards, prom_random *random)
{
    for (int i = 0; i < cards; i++) {
        float a = PI * (float)i / (float)cards + prom_random_between(random, -0.2f, 0.2f);
        float tilt = prom_random_between(random, -0.35f, 0.35f), c = cosf(a), s = sinf(a);
        float lift = prom_random_between(random, -0.12f, 0.12f) * height;
        float w = radius * prom_random_between(random, 0.85f, 1.1f), h = 0.55f * height;
        float x = at[0] + prom_random_between(random, -0.25f, 0.25f) * radius;
        float z = at[2] + prom_random_between(random, -0.25f, 0.25f) * radius;
        static const float corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        uint32_t first = 0;
        for (int k = 0; k < 4; k++) {
            float u = corner[k][0], v = corner[k][1];
            float p[3] = {x + c * w * u + s * tilt * h * v, at[1] + lift + h * v,
                          z + s * w * u - c * tilt * h * v};
            vec3 n = {c * u * 0.8f, 0.75f + 0.6f * v, s * u * 0.8f};
            glm_vec3_normalize(n);
            uint32_t id = prom_solid_vertex(shape, p, n, 0.5f + 0.5f * u, 0.5f - 0.5f * v);
            if (!k) first = id;
        }
        prom_solid_triangle(shape, first, first + 1, first + 2);
        prom_solid_triangle(shape, first, first + 2, first + 3);
    }
}

// A conifer: a cone of pictures that lean on the trunk.
static void build_spruce(prom_solid *shape, const float at[3], float radius, float height,
                         int cards, prom_random *random)
{
    float turned = prom_random_between(random, 0, PI);
    for (int i = 0; i < cards; i++) {
        float a = turned + 2 * PI * (float)i / (float)cards, c = cosf(a), s = sinf(a);
        float w = 0.9f * radius;
        vec3 n = {c, 0.5f, s};
        glm_vec3_normalize(n);
        const float p[4][3] = {
            {at[0] + 0.75f * radius * c - w * s, at[1] - 0.4f * height,
             at[2] + 0.75f * radius * s + w * c},
            {at[0] + 0.75f * radius * c + w * s, at[1] - 0.4f * height,
             at[2] + 0.75f * radius * s - w * c},
            {at[0] + 0.3f * w * s, at[1] + 0.6f * height, at[2] - 0.3f * w * c},
            {at[0] - 0.3f * w * s, at[1] + 0.6f * height, at[2] + 0.3f * w * c}};
        static const float uv[4][2] = {{0, 1}, {1, 1}, {0.65f, 0.05f}, {0.35f, 0.05f}};
        uint32_t first = 0;
        for (int k = 0; k < 4; k++) {
            uint32_t id = prom_solid_vertex(shape, p[k], n, uv[k][0], uv[k][1]);
            if (!k) first = id;
        }
        prom_solid_triangle(shape, first, first + 1, first + 2);
        prom_solid_triangle(shape, first, first + 2, first + 3);
    }
}

void prom_city_build_wood(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    static const uint32_t greens[] = {0xc0d4a0, 0xdcecb0, 0xa8c094, 0xf0e8a8};
    static const int cards[5] = {0, 3, 4, 10, 24};
    prom_random random = prom_random_stream(city->options.seed, 230, which->number);
    int count = cards[city->options.detail];
    bool conifers = which->number % 4 == 2;
    for (int i = 0; i < TREES; i++) {
        // Evenly over a disc, by the golden angle.
        float r = RADIUS * sqrtf(((float)i + 0.5f) / TREES), a = 2.39996f * (float)i;
        float height = prom_random_between(&random, 7, 11);
        bool cone = conifers ? i % 5 != 0 : which->number % 4 == 3 && i % 3 == 0;
        float x = r * cosf(a), z = r * sinf(a), wide = prom_random_between(&random, 3.2f, 4.4f);
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_BARK, 0xc0b8b0, 1));
        const float trunk[2][3] = {{x, -4, z}, {x, 0.6f * height, z}};
        prom_solid_tube(shape, trunk, (const float[]){0.25f, 0.12f}, 2, 3);
        if (cone) {
            prom_solid_use(shape, prom_city_paint(city, PROM_CITY_LEAVES_BROAD, 0x78948c, 1));
            build_spruce(shape, (float[]){x, 0.55f * height, z}, 0.55f * wide, 1.15f * height,
                         count, &random);
        } else {
            uint32_t tint = greens[(which->number + prom_random_below(&random, 2)) % 4];
            prom_solid_use(shape, prom_city_paint(city, PROM_CITY_LEAVES_BROAD, tint, 1));
            build_tuft(shape, (float[]){x, 0.62f * height, z}, wide, 0.8f * height, count,
                       &random);
        }
    }
}

// ---- terraces: steps up a slope of about a fifth, walls between, rows of vines on them

#define STEPS 5
#define DEPTH 6.0f
#define RISE 1.32f
#define HALF 19.0f

static void build_row(prom_city *city, prom_solid *shape, float z, float y, prom_random *random)
{
    int n = city->options.detail < 3 ? 8 : 16;
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_LEAVES_SMALL, 0xd8ecb0, 1));
    for (int i = 0; i < n; i++) {
        float w = 2 * (HALF - 1) / (float)n, x = -HALF + 1 + w * (float)i;
        float h = prom_random_between(random, 1.1f, 1.5f), lean = 0.25f;
        prom_solid_picture(shape, (float[]){x, y + 0.1f, z - lean},
                           (float[]){x + w, y + 0.1f, z + lean},
                           (float[]){x + w, y + h, z + lean}, (float[]){x, y + h, z - lean});
        prom_solid_picture(shape, (float[]){x, y + 0.1f, z + lean},
                           (float[]){x + w, y + 0.1f, z - lean},
                           (float[]){x + w, y + h, z - lean}, (float[]){x, y + h, z + lean});
    }
}

void prom_city_build_terrace(prom_city *city, const prom_city_prototype *which,
                             prom_solid *shape)
{
    prom_random random = prom_random_stream(city->options.seed, 231, which->number);
    for (int i = 0; i < STEPS; i++) {
        // The middle step lies half a metre above the slope.
        float y = RISE * ((float)i - (STEPS - 1) / 2.0f) + 0.6f;
        float front = DEPTH * (STEPS / 2.0f - (float)i), back = front - DEPTH;
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_STONE, 0xb8ad98, 2));
        prom_solid_box(shape, -HALF, y - 4.5f, back, HALF, y, front,
                       PROM_FACE_SIDES & ~(i + 1 < STEPS ? PROM_FACE_BACK : 0));
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_GRASS, 0xe8dcb8, 5));
        prom_solid_floor(shape, -HALF, back, HALF, front, y, 10);
        for (int row = 0; row < 3; row++)
            build_row(city, shape, front - 1.2f - 1.8f * (float)row, y, &random);
    }
}

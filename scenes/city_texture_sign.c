// Pictures with something on them to read: shop signs, a clock's face, posters.
#include "scenes/city_color.h"
#include "scenes/city_texture.h"

#include <string.h>

// ---- letters

// Five by seven dots, a row of bits each from the top, the leftmost bit highest; the letters
// that the signs need.
typedef struct letter {
    char name;
    unsigned char rows[7];
} letter;

static const letter letters[] = {
    {'A', {14, 17, 17, 31, 17, 17, 17}}, {'B', {30, 17, 17, 30, 17, 17, 30}},
    {'C', {14, 17, 16, 16, 16, 17, 14}}, {'D', {30, 17, 17, 17, 17, 17, 30}},
    {'E', {31, 16, 16, 30, 16, 16, 31}}, {'F', {31, 16, 16, 30, 16, 16, 16}},
    {'G', {14, 17, 16, 23, 17, 17, 15}}, {'H', {17, 17, 17, 31, 17, 17, 17}},
    {'I', {14, 4, 4, 4, 4, 4, 14}},      {'K', {17, 18, 20, 24, 20, 18, 17}},
    {'L', {16, 16, 16, 16, 16, 16, 31}}, {'M', {17, 27, 21, 21, 17, 17, 17}},
    {'N', {17, 25, 21, 19, 17, 17, 17}}, {'O', {14, 17, 17, 17, 17, 17, 14}},
    {'R', {30, 17, 17, 30, 20, 18, 17}}, {'S', {15, 16, 16, 14, 1, 1, 30}},
    {'T', {31, 4, 4, 4, 4, 4, 4}},       {'U', {17, 17, 17, 17, 17, 17, 14}},
    {'W', {17, 17, 17, 21, 21, 27, 17}}, {'Y', {17, 17, 10, 4, 4, 4, 4}},
};

static bool dot_of(char name, int column, int row)
{
    for (size_t i = 0; i < sizeof letters / sizeof *letters; i++)
        if (letters[i].name == name) return letters[i].rows[row] >> (4 - column) & 1;
    return false;
}

static const struct {
    const char *text;
    color board, ink;
} signs[PROM_CITY_SIGN_COUNT] = {
    {"BAKERY", {0.33f, 0.20f, 0.12f, 1}, {0.95f, 0.84f, 0.58f, 1}},
    {"BOOKS", {0.10f, 0.24f, 0.20f, 1}, {0.92f, 0.88f, 0.74f, 1}},
    {"CAFE", {0.45f, 0.10f, 0.11f, 1}, {0.97f, 0.93f, 0.85f, 1}},
    {"FLOWERS", {0.90f, 0.88f, 0.80f, 1}, {0.20f, 0.38f, 0.20f, 1}},
    {"HOTEL", {0.09f, 0.13f, 0.25f, 1}, {0.90f, 0.75f, 0.38f, 1}},
    {"MUSIC", {0.12f, 0.12f, 0.13f, 1}, {0.86f, 0.86f, 0.84f, 1}},
    {"TAILOR", {0.24f, 0.28f, 0.33f, 1}, {0.93f, 0.91f, 0.86f, 1}},
    {"WINE", {0.30f, 0.08f, 0.17f, 1}, {0.93f, 0.82f, 0.60f, 1}},
};

color prom_city_sign_color(float x, float y)
{
    int i = (int)(y * PROM_CITY_SIGN_COUNT), count = (int)strlen(signs[i].text);
    float v = y * PROM_CITY_SIGN_COUNT - (float)i;
    color board = shade(signs[i].board, 1 + 0.12f * rough(x, y, 8, 1));
    // A letter's cell is six dots wide and nine high; boards are four times as wide as high.
    int row = (int)floorf(v * 11 - 2), column = (int)floorf(x * 44 - 22 + 3 * (float)count);
    bool inside = row >= 0 && row < 7 && column >= 0 && column < 6 * count && column % 6 < 5;
    if (inside && dot_of(signs[i].text[column / 6], column % 6, row)) return signs[i].ink;
    bool rim = v < 0.06f || v > 0.94f || x < 0.012f || x > 0.988f;
    return rim ? mix(board, signs[i].ink, 0.6f) : board;
}

// ---- a clock's face at ten past ten

static bool on_hand(float x, float y, float turns, float length, float half)
{
    float dx = sinf(2 * PI * turns), dy = -cosf(2 * PI * turns);
    float along = x * dx + y * dy, across = fabsf(x * dy - y * dx);
    return along > -0.06f && along < length && across < half;
}

color prom_city_clock_color(float x, float y)
{
    x -= 0.5f;
    y -= 0.5f;
    float r = hypotf(x, y), turns = atan2f(x, -y) / (2 * PI) * 12;
    float hour = fabsf(turns - roundf(turns));
    color gold = {0.80f, 0.62f, 0.26f, 1}, dark = {0.12f, 0.13f, 0.17f, 1};
    if (r > 0.46f) return gold;
    if (r > 0.32f && r < 0.42f && hour < 0.10f) return dark;
    if (on_hand(x, y, 10.17f / 12, 0.22f, 0.020f) || on_hand(x, y, 1.0f / 6, 0.34f, 0.014f))
        return dark;
    return (color){0.93f, 0.91f, 0.84f, 1};
}

// ---- posters pasted side by side

color prom_city_poster_color(float x, float y)
{
    int column = (int)(x * 5), row = (int)(y * 2);
    float u = x * 5 - (float)column, v = y * 2 - (float)row;
    color paper = {0.45f + 0.5f * cell_random(column, row, 31),
                   0.40f + 0.5f * cell_random(column, row, 32),
                   0.35f + 0.5f * cell_random(column, row, 33), 1};
    color ink = shade(paper, paper.g > 0.6f ? 0.35f : 1.7f);
    if (fminf(fminf(u, 1 - u), fminf(v, 1 - v)) < 0.03f) return grey(0.72f);
    float disc = hypotf(u - 0.5f, 0.9f * (v - 0.36f));
    bool line = v > 0.66f && v < 0.94f && (int)(v * 36) % 3 == 0 && u > 0.14f &&
                u < 0.55f + 0.35f * cell_random(column, (int)(v * 12), 34);
    if (disc < 0.16f + 0.12f * cell_random(column, row, 35) || line) return ink;
    return v < 0.12f && u > 0.12f && u < 0.88f ? ink : paper;
}

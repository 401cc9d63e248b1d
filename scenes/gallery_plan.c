#include "scenes/gallery_plan.h"

#include "scenes/random.h"

#include <math.h>
#include <string.h>

#define CORE_COLUMNS 4u
#define CORE_ROWS 3u
#define CORRIDOR_WIDTH 4.0f
#define HALL_STEPS 36
#define HALL_TREAD 0.25f
#define LANDING 1.65f

static const float core_widths[CORE_COLUMNS] = {8.0f, 9.0f, 15.0f, 8.0f};
static const float core_depths[CORE_ROWS] = {8.0f, 8.6f, 8.0f};

float prom_gallery_column_middle(const prom_gallery_plan *plan, uint32_t column)
{
    return 0.5f * (plan->column_x[column][0] + plan->column_x[column][1]);
}

float prom_gallery_row_middle(const prom_gallery_plan *plan, uint32_t row)
{
    return 0.5f * (plan->row_z[row][0] + plan->row_z[row][1]);
}

static uint32_t *cell(const prom_gallery_plan *plan, uint32_t storey, uint32_t column,
                      uint32_t row)
{
    return &plan->cells[(storey * plan->rows + row) * plan->columns + column];
}

uint32_t prom_gallery_room_at(const prom_gallery_plan *plan, uint32_t storey, uint32_t column,
                              uint32_t row)
{
    return *cell(plan, storey, column, row);
}

// ---- size

static bool in_core(const prom_gallery_plan *plan, uint32_t column)
{
    return column - plan->core < CORE_COLUMNS;
}

static bool in_core_rows(const prom_gallery_plan *plan, uint32_t row)
{
    return row - plan->core_row < CORE_ROWS;
}

// Away from the core, every sixth cell or so of a large plan is a garden court.
static bool is_court(const prom_gallery_plan *plan, uint32_t column, uint32_t row)
{
    if (plan->rows < 5 || in_core(plan, column) || plan->corridor[column]) return false;
    uint32_t c = column > plan->core ? column - plan->core : plan->core - column;
    return row % 2 == 1 && c % 3 == 1 && row != plan->core_row + 1;
}

// Columns go alternately to the east and the west, rows to the south and the north; the third
// column outwards of each side is a corridor.
static void measure(prom_gallery_plan *plan, uint32_t more_columns, uint32_t more_rows,
                    uint64_t seed)
{
    float x = 0, z = 0;
    plan->columns = CORE_COLUMNS + more_columns;
    plan->rows = CORE_ROWS + more_rows;
    plan->core = more_columns / 2;
    plan->core_row = more_rows / 2;
    for (uint32_t i = 0; i < plan->columns; i++) {
        bool core = in_core(plan, i);
        uint32_t out = core             ? 0
                       : i < plan->core ? plan->core - i
                                        : i - plan->core - CORE_COLUMNS + 1;
        // A column keeps its width as the plan grows.
        prom_random r = prom_random_stream(seed, 1 + (i < plan->core), out);
        plan->corridor[i] = !core && (i < plan->core ? out % 3 == 2 : out % 3 == 1);
        float width = core                ? core_widths[i - plan->core]
                      : plan->corridor[i] ? CORRIDOR_WIDTH
                                          : prom_random_between(&r, 6.8f, 9.8f);
        plan->column_x[i][0] = x;
        plan->column_x[i][1] = x + width;
        x += width + PROM_GALLERY_WALL;
    }
    for (uint32_t j = 0; j < plan->rows; j++) {
        prom_random r = prom_random_stream(seed, 3, j + 1000 - plan->core_row);
        float depth = in_core_rows(plan, j) ? core_depths[j - plan->core_row]
                                            : prom_random_between(&r, 7.0f, 9.2f);
        plan->row_z[j][0] = z;
        plan->row_z[j][1] = z + depth;
        z += depth + PROM_GALLERY_WALL;
    }
}

static uint32_t count_rooms(const prom_gallery_plan *plan)
{
    uint32_t n = 11 + 6; // the core
    for (uint32_t i = 0; i < plan->columns; i++) {
        if (plan->corridor[i]) {
            n += 2;
            continue;
        }
        for (uint32_t j = 0; j < plan->rows; j++)
            if (!in_core(plan, i) || !in_core_rows(plan, j)) n += is_court(plan, i, j) ? 0 : 2;
    }
    return n;
}

static void choose_size(prom_gallery_plan *plan, const prom_gallery_options *options)
{
    uint32_t columns = 0, rows = 0;
    measure(plan, 0, 0, options->seed);
    while (count_rooms(plan) < options->rooms) {
        float width = plan->column_x[plan->columns - 1][1];
        float depth = plan->row_z[plan->rows - 1][1];
        if (width < 2.2f * depth)
            columns++;
        else
            rows++;
        measure(plan, columns, rows, options->seed);
    }
}

// ---- rooms

static uint32_t add_room(prom_gallery_plan *plan, prom_gallery_kind kind, uint32_t storey,
                         uint32_t column, uint32_t row, uint32_t rows)
{
    prom_gallery_room room = {
        .kind = kind,
        .storey = storey,
        .column = column,
        .row = row,
        .rows = rows,
        .x0 = plan->column_x[column][0],
        .x1 = plan->column_x[column][1],
        .z0 = plan->row_z[row][0],
        .z1 = plan->row_z[row + rows - 1][1],
        .y0 = storey ? PROM_GALLERY_UPPER : 0,
    };
    uint32_t id = (uint32_t)plan->rooms.count;
    prom_array_push(&plan->rooms, room);
    bool both = kind == PROM_GALLERY_HALL || kind == PROM_GALLERY_ROTUNDA ||
                kind == PROM_GALLERY_STAIRS || kind == PROM_GALLERY_COURT;
    for (uint32_t s = storey; s < (both ? 2 : storey + 1); s++)
        for (uint32_t j = row; j < row + rows; j++) *cell(plan, s, column, j) = id;
    if (kind != PROM_GALLERY_COURT) plan->room_count++;
    return id;
}

static void finish_room(prom_gallery_room *room, prom_random *r)
{
    float height =
        room->kind == PROM_GALLERY_CORRIDOR ? 3.9f : prom_random_between(r, 4.5f, 5.2f);
    uint32_t pick = prom_random_below(r, 10);
    room->color = prom_random_below(r, 1u << 16);
    room->floor = prom_random_below(r, 1u << 16);
    room->ceiling = pick < 4   ? PROM_GALLERY_COFFERS
                    : pick < 6 ? PROM_GALLERY_VAULT
                    : pick < 7 ? PROM_GALLERY_BEAMS
                               : PROM_GALLERY_FLAT;
    if (room->storey && pick >= 3 && room->kind != PROM_GALLERY_LIBRARY)
        room->ceiling = PROM_GALLERY_SKYLIGHT;
    if (room->kind == PROM_GALLERY_CORRIDOR) room->ceiling = PROM_GALLERY_VAULT;
    if (room->ceiling == PROM_GALLERY_VAULT) height = fminf(height, 3.9f);
    if (room->kind == PROM_GALLERY_HALL) height = 11.4f;
    if (room->kind == PROM_GALLERY_ROTUNDA) height = 8.2f;
    if (room->kind == PROM_GALLERY_STAIRS) height = 11.0f;
    if (room->kind == PROM_GALLERY_COURT) height = PROM_GALLERY_ROOF;
    if (room->kind == PROM_GALLERY_ROTUNDA || room->kind == PROM_GALLERY_COURT)
        room->ceiling = PROM_GALLERY_OPEN;
    if (room->kind == PROM_GALLERY_STAIRS || room->kind == PROM_GALLERY_HALL)
        room->ceiling = PROM_GALLERY_SKYLIGHT;
    room->y1 = room->y0 + height;
}

// A room that is not given by the core: no two neighbours of a row are of a kind.
static prom_gallery_kind choose_kind(const prom_gallery_plan *plan, uint32_t storey,
                                     uint32_t column, uint32_t row, prom_random *r)
{
    static const prom_gallery_kind kinds[] = {
        PROM_GALLERY_CABINET, PROM_GALLERY_SCULPTURES, PROM_GALLERY_VITRINES,
        PROM_GALLERY_CABINET, PROM_GALLERY_SALON,      PROM_GALLERY_MODERN,
        PROM_GALLERY_LIBRARY, PROM_GALLERY_SCULPTURES, PROM_GALLERY_VITRINES,
    };
    uint32_t west = column ? *cell(plan, storey, column - 1, row) : PROM_GALLERY_OUTSIDE;
    for (;;) {
        prom_gallery_kind kind = kinds[prom_random_below(r, sizeof kinds / sizeof *kinds)];
        if (west == PROM_GALLERY_OUTSIDE || plan->rooms.data[west].kind != kind) return kind;
    }
}

static void add_core(prom_gallery_plan *plan)
{
    uint32_t c = plan->core, r = plan->core_row;
    add_room(plan, PROM_GALLERY_CABINET, 0, c, r + 1, 1);
    add_room(plan, PROM_GALLERY_LIBRARY, 0, c, r, 1);
    add_room(plan, PROM_GALLERY_ROTUNDA, 0, c + 1, r + 1, 1);
    add_room(plan, PROM_GALLERY_HALL, 0, c + 2, r, CORE_ROWS);
    add_room(plan, PROM_GALLERY_STAIRS, 0, c + 3, r + 2, 1);
    add_room(plan, PROM_GALLERY_VITRINES, 0, c + 3, r + 1, 1);
    add_room(plan, PROM_GALLERY_CABINET, 1, c + 3, r + 1, 1);
}

static void add_rooms(prom_gallery_plan *plan, uint64_t seed)
{
    size_t cells = (size_t)2 * plan->rows * plan->columns;
    plan->cells = prom_alloc(cells, sizeof *plan->cells);
    for (size_t i = 0; i < cells; i++) plan->cells[i] = PROM_GALLERY_OUTSIDE;
    add_core(plan);
    for (uint32_t storey = 0; storey < 2; storey++) {
        for (uint32_t i = 0; i < plan->columns; i++) {
            for (uint32_t j = 0; j < plan->rows; j++) {
                if (*cell(plan, storey, i, j) != PROM_GALLERY_OUTSIDE) continue;
                prom_random r = prom_random_stream(seed, 4 + storey, i * 1000u + j);
                if (plan->corridor[i])
                    add_room(plan, PROM_GALLERY_CORRIDOR, storey, i, 0, plan->rows);
                else if (is_court(plan, i, j))
                    add_room(plan, PROM_GALLERY_COURT, 0, i, j, 1);
                else
                    add_room(plan, choose_kind(plan, storey, i, j, &r), storey, i, j, 1);
            }
        }
    }
    for (size_t i = 0; i < plan->rooms.count; i++) {
        prom_random r = prom_random_stream(seed, 6, i);
        finish_room(&plan->rooms.data[i], &r);
    }
}

// ---- openings

static const prom_gallery_room *room_of(const prom_gallery_plan *plan, uint32_t id)
{
    return id == PROM_GALLERY_OUTSIDE ? NULL : &plan->rooms.data[id];
}

static void add_door(prom_gallery_plan *plan, prom_gallery_opening door, uint32_t storey,
                     bool grand)
{
    door.width = grand ? 1.8f : 1.3f;
    door.y0 = storey ? PROM_GALLERY_UPPER : 0;
    door.y1 = door.y0 + (grand ? 3.0f : 2.5f);
    prom_array_push(&plan->openings, door);
}

static void add_windows(prom_gallery_plan *plan, prom_gallery_opening window, uint32_t storey,
                        float span)
{
    float middle = window.middle, offset = span > 6.5f ? 0.24f * span : 0;
    window.window = true;
    window.width = 1.3f;
    window.y0 = (storey ? PROM_GALLERY_UPPER : 0) + 0.95f;
    window.y1 = window.y0 + 2.55f;
    for (int k = offset > 0 ? -1 : 0; k <= (offset > 0 ? 1 : 0); k += 2) {
        window.middle = middle + (float)k * offset;
        prom_array_push(&plan->openings, window);
    }
}

// A tall one over the half landing of the stairs.
static void add_landing_window(prom_gallery_plan *plan, prom_gallery_opening window)
{
    window.window = true;
    window.width = 2.2f;
    window.y0 = PROM_GALLERY_UPPER / 2 + 0.9f;
    window.y1 = window.y0 + 4.2f;
    prom_array_push(&plan->openings, window);
}

// Between two cells that meet, or a cell and the outside: what leads through, if anything.
static void connect(prom_gallery_plan *plan, prom_gallery_opening o, uint32_t storey,
                    float span, bool axis, prom_random *r)
{
    const prom_gallery_room *a = room_of(plan, o.rooms[0]), *b = room_of(plan, o.rooms[1]);
    const prom_gallery_room *inside = a && a->kind != PROM_GALLERY_COURT ? a : b;
    const prom_gallery_room *other = inside == a ? b : a;
    if (!inside || inside->kind == PROM_GALLERY_COURT || o.rooms[0] == o.rooms[1]) return;
    if (!other || other->kind == PROM_GALLERY_COURT) {
        if (inside->kind != PROM_GALLERY_STAIRS)
            add_windows(plan, o, storey, span);
        else if (!storey && !o.along_x)
            add_landing_window(plan, o);
        return;
    }
    bool rotunda = a->kind == PROM_GALLERY_ROTUNDA || b->kind == PROM_GALLERY_ROTUNDA;
    if (rotunda && storey) return;
    // The stairs stand along their east and west walls; their landings lead north.
    if (a->kind == PROM_GALLERY_STAIRS) return;
    if (b->kind == PROM_GALLERY_STAIRS && o.along_x) return;
    bool must = axis || rotunda || a->kind == PROM_GALLERY_HALL ||
                b->kind == PROM_GALLERY_HALL || b->kind == PROM_GALLERY_STAIRS || o.along_x;
    if (must || prom_random_unit(r) < 0.6f) add_door(plan, o, storey, axis && o.along_x);
}

static void connect_columns(prom_gallery_plan *plan, uint32_t storey, uint64_t seed)
{
    for (uint32_t j = 0; j < plan->rows; j++) {
        for (uint32_t i = 0; i <= plan->columns; i++) {
            prom_random r = prom_random_stream(seed, 7 + storey, i * 1000u + j);
            prom_gallery_opening o = {
                .rooms = {i ? *cell(plan, storey, i - 1, j) : PROM_GALLERY_OUTSIDE,
                          i < plan->columns ? *cell(plan, storey, i, j) : PROM_GALLERY_OUTSIDE},
                .along_x = true,
                .from = i ? plan->column_x[i - 1][1] : -PROM_GALLERY_WALL,
                .middle = prom_gallery_row_middle(plan, j),
            };
            o.to = o.from + PROM_GALLERY_WALL;
            connect(plan, o, storey, plan->row_z[j][1] - plan->row_z[j][0],
                    j == plan->core_row + 1, &r);
        }
    }
}

static void connect_rows(prom_gallery_plan *plan, uint32_t storey, uint64_t seed)
{
    for (uint32_t i = 0; i < plan->columns; i++) {
        for (uint32_t j = 0; j <= plan->rows; j++) {
            prom_random r = prom_random_stream(seed, 9 + storey, i * 1000u + j);
            prom_gallery_opening o = {
                .rooms = {j ? *cell(plan, storey, i, j - 1) : PROM_GALLERY_OUTSIDE,
                          j < plan->rows ? *cell(plan, storey, i, j) : PROM_GALLERY_OUTSIDE},
                .from = j ? plan->row_z[j - 1][1] : -PROM_GALLERY_WALL,
                .middle = prom_gallery_column_middle(plan, i),
            };
            o.to = o.from + PROM_GALLERY_WALL;
            connect(plan, o, storey, plan->column_x[i][1] - plan->column_x[i][0], false, &r);
        }
    }
}

void prom_gallery_plan_init(prom_gallery_plan *plan, const prom_gallery_options *options)
{
    *plan = (prom_gallery_plan){0};
    choose_size(plan, options);
    add_rooms(plan, options->seed);
    for (uint32_t storey = 0; storey < 2; storey++) {
        connect_columns(plan, storey, options->seed);
        connect_rows(plan, storey, options->seed);
    }
}

void prom_gallery_plan_finish(prom_gallery_plan *plan)
{
    prom_free(plan->cells);
    prom_array_finish(&plan->rooms);
    prom_array_finish(&plan->openings);
}

// ---- walls as frames

prom_gallery_face prom_gallery_room_face(const prom_gallery_room *room, prom_gallery_side side)
{
    const float quarter = 1.57079633f;
    switch (side) {
    case PROM_GALLERY_NORTH:
        return (prom_gallery_face){room->x0, room->z0, 0, room->x1 - room->x0};
    case PROM_GALLERY_SOUTH:
        return (prom_gallery_face){room->x1, room->z1, 2 * quarter, room->x1 - room->x0};
    case PROM_GALLERY_WEST:
        return (prom_gallery_face){room->x0, room->z1, quarter, room->z1 - room->z0};
    default:
        return (prom_gallery_face){room->x1, room->z0, -quarter, room->z1 - room->z0};
    }
}

bool prom_gallery_in_face(const prom_gallery_plan *plan, const prom_gallery_opening *opening,
                          uint32_t id, prom_gallery_side side, float *along)
{
    const prom_gallery_room *room = &plan->rooms.data[id];
    bool low = side == PROM_GALLERY_NORTH || side == PROM_GALLERY_WEST;
    bool along_x = side == PROM_GALLERY_WEST || side == PROM_GALLERY_EAST;
    if (opening->along_x != along_x || opening->rooms[low ? 1 : 0] != id) return false;
    float m = opening->middle;
    *along = side == PROM_GALLERY_NORTH   ? m - room->x0
             : side == PROM_GALLERY_SOUTH ? room->x1 - m
             : side == PROM_GALLERY_WEST  ? room->z1 - m
                                          : m - room->z0;
    return true;
}

// ---- stairs

void prom_gallery_flights(const prom_gallery_plan *plan, prom_gallery_flight flights[3])
{
    const prom_gallery_room *hall =
        &plan->rooms.data[*cell(plan, 0, plan->core + 2, plan->core_row)];
    const prom_gallery_room *room =
        &plan->rooms.data[*cell(plan, 0, plan->core + 3, plan->core_row + 2)];
    float head = hall->z0 + PROM_GALLERY_BALCONY, half = 0.5f * PROM_GALLERY_UPPER;
    flights[0] = (prom_gallery_flight){
        .x = 0.5f * (hall->x0 + hall->x1),
        .width = 3.0f,
        .z0 = head + HALL_STEPS * HALL_TREAD,
        .z1 = head,
        .y1 = PROM_GALLERY_UPPER,
        .steps = HALL_STEPS,
    };
    float north = room->z0 + LANDING, south = room->z1 - LANDING, width = 1.8f;
    flights[1] = (prom_gallery_flight){
        room->x1 - 0.5f * width, width, south, north, half, PROM_GALLERY_UPPER, HALL_STEPS / 2};
    flights[2] = (prom_gallery_flight){room->x0 + 0.5f * width, width, north, south, 0, half,
                                       HALL_STEPS / 2};
}

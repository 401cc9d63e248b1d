#include "scenes/city_parts.h"

#include <string.h>
#include <unistd.h>

#define BLOCKS_MAX 128u
#define DETAIL_MAX 4u
#define STYLES_MAX 2000u

static prom_status check(const prom_city_options *o, prom_error *error)
{
    if (o->blocks > BLOCKS_MAX)
        return prom_fail(error, PROM_ERR_USAGE, "a city of %u blocks a side; the most is %u",
                         o->blocks, BLOCKS_MAX);
    if (o->detail > DETAIL_MAX)
        return prom_fail(error, PROM_ERR_USAGE, "city detail %u; it goes from 1 to %u",
                         o->detail, DETAIL_MAX);
    if (o->styles > STYLES_MAX)
        return prom_fail(error, PROM_ERR_USAGE, "%u house styles; the most is %u", o->styles,
                         STYLES_MAX);
    return PROM_OK;
}

static uint32_t at_least(uint32_t value, uint32_t least)
{
    return value > least ? value : least;
}

static void init(prom_city *city, const prom_city_options *options, const char *glb_path)
{
    *city = (prom_city){.options = *options, .glb = prom_glb_create(glb_path)};
    if (!city->options.blocks) city->options.blocks = 4;
    if (!city->options.detail) city->options.detail = 2;
    // A row needs houses for its corners and its middle.
    if (!city->options.styles) city->options.styles = 12 * city->options.detail;
    city->options.styles = at_least(city->options.styles, 3);
    for (int i = 0; i < PROM_CITY_TEXTURE_COUNT; i++) city->images[i] = PROM_GLB_NONE;
    prom_city_list_prototypes(city);
}

static void finish(prom_city *city)
{
    prom_glb_destroy(city->glb);
    prom_array_finish(&city->paints);
    prom_array_finish(&city->prototypes);
    prom_array_finish(&city->grounds);
}

typedef void (*way_maker)(const prom_city_plan *plan, prom_path *path);

static prom_status write_way(const char *file, const prom_city_plan *plan, way_maker make,
                             const char *title, prom_error *error)
{
    prom_path path = {0};
    make(plan, &path);
    prom_status status = prom_path_save(file, &path, title, error);
    prom_path_finish(&path);
    return status;
}

static prom_status write_ways(const char *walk, const char *flight, const prom_city_plan *plan,
                              prom_error *error)
{
    prom_status status = PROM_OK;
    if (walk)
        status = write_way(walk, plan, prom_city_walk, "generated city, on the ground", error);
    if (!status && flight) {
        status =
            write_way(flight, plan, prom_city_flight, "generated city, from the air", error);
        if (status && walk) unlink(walk);
    }
    return status;
}

prom_status prom_city_write(const char *glb_path, const char *path_file,
                            const prom_city_options *options, uint64_t *triangles,
                            prom_error *error)
{
    prom_status status = check(options, error);
    if (status) return status;
    prom_city city;
    prom_city_plan plan;
    init(&city, options, glb_path);
    prom_city_plan_init(&plan, &city.options);
    prom_city_lay_out(&city, &plan);
    if (city.error.status)
        status = prom_fail(error, city.error.status, "%s", city.error.text);
    else
        status = prom_glb_finish(city.glb, "promenade city", error);
    if (!status) {
        status = write_ways(path_file, options->flight_file, &plan, error);
        if (status) unlink(glb_path); // all or none
    }
    if (!status && triangles) *triangles = prom_glb_triangles(city.glb);
    prom_city_plan_finish(&plan);
    finish(&city);
    return status;
}

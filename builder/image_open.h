// Private to the decoders of pictures (C++): opening a foreign picture, by what its bytes are.
#ifndef PROM_BUILDER_IMAGE_OPEN_H
#define PROM_BUILDER_IMAGE_OPEN_H

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <exception>
#include <memory>
#include <new>
#include <string>

extern "C" {
#include "metaobj/base/status.h"
}

namespace prom
{

// A picture beyond this is taken for a broken header (by taste: 16K x 16K).
constexpr int max_side = 16384;
constexpr uint64_t max_pixels = 1ull << 28;
constexpr uint64_t max_file_bytes = 1ull << 30;

struct opened_image {
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory; // outlives the reader
    std::unique_ptr<OIIO::ImageInput> input;
    OIIO::ImageSpec spec;
};

// Opens the first picture in `data`, which must outlive it, with straight alpha and one thread.
// Returns why it cannot be read; empty when it can.
std::string open_image(const uint8_t *data, size_t bytes, uint64_t pixel_limit,
                       opened_image &image);

std::string one_line(std::string text);
prom_status broken(prom_error *error, const char *name, const std::string &why);

// A C++ exception must not get into C.
template <class F> prom_status guarded(prom_error *error, const char *name, F body)
{
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return broken(error, name, "out of memory");
    } catch (const std::exception &e) {
        return broken(error, name, e.what());
    } catch (...) {
        return broken(error, name, "the decoder failed");
    }
}

} // namespace prom

#endif

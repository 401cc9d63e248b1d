#include "builder/image_open.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

extern "C" {
#include "builder/file_io.h"
#include "builder/image_io.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"
}

using namespace OIIO;

namespace
{

// Interleaved channels of the file -> RGBA floats in [0,1] as stored.
void expand(const float *in, int channels, size_t count, float *out)
{
    for (size_t i = 0; i < count; i++, in += channels, out += 4) {
        bool grey = channels < 3;
        for (int c = 0; c < 3; c++) out[c] = grey ? in[0] : in[c];
        out[3] = channels == 2 ? in[1] : channels == 4 ? in[3] : 1.0f;
        for (int c = 0; c < 4; c++) out[c] = std::isfinite(out[c]) ? out[c] : 0.0f;
    }
}

void expand8(const uint8_t *in, int channels, size_t count, uint8_t *out)
{
    for (size_t i = 0; i < count; i++, in += channels, out += 4) {
        bool grey = channels < 3;
        for (int c = 0; c < 3; c++) out[c] = grey ? in[0] : in[c];
        out[3] = channels == 2 ? in[1] : channels == 4 ? in[3] : 255;
    }
}

// How much a texel's colour counts in a mean: its alpha, with a little for empty texels, so
// that a picture whose alpha is later ignored keeps the colours there.
float weight_of(float alpha)
{
    return alpha * (254.0f / 255.0f) + 1.0f / 255.0f;
}

// Resamples in linear light, colours weighted by alpha.
std::string resample(const uint8_t *rgba, int width, int height, uint8_t *out, int w, int h)
{
    std::vector<float> linear(size_t(width) * size_t(height) * 4);
    for (size_t i = 0; i < linear.size(); i += 4) {
        float weight = weight_of(float(rgba[i + 3]) / 255.0f);
        for (size_t c = 0; c < 3; c++)
            linear[i + c] = prom_srgb8_to_linear(rgba[i + c]) * weight;
        linear[i + 3] = weight;
    }
    ImageBuf source(ImageSpec(width, height, 4, TypeDesc::FLOAT), linear.data());
    std::vector<float> small(size_t(w) * size_t(h) * 4);
    ImageBuf target(ImageSpec(w, h, 4, TypeDesc::FLOAT), small.data());
    // One thread: the library's own pool does not survive a fork.
    if (!ImageBufAlgo::resize(target, source, "triangle", 2.0f, ROI::All(), 1))
        return target.geterror();
    for (size_t i = 0; i < small.size(); i += 4) {
        float weight = std::max(small[i + 3], 1.0f / 255.0f);
        for (size_t c = 0; c < 3; c++)
            out[i + c] = prom_linear_to_srgb8(std::clamp(small[i + c] / weight, 0.0f, 1.0f));
        float alpha = (weight - 1.0f / 255.0f) * (255.0f / 254.0f);
        out[i + 3] = uint8_t(std::lround(std::clamp(alpha, 0.0f, 1.0f) * 255.0f));
    }
    return "";
}

// Reduces to at most max_px on a side. `rgba` is replaced.
std::string reduce(std::vector<uint8_t> &rgba, int &width, int &height, int max_px)
{
    double scale = double(max_px) / std::max(width, height);
    int w = std::clamp(int(std::lround(width * scale)), 1, max_px);
    int h = std::clamp(int(std::lround(height * scale)), 1, max_px);
    std::vector<uint8_t> small(size_t(w) * size_t(h) * 4);
    std::string why = resample(rgba.data(), width, height, small.data(), w, h);
    if (!why.empty()) return why;
    rgba.swap(small);
    width = w;
    height = h;
    return "";
}

std::string read_pixels(ImageInput &input, const ImageSpec &spec, std::vector<uint8_t> &rgba)
{
    int channels = std::min(spec.nchannels, 4);
    size_t count = size_t(spec.width) * size_t(spec.height);
    rgba.resize(count * 4);
    // Formats that store floats store linear light.
    if (spec.format.is_floating_point()) {
        std::vector<float> raw(count * size_t(channels)), wide(count * 4);
        if (!input.read_image(0, 0, 0, channels, TypeDesc::FLOAT, raw.data()))
            return input.geterror();
        expand(raw.data(), channels, count, wide.data());
        for (size_t i = 0; i < wide.size(); i++) {
            float v = std::clamp(wide[i], 0.0f, 1.0f);
            rgba[i] = i % 4 == 3 ? uint8_t(std::lround(v * 255.0f)) : prom_linear_to_srgb8(v);
        }
        return "";
    }
    std::vector<uint8_t> raw(count * size_t(channels));
    if (!input.read_image(0, 0, 0, channels, TypeDesc::UINT8, raw.data()))
        return input.geterror();
    expand8(raw.data(), channels, count, rgba.data());
    return "";
}

prom_status decode(const uint8_t *data, size_t bytes, const char *name, uint32_t max_px,
                   uint32_t *width, uint32_t *height, uint8_t **rgba, prom_error *error)
{
    prom::opened_image image;
    std::vector<uint8_t> pixels;
    std::string why = prom::open_image(data, bytes, prom::max_pixels, image);
    if (why.empty()) why = read_pixels(*image.input, image.spec, pixels);
    int w = image.spec.width, h = image.spec.height;
    if (why.empty() && uint32_t(std::max(w, h)) > max_px)
        why = reduce(pixels, w, h, int(max_px));
    if (!why.empty()) return prom::broken(error, name, why);
    *rgba = static_cast<uint8_t *>(prom_alloc(pixels.size(), 1));
    std::memcpy(*rgba, pixels.data(), pixels.size());
    *width = uint32_t(w);
    *height = uint32_t(h);
    return PROM_OK;
}

bool encode(uint32_t width, uint32_t height, int channels, const uint8_t *pixels,
            std::vector<unsigned char> &bytes, std::string &why)
{
    auto output = ImageOutput::create("png");
    if (!output) {
        why = OIIO::geterror();
        return false;
    }
    ImageSpec spec(int(width), int(height), channels, TypeDesc::UINT8);
    Filesystem::IOVecOutput memory(bytes);
    spec["oiio:UnassociatedAlpha"] = 1;
    spec["oiio:ColorSpace"] = "sRGB";
    output->threads(1);
    bool good = output->set_ioproxy(&memory) && output->open("picture.png", spec) &&
                output->write_image(TypeDesc::UINT8, pixels) && output->close();
    if (!good) why = prom::one_line(output->geterror());
    return good;
}

} // namespace

prom_status prom_image_read_memory(const void *data, size_t bytes, const char *name,
                                   uint32_t max_px, uint32_t *width, uint32_t *height,
                                   uint8_t **rgba, prom_error *error)
{
    return prom::guarded(error, name, [&] {
        return decode(static_cast<const uint8_t *>(data), bytes, name,
                      std::clamp(max_px, 1u, uint32_t(prom::max_side)), width, height, rgba,
                      error);
    });
}

prom_status prom_image_read(const char *path, uint32_t max_px, uint32_t *width,
                            uint32_t *height, uint8_t **rgba, prom_error *error)
{
    return prom::guarded(error, path, [&] {
        prom_bytes file;
        prom_status status = prom_file_read(path, prom::max_file_bytes, &file, error);
        if (status) return status;
        status = prom_image_read_memory(file.data, file.count, path, max_px, width, height,
                                        rgba, error);
        prom_free(file.data);
        return status;
    });
}

bool prom_image_resize(const uint8_t *rgba, uint32_t width, uint32_t height, uint8_t *out,
                       uint32_t out_width, uint32_t out_height)
{
    return prom::guarded(nullptr, "resampling", [&] {
               std::string why = resample(rgba, int(width), int(height), out, int(out_width),
                                          int(out_height));
               return why.empty() ? PROM_OK : PROM_ERR_UNSUPPORTED;
           }) == PROM_OK;
}

prom_status prom_image_encode_png(uint32_t width, uint32_t height, int channels,
                                  const uint8_t *pixels, uint8_t **png, size_t *bytes,
                                  prom_error *error)
{
    return prom::guarded(error, "PNG", [&] {
        std::vector<unsigned char> data;
        std::string why;
        if (!encode(width, height, channels, pixels, data, why))
            return prom_fail(error, PROM_ERR_OUTPUT, "a %ux%u PNG cannot be encoded: %s", width,
                             height, why.c_str());
        *png = static_cast<uint8_t *>(prom_alloc(data.size(), 1));
        std::memcpy(*png, data.data(), data.size());
        *bytes = data.size();
        return PROM_OK;
    });
}

prom_status prom_image_write_png(const char *path, uint32_t width, uint32_t height,
                                 int channels, const uint8_t *pixels, prom_error *error)
{
    uint8_t *png = nullptr;
    size_t bytes = 0;
    prom_status status =
        prom_image_encode_png(width, height, channels, pixels, &png, &bytes, error);
    if (status) return status;
    prom_bytes part = {png, bytes};
    status = prom_file_write(path, &part, 1, error);
    prom_free(png);
    return status;
}

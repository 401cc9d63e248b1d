#include "builder/image_open.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

extern "C" {
#include "builder/file_io.h"
#include "builder/picture_parts.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"
}

using namespace OIIO;

namespace
{

// Where the colours are among the channels of a file.
struct channel_map {
    std::array<int, 3> color;
    int count;      // 1 or 3
    int alpha;      // -1: none
    int begin, end; // the range that holds them all
};

int named(const ImageSpec &spec, const char *name)
{
    auto begin = spec.channelnames.begin(), end = spec.channelnames.end();
    auto at = std::find(begin, end, name) - begin; // some readers name too few or too many
    return at < std::min<ptrdiff_t>(end - begin, spec.nchannels) ? int(at) : -1;
}

// By name where there are names, as in an EXR of many layers; else the first three, or grey.
channel_map map_channels(const ImageSpec &spec)
{
    channel_map m = {{named(spec, "R"), named(spec, "G"), named(spec, "B")}, 3, -1, 0, 0};
    m.alpha = named(spec, "A");
    if (m.alpha < 0 && spec.alpha_channel < spec.nchannels) m.alpha = spec.alpha_channel;
    if (std::min({m.color[0], m.color[1], m.color[2]}) < 0) {
        std::vector<int> others;
        for (int c = 0; c < spec.nchannels; c++)
            if (c != m.alpha && c != spec.z_channel) others.push_back(c);
        if (others.empty()) others.push_back(0); // a lone mask or depth
        m.count = others.size() < 3 ? 1 : 3;
        std::copy_n(others.begin(), m.count, m.color.begin());
    }
    auto last = m.color.begin() + m.count;
    if (std::find(m.color.begin(), last, m.alpha) != last) m.alpha = -1;
    auto [least, greatest] = std::minmax_element(m.color.begin(), last);
    m.begin = m.alpha < 0 ? *least : std::min(*least, m.alpha);
    m.end = std::max(*greatest, m.alpha) + 1;
    return m;
}

// An EXR stores a part of what it displays, or more. Black and transparent is what it lacks.
template <class T> std::vector<T> to_display(const ImageSpec &spec, std::vector<T> raw, int n)
{
    size_t width = size_t(spec.full_width);
    std::vector<T> out(width * size_t(spec.full_height) * size_t(n));
    int x0 = std::max(spec.x, spec.full_x);
    int x1 = std::min(spec.x + spec.width, spec.full_x + spec.full_width);
    int y0 = std::max(spec.y, spec.full_y);
    int y1 = std::min(spec.y + spec.height, spec.full_y + spec.full_height);
    for (int y = y0; y < y1 && x0 < x1; y++) {
        size_t from = size_t(y - spec.y) * size_t(spec.width) + size_t(x0 - spec.x);
        size_t to = size_t(y - spec.full_y) * width + size_t(x0 - spec.full_x);
        std::copy_n(raw.data() + from * size_t(n), size_t(x1 - x0) * size_t(n),
                    out.data() + to * size_t(n));
    }
    return out;
}

bool has_window(const ImageSpec &spec)
{
    return spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
           spec.height != spec.full_height;
}

struct job {
    prom::opened_image image;
    channel_map map;
    bool window; // a display window of its own
    prom_picture_file *file;
};

// Reads as T and stores colours as U = convert(T). `opaque`: the alpha that covers.
template <class T, class U, class F>
std::string read_as(job &j, TypeDesc type, T opaque, F convert)
{
    const ImageSpec &spec = j.image.spec;
    const channel_map &m = j.map;
    int n = m.end - m.begin;
    std::vector<T> raw(size_t(spec.width) * size_t(spec.height) * size_t(n));
    // A reader may go on after damage with pixels of its own making, and only leave a message.
    if (!j.image.input->read_image(0, 0, m.begin, m.end, type, raw.data()) ||
        j.image.input->has_error())
        return j.image.input->geterror();
    if (j.window) raw = to_display(spec, std::move(raw), n);
    prom_picture &p = j.file->picture;
    size_t count = size_t(p.width) * p.height;
    auto *out = static_cast<U *>(prom_alloc(count, size_t(m.count) * sizeof(U)));
    j.file->pixels = out;
    const T *in = raw.data();
    for (size_t i = 0; i < count; i++, in += n) {
        for (int c = 0; c < m.count; c++) *out++ = convert(in[m.color[size_t(c)] - m.begin]);
        if (m.alpha >= 0 && in[m.alpha - m.begin] < opaque) j.file->transparent = true;
    }
    return "";
}

std::string read_16(job &j)
{
    std::vector<float> linear(65536);
    for (size_t v = 0; v < linear.size(); v++)
        linear[v] = prom_srgb_to_linear(float(v) / 65535.0f);
    return read_as<uint16_t, float>(j, TypeDesc::UINT16, 65535,
                                    [&](uint16_t v) { return linear[v]; });
}

std::string read_values(job &j)
{
    TypeDesc type = j.image.spec.channelformat(j.map.color[0]);
    j.file->picture.floats = type != TypeDesc::UINT8;
    if (type == TypeDesc::UINT8)
        return read_as<uint8_t, uint8_t>(j, type, 255, [](uint8_t v) { return v; });
    if (type == TypeDesc::UINT16) return read_16(j);
    if (type.is_floating_point())
        return read_as<float, float>(j, TypeDesc::FLOAT, 1.0f, [](float v) { return v; });
    return read_as<float, float>(j, TypeDesc::FLOAT, 1.0f, prom_srgb_to_linear);
}

std::string read_picture(job &j)
{
    const ImageSpec &spec = j.image.spec;
    prom_picture &p = j.file->picture;
    std::string format = j.image.input->format_name();
    j.map = map_channels(spec);
    j.window = format == "openexr" && has_window(spec);
    if (format == "openexr" && !spec.channelformat(j.map.color[0]).is_floating_point())
        return "its channels are whole numbers, not colours";
    p.width = uint32_t(j.window ? spec.full_width : spec.width);
    p.height = uint32_t(j.window ? spec.full_height : spec.height);
    p.channels = uint32_t(j.map.count);
    if (p.width < 1 || p.height < 1 || p.width > PROM_PICTURE_SIDE_MAX ||
        p.height > PROM_PICTURE_SIDE_MAX ||
        uint64_t(p.width) * p.height > PROM_PICTURE_PIXELS_MAX)
        return "its display window is too large";
    j.file->left_out = uint32_t(spec.nchannels - j.map.count - (j.map.alpha >= 0));
    std::string why = read_values(j);
    if (why.empty() && format == "webp" && j.file->transparent)
        return "its reader multiplies the colours of a transparent WebP by alpha; convert it "
               "to "
               "PNG";
    return why;
}

prom_status decode(const prom_bytes &bytes, const char *path, prom_picture_file *file,
                   prom_error *error)
{
    job j = {};
    j.file = file;
    std::string why =
        prom::open_image(bytes.data, bytes.count, PROM_PICTURE_PIXELS_MAX, j.image);
    if (why.empty()) why = read_picture(j);
    if (!why.empty()) return prom::broken(error, path, why);
    file->picture.pixels = file->pixels;
    return PROM_OK;
}

} // namespace

prom_status prom_picture_decode(const char *path, prom_picture_file *file, prom_error *error)
{
    return prom::guarded(error, path, [&] {
        prom_bytes bytes;
        *file = {};
        prom_status status = prom_file_read(path, prom::max_file_bytes, &bytes, error);
        if (status) return status;
        status = decode(bytes, path, file, error);
        prom_free(bytes.data);
        return status;
    });
}

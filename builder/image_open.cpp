#include "builder/image_open.h"

#include <algorithm>
#include <cstring>
#include <unistd.h>

using namespace OIIO;

namespace
{

bool starts(const uint8_t *data, size_t bytes, size_t at, const char *magic, size_t length)
{
    return bytes >= at + length && std::memcmp(data + at, magic, length) == 0;
}

// TGA has no magic: the header's fields must be possible ones.
bool is_tga(const uint8_t *d, size_t bytes)
{
    if (bytes < 18 || d[1] > 1) return false;
    int type = d[2] & ~8;
    if ((d[2] & ~11) || type < 1 || type > 3 || (type == 1 && d[1] != 1)) return false;
    int bits = d[16];
    bool depth = bits == 8 || bits == 15 || bits == 16 || bits == 24 || bits == 32;
    return depth && (d[12] | d[13]) && (d[14] | d[15]);
}

// The reader by what the data are, never by the file's ending: many decoders crash when fed a
// foreign format. NULL when unknown.
const char *format_of(const uint8_t *d, size_t n)
{
    static const struct {
        size_t at;
        const char *magic;
        size_t length;
        const char *format;
    } table[] = {
        {0, "\x89PNG\r\n\x1a\n", 8, "png"},
        {0, "\xff\xd8\xff", 3, "jpeg"},
        {0, "II*\0", 4, "tiff"},
        {0, "MM\0*", 4, "tiff"},
        {0, "II+\0", 4, "tiff"},
        {0, "MM\0+", 4, "tiff"},
        {0, "DDS ", 4, "dds"},
        {0, "GIF8", 4, "gif"},
        {0, "BM", 2, "bmp"},
        {8, "WEBP", 4, "webp"},
        {0, "#?", 2, "hdr"},
        {0, "8BPS", 4, "psd"},
        {0, "\x76\x2f\x31\x01", 4, "openexr"},
        {4, "jP  \r\n", 6, "jpeg2000"},
        {0, "\xff\x4f\xff\x51", 4, "jpeg2000"},
        {4, "ftypheic", 8, "heif"},
        {4, "ftypmif1", 8, "heif"},
        {4, "ftypavif", 8, "heif"},
        {0, "\x01\xda", 2, "sgi"},
        {0, "SDPX", 4, "dpx"},
        {0, "XPDS", 4, "dpx"},
        {0, "\x80\x2a\x5f\xd7", 4, "cineon"},
        {0, "SIMPLE  =", 9, "fits"},
        {0, "FOR4", 4, "iff"},
        {0, "\0\0\1\0", 4, "ico"},
    };
    for (const auto &row : table)
        if (starts(d, n, row.at, row.magic, row.length)) return row.format;
    bool pnm = n > 2 && d[0] == 'P' && std::memchr("123456Ff", d[1], 8);
    if (pnm && std::memchr(" \t\r\n", d[2], 4)) return "pnm";
    return is_tga(d, n) ? "targa" : nullptr;
}

std::string check_spec(const ImageSpec &spec, uint64_t pixel_limit)
{
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.deep)
        return "it has no two-dimensional picture";
    if (spec.width <= prom::max_side && spec.height <= prom::max_side &&
        uint64_t(spec.width) * uint64_t(spec.height) <= pixel_limit && spec.nchannels <= 64)
        return "";
    std::string side = std::to_string(prom::max_side);
    return "it claims " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
           " pixels of " + std::to_string(spec.nchannels) + " channel(s); at most " + side +
           "x" + side + " pixels, " + std::to_string(pixel_limit >> 20) +
           " Mi in all, of 64 channels are read";
}

// The few readers that insist on a file get one, which is gone once they have it open.
std::string temporary_copy(const uint8_t *data, size_t bytes, std::string &path)
{
    path = Filesystem::temp_directory_path() + "/promenade-XXXXXX";
    int fd = mkstemp(path.data());
    if (fd < 0) return "no temporary file could be made";
    bool written = write(fd, data, bytes) == ssize_t(bytes);
    close(fd);
    if (written) return "";
    unlink(path.c_str());
    return "no temporary file could be written";
}

} // namespace

namespace prom
{

std::string one_line(std::string text)
{
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text.empty() ? "unknown reason" : text;
}

prom_status broken(prom_error *error, const char *name, const std::string &why)
{
    return prom_fail(error, PROM_ERR_INPUT, "%s: the picture cannot be read: %s", name,
                     one_line(why).c_str());
}

std::string open_image(const uint8_t *data, size_t bytes, uint64_t pixel_limit,
                       opened_image &image)
{
    const char *format = format_of(data, bytes);
    if (!format) return "it is of no known picture format";
    image.input = ImageInput::create(format);
    if (!image.input) {
        (void)OIIO::geterror();
        return std::string("this build reads no ") + format;
    }
    image.input->threads(1);
    image.memory = std::make_unique<Filesystem::IOMemReader>(data, bytes);
    bool from_memory =
        image.input->supports("ioproxy") && image.input->set_ioproxy(image.memory.get());
    std::string file = std::string("picture.") + format;
    if (!from_memory) {
        std::string why = temporary_copy(data, bytes, file);
        if (!why.empty()) return why;
    }
    ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    bool open = image.input->open(file, image.spec, config);
    if (!from_memory) unlink(file.c_str());
    return open ? check_spec(image.spec, pixel_limit) : one_line(image.input->geterror());
}

} // namespace prom

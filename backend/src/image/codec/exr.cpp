// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR reader: pictures from OpenEXR files, their headers checked first. OpenEXR allocates
// memory by the sizes in the header, so our own walk through the header checks them first
// (OpenEXR's own limits are global and would hold for our host program, too). Where OpenEXR reads a
// header otherwise than we do (it takes an attribute's size from its type), the file is refused.
#include "base/error.h"
#include "image/codec/image_codecs.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <algorithm>
#include <cstring>
#include <limits>

namespace lodestone::image {
namespace {

struct PixelWindow {
    int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;  // both ends inclusive

    int64_t width() const { return int64_t{x1} - x0 + 1; }
    int64_t height() const { return int64_t{y1} - y0 + 1; }
};

struct ExrLayout {
    PixelWindow data;
    PixelWindow display;
    uint64_t tile_pixels = 0;
    uint64_t channels = 0;
};

class ExrMemoryStream : public Imf::IStream {
public:
    ExrMemoryStream(std::string_view bytes, const std::string& name)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}

    bool read(char out[], int size) override {
        if (size < 0 || static_cast<uint64_t>(size) > bytes_.size() - at_)
            throw std::runtime_error("the file ends too early");
        std::memcpy(out, bytes_.data() + at_, static_cast<size_t>(size));
        at_ += static_cast<size_t>(size);
        return at_ < bytes_.size();
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t position) override {
        if (position > bytes_.size())
            throw std::runtime_error("the file ends too early");
        at_ = static_cast<size_t>(position);
    }

private:
    std::string_view bytes_;
    size_t at_ = 0;
};

template <typename T>
T value_at(std::string_view bytes, size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// Reads a name of at most 255 characters that ends with 0; moves `at` behind it.
std::string_view word(std::string_view bytes, size_t& at) {
    const size_t end = bytes.substr(0, std::min(bytes.size(), at + 256)).find('\0', at);
    if (end == std::string_view::npos)
        throw std::runtime_error("the header ends too early");
    const std::string_view found = bytes.substr(at, end - at);
    at = end + 1;
    return found;
}

/// Reads the layout from the header.
/// source: openexr.com, "OpenEXR File Layout" (magic, version and flags, attributes).
ExrLayout layout_of(std::string_view bytes) {
    // Law: bit 11 of the version field marks deep data ("OpenEXR File Layout").
    constexpr uint32_t kDeep = 0x800;
    // Law: bit 12 of the version field marks several parts ("OpenEXR File Layout").
    constexpr uint32_t kManyParts = 0x1000;
    if (bytes.size() < 8)
        throw std::runtime_error("the header ends too early");
    if ((value_at<uint32_t>(bytes, 4) & (kDeep | kManyParts)) != 0)
        throw std::runtime_error("deep pictures and pictures of several parts are not read");
    ExrLayout layout;
    size_t at = 8;
    for (std::string_view name = word(bytes, at); !name.empty(); name = word(bytes, at)) {
        word(bytes, at);  // the type
        if (bytes.size() - at < 4)
            throw std::runtime_error("the header ends too early");
        const auto size = value_at<uint32_t>(bytes, at);
        at += 4;
        if (size > bytes.size() - at)
            throw std::runtime_error("the header ends too early");
        if ((name == "dataWindow" || name == "displayWindow") && size == 16) {
            (name == "dataWindow" ? layout.data : layout.display) =
                value_at<PixelWindow>(bytes, at);
        } else if (name == "tiles" && size >= 8) {
            layout.tile_pixels =
                uint64_t{value_at<uint32_t>(bytes, at)} * value_at<uint32_t>(bytes, at + 4);
        } else if (name == "channels") {
            layout.channels = size / 18;  // each has at least a letter, its 0 and 16 bytes
        }
        at += size;
    }
    return layout;
}

/// Rows that are read at a time.
/// Law: the rows of the largest block of any compression (DWAB).
constexpr int kRowsAtOnce = 256;

void check_layout(const ExrLayout& layout, int64_t most_pixels) {
    // Pixels along a side.
    // Taste: a larger value lets a file ask for larger tables of rows.
    constexpr int64_t kMostSide = 1 << 16;
    // Channels of a file.
    // Taste: a larger value lets a file ask for more memory a pixel.
    constexpr uint64_t kMostChannels = 256;
    // Bytes that OpenEXR may take for the rows it reads at a time.
    // Taste: a larger value reads wider pictures.
    constexpr uint64_t kMostBufferBytes = uint64_t{1} << 30u;
    for (const PixelWindow& window : {layout.data, layout.display}) {
        if (window.width() < 1 || window.height() < 1 || window.width() > kMostSide ||
            window.height() > kMostSide || window.width() * window.height() > most_pixels)
            throw std::runtime_error(text("a window of ", window.width(), " x ", window.height(),
                                          " pixels is empty or too large"));
    }
    const int64_t rows = std::min<int64_t>(kRowsAtOnce, layout.data.height());
    const auto block =
        std::max(static_cast<uint64_t>(layout.data.width() * rows), layout.tile_pixels);
    if (layout.channels > kMostChannels || layout.tile_pixels > (uint64_t{1} << 28u) ||
        block * std::max<uint64_t>(layout.channels, 1) * 4 > kMostBufferBytes)
        throw std::runtime_error("too many channels, or tiles too large");
}

bool same(const PixelWindow& ours, const Imath::Box2i& theirs) {
    return ours.x0 == theirs.min.x && ours.y0 == theirs.min.y && ours.x1 == theirs.max.x &&
           ours.y1 == theirs.max.y;
}

/// The part within the display window; without a part, all of the window.
PixelWindow window_of(const ExrLayout& layout, const std::optional<ImageRegion>& part,
                      const std::string& name) {
    const PixelWindow& all = layout.display;
    if (!part)
        return all;
    if (part->left < 0 || part->top < 0 || part->width < 1 || part->height < 1 ||
        int64_t{part->left} + part->width > all.width() ||
        int64_t{part->top} + part->height > all.height())
        fail(Status::InvalidArgument, "'", name, "' has ", all.width(), " x ", all.height(),
             " pixels: no part of ", part->width, " x ", part->height, " at ", part->left, ", ",
             part->top);
    const int32_t x = all.x0 + part->left;
    const int32_t y = all.y0 + part->top;
    return {x, y, x + part->width - 1, y + part->height - 1};
}

/// Reads the pixels of `data` that `window` has into `pixels` (RGBA, the window's rows), a few rows
/// at a time.
void read_rows(Imf::InputFile& file, const PixelWindow& data, const PixelWindow& window, bool gray,
               std::vector<float>& pixels) {
    const int32_t first = std::max(window.x0, data.x0);
    const int64_t columns = int64_t{std::min(window.x1, data.x1)} - first + 1;
    const int64_t end = int64_t{std::min(window.y1, data.y1)} + 1;
    if (columns < 1)
        return;
    const size_t column = 4 * sizeof(float);
    const size_t row = column * static_cast<size_t>(data.width());
    std::vector<float> rows(
        4 * static_cast<size_t>(data.width() * std::min<int64_t>(kRowsAtOnce, data.height())));
    int64_t next = std::max(window.y0, data.y0);
    while (next < end) {  // whole blocks of the file, but for the first and the last
        const int64_t from = next;
        next = std::min(end, from + kRowsAtOnce - (from - data.y0) % kRowsAtOnce);
        // OpenEXR addresses pixel (x, y) at base + x column + y row.
        const auto base = reinterpret_cast<intptr_t>(rows.data()) -
                          static_cast<intptr_t>(column) * data.x0 -
                          static_cast<intptr_t>(row) * static_cast<intptr_t>(from);
        Imf::FrameBuffer buffer;
        const char* const names[4] = {gray ? "Y" : "R", "G", "B", "A"};
        for (size_t i = 0; i < 4; ++i) {
            if (gray && (i == 1 || i == 2))
                continue;
            buffer.insert(names[i], Imf::Slice(Imf::FLOAT,
                                               reinterpret_cast<char*>(base) +  // NOLINT
                                                   i * sizeof(float),
                                               column, row, 1, 1, i == 3 ? 1.0 : 0.0));
        }
        file.setFrameBuffer(buffer);
        file.readPixels(static_cast<int>(from), static_cast<int>(next - 1));
        for (int64_t y = from; y < next; ++y)
            std::copy_n(rows.data() + 4 * ((y - from) * data.width() + first - data.x0),
                        4 * columns,
                        pixels.data() + 4 * ((y - window.y0) * window.width() + first - window.x0));
    }
}

PackedImage decode(std::string_view bytes, const std::string& name,
                   const std::optional<ImageRegion>& part) {
    const ExrLayout layout = layout_of(bytes);
    check_layout(layout,
                 part ? std::numeric_limits<int64_t>::max() : static_cast<int64_t>(kMostPixels));
    ExrMemoryStream memory(bytes, name);
    Imf::InputFile file(memory, 0);
    if (!same(layout.data, file.header().dataWindow()) ||
        !same(layout.display, file.header().displayWindow()))
        throw std::runtime_error("its header says two things about its size");
    const Imf::ChannelList& channels = file.header().channels();
    const bool gray = channels.findChannel("R") == nullptr && channels.findChannel("Y") != nullptr;
    if (!gray && channels.findChannel("R") == nullptr)
        throw std::runtime_error("it has neither a channel R nor Y");
    if (channels.findChannel("RY") != nullptr)
        throw std::runtime_error("luminance and chroma are not read");
    const PixelWindow window = window_of(layout, part, name);
    PackedImage image;
    image.width = static_cast<int>(window.width());
    image.height = static_cast<int>(window.height());
    image.depth = 32;
    image.floats.resize(4 * image.size(), 0.0f);
    read_rows(file, layout.data, window, gray, image.floats);
    const bool opaque = channels.findChannel("A") == nullptr;
    for (size_t i = 0; i < image.floats.size() && (gray || opaque); i += 4) {
        float* pixel = image.floats.data() + i;
        if (gray)
            pixel[1] = pixel[2] = pixel[0];
        if (opaque)
            pixel[3] = 1;
    }
    return image;
}

}  // namespace

PackedImage decode_exr(std::string_view bytes, const std::string& name,
                       const std::optional<ImageRegion>& part) {
    try {
        return decode(bytes, name, part);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {  // OpenEXR's own errors are std::exceptions
        fail(Status::BadFile, "'", name, "' cannot be read as OpenEXR: ", e.what());
    }
}

}  // namespace lodestone::image

// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR allocates by what the header says, so the header's sizes are checked by our own walk
// through it first (OpenEXR's own limits are global and would hold for our host program, too). Where
// OpenEXR reads a header otherwise than we do (it takes an attribute's size from its type), it is refused.
#include "base/error.h"
#include "image/codecs.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <algorithm>
#include <cstring>

namespace lodestone::image {
namespace {

struct Window {
    int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;  // inclusive

    int64_t width() const { return int64_t{x1} - x0 + 1; }
    int64_t height() const { return int64_t{y1} - y0 + 1; }
};

struct Layout {
    Window data;
    Window display;
    uint64_t tile_pixels = 0;
    uint64_t channels = 0;
};

class Memory : public Imf::IStream {
public:
    Memory(std::string_view bytes, const std::string& name)
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

/// A name of at most 255 characters that ends with 0; moves `at` behind it.
std::string_view word(std::string_view bytes, size_t& at) {
    const size_t end = bytes.substr(0, std::min(bytes.size(), at + 256)).find('\0', at);
    if (end == std::string_view::npos)
        throw std::runtime_error("the header ends too early");
    const std::string_view found = bytes.substr(at, end - at);
    at = end + 1;
    return found;
}

/// source: openexr.com, "OpenEXR File Layout" (magic, version and flags, attributes).
Layout layout_of(std::string_view bytes) {
    constexpr uint32_t kDeep = 0x800;
    constexpr uint32_t kManyParts = 0x1000;
    if (bytes.size() < 8)
        throw std::runtime_error("the header ends too early");
    if ((value_at<uint32_t>(bytes, 4) & (kDeep | kManyParts)) != 0)
        throw std::runtime_error("deep pictures and pictures of several parts are not read");
    Layout layout;
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
            (name == "dataWindow" ? layout.data : layout.display) = value_at<Window>(bytes, at);
        } else if (name == "tiles" && size >= 8) {
            layout.tile_pixels =
                uint64_t{value_at<uint32_t>(bytes, at)} * value_at<uint32_t>(bytes, at + 4);
        } else if (name == "channels") {
            layout.channels = size / 18;  // of at least a letter, its 0 and 16 bytes
        }
        at += size;
    }
    return layout;
}

void check_layout(const Layout& layout) {
    constexpr int64_t kMostSide = 1 << 15;
    constexpr uint64_t kMostChannels = 256;
    constexpr uint64_t kMostBufferBytes = uint64_t{1} << 30u;
    constexpr uint64_t kRowsAtOnce = 256;  // the largest block of any compression (DWAB)
    for (const Window& window : {layout.data, layout.display}) {
        if (window.width() < 1 || window.height() < 1 || window.width() > kMostSide ||
            window.height() > kMostSide ||
            window.width() * window.height() > static_cast<int64_t>(kMostPixels))
            throw std::runtime_error(text("a window of ", window.width(), " x ", window.height(),
                                          " pixels is empty or too large"));
    }
    const uint64_t block =
        std::max(static_cast<uint64_t>(layout.data.width()) *
                     std::min(kRowsAtOnce, static_cast<uint64_t>(layout.data.height())),
                 layout.tile_pixels);
    if (layout.channels > kMostChannels || layout.tile_pixels > (uint64_t{1} << 28u) ||
        block * std::max<uint64_t>(layout.channels, 1) * 4 > kMostBufferBytes)
        throw std::runtime_error("too many channels, or tiles too large");
}

bool same(const Window& ours, const Imath::Box2i& theirs) {
    return ours.x0 == theirs.min.x && ours.y0 == theirs.min.y && ours.x1 == theirs.max.x &&
           ours.y1 == theirs.max.y;
}

Image decode(std::string_view bytes, const std::string& name) {
    const Layout layout = layout_of(bytes);
    check_layout(layout);
    Memory memory(bytes, name);
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
    const auto data_width = static_cast<size_t>(layout.data.width());
    const auto data_height = static_cast<size_t>(layout.data.height());
    std::vector<float> data(4 * data_width * data_height, 0.0f);
    const size_t column = 4 * sizeof(float);
    const size_t row = column * data_width;
    // OpenEXR addresses pixel (x, y) at base + x column + y row, from the window's own origin.
    const auto base = reinterpret_cast<intptr_t>(data.data()) -
                      static_cast<intptr_t>(column) * layout.data.x0 -
                      static_cast<intptr_t>(row) * layout.data.y0;
    Imf::FrameBuffer buffer;
    const char* const names[4] = {gray ? "Y" : "R", "G", "B", "A"};
    for (size_t i = 0; i < 4; ++i) {
        if (gray && (i == 1 || i == 2))
            continue;
        buffer.insert(names[i],
                      Imf::Slice(Imf::FLOAT,
                                 reinterpret_cast<char*>(base) + i * sizeof(float),  // NOLINT
                                 column, row, 1, 1, i == 3 ? 1.0 : 0.0));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(layout.data.y0, layout.data.y1);
    Image image = blank(layout.display.width(), layout.display.height(), true, name);
    const bool opaque = channels.findChannel("A") == nullptr;
    for (int64_t y = 0; y < image.height; ++y) {
        for (int64_t x = 0; x < image.width; ++x) {
            const int64_t from_x = x + layout.display.x0 - layout.data.x0;
            const int64_t from_y = y + layout.display.y0 - layout.data.y0;
            float* pixel = image.pixels.data() + 4 * (y * image.width + x);
            if (opaque)
                pixel[3] = 1;
            if (from_x < 0 || from_y < 0 || from_x >= layout.data.width() ||
                from_y >= layout.data.height())
                continue;
            std::copy_n(data.data() + 4 * (from_y * layout.data.width() + from_x), 4, pixel);
            if (gray)
                pixel[1] = pixel[2] = pixel[0];
        }
    }
    return image;
}

}  // namespace

Image decode_exr(std::string_view bytes, const std::string& name) {
    try {
        return decode(bytes, name);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {  // OpenEXR's own errors are std::exceptions
        fail(Status::BadFile, "'", name, "' cannot be read as OpenEXR: ", e.what());
    }
}

}  // namespace lodestone::image

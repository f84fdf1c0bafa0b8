// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR writer: pictures of linear light as OpenEXR files in memory.
#include "base/error.h"
#include "image/image.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <algorithm>
#include <half.h>

namespace lodestone::image {
namespace {

class ExrMemoryOutput : public Imf::OStream {
public:
    ExrMemoryOutput() : Imf::OStream("picture") {}

    void write(const char bytes[], int size) override {
        const auto count = static_cast<size_t>(size);
        if (at_ + count > bytes_.size())
            bytes_.resize(at_ + count);
        std::copy_n(bytes, count, bytes_.begin() + static_cast<ptrdiff_t>(at_));
        at_ += count;
    }
    uint64_t tellp() override { return at_; }
    void seekp(uint64_t position) override { at_ = static_cast<size_t>(position); }

    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    size_t at_ = 0;
};

half half_of(float value) {
    return {std::clamp(value, -static_cast<float>(HALF_MAX), static_cast<float>(HALF_MAX))};
}

}  // namespace

std::string exr_bytes(const Image& image) {
    if (!image.linear || image.width < 1 || image.height < 1 ||
        image.pixels.size() != 4 * image.size())
        fail(Status::InvalidArgument, "an image of ", image.width, " x ", image.height, " with ",
             image.pixels.size(), image.linear ? " values" : " encoded values",
             " cannot be an OpenEXR picture");
    std::vector<half> values(image.pixels.size());
    std::transform(image.pixels.begin(), image.pixels.end(), values.begin(), half_of);
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    // Taste: a file that is read once; a higher level takes longer for one as large.
    header.zipCompressionLevel() = 1;
    const size_t pixel = 4 * sizeof(half);
    Imf::FrameBuffer buffer;
    const char* const names[4] = {"R", "G", "B", "A"};
    for (size_t i = 0; i < 4; ++i) {
        header.channels().insert(names[i], Imf::Channel(Imf::HALF));
        buffer.insert(names[i], Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data() + i),
                                           pixel, pixel * static_cast<size_t>(image.width)));
    }
    try {
        ExrMemoryOutput memory;
        {
            Imf::OutputFile file(memory, header, 0);
            file.setFrameBuffer(buffer);
            file.writePixels(image.height);
        }
        return memory.take();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        fail(Status::Internal, "an OpenEXR picture could not be made: ", e.what());
    }
}

}  // namespace lodestone::image

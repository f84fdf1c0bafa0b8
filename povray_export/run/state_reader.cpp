// SPDX-License-Identifier: GPL-3.0-or-later
// The file (POV-Ray 3.7, found by looking at files): a head of 512 bytes, then messages. Numbers are
// big-endian.
//
//     message    "POVRAYMS"  uint32 version  uint32 bytes after the next word  "RAWS"
//                "OBJE"  uint32 number of attributes  attributes
//     attribute  key[4]  type[4]  uint32 length  data
//                the length counts bytes, and numbers of 4 bytes where the type begins with V
//
// The attribute MIDE says what a message is:
//
//     PxBS  a finished rectangle: PBlo float32[][5], its rows from the top; Left, Top, Righ, Bott
//           int32, the first and the last column and row
//     PxSe  squares of a mosaic: PPos int32[][2], their upper left corners; PCol float32[][5];
//           PiSi int32, their side
//
// The five numbers are red, green and blue, linear, with associated alpha; filter, always 0 here;
// transmit, which is 1 - alpha.
#include "povray_export/run/state_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace lodestone::povray {
namespace {

// Law: POV-Ray's head of the file, whose first bytes are this text.
constexpr size_t kHeadBytes = 512;
constexpr std::string_view kHeadText = "POV-Ray Render State File";
// Law: the two words and two numbers before a message.
constexpr size_t kMessageHeadBytes = 20;
/// A longer message is no message.
/// Taste: POV-Ray's longest have 21 kB; a larger value lets garbage take more memory.
constexpr uint32_t kMostMessageBytes = 1U << 20U;
/// A larger square is none of a mosaic.
/// Taste: POV-Ray's have 32 pixels; a larger value lets garbage take more time.
constexpr int32_t kMostSquareSide = 1024;
/// The pixels that a call paints before it ends, with the message that it is in.
/// Taste: a few milliseconds; a larger value looks at the clock less often.
constexpr uint64_t kMostPainted = 1U << 22U;
/// Law: red, green, blue, filter, transmit.
constexpr size_t kChannels = 5;
/// Law: the bytes of a number.
constexpr size_t kNumberBytes = 4;

uint32_t number_at(std::string_view bytes, size_t at) {
    unsigned char raw[kNumberBytes];
    std::memcpy(raw, bytes.data() + at, kNumberBytes);
    return static_cast<uint32_t>(raw[0]) << 24U | static_cast<uint32_t>(raw[1]) << 16U |
           static_cast<uint32_t>(raw[2]) << 8U | raw[3];
}

float float_at(std::string_view bytes, size_t at) {
    const auto value = std::bit_cast<float>(number_at(bytes, at));
    return std::isfinite(value) ? value : 0.0f;
}

LivePixel pixel_at(std::string_view bytes, size_t index) {
    const size_t at = index * kChannels * kNumberBytes;
    const float alpha = 1 - float_at(bytes, at + 4 * kNumberBytes);
    return {float_at(bytes, at), float_at(bytes, at + kNumberBytes),
            float_at(bytes, at + 2 * kNumberBytes), std::clamp(alpha, 0.0f, 1.0f)};
}

/// The attributes of a message that say what was drawn.
struct DrawnMessage {
    std::string_view kind;
    std::string_view block;
    std::string_view positions;
    std::string_view colors;
    int32_t side = 0;
    int32_t left = 0;
    int32_t top = 0;
    int32_t right = 0;
    int32_t bottom = 0;
};

/// Keeps an attribute that is known; its data lies in the message.
void keep(std::string_view key, std::string_view data, DrawnMessage& out) {
    const std::pair<std::string_view, std::string_view*> texts[] = {
        {"MIDE", &out.kind}, {"PBlo", &out.block}, {"PPos", &out.positions}, {"PCol", &out.colors}};
    for (const auto& [name, value] : texts) {
        if (key == name)
            *value = data;
    }
    const std::pair<std::string_view, int32_t*> numbers[] = {{"PiSi", &out.side},
                                                             {"Left", &out.left},
                                                             {"Top ", &out.top},
                                                             {"Righ", &out.right},
                                                             {"Bott", &out.bottom}};
    for (const auto& [name, value] : numbers) {
        if (key == name && data.size() == kNumberBytes)
            *value = static_cast<int32_t>(number_at(data, 0));
    }
}

/// Takes a message apart; one that ends within an attribute says nothing.
DrawnMessage taken_apart(std::string_view body) {
    constexpr size_t kAttributeHead = 12;  // Law: its key, its type and its length
    DrawnMessage out;
    if (body.size() < 8 || body.substr(0, 4) != "OBJE")
        return {};
    const uint32_t count = number_at(body, 4);
    size_t at = 8;
    for (uint32_t i = 0; i < count; ++i) {
        if (body.size() - at < kAttributeHead)
            return {};
        const std::string_view key = body.substr(at, 4);
        const uint64_t unit = body[at + 4] == 'V' ? kNumberBytes : 1;
        const uint64_t bytes = unit * number_at(body, at + 8);
        at += kAttributeHead;
        if (bytes > body.size() - at)
            return {};
        keep(key, body.substr(at, bytes), out);
        at += bytes;
    }
    return out;
}

/// Returns the number of pixels, as draw_squares() does.
uint64_t draw_block(const DrawnMessage& message, LivePicture& picture) {
    const int64_t width = int64_t{message.right} - message.left + 1;
    const int64_t height = int64_t{message.bottom} - message.top + 1;
    const size_t count = message.block.size() / (kChannels * kNumberBytes);
    if (count == 0 || message.block.size() % (kChannels * kNumberBytes) != 0 || width < 1 ||
        height < 1 || width > static_cast<int64_t>(count) ||
        static_cast<uint64_t>(width) * static_cast<uint64_t>(height) != count)
        return 0;
    std::vector<LivePixel> pixels(count);
    for (size_t i = 0; i < count; ++i)
        pixels[i] = pixel_at(message.block, i);
    picture.finish({message.left, message.top, static_cast<int>(width), static_cast<int>(height)},
                   pixels);
    return count;
}

uint64_t draw_squares(const DrawnMessage& message, LivePicture& picture) {
    const size_t count = message.positions.size() / (2 * kNumberBytes);
    if (message.side < 1 || message.side > kMostSquareSide ||
        message.positions.size() != count * 2 * kNumberBytes ||
        message.colors.size() != count * kChannels * kNumberBytes)
        return 0;
    // The squares of a message do not overlap: no message paints more than the whole picture.
    uint64_t painted = 0;
    for (size_t i = 0; i < count && painted <= picture.pixels(); ++i) {
        const size_t at = i * 2 * kNumberBytes;
        const auto left = static_cast<int32_t>(number_at(message.positions, at));
        const auto top = static_cast<int32_t>(number_at(message.positions, at + kNumberBytes));
        painted +=
            picture.paint({left, top, message.side, message.side}, pixel_at(message.colors, i));
    }
    return painted;
}

}  // namespace

void StateReader::stop_reading() {
    broken_ = true;
    behind_ = false;
    pending_.clear();
    pending_.shrink_to_fit();
}

void StateReader::read(std::string_view piece) {
    if (broken_)
        return;
    pending_.append(piece);
    std::string_view rest = pending_;
    if (!past_head_) {
        const size_t known = std::min(rest.size(), kHeadText.size());
        if (rest.substr(0, known) != kHeadText.substr(0, known))
            return stop_reading();
        if (rest.size() < kHeadBytes)
            return;
        rest.remove_prefix(kHeadBytes);
        past_head_ = true;
    }
    behind_ = false;
    uint64_t painted = 0;
    while (rest.size() >= kMessageHeadBytes) {
        const uint32_t bytes = number_at(rest, 12);
        if (rest.substr(0, 8) != "POVRAYMS" || rest.substr(16, 4) != "RAWS" ||
            bytes > kMostMessageBytes)
            return stop_reading();
        if (rest.size() - kMessageHeadBytes < bytes)
            break;
        if (painted > kMostPainted) {
            behind_ = true;
            break;
        }
        const DrawnMessage message = taken_apart(rest.substr(kMessageHeadBytes, bytes));
        if (message.kind == "PxBS")
            painted += draw_block(message, picture_);
        else if (message.kind == "PxSe")
            painted += draw_squares(message, picture_);
        rest.remove_prefix(kMessageHeadBytes + bytes);
    }
    pending_.erase(0, pending_.size() - rest.size());
}

}  // namespace lodestone::povray

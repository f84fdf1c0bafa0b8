// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/obj/mtl_map.h"

#include "base/error.h"
#include "base/files.h"
#include "format/obj/text_lines.h"
#include "format/sibling_file.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace lodestone::format {
namespace {

/// Takes up to three numbers off; what is not there keeps its value.
void take_numbers(std::string_view& words, std::array<double, 3>& numbers) {
    for (double& number : numbers) {
        std::string_view rest = words;
        float value = 0;
        // The last word is the file, even when it looks like a number.
        if (!next_float(rest, value) || trimmed(rest).empty())
            return;
        words = rest;
        if (std::isfinite(value))
            number = static_cast<double>(value);
    }
}

double take_number(std::string_view& words, double usual) {
    std::string_view word = next_word(words);
    float value = 0;
    return next_float(word, value) && std::isfinite(value) ? static_cast<double>(value) : usual;
}

TextureChannel channel_of(std::string_view word, TextureChannel usual) {
    constexpr std::string_view kLetters = "rgbml";
    constexpr std::array<TextureChannel, 5> kChannels{TextureChannel::Red, TextureChannel::Green,
                                                      TextureChannel::Blue, TextureChannel::Alpha,
                                                      TextureChannel::Luma};
    const size_t at = word.size() == 1 ? kLetters.find(word[0]) : std::string_view::npos;
    return at == std::string_view::npos ? usual : kChannels[at];
}

}  // namespace

MapLine map_line(std::string_view words) {
    MapLine out;
    std::array<double, 6>& m = out.texture.to_picture;
    for (words = trimmed(words); words.starts_with('-'); words = trimmed(words)) {
        std::string_view rest = words;
        const std::string_view option = next_word(rest);
        constexpr std::array<std::string_view, 6> kOneValue{"-blendu", "-blendv", "-boost",
                                                            "-cc",     "-texres", "-type"};
        std::array<double, 3> numbers{0, 0, 0};
        if (option == "-s") {
            numbers = {1, 1, 1};
            take_numbers(rest, numbers);
            m[0] = numbers[0];
            m[4] = numbers[1];
        } else if (option == "-o") {
            take_numbers(rest, numbers);
            m[2] = numbers[0];
            m[5] = numbers[1];
        } else if (option == "-t") {
            take_numbers(rest, numbers);
        } else if (option == "-mm") {
            out.texture.offset = glm::dvec3(take_number(rest, 0));
            out.texture.scale = glm::dvec3(take_number(rest, 1));
        } else if (option == "-bm") {
            out.bump = take_number(rest, 1);
        } else if (option == "-clamp") {
            if (next_word(rest) == "on")
                out.texture.extension = TextureExtension::Extend;
        } else if (option == "-imfchan") {
            out.texture.channel = channel_of(next_word(rest), out.texture.channel);
            out.channel = true;
        } else if (std::find(kOneValue.begin(), kOneValue.end(), option) != kOneValue.end()) {
            next_word(rest);
        } else {
            break;  // a file may begin with a dash
        }
        words = rest;
    }
    out.file = std::string(words);
    return out;
}

std::optional<std::string> map_options(const Texture& texture) {
    const std::array<double, 6>& m = texture.to_picture;
    if (m[1] != 0 || m[3] != 0 || texture.extension == TextureExtension::Clip ||
        texture.extension == TextureExtension::Mirror ||
        !std::all_of(m.begin(), m.end(), [](double x) { return std::isfinite(x); }))
        return std::nullopt;
    std::string out;
    const auto put = [&out](const char* option, double u, double v, double w) {
        out += option;
        for (const double number : {u, v, w})
            put_number(out, number);
    };
    if (m[0] != 1 || m[4] != 1)
        put(" -s", m[0], m[4], 1);
    if (m[2] != 0 || m[5] != 0)
        put(" -o", m[2], m[5], 0);
    if (texture.extension == TextureExtension::Extend)
        out += " -clamp on";
    return out;
}

PicturePtr MapPictures::find(const std::string& file, ColorSpace space) {
    const auto path = sibling(folder_, file);
    if (!path)
        fail(Status::Io, "'", file.substr(0, 200), "' is not inside the folder of the model");
    const std::string key = path->string();
    if (const auto found = known_.find({key, space}); found != known_.end())
        return found->second;
    if (const auto found = broken_.find(key); found != broken_.end())
        throw Error(Status::BadFile, found->second);
    try {
        return known_[{key, space}] =
                   image::make_picture(read_file(*path, image::kMostFileBytes), space, file);
    } catch (const Error& e) {
        broken_[key] = e.what();
        throw;
    }
}

void put_number(std::string& out, double value) {
    std::array<char, 32> digits;
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(value));
    out += ' ';
    out.append(digits.data(), end.ptr);
}

}  // namespace lodestone::format

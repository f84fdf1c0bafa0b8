// SPDX-License-Identifier: GPL-3.0-or-later
// Why not libpng's text functions: they write text together with pixels, so that every picture is
// decoded and encoded anew: 0.4 s instead of 0.2 ms for 1024 x 1024 pixels, and other bytes than
// the renderer wrote (docs/EXPERIMENTS.md, "Formats").
#include "image/png_text.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>

namespace lodestone::image {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n"sv;
/// Bytes of a chunk besides its data: length, type and checksum.
/// Law: PNG specification, 5.3.
constexpr size_t kFrame = 12;

/// The checksum of PNG's specification (annex D).
uint32_t checksum(std::string_view bytes) {
    // Law: the polynomial 0xedb88320 of PNG's specification (annex D).
    static const std::array<uint32_t, 256> kTable = [] {
        std::array<uint32_t, 256> out{};
        for (uint32_t i = 0; i < 256; ++i) {
            uint32_t c = i;
            for (int bit = 0; bit < 8; ++bit)
                c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1u) : c >> 1u;
            out[i] = c;
        }
        return out;
    }();
    uint32_t c = 0xffffffffu;
    for (const char byte : bytes)
        c = kTable[(c ^ static_cast<unsigned char>(byte)) & 0xffu] ^ (c >> 8u);
    return c ^ 0xffffffffu;
}

uint32_t number_at(std::string_view bytes, size_t at) {
    uint32_t out = 0;
    for (size_t i = 0; i < 4; ++i)
        out = out << 8u | static_cast<unsigned char>(bytes[at + i]);
    return out;
}

void append_number(std::string& out, uint32_t value) {
    for (const unsigned shift : {24u, 16u, 8u, 0u})
        out += static_cast<char>(value >> shift & 0xffu);
}

struct PngChunk {
    std::string_view type;
    std::string_view data;
    std::string_view whole;

    std::string_view keyword() const {
        return type == "tEXt"sv ? data.substr(0, data.find('\0')) : std::string_view();
    }
};

void for_each_chunk(std::string_view png, const std::string& name,
                    const std::function<void(const PngChunk&)>& visit) {
    if (!png.starts_with(kSignature))
        fail(Status::BadFile, "'", name, "' is not a PNG");
    for (size_t at = kSignature.size(); at < png.size();) {
        const size_t left = png.size() - at;
        if (left < kFrame || number_at(png, at) > left - kFrame)
            fail(Status::BadFile, "'", name, "' is a broken PNG: it ends too early");
        const size_t size = number_at(png, at);
        visit({png.substr(at + 4, 4), png.substr(at + 8, size), png.substr(at, size + kFrame)});
        at += size + kFrame;
    }
}

std::string printable(const std::string& text) {
    std::string out = text;
    std::replace_if(
        out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return out;
}

}  // namespace

std::string with_png_text(std::string_view png, const TextLines& lines, const std::string& name) {
    std::string added;
    std::vector<std::string> keywords;
    for (const auto& [keyword, text] : lines) {
        if (keyword.empty() || keyword.size() > 79)
            fail(Status::InvalidArgument, "the keyword '", keyword, "' has ", keyword.size(),
                 " characters; 1 to 79 expected");
        keywords.push_back(printable(keyword));
        const std::string content = keywords.back() + '\0' + printable(text);
        if (content.size() > (size_t{1} << 24u))
            fail(Status::InvalidArgument, "the text of '", keyword, "' is too long for a PNG");
        append_number(added, static_cast<uint32_t>(content.size()));
        const std::string body = "tEXt" + content;
        added += body;
        append_number(added, checksum(body));
    }
    std::string out(kSignature);
    out.reserve(png.size() + added.size());
    bool header = true;  // it comes first
    for_each_chunk(png, name, [&](const PngChunk& chunk) {
        if (std::find(keywords.begin(), keywords.end(), chunk.keyword()) == keywords.end())
            out += chunk.whole;
        if (header)
            out += added;
        header = false;
    });
    if (header)
        fail(Status::BadFile, "'", name, "' is a broken PNG: it ends too early");
    return out;
}

TextLines png_text(std::string_view png, const std::string& name) {
    TextLines lines;
    for_each_chunk(png, name, [&](const PngChunk& chunk) {
        const std::string_view keyword = chunk.keyword();
        if (!keyword.empty() && keyword.size() < chunk.data.size())
            lines.emplace_back(keyword, chunk.data.substr(keyword.size() + 1));
    });
    return lines;
}

}  // namespace lodestone::image

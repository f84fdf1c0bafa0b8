// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/ply.h"

#include "base/color.h"
#include "image/image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

namespace lodestone::format {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };
enum class PlyEncoding { Ascii, Little, Big };

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float;
    std::optional<PlyType> count;  // set: a list, its length has this type
};

struct PlyElement {
    std::string name;
    uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::Ascii;
    std::vector<PlyElement> elements;
};

size_t size_of(PlyType type) {
    // Law: the bytes of the types, in the order of PlyType.
    constexpr std::array<size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<size_t>(type)];
}

std::optional<PlyType> type_named(std::string_view word) {
    constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                     {"uchar", "uint8"},
                                                                     {"short", "int16"},
                                                                     {"ushort", "uint16"},
                                                                     {"int", "int32"},
                                                                     {"uint", "uint32"},
                                                                     {"float", "float32"},
                                                                     {"double", "float64"}}};
    for (size_t i = 0; i < kNames.size(); ++i) {
        if (word == kNames[i][0] || word == kNames[i][1])
            return static_cast<PlyType>(i);
    }
    return std::nullopt;
}

bool space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

class PlyParser {
public:
    PlyParser(std::string_view bytes, const std::string& name, Problems& problems)
        : bytes_(bytes), name_(name), problems_(problems) {}

    Mesh read() {
        read_header();
        for (const PlyElement& element : header_.elements) {
            check_count(element);
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else
                skip(element);
        }
        finish();
        return std::move(mesh_);
    }

private:
    template <typename... Parts>
    [[noreturn]] void bad(const Parts&... parts) const {
        fail(Status::BadFile, "'", name_, "' is a broken PLY: ", parts...);
    }

    std::string_view line() {
        const size_t end = bytes_.find('\n', at_);
        if (end == std::string_view::npos || end - at_ > 4096)
            bad("its header does not end");
        std::string_view found = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        while (!found.empty() && space(found.back()))
            found.remove_suffix(1);
        return found;
    }

    static std::vector<std::string_view> words(std::string_view line) {
        std::vector<std::string_view> found;
        size_t at = 0;
        while (at < line.size()) {
            while (at < line.size() && space(line[at]))
                ++at;
            const size_t begin = at;
            while (at < line.size() && !space(line[at]))
                ++at;
            if (at > begin)
                found.push_back(line.substr(begin, at - begin));
        }
        return found;
    }

    void read_header() {
        if (line() != "ply")
            bad("it does not begin with 'ply'");
        bool format = false;
        while (true) {
            const std::string_view text = line();
            const auto word = words(text);
            if (word.empty() || word[0] == "comment" || word[0] == "obj_info")
                continue;
            if (word[0] == "end_header")
                break;
            if (word[0] == "format" && word.size() >= 2) {
                format = true;
                if (word[1] == "ascii")
                    header_.encoding = PlyEncoding::Ascii;
                else if (word[1] == "binary_little_endian")
                    header_.encoding = PlyEncoding::Little;
                else if (word[1] == "binary_big_endian")
                    header_.encoding = PlyEncoding::Big;
                else
                    bad("unknown format '", word[1], "'");
            } else if (word[0] == "element" && word.size() == 3) {
                PlyElement element;
                element.name = word[1];
                const char* end = word[2].data() + word[2].size();
                const auto parsed = std::from_chars(word[2].data(), end, element.count);
                if (parsed.ec != std::errc() || parsed.ptr != end)
                    bad("'", text, "'");
                header_.elements.push_back(std::move(element));
            } else if (word[0] == "property" && !header_.elements.empty()) {
                header_.elements.back().properties.push_back(property(word, text));
            } else {
                bad("'", text, "'");
            }
        }
        if (!format)
            bad("it names no format");
    }

    PlyProperty property(const std::vector<std::string_view>& word, std::string_view text) const {
        PlyProperty property;
        std::optional<PlyType> type;
        if (word.size() == 5 && word[1] == "list") {
            property.count = type_named(word[2]);
            type = type_named(word[3]);
            if (!property.count || *property.count == PlyType::Float ||
                *property.count == PlyType::Double)
                bad("'", text, "'");
        } else if (word.size() == 3) {
            type = type_named(word[1]);
        }
        if (!type)
            bad("'", text, "'");
        property.type = *type;
        property.name = word.back();
        return property;
    }

    /// Before anything is allocated: so many elements must fit into what is left of the file.
    void check_count(const PlyElement& element) const {
        size_t least = 0;
        for (const PlyProperty& property : element.properties) {
            if (header_.encoding == PlyEncoding::Ascii)
                least += 2;  // a digit and a space
            else
                least += size_of(property.count ? *property.count : property.type);
        }
        const size_t left = bytes_.size() - at_ + 1;  // the last space may be missing
        if (least > 0 && element.count > left / least)
            bad(element.count, " elements '", element.name, "' do not fit into ", left - 1,
                " bytes");
        if (element.count >= uint64_t{1} << 31u && least > 0)
            bad(element.count, " elements '", element.name, "' are too many");
    }

    double number(PlyType type) {
        return header_.encoding == PlyEncoding::Ascii ? ascii_number() : binary_number(type);
    }

    double ascii_number() {
        while (at_ < bytes_.size() && space(bytes_[at_]))
            ++at_;
        size_t end = at_;
        while (end < bytes_.size() && !space(bytes_[end]))
            ++end;
        if (end == at_)
            bad("it ends too early");
        const char* first = bytes_.data() + at_;
        if (*first == '+')
            ++first;
        double value = 0;
        const auto parsed = std::from_chars(first, bytes_.data() + end, value);
        if (parsed.ec == std::errc::invalid_argument || parsed.ptr != bytes_.data() + end)
            bad("'", bytes_.substr(at_, std::min<size_t>(end - at_, 40)), "' is not a number");
        if (parsed.ec == std::errc::result_out_of_range)
            value = std::nan("");
        at_ = end;
        return value;
    }

    template <typename T>
    double raw() {
        std::array<char, sizeof(T)> data;
        std::memcpy(data.data(), bytes_.data() + at_, sizeof(T));
        if (header_.encoding == PlyEncoding::Big)
            std::reverse(data.begin(), data.end());
        T value;
        std::memcpy(&value, data.data(), sizeof(T));
        at_ += sizeof(T);
        return static_cast<double>(value);
    }

    double binary_number(PlyType type) {
        if (size_of(type) > bytes_.size() - at_)
            bad("it ends too early");
        switch (type) {
            case PlyType::Int8:
                return raw<int8_t>();
            case PlyType::Uint8:
                return raw<uint8_t>();
            case PlyType::Int16:
                return raw<int16_t>();
            case PlyType::Uint16:
                return raw<uint16_t>();
            case PlyType::Int32:
                return raw<int32_t>();
            case PlyType::Uint32:
                return raw<uint32_t>();
            case PlyType::Float:
                return raw<float>();
            case PlyType::Double:
                return raw<double>();
        }
        return 0;
    }

    /// The length of a list, whose items are known to fit into the file.
    uint64_t list_length(const PlyProperty& property) {
        const double length = number(*property.count);
        const size_t least = header_.encoding == PlyEncoding::Ascii ? 2 : size_of(property.type);
        const size_t left = bytes_.size() - at_ + 1;
        const size_t most = left / least;
        if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>(most))
            bad("a list of ", length, " items does not fit into ", left - 1, " bytes");
        return static_cast<uint64_t>(length);
    }

    void skip_property(const PlyProperty& property) {
        const uint64_t count = property.count ? list_length(property) : 1;
        for (uint64_t i = 0; i < count; ++i)
            number(property.type);
    }

    void skip(const PlyElement& element) {
        if (element.properties.empty())
            return;
        for (uint64_t i = 0; i < element.count; ++i) {
            for (const PlyProperty& property : element.properties)
                skip_property(property);
        }
    }

    /// Where a vertex property goes: 0...2 position, 3...5 normal, 6...7 uv, 8...11 color, -1
    /// nowhere.
    static int place_of(const PlyProperty& property) {
        struct PropertyPlace {
            std::string_view name;
            int place;
        };
        // Law: the names that PLY files have in use, and our order of a vertex's numbers.
        constexpr std::array<PropertyPlace, 20> kPlaces{{{"x", 0},
                                                         {"y", 1},
                                                         {"z", 2},
                                                         {"nx", 3},
                                                         {"ny", 4},
                                                         {"nz", 5},
                                                         {"s", 6},
                                                         {"t", 7},
                                                         {"u", 6},
                                                         {"v", 7},
                                                         {"texture_u", 6},
                                                         {"texture_v", 7},
                                                         {"red", 8},
                                                         {"green", 9},
                                                         {"blue", 10},
                                                         {"alpha", 11},
                                                         {"diffuse_red", 8},
                                                         {"diffuse_green", 9},
                                                         {"diffuse_blue", 10},
                                                         {"diffuse_alpha", 11}}};
        if (property.count)
            return -1;
        const auto found =
            std::find_if(kPlaces.begin(), kPlaces.end(),
                         [&](const PropertyPlace& place) { return place.name == property.name; });
        return found == kPlaces.end() ? -1 : found->place;
    }

    /// Integers are display-encoded, as every program writes them; floats are linear.
    static float channel_of(double value, PlyType type, bool alpha) {
        double most = 1;
        if (type == PlyType::Uint8)
            most = 255;
        else if (type == PlyType::Uint16)
            most = 65535;
        const auto share = static_cast<float>(value / most);
        return most == 1 || alpha ? share : decode_srgb(share);
    }

    void read_vertices(const PlyElement& element) {
        std::vector<int> places;
        std::array<bool, 12> present{};
        for (const PlyProperty& property : element.properties) {
            places.push_back(place_of(property));
            if (places.back() >= 0)
                present[static_cast<size_t>(places.back())] = true;
        }
        if (!present[0] || !present[1] || !present[2])
            bad("its vertices lack x, y or z");
        if (!mesh_.positions.empty())
            bad("it has two lists of vertices");
        const bool normals = present[3] && present[4] && present[5];
        const bool uvs = present[6] && present[7];
        const bool colors = present[8] && present[9] && present[10];
        mesh_.positions.reserve(element.count);
        if (normals)
            mesh_.normals.reserve(element.count);
        if (uvs)
            mesh_.uvs.reserve(element.count);
        if (colors)
            mesh_.colors.reserve(element.count);
        for (uint64_t i = 0; i < element.count; ++i) {
            std::array<float, 12> values{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
            for (size_t p = 0; p < places.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (places[p] < 0) {
                    skip_property(property);
                    continue;
                }
                const double value = number(property.type);
                values[static_cast<size_t>(places[p])] =
                    places[p] < 8 ? static_cast<float>(value)
                                  : channel_of(value, property.type, places[p] == 11);
            }
            mesh_.positions.emplace_back(values[0], values[1], values[2]);
            if (normals)
                mesh_.normals.emplace_back(values[3], values[4], values[5]);
            if (uvs)
                mesh_.uvs.emplace_back(values[6], values[7]);
            if (colors)
                mesh_.colors.emplace_back(values[8], values[9], values[10], values[11]);
        }
    }

    void read_faces(const PlyElement& element) {
        for (uint64_t i = 0; i < element.count; ++i) {
            for (const PlyProperty& property : element.properties) {
                if (property.count &&
                    (property.name == "vertex_indices" || property.name == "vertex_index"))
                    read_polygon(property);
                else
                    skip_property(property);
            }
            if (element.properties.empty())
                break;
        }
    }

    void read_polygon(const PlyProperty& property) {
        const uint64_t count = list_length(property);
        uint32_t first = 0;
        uint32_t previous = 0;
        const size_t before = mesh_.triangles.size();
        bool whole = count >= 3;
        for (uint64_t i = 0; i < count; ++i) {
            const double value = number(property.type);
            // The vertices may come after the faces: their number is checked at the end.
            if (!(value >= 0) || value > 4294967295.0 || value != std::floor(value)) {
                whole = false;
                continue;
            }
            const auto index = static_cast<uint32_t>(value);
            if (i == 0)
                first = index;
            else if (i >= 2 && whole)
                mesh_.triangles.emplace_back(first, previous, index);
            previous = index;
        }
        if (!whole) {
            mesh_.triangles.resize(before);
            ++bad_faces_;
        }
    }

    void finish() {
        const size_t vertices = mesh_.positions.size();
        const auto outside = [vertices](const Triangle& t) {
            return t.x >= vertices || t.y >= vertices || t.z >= vertices;
        };
        bad_faces_ += std::erase_if(mesh_.triangles, outside);
        if (bad_faces_ > 0)
            problems_.push_back({name_, Severity::Error, "bad_faces",
                                 text(bad_faces_,
                                      " faces with fewer than three corners, or with vertices "
                                      "that are not there, were left out")});
        if (mesh_.triangles.empty())
            problems_.push_back({name_, Severity::Warning, "no_faces",
                                 text("the file has ", vertices, " vertices and no faces")});
        check(mesh_);
        repair(mesh_, name_, problems_);
    }

    std::string_view bytes_;
    const std::string& name_;
    Problems& problems_;
    size_t at_ = 0;
    PlyHeader header_;
    Mesh mesh_;
    size_t bad_faces_ = 0;
};

}  // namespace

Mesh read_ply(std::string_view bytes, const std::string& name, Problems& problems) {
    return PlyParser(bytes, name, problems).read();
}

}  // namespace lodestone::format

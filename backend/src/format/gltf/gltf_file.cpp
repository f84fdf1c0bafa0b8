// SPDX-License-Identifier: GPL-3.0-or-later
// tinygltf trusts its input: it checks chunk ends 8 bytes too late, follows "../", copies the
// binary chunk once per buffer, recurses into extras, and throws what its callers do not expect.
// Each of these is stopped here.
#include "format/gltf/gltf_file.h"

#include "base/error.h"
#include "base/files.h"
#include "format/sibling_file.h"

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>
#include <sstream>

namespace lodestone::format {
namespace {

// Law: "glTF" in ASCII, little-endian (glTF 2.0, GLB header).
constexpr uint32_t kGlbMagic = 0x46546C67;
// Law: "JSON" in ASCII, little-endian (glTF 2.0, GLB chunks).
constexpr uint32_t kJsonChunk = 0x4E4F534A;
// Law: "BIN" and a zero in ASCII, little-endian (glTF 2.0, GLB chunks).
constexpr uint32_t kBinaryChunk = 0x004E4942;

uint32_t word_at(std::string_view bytes, size_t offset) {
    uint32_t value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// The JSON chunk; checks that both chunks lie inside the file.
std::string_view glb_json(std::string_view bytes, const std::string& name) {
    if (bytes.size() < 20 || bytes.size() > std::numeric_limits<uint32_t>::max())
        fail(Status::BadFile, "'", name, "' is no GLB of ", bytes.size(), " bytes");
    const uint64_t length = word_at(bytes, 8);
    const uint64_t json = word_at(bytes, 12);
    if (word_at(bytes, 4) != 2)
        fail(Status::BadFile, "'", name, "' is a GLB of version ", word_at(bytes, 4),
             "; only version 2 is read");
    if (length > bytes.size() || 20 + json > length || word_at(bytes, 16) != kJsonChunk)
        fail(Status::BadFile, "'", name, "' is a GLB that is cut off or has no JSON chunk");
    if (20 + json < length) {
        if (28 + json > length || 28 + json + word_at(bytes, 20 + json) > length ||
            word_at(bytes, 24 + json) != kBinaryChunk)
            fail(Status::BadFile, "'", name, "' is a GLB whose binary chunk is cut off");
    }
    return bytes.substr(20, json);
}

/// Walks through the JSON text once: depth, buffers without a uri (only one can be the chunk),
/// buffers that stand in for what EXT_meshopt_compression packs, and the files that are pictures.
class GltfScan : public nlohmann::json_sax<nlohmann::json> {
public:
    std::string complaint;
    std::set<std::string> buffers;   // files
    std::set<std::string> pictures;  // likewise
    std::vector<size_t> fallbacks;   // buffers, in their order

    bool null() override { return true; }
    bool boolean(bool value) override {
        if (depth_ == 5 && in_buffers_ && in_extensions_ && in_meshopt_ && key_is_fallback_)
            fallback_ = value;
        return true;
    }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool string(string_t& value) override {
        if (depth_ == 3 && key_is_uri_ && !value.empty()) {
            has_uri_ = true;
            if ((in_buffers_ || in_images_) && !value.starts_with("data:"))
                (in_buffers_ ? buffers : pictures).insert(percent_decoded(value));
        }
        return true;
    }
    bool key(string_t& name) override {
        if (depth_ == 1) {
            in_buffers_ = name == "buffers";
            in_images_ = name == "images";
            if (in_buffers_) {  // the last of equal keys counts
                buffer_ = 0;
                fallbacks.clear();
            }
        }
        if (depth_ == 3)
            in_extensions_ = name == "extensions";
        if (depth_ == 4)
            in_meshopt_ = name == "EXT_meshopt_compression" || name == "KHR_meshopt_compression";
        key_is_uri_ = name == "uri";
        key_is_fallback_ = name == "fallback";
        return true;
    }
    bool start_object(std::size_t) override {
        if (depth_ == 2)
            has_uri_ = fallback_ = false;
        return enter();
    }
    bool start_array(std::size_t) override { return enter(); }
    bool end_object() override {
        if (depth_-- != 3 || !in_buffers_)
            return true;
        if (fallback_)
            fallbacks.push_back(buffer_);
        else if (!has_uri_ && ++without_uri_ > 1)
            complaint = "several buffers claim the binary chunk";
        ++buffer_;
        return complaint.empty();
    }
    bool end_array() override {
        --depth_;
        return true;
    }
    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::json::exception&) override {
        complaint = text("its JSON is broken near byte ", position);
        return false;
    }

private:
    bool enter() {
        // Taste: a larger number reads files that nest deeper and needs more stack.
        constexpr int kMostNested = 64;
        if (++depth_ > kMostNested)
            complaint = "its JSON is nested too deeply";
        return depth_ <= kMostNested;
    }

    int depth_ = 0;
    bool in_buffers_ = false;
    bool in_images_ = false;
    bool in_extensions_ = false;
    bool in_meshopt_ = false;
    bool key_is_uri_ = false;
    bool key_is_fallback_ = false;
    bool has_uri_ = false;
    bool fallback_ = false;
    int without_uri_ = 0;
    size_t buffer_ = 0;
};

/// The JSON text with a byte in each of some buffers: tinygltf wants data in all of them, and what
/// is packed by EXT_meshopt_compression needs no fallback.
std::string with_a_byte_in(const std::vector<size_t>& buffers, std::string_view json) {
    nlohmann::json document = nlohmann::json::parse(json.begin(), json.end());
    nlohmann::json& found = document["buffers"];
    for (const size_t buffer : buffers) {
        if (!found.is_array() || buffer >= found.size() || !found[buffer].is_object())
            continue;
        found[buffer]["uri"] = "data:application/octet-stream;base64,AA==";
        found[buffer]["byteLength"] = 1;
    }
    return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A GLB with another JSON chunk.
std::string with_json(std::string_view glb, std::string json, const std::string& name) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const size_t rest = size_t{20} + word_at(glb, 12);
    std::string out(glb.substr(0, 20));
    out += json;
    out += glb.substr(rest, word_at(glb, 8) - rest);
    if (out.size() > std::numeric_limits<uint32_t>::max())
        fail(Status::BadFile, "'", name, "' is larger than 4 GiB");
    const auto put = [&out](size_t offset, size_t value) {
        const auto word = static_cast<uint32_t>(value);
        std::memcpy(out.data() + offset, &word, sizeof word);
    };
    put(8, out.size());
    put(12, json.size());
    return out;
}

/// The one folder that may be read, and how much.
struct ReadableFiles {
    std::string folder;              // canonical, or empty
    std::set<std::string> pictures;  // left alone: a hostile file names one a million times
    uint64_t bytes_left = uint64_t{4} << 30u;
};

std::optional<std::filesystem::path> allowed(const std::string& path, const ReadableFiles& reach) {
    // tinygltf also looks in the current folder ("./name"): that has no such beginning.
    const std::string beginning = reach.folder + '/';
    if (reach.folder.empty() || !path.starts_with(beginning) ||
        reach.pictures.contains(path.substr(beginning.size())))
        return std::nullopt;
    return sibling(reach.folder, path.substr(beginning.size()));
}

bool file_exists(const std::string& path, void* reach) {
    return allowed(path, *static_cast<ReadableFiles*>(reach)).has_value();
}

std::string same_path(const std::string& path, void*) {
    return path;
}

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, const std::string& path,
                     void* user) {
    auto& reach = *static_cast<ReadableFiles*>(user);
    try {
        const auto file = allowed(path, reach);
        if (!file)
            fail(Status::Io, "it is not inside the folder of the model");
        const std::string bytes = read_file(*file, reach.bytes_left);
        reach.bytes_left -= bytes.size();
        out->assign(bytes.begin(), bytes.end());
        return true;
    } catch (const Error& e) {
        if (error != nullptr)
            *error = e.what();
        return false;
    }
}

bool write_no_file(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

/// Keeps pictures encoded. Those in buffer views are looked up later, with their ranges checked:
/// `data` of these may point anywhere.
bool keep_encoded(tinygltf::Image* picture, const int, std::string*, std::string*, int, int,
                  const unsigned char* data, int size, void*) {
    if (picture->bufferView < 0 && size > 0)
        picture->image.assign(data, data + size);
    picture->as_is = true;
    return true;
}

std::string first_line(std::string_view words) {
    return std::string(words.substr(0, std::min<size_t>(words.find('\n'), 200)));
}

}  // namespace

void load_gltf(tinygltf::Model& model, std::string_view bytes, const std::filesystem::path& folder,
               const std::string& name) {
    const bool binary = bytes.size() >= 4 && word_at(bytes, 0) == kGlbMagic;
    const std::string_view json = binary ? glb_json(bytes, name) : bytes;
    if (json.size() > std::numeric_limits<uint32_t>::max())
        fail(Status::BadFile, "'", name, "' is larger than 4 GiB");
    GltfScan scan;
    if (!nlohmann::json::sax_parse(json.begin(), json.end(), &scan))
        fail(Status::BadFile, "'", name, "' is not read: ", scan.complaint);
    std::string rewritten;
    if (!scan.fallbacks.empty()) {
        rewritten = with_a_byte_in(scan.fallbacks, json);
        if (binary)
            rewritten = with_json(bytes, std::move(rewritten), name);
        bytes = rewritten;
    }
    ReadableFiles reach;
    for (std::string file : scan.pictures) {
        if (scan.buffers.contains(file))
            continue;
        reach.pictures.insert(file);
        std::replace(file.begin(), file.end(), '+', ' ');  // as tinygltf reads them
        reach.pictures.insert(std::move(file));
    }
    std::error_code failed;
    if (!folder.empty())
        reach.folder = std::filesystem::canonical(folder, failed).string();
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded, nullptr);
    loader.SetFsCallbacks({file_exists, same_path, read_whole_file, write_no_file, &reach});
    std::string error;
    std::string warning;
    bool loaded = false;
    try {
        loaded =
            binary
                ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                              reinterpret_cast<const unsigned char*>(bytes.data()),
                                              static_cast<unsigned>(bytes.size()), reach.folder)
                : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(),
                                             static_cast<unsigned>(bytes.size()), reach.folder);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        error = e.what();
    }
    if (!loaded)
        fail(Status::BadFile, "'", name, "' is not valid glTF: ", first_line(error));
}

std::string save_glb(tinygltf::Model& model) {
    // tinygltf writes an empty object as null, which is no scene.
    if (!model.scenes.empty() && model.scenes[0].nodes.empty()) {
        model.scenes.clear();
        model.defaultScene = -1;
    }
    // tinygltf writes offsets as int.
    if (!model.buffers.empty() &&
        model.buffers[0].data.size() > size_t{std::numeric_limits<int32_t>::max()})
        fail(Status::InvalidArgument, "a GLB of ", model.buffers[0].data.size(),
             " bytes is larger than 2 GiB");
    std::ostringstream out;
    try {
        tinygltf::TinyGLTF writer;
        writer.SetImageWriter(nullptr, nullptr);  // they are in buffer views, or files already
        if (!writer.WriteGltfSceneToStream(&model, out, false, true) || !out)
            fail(Status::Internal, "a GLB could not be written");
    } catch (const nlohmann::json::exception& e) {
        fail(Status::Internal, "a GLB could not be written: ", e.what());
    }
    return std::move(out).str();
}

std::string percent_decoded(std::string_view uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string out;
    for (size_t i = 0; i < uri.size(); ++i) {
        const bool coded =
            uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
        out += coded ? static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i];
        i += coded ? 2 : 0;
    }
    return out;
}

}  // namespace lodestone::format

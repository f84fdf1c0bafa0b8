// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/bound_level_file.h"

#include <cstring>
#include <type_traits>

namespace lodestone::segment {
namespace {

// The number changes with the layout; a machine of the other byte order reads another one.
// Law: "LdBound3" in ASCII, little-endian.
constexpr uint64_t kMagic = 0x33646e756f42644cu;

using deform::BoundLevel;
using deform::PoseErrorSample;
using deform::SurfaceAnchor;

/// Visits every array of a level in the order they lie in the file.
template <typename Level, typename Visit>
void for_each_array(Level& level, const Visit& visit) {
    visit(level.mesh.positions);
    visit(level.mesh.normals);
    visit(level.mesh.uvs);
    visit(level.mesh.colors);
    visit(level.mesh.triangles);
    visit(level.mesh.slots);
    visit(level.places);
    visit(level.anchors);
    visit(level.normals);
    visit(level.error_samples.of_source);
    visit(level.error_samples.of_level);
}

void put(std::string& bytes, const void* data, size_t size) {
    bytes.append(static_cast<const char*>(data), size);
}

class BoundLevelReader {
public:
    BoundLevelReader(const char* data, size_t size) : data_(data), left_(size) {}

    uint64_t number() {
        uint64_t value = 0;
        take(&value, sizeof value);
        return value;
    }

    template <typename T>
    void array(std::vector<T>& values) {
        const uint64_t count = number();
        if (count > left_ / sizeof(T))
            fail(Status::BadFile, "bound levels end early");
        values.resize(count);
        take(values.data(), count * sizeof(T));
    }

    bool done() const { return left_ == 0; }

private:
    void take(void* to, size_t size) {
        if (size > left_)
            fail(Status::BadFile, "bound levels end early");
        if (size > 0)
            std::memcpy(to, data_, size);
        data_ += size;
        left_ -= size;
    }

    const char* data_;
    size_t left_;
};

Hash hash_of(const char* data, size_t size) {
    return Hasher().bytes(data, size).result();
}

}  // namespace

std::string bytes_of(const BoundLevels& levels) {
    std::string bytes;
    const uint64_t head[2] = {kMagic, levels.size()};
    put(bytes, head, sizeof head);
    for (const BoundLevel& level : levels) {
        for_each_array(level, [&](const auto& values) {
            using T = typename std::decay_t<decltype(values)>::value_type;
            static_assert(sizeof(SurfaceAnchor) == 8 * sizeof(float) &&
                          sizeof(PoseErrorSample) ==
                              11 * sizeof(float));  // no gaps of unknown content
            const uint64_t count = values.size();
            put(bytes, &count, sizeof count);
            put(bytes, values.data(), values.size() * sizeof(T));
        });
        put(bytes, &level.look_error, sizeof level.look_error);
    }
    const Hash hash = hash_of(bytes.data(), bytes.size());
    put(bytes, &hash, sizeof hash);
    return bytes;
}

BoundLevels bound_levels_of(const std::string& bytes) {
    Hash hash = 0;
    if (bytes.size() < 3 * sizeof hash)
        fail(Status::BadFile, "bound levels end early");
    const size_t content = bytes.size() - sizeof hash;
    std::memcpy(&hash, bytes.data() + content, sizeof hash);
    if (hash != hash_of(bytes.data(), content))
        fail(Status::BadFile, "bound levels are not what was written");
    BoundLevelReader reader(bytes.data(), content);
    if (reader.number() != kMagic)
        fail(Status::BadFile, "bound levels of another version");
    const uint64_t count = reader.number();
    BoundLevels levels;
    for (uint64_t i = 0; i < count; ++i) {
        BoundLevel level;
        for_each_array(level, [&](auto& values) { reader.array(values); });
        const uint64_t look_error = reader.number();
        std::memcpy(&level.look_error, &look_error, sizeof look_error);
        try {
            deform::check(level);
        } catch (const Error& error) {
            fail(Status::BadFile, "bound levels cannot be used: ", error.what());
        }
        levels.push_back(std::move(level));
    }
    if (!reader.done())
        fail(Status::BadFile, "bound levels go on after their end");
    return levels;
}

}  // namespace lodestone::segment

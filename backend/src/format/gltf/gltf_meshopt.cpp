// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf/gltf_meshopt.h"

#include "base/error.h"
#include "base/text.h"
#include "format/gltf/gltf_accessor.h"

#include <tiny_gltf.h>

#include <meshoptimizer.h>
#include <span>

namespace lodestone::format {
namespace {

constexpr const char* kExtension = "EXT_meshopt_compression";

// How many bytes one packed byte can become.
// Law: a header of 2 bits stands for 16 equal bytes (EXT_meshopt_compression, attributes).
constexpr size_t kMostGrowth = 64;

enum class Packing { VertexAttributes, TriangleList, IndexSequence };

enum class Filter { None, Octahedral, Quaternion, Exponential };

/// A packed view, its numbers checked against each other but for the bytes themselves.
struct PackedView {
    std::span<const unsigned char> bytes;
    size_t count = 0;   // elements
    size_t stride = 0;  // bytes an element
    Packing packing = Packing::VertexAttributes;
    Filter filter = Filter::None;

    size_t size() const { return count * stride; }
};

/// A whole number that is not negative; absent ones are `otherwise`.
size_t whole_number(const tinygltf::Value& from, const char* key, int otherwise) {
    const tinygltf::Value& value = member(from, key);
    const bool absent = !from.Has(key) && otherwise >= 0;
    if (!absent && (!value.IsInt() || value.GetNumberAsInt() < 0))
        fail(Status::BadFile, "its ", key, " is no count");
    return static_cast<size_t>(absent ? otherwise : value.GetNumberAsInt());
}

std::string word(const tinygltf::Value& from, const char* key) {
    const tinygltf::Value& value = member(from, key);
    return value.IsString() ? value.Get<std::string>() : "";
}

Packing packing_of(const std::string& mode) {
    if (mode == "ATTRIBUTES")
        return Packing::VertexAttributes;
    if (mode == "TRIANGLES")
        return Packing::TriangleList;
    if (mode == "INDICES")
        return Packing::IndexSequence;
    fail(Status::BadFile, "its mode '", mode.substr(0, 40), "' is not known");
}

Filter filter_of(const std::string& filter) {
    if (filter.empty() || filter == "NONE")
        return Filter::None;
    if (filter == "OCTAHEDRAL")
        return Filter::Octahedral;
    if (filter == "QUATERNION")
        return Filter::Quaternion;
    if (filter == "EXPONENTIAL")
        return Filter::Exponential;
    fail(Status::BadFile, "its filter '", filter.substr(0, 40), "' is not known");
}

std::span<const unsigned char> packed_bytes(const tinygltf::Model& model,
                                            const tinygltf::Value& from) {
    const size_t buffer = whole_number(from, "buffer", -1);
    const size_t offset = whole_number(from, "byteOffset", 0);
    const size_t length = whole_number(from, "byteLength", -1);
    if (buffer >= model.buffers.size())
        fail(Status::BadFile, "it lies in buffer ", buffer, " of ", model.buffers.size());
    const auto& data = model.buffers[buffer].data;
    if (offset > data.size() || length > data.size() - offset)
        fail(Status::BadFile, "its packed bytes leave their buffer");
    return {data.data() + offset, length};
}

/// Checks all that the codec asserts, and that so few bytes can hold so many elements.
void check_shape(const PackedView& view) {
    const bool attributes = view.packing == Packing::VertexAttributes;
    const bool stride_known = attributes
                                  ? view.stride > 0 && view.stride <= 256 && view.stride % 4 == 0
                                  : view.stride == 2 || view.stride == 4;
    const bool filter_fits =
        view.filter == Filter::None ||
        (attributes && (view.filter == Filter::Exponential || view.stride == 8 ||
                        (view.filter == Filter::Octahedral && view.stride == 4)));
    if (!stride_known || !filter_fits)
        fail(Status::BadFile, "a stride of ", view.stride, " bytes does not fit its mode");
    if (view.packing == Packing::TriangleList && view.count % 3 != 0)
        fail(Status::BadFile, "its ", view.count, " indices are no triangles");
    // Law: at least a byte for each triangle and each index (EXT_meshopt_compression, bitstreams).
    const size_t most = attributes ? view.bytes.size() * kMostGrowth / view.stride
                        : view.packing == Packing::TriangleList ? view.bytes.size() * 3
                                                                : view.bytes.size();
    if (view.count < 1 || view.count > most)
        fail(Status::BadFile, view.bytes.size(), " bytes cannot hold its ", view.count,
             " elements");
}

PackedView packed_view(const tinygltf::Model& model, const tinygltf::BufferView& from) {
    const tinygltf::Value& packed = from.extensions.at(kExtension);
    PackedView view;
    view.bytes = packed_bytes(model, packed);
    view.count = whole_number(packed, "count", -1);
    view.stride = whole_number(packed, "byteStride", -1);
    view.packing = packing_of(word(packed, "mode"));
    view.filter = filter_of(word(packed, "filter"));
    check_shape(view);
    if (from.byteStride != 0 && from.byteStride != view.stride)
        fail(Status::BadFile, "it has strides of ", from.byteStride, " and ", view.stride,
             " bytes");
    return view;
}

void unfilter(Filter filter, std::vector<unsigned char>& data, size_t count, size_t stride) {
    switch (filter) {
        case Filter::None:
            break;
        case Filter::Octahedral:
            meshopt_decodeFilterOct(data.data(), count, stride);
            break;
        case Filter::Quaternion:
            meshopt_decodeFilterQuat(data.data(), count, stride);
            break;
        case Filter::Exponential:
            meshopt_decodeFilterExp(data.data(), count, stride);
            break;
    }
}

std::vector<unsigned char> unpacked(const PackedView& view) {
    std::vector<unsigned char> out(view.size());
    const unsigned char* const bytes = view.bytes.data();
    const size_t size = view.bytes.size();
    int failed = 0;
    if (view.packing == Packing::VertexAttributes)
        failed = meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, bytes, size);
    else if (view.packing == Packing::TriangleList)
        failed = meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, bytes, size);
    else
        failed = meshopt_decodeIndexSequence(out.data(), view.count, view.stride, bytes, size);
    if (failed == -1)
        fail(Status::BadFile, "its bytes are of another version of the codec, or of another mode");
    if (failed != 0)
        fail(Status::BadFile, "its packed bytes are broken");
    unfilter(view.filter, out, view.count, view.stride);
    return out;
}

}  // namespace

void unpack_views(tinygltf::Model& model, const std::string& name) {
    // Views may share packed bytes, and a hostile file would share them a million times.
    size_t bytes_left = size_t{1} << 24u;
    for (const tinygltf::Buffer& buffer : model.buffers)
        bytes_left += buffer.data.size() * kMostGrowth;
    for (size_t i = 0; i < model.bufferViews.size(); ++i) {
        tinygltf::BufferView& view = model.bufferViews[i];
        if (!view.extensions.contains(kExtension))
            continue;
        try {
            const PackedView packed = packed_view(model, view);
            if (packed.size() > bytes_left)
                fail(Status::BadFile, "the file shows the same data too often");
            bytes_left -= packed.size();
            tinygltf::Buffer buffer;
            buffer.data = unpacked(packed);
            view.byteStride = packed.packing == Packing::VertexAttributes ? packed.stride : 0;
            view.byteLength = buffer.data.size();
            view.byteOffset = 0;
            view.buffer = static_cast<int>(model.buffers.size());
            model.buffers.push_back(std::move(buffer));
        } catch (const Error& e) {
            fail(Status::BadFile, "'", name, "': buffer view ", i, " is packed by ", kExtension,
                 ", but ", e.what());
        }
    }
}

}  // namespace lodestone::format

// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf/gltf_accessor.h"

#include "base/error.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>

namespace lodestone::format {
namespace {

std::span<const unsigned char> checked_view(const tinygltf::Model& model, int index) {
    if (index < 0 || static_cast<size_t>(index) >= model.bufferViews.size())
        fail(Status::BadFile, "buffer view ", index, " of ", model.bufferViews.size());
    const tinygltf::BufferView& view = model.bufferViews[static_cast<size_t>(index)];
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= model.buffers.size())
        fail(Status::BadFile, "buffer ", view.buffer, " of ", model.buffers.size());
    const auto& data = model.buffers[static_cast<size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        fail(Status::BadFile, "buffer view ", index, " leaves its buffer");
    return {data.data() + view.byteOffset, view.byteLength};
}

template <typename T>
T load(const unsigned char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

template <typename T>
float normal(T value, bool normalized) {
    const auto number = static_cast<float>(value);
    return normalized ? std::max(number / static_cast<float>(std::numeric_limits<T>::max()), -1.0f)
                      : number;
}

}  // namespace

AccessorElements::AccessorElements(const tinygltf::Model& model, int accessor, int components) {
    if (accessor < 0 || static_cast<size_t>(accessor) >= model.accessors.size())
        fail(Status::BadFile, "accessor ", accessor, " of ", model.accessors.size());
    const tinygltf::Accessor& from = model.accessors[static_cast<size_t>(accessor)];
    if (from.sparse.isSparse)
        fail(Status::BadFile, "accessor ", accessor, " is sparse; write plain accessors");
    const int found = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type));
    if (found != components)
        fail(Status::BadFile, "accessor ", accessor, " has ", found, " components, not ",
             components);
    const int number = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(from.componentType));
    if (number < 1 || number > 4 || from.componentType == TINYGLTF_COMPONENT_TYPE_INT)
        fail(Status::BadFile, "accessor ", accessor, " has the unknown type ", from.componentType);
    const std::span<const unsigned char> view = checked_view(model, from.bufferView);
    const size_t size = static_cast<size_t>(number) * static_cast<size_t>(components);
    const size_t stride = model.bufferViews[static_cast<size_t>(from.bufferView)].byteStride;
    stride_ = stride == 0 ? size : stride;
    if (stride_ < size || stride_ > 4096)
        fail(Status::BadFile, "accessor ", accessor, " has a stride of ", stride_, " bytes");
    if (from.byteOffset > view.size() || from.count < 1 || size > view.size() - from.byteOffset ||
        from.count - 1 > (view.size() - from.byteOffset - size) / stride_)
        fail(Status::BadFile, "the ", from.count, " elements of accessor ", accessor,
             " leave its buffer view");
    first_ = view.data() + from.byteOffset;
    count_ = from.count;
    type_ = from.componentType;
    normalized_ = from.normalized;
}

float AccessorElements::number(size_t element, int component) const {
    const unsigned char* at = first_ + element * stride_;
    const auto skip = static_cast<size_t>(component);
    switch (type_) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return normal(load<int8_t>(at + skip), normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return normal(load<uint8_t>(at + skip), normalized_);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return normal(load<int16_t>(at + 2 * skip), normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return normal(load<uint16_t>(at + 2 * skip), normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return normal(load<uint32_t>(at + 4 * skip), normalized_);
        default:
            return load<float>(at + 4 * skip);
    }
}

uint32_t AccessorElements::index(size_t element) const {
    const unsigned char* at = first_ + element * stride_;
    switch (type_) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<uint8_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<uint16_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<uint32_t>(at);
        default:
            fail(Status::BadFile, "indices have the unknown type ", type_);
    }
}

int components_of(const tinygltf::Model& model, int accessor) {
    if (accessor < 0 || static_cast<size_t>(accessor) >= model.accessors.size())
        fail(Status::BadFile, "accessor ", accessor, " of ", model.accessors.size());
    const int type = model.accessors[static_cast<size_t>(accessor)].type;
    const int found = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type));
    return found >= 1 && found <= 4 && type != TINYGLTF_TYPE_MAT2 ? found : 0;
}

int add_view(tinygltf::Model& model, const void* data, size_t bytes, int target) {
    if (model.buffers.empty())
        model.buffers.emplace_back();
    std::vector<unsigned char>& out = model.buffers[0].data;
    out.resize((out.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = out.size();
    view.byteLength = bytes;
    view.target = target;
    const auto* first = static_cast<const unsigned char*>(data);
    out.insert(out.end(), first, first + bytes);
    model.bufferViews.push_back(std::move(view));
    return static_cast<int>(model.bufferViews.size() - 1);
}

int add_floats(tinygltf::Model& model, std::span<const float> values, int components, bool bounds) {
    // Law: the types of accessors by their number of components (glTF 2.0, accessor data types).
    constexpr int kTypes[5] = {0, TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3,
                               TINYGLTF_TYPE_VEC4};
    tinygltf::Accessor accessor;
    accessor.bufferView =
        add_view(model, values.data(), values.size_bytes(), TINYGLTF_TARGET_ARRAY_BUFFER);
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.type = kTypes[components];
    accessor.count = values.size() / static_cast<size_t>(components);
    for (size_t c = 0; bounds && c < static_cast<size_t>(components); ++c) {
        float low = values[c];
        float high = values[c];
        for (size_t i = c; i < values.size(); i += static_cast<size_t>(components)) {
            low = std::min(low, values[i]);
            high = std::max(high, values[i]);
        }
        accessor.minValues.push_back(static_cast<double>(low));
        accessor.maxValues.push_back(static_cast<double>(high));
    }
    model.accessors.push_back(std::move(accessor));
    return static_cast<int>(model.accessors.size() - 1);
}

const tinygltf::Value& member(const tinygltf::Value& value, const char* key) {
    static const tinygltf::Value kNull;
    return value.Has(key) ? value.Get(key) : kNull;
}

std::string view_bytes(const tinygltf::Model& model, int view) {
    const std::span<const unsigned char> found = checked_view(model, view);
    return {found.begin(), found.end()};
}

}  // namespace lodestone::format

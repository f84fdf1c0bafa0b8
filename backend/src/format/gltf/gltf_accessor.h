// SPDX-License-Identifier: GPL-3.0-or-later
// glTF accessors: ranges checked once, then read as floats or indices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
class Value;
}  // namespace tinygltf

namespace lodestone::format {

/// `count` elements of `components` numbers that surely lie inside their buffer.
class AccessorElements {
public:
    /// Throws Error(BadFile) with a sentence on what is wrong with the accessor; sparse ones and
    /// those without data are refused.
    AccessorElements(const tinygltf::Model& model, int accessor, int components);

    size_t count() const { return count_; }
    /// A number of an element. Integers are normalized where the accessor says so.
    float number(size_t element, int component) const;
    /// The value of an unsigned integer accessor; throws Error(BadFile) for others.
    uint32_t index(size_t element) const;

private:
    const unsigned char* first_ = nullptr;
    size_t stride_ = 0;
    size_t count_ = 0;
    int type_ = 0;
    bool normalized_ = false;
};

/// How many numbers an element has; 0 for matrices. Throws Error(BadFile).
int components_of(const tinygltf::Model& model, int accessor);

/// Appends data, 4-byte aligned, as one buffer view (`target` 0 = none) of buffer 0.
int add_view(tinygltf::Model& model, const void* data, size_t bytes, int target);
/// Appends an accessor of floats with 1 to 4 components, one element a vertex; `bounds` adds min
/// and max. Returns its index.
int add_floats(tinygltf::Model& model, std::span<const float> values, int components, bool bounds);

/// The member of an extras or extensions object; null when there is none.
const tinygltf::Value& member(const tinygltf::Value& value, const char* key);

/// The bytes of a picture that lies in a buffer view. Throws Error(BadFile).
std::string view_bytes(const tinygltf::Model& model, int view);

}  // namespace lodestone::format

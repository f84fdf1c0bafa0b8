// SPDX-License-Identifier: GPL-3.0-or-later
// Array bytes: files that are arrays of numbers, in the byte order of one machine, with a hash of
// all at their end.
#pragma once

#include "base/error.h"
#include "base/hash.h"

#include <cstring>
#include <string>
#include <vector>

namespace lodestone::segment {

class ArrayWriter {
public:
    /// `magic`: the first number of the file, which tells its kind and version.
    explicit ArrayWriter(uint64_t magic) { number(magic); }

    /// Eight bytes of any type.
    template <typename T>
    void number(T value) {
        static_assert(sizeof value == sizeof(uint64_t));
        put(&value, sizeof value);
    }
    /// `T` must have no gaps of unknown content.
    template <typename T>
    void array(const std::vector<T>& values) {
        number(uint64_t{values.size()});
        put(values.data(), values.size() * sizeof(T));
    }
    std::string take() {
        number(Hasher().bytes(bytes_.data(), bytes_.size()).result());
        return std::move(bytes_);
    }

private:
    void put(const void* data, size_t size) { bytes_.append(static_cast<const char*>(data), size); }
    std::string bytes_;
};

/// Each function throws Error(BadFile) for bytes that the writer has not made; `what`: the word for
/// what they are.
class ArrayReader {
public:
    ArrayReader(const std::string& bytes, uint64_t magic, const char* what)
        : data_(bytes.data()), left_(bytes.size()), what_(what) {
        Hash hash = 0;
        if (left_ < 3 * sizeof hash)
            fail(Status::BadFile, what_, " end early");
        left_ -= sizeof hash;
        std::memcpy(&hash, data_ + left_, sizeof hash);
        if (hash != Hasher().bytes(data_, left_).result())
            fail(Status::BadFile, what_, " are not what was written");
        if (number<uint64_t>() != magic)
            fail(Status::BadFile, what_, " of another version");
    }

    template <typename T>
    T number() {
        T value{};
        static_assert(sizeof value == sizeof(uint64_t));
        take(&value, sizeof value);
        return value;
    }
    template <typename T>
    void array(std::vector<T>& values) {
        const auto count = number<uint64_t>();
        if (count > left_ / sizeof(T))
            fail(Status::BadFile, what_, " end early");
        values.resize(count);
        take(values.data(), count * sizeof(T));
    }
    void end() const {
        if (left_ > 0)
            fail(Status::BadFile, what_, " go on after their end");
    }

private:
    void take(void* to, size_t size) {
        if (size > left_)
            fail(Status::BadFile, what_, " end early");
        if (size > 0)
            std::memcpy(to, data_, size);
        data_ += size;
        left_ -= size;
    }

    const char* data_;
    size_t left_;
    const char* what_;
};

}  // namespace lodestone::segment

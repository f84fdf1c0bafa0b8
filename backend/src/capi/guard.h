// SPDX-License-Identifier: GPL-3.0-or-later
// Guard: the fence every exported function runs inside; nothing throws across the C interface.
#pragma once

#include "lodestone/lodestone.h"

#include "base/error.h"
#include "base/job.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>
#include <type_traits>

namespace lodestone::capi {

/// This thread's last sentence; a fixed buffer, so that setting it cannot fail.
struct LastError {
    char text[2048] = "";

    void set(const char* sentence) noexcept { std::snprintf(text, sizeof text, "%s", sentence); }
    void clear() noexcept { text[0] = '\0'; }
};
LastError& last_error() noexcept;

template <typename Body>
lds_status guard(Body&& body) noexcept {
    try {
        last_error().clear();
        body();
        return LDS_OK;
    } catch (const Error& error) {
        last_error().set(error.what());
        return static_cast<lds_status>(error.status);
    } catch (const std::bad_alloc&) {
        last_error().set("out of memory");
        return LDS_ERROR_OUT_OF_MEMORY;
    } catch (const std::exception& error) {
        last_error().set(error.what());
        return LDS_ERROR_INTERNAL;
    } catch (...) {
        last_error().set("unknown error");
        return LDS_ERROR_INTERNAL;
    }
}

/// Throws unless the pointer is there; `what` names the argument.
inline void require(const void* pointer, const char* what) {
    if (pointer == nullptr)
        fail(Status::InvalidArgument, what, " is null");
}

/// The number of bytes of a struct that both the caller (by its struct_size) and this library know.
/// Throws for a null pointer and for a length that no version of the struct has had.
template <typename Struct>
size_t known_bytes(const Struct* value, const char* what) {
    static_assert(std::is_trivially_copyable_v<Struct>);
    require(value, what);
    // Law: a struct holds its struct_size and another member, and no member ends between two words.
    constexpr size_t kWord = sizeof(value->struct_size);
    if (value->struct_size < 2 * kWord || value->struct_size % kWord != 0)
        fail(Status::InvalidArgument, what, ".struct_size is ", value->struct_size, "; ",
             sizeof(Struct), " expected");
    return std::min(size_t{value->struct_size}, sizeof(Struct));
}

/// The caller's struct. Fields that an older, shorter one lacks are 0.
template <typename Struct>
Struct checked(const Struct* value, const char* what) {
    Struct whole{};
    std::memcpy(&whole, value, known_bytes(value, what));
    return whole;
}

/// Copies a result out, as much of it as the caller's struct holds, and keeps its struct_size.
/// Throws before anything is written.
template <typename Struct>
void hand_out(Struct* out, Struct value, const char* what) {
    const size_t known = known_bytes(out, what);
    value.struct_size = out->struct_size;
    std::memcpy(out, &value, known);
}

inline Job job_of(lds_job* job) {
    return job == nullptr ? Job() : Job(&job->cancel, &job->stage, &job->fraction);
}

}  // namespace lodestone::capi

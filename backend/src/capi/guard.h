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

/// Throws unless a struct's size is one this library knows (callers set struct_size).
template <typename Struct>
const Struct& checked(const Struct* value, const char* what) {
    require(value, what);
    if (value->struct_size < sizeof(Struct))
        fail(Status::InvalidArgument, what, ".struct_size is ", value->struct_size, "; ",
             sizeof(Struct), " expected");
    return *value;
}

/// Throws unless a struct that has grown is at least as long as in version 1.
template <typename Struct>
void require_size(const Struct* value, size_t least, const char* what) {
    require(value, what);
    if (value->struct_size < least)
        fail(Status::InvalidArgument, what, ".struct_size is ", value->struct_size, "; ", least,
             " or more expected");
}

/// A struct that has grown since version 1: what a caller's older, shorter one lacks is 0. `least`
/// is the size of version 1.
template <typename Struct>
Struct grown(const Struct* value, size_t least, const char* what) {
    require_size(value, least, what);
    Struct out{};
    std::memcpy(&out, value, std::min<size_t>(value->struct_size, sizeof out));
    return out;
}

/// Copies as much of a result out as the caller's struct can hold; throws before anything is
/// written.
template <typename Struct>
void hand_out_grown(Struct* out, Struct value, size_t least, const char* what) {
    require_size(out, least, what);
    value.struct_size = out->struct_size;
    std::memcpy(out, &value, std::min<size_t>(value.struct_size, sizeof value));
}

/// Copies a result out, keeping the caller's struct_size; throws before anything is written.
template <typename Struct>
void hand_out(Struct* out, Struct value, const char* what) {
    checked(out, what);
    value.struct_size = out->struct_size;
    *out = value;
}

inline Job job_of(lds_job* job) {
    return job == nullptr ? Job() : Job(&job->cancel, &job->stage, &job->fraction);
}

}  // namespace lodestone::capi

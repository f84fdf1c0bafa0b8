// SPDX-License-Identifier: GPL-3.0-or-later
// Guard: the fence every exported function runs inside; nothing throws across the C interface.
#pragma once

#include "lodestone/lodestone.h"

#include "base/error.h"
#include "base/job.h"

#include <cstdio>
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

/// Throws unless a struct is at least as long as this library knows it (callers set struct_size).
/// The version that makes a struct longer has to accept its older length here.
template <typename Struct>
const Struct& checked(const Struct* value, const char* what) {
    require(value, what);
    if (value->struct_size < sizeof(Struct))
        fail(Status::InvalidArgument, what, ".struct_size is ", value->struct_size, "; ",
             sizeof(Struct), " expected");
    return *value;
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

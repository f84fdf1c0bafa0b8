// SPDX-License-Identifier: GPL-3.0-or-later
#include "capi/guard.h"
#include "model/representation.h"
#include "ray/mesh_scene.h"

using namespace lodestone;

namespace lodestone::capi {

LastError& last_error() noexcept {
    thread_local LastError error;
    return error;
}

}  // namespace lodestone::capi

uint32_t lds_abi_version(void) {
    return LDS_ABI_VERSION;
}

const char* lds_version(void) {
    return LODESTONE_VERSION;
}

const char* lds_status_name(lds_status status) {
    switch (status) {
        case LDS_OK:
            return "OK";
        case LDS_ERROR_INVALID_ARGUMENT:
            return "INVALID_ARGUMENT";
        case LDS_ERROR_OUT_OF_MEMORY:
            return "OUT_OF_MEMORY";
        case LDS_ERROR_INTERNAL:
            return "INTERNAL";
        case LDS_ERROR_CANCELLED:
            return "CANCELLED";
        case LDS_ERROR_STALE_ID:
            return "STALE_ID";
        case LDS_ERROR_IO:
            return "IO";
        case LDS_ERROR_BAD_FILE:
            return "BAD_FILE";
        case LDS_ERROR_RAYS_UNAVAILABLE:
            return "RAYS_UNAVAILABLE";
        case LDS_ERROR_POVRAY_MISSING:
            return "POVRAY_MISSING";
        case LDS_ERROR_POVRAY_FAILED:
            return "POVRAY_FAILED";
    }
    return "UNKNOWN";
}

const char* lds_kind_name(int32_t kind) {
    static_assert(LDS_KIND_COUNT == kKindLimit);
    return is_kind(kind) ? name_of(static_cast<Kind>(kind)) : "";
}

const char* lds_last_error_text(void) {
    return capi::last_error().text;
}

lds_status lds_rays_check(void) {
    return capi::guard([] {
        std::string reason;
        if (!ray::available(&reason))
            fail(Status::RaysUnavailable, reason);
    });
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/view.h"

#include "base/error.h"

namespace lodestone {

const char* name_of(LightKind kind) {
    static constexpr const char* kNames[] = {"sun", "point", "spot", "area"};
    return kNames[static_cast<size_t>(kind)];
}

LightKind light_kind_named(const std::string& name) {
    for (const LightKind kind :
         {LightKind::Sun, LightKind::Point, LightKind::Spot, LightKind::Area}) {
        if (name == name_of(kind))
            return kind;
    }
    fail(Status::BadFile, "a light has the kind '", name, "'");
}

}  // namespace lodestone

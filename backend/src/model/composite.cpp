// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/composite.h"

namespace lodestone {

Bound bound_of(const Composite& composite) {
    Bound out;
    for (const Solid& solid : composite.solids) {
        const Bound one =
            solid.box ? bound_of_box(solid.primitive) : bound_of_ellipsoid(solid.primitive);
        out = out.empty() ? one : merged(out, one);
    }
    return out;
}

Mesh tessellate(const Composite& composite, int subdivisions) {
    Mesh out;
    for (const Solid& solid : composite.solids) {
        Mesh one = solid.box ? tessellate_box(solid.primitive)
                             : tessellate_ellipsoid(solid.primitive, subdivisions);
        one.slots.assign(one.triangles.size(), solid.slot);
        append(out, one, {});
    }
    return out;
}

}  // namespace lodestone

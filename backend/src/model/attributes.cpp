// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/attributes.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

double Attributes::radius_of_gyration() const {
    return visible_area > 0 ? std::sqrt(std::max(0.0, trace(moments) / visible_area)) : 0;
}

glm::dmat3 Attributes::inertia() const {
    return glm::dmat3(trace(moments)) - moments;
}

}  // namespace lodestone

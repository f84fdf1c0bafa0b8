// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/stand_in_surroundings.h"

#include "hierarchy/environment_objects.h"
#include "hierarchy/flat_layers.h"

namespace lodestone::hierarchy {

StandInSurroundings surroundings_of(const Model& model, const std::vector<ObjectIndex>& order,
                                    const MeshSource& source, const Job& job) {
    StandInSurroundings around{uses_of(model),
                               with_environment(model),
                               with_hidden(model),
                               layers_of(model, order, source, job),
                               marked_environment(model, order),
                               {}};
    around.ground = grounds_of(model, order, around.marked);
    return around;
}

std::vector<uint64_t> uses_of(const Model& model) {
    std::vector<uint64_t> uses(model.objects.size(), 0);
    std::vector<ObjectIndex> order = bottom_up(model);
    if (!order.empty())
        uses[model.root] = 1;
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
        const Object& object = model.objects[*at];
        if (!object.group())
            continue;
        for (const Placement& placement : object.representations[0].assembly().placements)
            uses[placement.object] += uses[*at];
    }
    return uses;
}

}  // namespace lodestone::hierarchy

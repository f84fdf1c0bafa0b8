// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/follow/lens_change.h"

#include <algorithm>

namespace lodestone::choose {
namespace {

bool same(const DetailLens& a, const DetailLens& b) {
    const auto& [name, shape, transform, radius, strength, falloff, filter, objects] = a;
    return shape == b.shape && transform.linear == b.transform.linear &&
           transform.offset == b.transform.offset && radius == b.radius && strength == b.strength &&
           falloff == b.falloff && filter == b.filter && objects == b.objects;
}

/// A group within reach, and the facts along the path to the objects it places.
struct ReachedGroup {
    uint32_t node = 0;
    LensField::LensPath changed;
    FactorField::FactorPath path;
};

}  // namespace

std::vector<DetailLens> changed_lenses(const std::vector<DetailLens>& before,
                                       const std::vector<DetailLens>& now) {
    std::vector<DetailLens> changed;
    for (size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
        if (i < before.size() && i < now.size() && same(before[i], now[i]))
            continue;
        if (i < before.size())
            changed.push_back(before[i]);
        if (i < now.size())
            changed.push_back(now[i]);
    }
    return changed;
}

void refresh_lens_factors(const ChoiceTable& table, const View& view,
                          const std::vector<DetailLens>& changed, FactorField& field,
                          const Cut& cut, std::vector<SeenNode>& seen,
                          std::vector<uint32_t>& reached) {
    reached.clear();
    // Everything within reach, whether a lens lists it or not.
    std::vector<DetailLens> anything = changed;
    for (DetailLens& lens : anything) {
        lens.filter = LensFilter::All;
        lens.objects.clear();
    }
    LensField reach(table.model(), anything);
    ReachedGroup root;
    root.node = kNoParent;
    root.changed = reach.root();
    root.path = field.root();
    std::vector<ReachedGroup> groups{root};
    for (uint32_t i = 0; i < cut.nodes.size(); ++i) {
        const CutNode& node = cut.nodes[i];
        while (groups.size() > 1 && groups.back().node > node.parent)
            groups.pop_back();
        if (groups.back().node != node.parent)
            continue;
        SeenNode& known = seen[node.transform];
        const Affine& world = cut.world(node);
        const TableRow& row = table.row(known.row);
        const Bound local = table.bound(known.row);
        ReachedGroup here = groups.back();
        here.node = i;
        here.changed =
            reach.at(node.object, true, transformed(local, world, known.stretch), here.changed)
                .below;
        if (here.changed.begin == here.changed.end)
            continue;
        here.path = path_to(field, here.path, table.model(), cut, node);
        OccurrenceSight sight;
        DetailFactors factors;
        find_sight(view, field, {node, world}, row.group, local, table.object(known.row).demand,
                   known.stretch, here.path, sight, factors);
        known.total = sight.total;
        reached.push_back(i);
        if (node.opened)
            groups.push_back(here);
    }
}

}  // namespace lodestone::choose

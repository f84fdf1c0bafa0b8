// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/position_groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

namespace lodestone::group {
namespace {

using Items = std::vector<uint32_t>;  // places in the group's assembly, rising

// Levels of cells below the highest.
// Taste: things within 2^-32 of the whole count as in one place; a larger value makes deeper chains
// of groups.
constexpr int kLevels = 32;
/// Binary digits of a cell's number.
/// Law: a double holds 53; the number must stay exact.
constexpr int kDigits = 50;

class PositionGrouper {
public:
    PositionGrouper(Model& model, ObjectIndex group, size_t most)
        : model_(model), group_(group), most_(most), placements_(assembly().placements) {
        for (const Object& object : model.objects)
            uids_.insert(object.uid);
        middles_.reserve(placements_.size());
        for (const Placement& placement : placements_) {
            const Object& child = model.objects.at(placement.object);
            const Bound bound = child.representations.empty() ? Bound() : child.bound();
            const glm::dvec3 middle =
                placement.transform(bound.empty() ? glm::dvec3(0.0) : bound.center);
            const bool finite = std::isfinite(middle.x + middle.y + middle.z);
            middles_.push_back(finite ? middle : glm::dvec3(0.0));  // no cell holds NaN
        }
    }

    size_t run() {
        Items all(placements_.size());
        std::iota(all.begin(), all.end(), 0u);
        const size_t before = model_.objects.size();
        std::vector<Placement> top = part(all, highest_level());
        auto assembly = std::make_shared<Assembly>();
        assembly->placements = std::move(top);
        model_.objects[group_].representations[0].payload =
            std::shared_ptr<const Assembly>(std::move(assembly));
        return model_.objects.size() - before;
    }

private:
    const Assembly& assembly() const {
        return model_.objects[group_].representations[0].assembly();
    }

    /// Finds the lowest level at which the whole is in at most two cells along each axis.
    int highest_level() {
        Box3 box;
        double farthest = 0;
        for (const glm::dvec3& middle : middles_) {
            box.add(middle);
            farthest =
                std::max({farthest, std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)});
        }
        const glm::dvec3 size = box.size();
        const double extent = std::max({size.x, size.y, size.z});
        if (!(extent > 0) || !std::isfinite(extent) || !std::isfinite(farthest)) {
            lowest_ = 1;
            return 0;
        }
        const int level = std::ilogb(extent) + 1;  // 2^level > extent
        lowest_ = std::max(level - kLevels, std::ilogb(farthest) - kDigits);
        return level;
    }

    glm::dvec3 cell_of(uint32_t item, int level) const {
        const glm::dvec3& p = middles_[item];
        return {std::floor(std::ldexp(p.x, -level)), std::floor(std::ldexp(p.y, -level)),
                std::floor(std::ldexp(p.z, -level))};
    }

    /// Makes at most `most_` placements that hold the items; there are more items than that.
    std::vector<Placement> part(const Items& items, int level) {
        const auto key = [&](uint32_t item) {
            const glm::dvec3 cell = cell_of(item, level);
            return std::tuple(cell.z, cell.y, cell.x);
        };
        for (; level >= lowest_; --level) {  // a cell that holds all of them is no group
            const auto first = key(items.front());
            if (std::any_of(items.begin(), items.end(),
                            [&](uint32_t item) { return key(item) != first; }))
                break;
        }
        if (level < lowest_)
            return in_order(items);
        Items sorted = items;
        std::stable_sort(sorted.begin(), sorted.end(),
                         [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
        std::vector<Placement> out;
        for (auto at = sorted.begin(); at != sorted.end();) {
            const auto end = std::find_if(
                at, sorted.end(), [cell = key(*at), &key](uint32_t i) { return key(i) != cell; });
            const Items inside(at, end);
            const glm::dvec3 cell = cell_of(*at, level);
            at = end;
            if (inside.size() == 1) {
                out.push_back(placements_[inside.front()]);
                continue;
            }
            std::vector<Placement> children;
            if (inside.size() <= most_) {
                for (const uint32_t item : inside)
                    children.push_back(placements_[item]);
            } else {
                children = part(inside, level - 1);
            }
            out.push_back(add_group(
                Hasher().value(level).value(cell.x + 0.0).value(cell.y + 0.0).value(cell.z + 0.0),
                std::move(children)));
        }
        return out;
    }

    /// Makes placements of items that are in one place.
    std::vector<Placement> in_order(const Items& items) {
        size_t share = 1;  // items in each: a power of most_, so that groups below are full
        while (share * most_ < items.size())
            share *= most_;
        std::vector<Placement> out;
        for (size_t at = 0; at < items.size(); at += share) {
            const Items inside(
                items.begin() + static_cast<std::ptrdiff_t>(at),
                items.begin() + static_cast<std::ptrdiff_t>(std::min(at + share, items.size())));
            if (inside.size() == 1) {
                out.push_back(placements_[inside.front()]);
                continue;
            }
            std::vector<Placement> children;
            if (inside.size() <= most_) {
                for (const uint32_t item : inside)
                    children.push_back(placements_[item]);
            } else {
                children = in_order(inside);
            }
            const glm::dvec3& place = middles_[inside.front()];
            out.push_back(add_group(Hasher()
                                        .value(place.x + 0.0)
                                        .value(place.y + 0.0)
                                        .value(place.z + 0.0)
                                        .value(inside.front())
                                        .value(inside.size()),
                                    std::move(children)));
        }
        return out;
    }

    Placement add_group(const Hasher& cell, std::vector<Placement>&& children) {
        Object made;
        const Object& whole = model_.objects[group_];
        const std::string place = hex16(cell.result());
        for (uint32_t attempt = 0; made.uid.empty() || !uids_.insert(made.uid).second; ++attempt)
            made.uid = hex16(Hasher().text(whole.uid).text(place).value(attempt).result());
        made.name = text(whole.name, " ", ++count_);
        made.role = whole.role;
        Representation finest;
        finest.summary.kind = Kind::Assembly;
        auto assembly = std::make_shared<Assembly>();
        assembly->placements = std::move(children);
        finest.payload = std::shared_ptr<const Assembly>(std::move(assembly));
        made.representations.push_back(std::move(finest));
        Placement placement;
        placement.object = static_cast<ObjectIndex>(model_.objects.size());
        placement.name = made.name;
        model_.objects.push_back(std::move(made));
        return placement;
    }

    Model& model_;
    ObjectIndex group_;
    size_t most_;
    std::vector<Placement> placements_;
    std::vector<glm::dvec3> middles_;  // in the group's frame
    std::set<std::string> uids_;
    int lowest_ = 0;
    size_t count_ = 0;
};

}  // namespace

size_t group_by_position(Model& model, ObjectIndex group, size_t most) {
    if (group >= model.objects.size() || !model.objects[group].group())
        fail(Status::InvalidArgument, "only a group can be grouped by position");
    if (most < kLeastChildren)
        fail(Status::InvalidArgument, "groups of at most ", most, " children; ", kLeastChildren,
             " or more expected");
    if (model.objects[group].representations[0].assembly().placements.size() <= most)
        return 0;
    return PositionGrouper(model, group, most).run();
}

}  // namespace lodestone::group

// SPDX-License-Identifier: GPL-3.0-or-later
// Opened group: the representations that draw a group's children within an error.
#pragma once

#include "choose/cut.h"

#include <map>

namespace lodestone::hierarchy {

/// How finely an ellipsoid is drawn by triangles: 80 of them.
/// Taste: one more is four times the triangles.
inline constexpr int kDrawnSubdivisions = 1;

/// The costs of an occurrence of the group's children within an error.
struct DrawnCosts {
    uint64_t triangles = 0;  // of the flat mesh
    double bytes = 0;        // in the renderer
    double alone = 0;        // the same with all of each representation's: as the cut counts
};

/// Remembers what it was asked. The group's own stand-ins do not count. The model and `uses`, by
/// object, must outlive it and stay as they are. Not thread-safe.
class OpenedGroup {
public:
    OpenedGroup(const Model& model, ObjectIndex group, const std::vector<uint64_t>& uses);

    const Model& model() const { return table_.model(); }
    ObjectIndex index() const { return group_; }
    /// How often the group is drawn.
    uint64_t uses() const { return uses_[group_]; }

    /// Children by their cheapest representations within `error` metres (0: the finest).
    choose::Cut cut(double error, const Job& job);
    /// Bytes: a share of every representation (its bytes over its object's uses, for all
    /// occurrences share it) and the occurrences themselves.
    DrawnCosts drawn_within(double error, const Job& job);

private:
    choose::ChoiceTable table_;
    ObjectIndex group_;
    const std::vector<uint64_t>& uses_;
    std::map<double, DrawnCosts> drawn_;  // by error
};

}  // namespace lodestone::hierarchy

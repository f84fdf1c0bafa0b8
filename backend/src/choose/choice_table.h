// SPDX-License-Identifier: GPL-3.0-or-later
// Choice table: all that choosing reads of a model, in flat arrays. Siblings lie beside each other
// and subtrees together, so that a visit misses the cache seldom. It is made once per change of the
// model.
#pragma once

#include "model/model.h"

#include <atomic>
#include <unordered_map>

namespace lodestone::choose {

/// A representation that the view can draw (never an assembly).
struct TableLevel {
    double error = 0;  // in metres, in the object's frame
    /// From this error on, the children of the group cost less than this stand-in (in bytes; shared
    /// representations are counted at each use); infinite: they never do. Children are farther away
    /// than their group and ask for no smaller error than it does, so the levels that are then
    /// chosen below cost less, too. It is infinite for a sealed level.
    double opens_from = 0;
    uint64_t bytes = 0;
    uint64_t triangles = 0;
    uint32_t lod = 0;
    uint32_t distinct = 0;  // levels with equal numbers draw the same
    Kind kind = Kind::Mesh;
    bool sealed = false;
};

/// The decisions that a user made for a placement or for its object. Nearly all have none.
struct PlacementOverrides {
    double importance = 1;
    double demand = 1;  // that of the object
    uint32_t coarsest = kAnyLevel;
    uint32_t finest = 0;
    RayMask hidden = 0;
};

/// The `linear` of a child that is moved only, neither turned nor scaled.
inline constexpr uint32_t kUnturned = ~uint32_t{0};

/// A placement, with the numbers of its object that are read first. It fills one line of a cache.
struct alignas(64) TableChild {
    glm::dvec3 offset{0.0};
    /// The least error of the object's levels; infinite if it has no level.
    double finest_error = 0;
    ObjectIndex object = kNoObject;
    uint32_t row = 0;
    uint32_t linear = kUnturned;  // in linears_; kUnturned: moved only
    uint32_t overrides = 0;       // in overrides_; 0: none
    // The children of its object; these two are known in a whole table only.
    uint32_t first_child = 0;
    uint32_t child_count = 0;
    // The rows and levels of the first child; those of the others follow, if no placement before
    // uses them.
    uint32_t first_row = 0;
    uint32_t first_level = 0;
};

/// An object as it is seen. It fills one line of a cache.
struct alignas(64) TableRow {
    Box3 box;
    double radius = 0;
    uint32_t first_level = 0;  // the finest level is first
    uint32_t level_count : 28 = 0;
    bool group : 1 = false;
    bool drawable : 1 = false;  // it has representations
    bool centered : 1 = false;  // the center of its bound is the center of its box
    /// However it is seen, the object or something in it is drawn, unless a placement forbids
    /// levels. It is known in a whole table only; false means that it may or may not be so.
    bool lasting : 1 = false;
};

/// The data of an object that are read seldom.
struct TableObject {
    glm::dvec3 center{0.0};  // the center of its bound
    double demand = 1;
    ObjectIndex object = kNoObject;
    uint32_t all_levels = 0;  // the levels that the view cannot draw are counted, too
    uint32_t first_child = 0;
    uint32_t child_count = 0;
    bool expanded = false;  // its children are in the table
    bool openings = false;  // the opens_from of its levels is known
};

class ChoiceTable {
public:
    /// The table is empty; rows are made when they are asked for. The model must not change.
    ChoiceTable(const Model& model, KindMask kinds) : model_(model), kinds_(kinds) {}

    /// The table of everything below an object. It never changes afterwards: safe from any thread.
    static ChoiceTable whole(const Model& model, ObjectIndex root, KindMask kinds);

    KindMask kinds() const { return kinds_; }
    const Model& model() const { return model_; }
    const TableRow& row(uint32_t index) const { return rows_[index]; }
    const TableObject& object(uint32_t row) const { return objects_[row]; }
    Bound bound(uint32_t index) const {
        const TableRow& row = rows_[index];
        return {row.centered ? row.box.center() : objects_[index].center, row.radius, row.box};
    }
    const TableLevel& level(uint32_t index) const { return levels_[index]; }
    const TableChild& child(uint32_t index) const { return children_[index]; }
    const glm::dmat3& linear(uint32_t index) const { return linears_[index]; }
    const PlacementOverrides& overrides(uint32_t index) const { return overrides_[index]; }
    /// The assembly of a group that is expanded; the table keeps it alive.
    const Assembly& assembly(uint32_t row) const { return *assemblies_[row]; }
    size_t size() const { return rows_.size(); }
    size_t distinct() const { return distinct_.size(); }
    /// Prefetches the row and the first levels of a child.
    void prefetch(uint32_t child) const {
        const uint32_t row = children_[child].row;
        prefetch(rows_, row);
        prefetch(levels_, rows_[row].first_level);
    }
    /// Prefetches the same of a placed group's first children, before their placements are known.
    void prefetch_below(uint32_t first_child, uint32_t first_row, uint32_t first_level,
                        uint32_t count) const {
        for (uint32_t i = 0; i < count; ++i) {
            prefetch(children_, first_child + i);
            prefetch(rows_, first_row + i);
            prefetch(levels_, first_level + i);
        }
    }
    /// The number of nodes of the last cut, for which the next one reserves memory. It is a hint;
    /// no result depends on it.
    size_t expected() const { return expected_.value.load(std::memory_order_relaxed); }
    void expect(size_t nodes) const {
        expected_.value.store(nodes + nodes / 8, std::memory_order_relaxed);
    }

    /// The row of an object. It is made, with its levels, if the table has none.
    uint32_t row_of(ObjectIndex object);
    /// The row of an object that is in the table.
    uint32_t find(ObjectIndex object) const { return by_object_.at(object); }
    /// Makes the rows of the objects that a group places.
    void expand(uint32_t row);

private:
    template <typename Row>
    static void prefetch(const std::vector<Row>& rows, size_t index) {
        if (index < rows.size())
            __builtin_prefetch(rows.data() + index);
    }

    uint32_t add(ObjectIndex object);
    void link();
    /// The bytes of one occurrence, with all of what it draws.
    double own_cost(const TableLevel& level) const;
    double stretch_of(const TableChild& child) const;
    void set_openings(uint32_t row);
    double cost_at(uint32_t row, double error, int depth);
    double cost_below(uint32_t row, double error, int depth);

    struct NodeCountHint {
        std::atomic<size_t> value{0};
        NodeCountHint() = default;
        NodeCountHint(NodeCountHint&& other) noexcept : value(other.value.load()) {}
    };

    const Model& model_;
    KindMask kinds_;
    mutable NodeCountHint expected_;
    std::vector<TableRow> rows_;
    std::vector<TableObject> objects_;  // by row
    std::vector<TableLevel> levels_;
    std::vector<TableChild> children_;
    std::vector<glm::dmat3> linears_;
    std::vector<double> stretches_;  // by the index of the linear map
    std::vector<PlacementOverrides> overrides_{PlacementOverrides{}};
    /// By row; null for an object that is no group.
    std::vector<std::shared_ptr<const Assembly>> assemblies_;
    std::unordered_map<ObjectIndex, uint32_t> by_object_;
    std::unordered_map<Hash, uint32_t> distinct_;
};

}  // namespace lodestone::choose

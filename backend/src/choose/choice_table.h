// SPDX-License-Identifier: GPL-3.0-or-later
// ChoiceTable: all that choosing reads of a model, in flat arrays, siblings beside each other and
// subtrees together, so that a visit misses few caches. Made once per change of the model.
#pragma once

#include "model/model.h"

#include <atomic>
#include <unordered_map>

namespace lodestone::choose {

/// A representation that the view can draw (never an assembly).
struct TableLevel {
    double error = 0;  // metres, object's frame
    /// From this error on its group's children cost less (in bytes, those of shared representations
    /// counted each time) than this stand-in; infinite: never. Children are farther than their
    /// group and ask for no less error than it does, so what is then chosen below costs less
    /// indeed. Never where it is sealed.
    double opens_from = 0;
    uint64_t bytes = 0;
    uint64_t triangles = 0;
    uint32_t lod = 0;
    uint32_t distinct = 0;  // equal numbers draw the same
    Kind kind = Kind::Mesh;
    bool sealed = false;
};

/// What is particular of a placement, or of its object; of nearly all nothing is.
struct PlacementOverrides {
    double importance = 1;
    double demand = 1;  // of the object
    uint32_t coarsest = kAnyLevel;
    uint32_t finest = 0;
    RayMask hidden = 0;
};

inline constexpr uint32_t kUnturned = ~uint32_t{0};

/// A placement, with what its object is looked at first by: a line of a cache.
struct alignas(64) TableChild {
    glm::dvec3 offset{0.0};
    double finest_error = 0;  // the least of its object's levels; infinite without any
    ObjectIndex object = kNoObject;
    uint32_t row = 0;
    uint32_t linear = kUnturned;  // in linears(); kUnturned: moved only
    uint32_t overrides = 0;       // in overrides(); 0: none
    // Of its object's children; of a whole table alone.
    uint32_t first_child = 0;
    uint32_t child_count = 0;
    // Of the first of them; the others' lie behind, if they are used nowhere before.
    uint32_t first_row = 0;
    uint32_t first_level = 0;
};

/// An object as it is seen: a line of a cache.
struct alignas(64) TableRow {
    Box3 box;
    double radius = 0;
    uint32_t first_level = 0;  // finest first
    uint32_t level_count : 28 = 0;
    bool group : 1 = false;
    bool drawable : 1 = false;  // it has representations
    bool centered : 1 = false;  // its bound's center is its box's
    /// However it is seen, it or something in it is drawn, where a placement forbids no level. Of a
    /// whole table alone; false: it may be so.
    bool lasting : 1 = false;
};

/// The rest of it.
struct TableObject {
    glm::dvec3 center{0.0};  // of its bound
    double demand = 1;
    ObjectIndex object = kNoObject;
    uint32_t all_levels = 0;  // those that the view cannot draw included
    uint32_t first_child = 0;
    uint32_t child_count = 0;
    bool expanded = false;  // its children are in the table
    bool openings = false;  // its levels' opens_from is known
};

class ChoiceTable {
public:
    /// Empty; rows are made when they are asked for. The model must stay as it is.
    ChoiceTable(const Model& model, KindMask kinds) : model_(model), kinds_(kinds) {}

    /// Of everything below an object. Never changes afterwards: safe from any thread.
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
    /// Of a group that is expanded; the table keeps it.
    const Assembly& assembly(uint32_t row) const { return *assemblies_[row]; }
    size_t size() const { return rows_.size(); }
    size_t distinct() const { return distinct_.size(); }
    /// Brings nearer what is read of a child and of those behind it.
    void prefetch(uint32_t child) const {
        const uint32_t row = children_[child].row;
        prefetch(rows_, row);
        prefetch(levels_, rows_[row].first_level);
    }
    /// The same of a placed group's first children, before their placements are known.
    void prefetch_below(uint32_t first_child, uint32_t first_row, uint32_t first_level,
                        uint32_t count) const {
        for (uint32_t i = 0; i < count; ++i) {
            prefetch(children_, first_child + i);
            prefetch(rows_, first_row + i);
            prefetch(levels_, first_level + i);
        }
    }
    /// Nodes of the cut before: what the next one makes room for. A hint; nothing depends on it.
    size_t expected() const { return expected_.value.load(std::memory_order_relaxed); }
    void expect(size_t nodes) const {
        expected_.value.store(nodes + nodes / 8, std::memory_order_relaxed);
    }

    /// The row of an object; made, with its levels, if it is not there.
    uint32_t row_of(ObjectIndex object);
    /// The row of an object that is in the table.
    uint32_t find(ObjectIndex object) const { return by_object_.at(object); }
    /// Makes the rows of what a group places.
    void expand(uint32_t row);

private:
    template <typename Row>
    static void prefetch(const std::vector<Row>& rows, size_t index) {
        if (index < rows.size())
            __builtin_prefetch(rows.data() + index);
    }

    uint32_t add(ObjectIndex object);
    void link();
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
    std::vector<double> stretches_;  // of them
    std::vector<PlacementOverrides> overrides_{PlacementOverrides{}};
    std::vector<std::shared_ptr<const Assembly>> assemblies_;  // by row; null of what is no group
    std::unordered_map<ObjectIndex, uint32_t> by_object_;
    std::unordered_map<Hash, uint32_t> distinct_;
};

}  // namespace lodestone::choose

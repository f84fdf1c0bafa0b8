// SPDX-License-Identifier: GPL-3.0-or-later
// Table: all that choosing reads of a model, in flat arrays, siblings beside each other and subtrees
// together, so that a visit misses few caches. Made once per change of the model.
#pragma once

#include "model/model.h"

#include <atomic>
#include <unordered_map>

namespace lodestone::quality {

/// A representation that the view can draw (never an assembly).
struct TableLevel {
    double error = 0;  // metres, object's frame
    /// From this error on its group's children cost less (in bytes, those of shared representations
    /// counted each time) than this stand-in; infinite: never. Children are farther than their group
    /// and ask for no less error than it does, so what is then chosen below costs less indeed.
    double opens_from = 0;
    uint64_t bytes = 0;
    uint64_t triangles = 0;
    uint32_t lod = 0;
    uint32_t distinct = 0;  // equal numbers draw the same
    Kind kind = Kind::Mesh;
};

struct TableChild {
    glm::dvec3 offset{0.0};
    double stretch = 1;  // of its placement
    double importance = 1;
    uint32_t row = 0;
    uint32_t linear = 0;  // in linears(); kUnturned: moved only
    uint32_t coarsest = kAnyLevel;
    uint32_t finest = 0;
    RayMask hidden = 0;
};
inline constexpr uint32_t kUnturned = ~uint32_t{0};

/// An object.
struct alignas(64) TableRow {
    Bound bound;
    double demand = 1;
    ObjectIndex object = kNoObject;
    uint32_t first_level = 0;  // finest first
    uint32_t level_count = 0;
    uint32_t all_levels = 0;  // of the object, those that the view cannot draw included
    uint32_t first_child = 0;
    uint32_t child_count = 0;
    bool group = false;
    bool drawable = false;  // it has representations
    bool expanded = false;  // its children are in the table
    bool openings = false;  // its levels' opens_from is known
};

class Table {
public:
    /// Empty; rows are made when they are asked for. The model must stay as it is.
    Table(const Model& model, KindMask kinds) : model_(model), kinds_(kinds) {}

    /// Of everything below an object. Never changes afterwards: safe from any thread.
    static Table whole(const Model& model, ObjectIndex root, KindMask kinds);

    KindMask kinds() const { return kinds_; }
    const Model& model() const { return model_; }
    const TableRow& row(uint32_t index) const { return rows_[index]; }
    const TableLevel& level(uint32_t index) const { return levels_[index]; }
    const TableChild& child(uint32_t index) const { return children_[index]; }
    const glm::dmat3& linear(uint32_t index) const { return linears_[index]; }
    /// Of a group that is expanded; the table keeps it.
    const Assembly& assembly(uint32_t row) const { return *assemblies_[row]; }
    size_t size() const { return rows_.size(); }
    size_t distinct() const { return distinct_.size(); }
    /// Brings a row nearer that is visited soon.
    void fetch(uint32_t row) const {
        const char* at = reinterpret_cast<const char*>(&rows_[row]);
        __builtin_prefetch(at);
        __builtin_prefetch(at + 64);
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
    uint32_t add(ObjectIndex object);
    void set_openings(uint32_t row);
    double cost_at(uint32_t row, double error, int depth);
    double cost_below(uint32_t row, double error, int depth);

    struct Hint {
        std::atomic<size_t> value{0};
        Hint() = default;
        Hint(Hint&& other) noexcept : value(other.value.load()) {}
    };

    const Model& model_;
    KindMask kinds_;
    mutable Hint expected_;
    std::vector<TableRow> rows_;
    std::vector<TableLevel> levels_;
    std::vector<TableChild> children_;
    std::vector<glm::dmat3> linears_;
    std::vector<std::shared_ptr<const Assembly>> assemblies_;  // by row; null of what is no group
    std::unordered_map<ObjectIndex, uint32_t> by_object_;
    std::unordered_map<Hash, uint32_t> distinct_;
};

}  // namespace lodestone::quality

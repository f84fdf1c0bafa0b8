// SPDX-License-Identifier: GPL-3.0-or-later
// Cut: the result of choosing for a view. Every path from the root crosses it exactly once.
#pragma once

#include "base/job.h"
#include "choose/choice_table.h"
#include "choose/detail_factors.h"
#include "model/model.h"

#include <map>
#include <string>
#include <vector>

namespace lodestone::choose {

/// The parent of the root.
inline constexpr uint32_t kNoParent = ~uint32_t{0};

/// An occurrence that the choice visited: either opened (its assembly goes on below) or chosen. No
/// field changes with the eye as long as the occurrence is drawn by the same level; see
/// error_on_screen().
struct CutNode {
    ObjectIndex object = kNoObject;
    uint32_t parent = kNoParent;  // index of the opened node above it
    uint32_t placement = 0;       // index in that node's assembly
    uint32_t lod = 0;  // the LOD number of the chosen representation; 0 for an opened group
    uint32_t coarsest = kAnyLevel;
    uint32_t finest = 0;
    Kind kind = Kind::Assembly;  // the kind of the chosen representation
    bool opened = false;
    RayMask hidden = 0;  // the ray classes that do not see it, all its placements taken together
    uint32_t transform = 0;  // in Cut::transforms; nodes share none
    double importance = 1;   // the product over its placements
};

struct Cut {
    std::vector<CutNode> nodes;    // depth-first, in order of placements
    std::vector<uint32_t> chosen;  // indices of the nodes that are drawn, rising
    /// The maps from object to world, in any order; some belong to no node. Nodes lie apart from
    /// them, so that a node that moves in memory takes 40 bytes, not 136.
    std::vector<Affine> transforms;

    uint64_t triangles = 0;  // those of all occurrences
    uint64_t bytes = 0;      // POV-Ray's memory: distinct representations and occurrences
    uint64_t originals = 0;  // the chosen occurrences that are drawn at LOD 0
    double largest_error_px = 0;
    uint32_t largest_error_node = kNoParent;
    std::map<std::string, uint64_t> kinds;  // the word of a kind -> the occurrences drawn by it

    const Affine& world(const CutNode& node) const { return transforms[node.transform]; }
};

/// The highest costs that a cut may have; 0: no limit.
struct CutBudget {
    uint64_t triangles = 0;  // those of all occurrences
    uint64_t bytes = 0;      // in POV-Ray's memory, as Cut::bytes

    bool fits(const Cut& cut) const {
        return (triangles == 0 || cut.triangles <= triangles) && (bytes == 0 || cut.bytes <= bytes);
    }
};

/// Chooses for the camera class, from the model's root. The result depends on the arguments only. A
/// group that is good enough is drawn by its stand-in, unless its children would be drawn by levels
/// that cost less (TableLevel::opens_from); it must be good enough for the most important object
/// below it. Throws Error(InvalidArgument) for a view that makes no sense or a model without root.
/// Cost: one visit per opened group and chosen occurrence. Thread-safe on a const model.
Cut choose_cut(const Model& model, const View& view, const Job& job = {});

/// The same cut, chosen from a whole table of the model for the view's kinds, so that no table is
/// made.
Cut choose_cut(const ChoiceTable& table, const View& view, const Job& job = {});

/// The same cut; none, and sooner, when it costs more than the budget.
std::optional<Cut> choose_cut_if_within(const ChoiceTable& table, const View& view,
                                        const CutBudget& budget, const Job& job = {});

/// The same for the part of the model below one object, in the frame of that object.
Cut choose_below(const Model& model, ObjectIndex root, const View& view, const Job& job = {});

/// The same for several views that share a table for their kinds; missing rows are added to it.
Cut choose_below(ChoiceTable& table, ObjectIndex root, const View& view, const Job& job = {});

/// The facts along the path to a node, from those that FactorField::at left for its group; those of
/// the root for a node without a group.
FactorField::FactorPath path_to(const FactorField& field, const FactorField::FactorPath& group,
                                const Model& model, const Cut& cut, const CutNode& node);

/// How many occurrences are drawn by a level of an object.
struct LevelUse {
    ObjectIndex object = kNoObject;
    uint32_t lod = 0;
    uint64_t occurrences = 0;
};

/// The uses of all levels that a cut draws, by rising object and LOD number.
std::vector<LevelUse> level_uses(const Cut& cut);

/// The error on screen, in pixels, of a chosen node of a cut for this view; 0 for an opened node.
double error_on_screen(const ChoiceTable& table, const View& view, const Cut& cut,
                       const CutNode& node);

/// The numbers that explain why a node is drawn as it is.
struct ChoiceReason {
    struct ReasonLevel {
        ObjectIndex object = kNoObject;
        uint32_t lod = 0;
        Kind kind = Kind::Mesh;
        double error = 0;     // in metres, in the object's frame
        double error_px = 0;  // on screen
        /// The product of its factors; error_px * total is compared with Pixel Error.
        double total = 1;
    };
    ReasonLevel chosen;
    double z = 0;        // in metres, from the eye
    double pixel = 0;    // size of a pixel there, metres
    double stretch = 1;  // that of its transform
    DetailFactors factors;
    /// The next coarser level of the same object, else the finest stand-in of the nearest group
    /// around it that has one.
    std::optional<ReasonLevel> coarser;
    bool pinned = false;  // a decision on the placement forbids `coarser`
};

/// The reasons for a node of a cut of this model and view, with the numbers it was chosen by.
/// Throws Error(InvalidArgument) for a cut of another view whose lenses hide the node.
ChoiceReason explain_choice(const Model& model, const View& view, const Cut& cut, uint32_t node);

/// The names of the placements from the root to a node, joined by '/'.
std::string path_of(const Model& model, const Cut& cut, uint32_t node);
/// The same names, from the table that the cut was chosen from; its model may be gone.
std::string path_of(const ChoiceTable& table, const Cut& cut, uint32_t node);

}  // namespace lodestone::choose

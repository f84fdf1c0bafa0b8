// SPDX-License-Identifier: GPL-3.0-or-later
// Cut: the result of choosing for a view; every path from the root crosses it exactly once.
#pragma once

#include "base/job.h"
#include "choose/choice_table.h"
#include "choose/detail_factors.h"
#include "model/model.h"

#include <map>
#include <string>
#include <vector>

namespace lodestone::choose {

inline constexpr uint32_t kNoParent = ~uint32_t{0};

/// An occurrence the choice visited: either opened (its assembly goes on below) or chosen. Nothing
/// in it changes with the eye as long as it is drawn alike: see error_on_screen().
struct CutNode {
    ObjectIndex object = kNoObject;
    uint32_t parent = kNoParent;  // index of the opened node above it
    uint32_t placement = 0;       // index in that node's assembly
    uint32_t lod = 0;             // the chosen representation's LOD number; 0 of an opened group
    uint32_t coarsest = kAnyLevel;
    uint32_t finest = 0;
    Kind kind = Kind::Assembly;  // of the choice
    bool opened = false;
    RayMask hidden = 0;      // ray classes that do not see it: its placements' together
    uint32_t transform = 0;  // in Cut::transforms; nodes share none
    double importance = 1;   // its placements' together
};

struct Cut {
    std::vector<CutNode> nodes;    // depth-first, in order of placements
    std::vector<uint32_t> chosen;  // indices of the nodes that are drawn, rising
    /// object -> world, in any order, some of none: nodes that move take 40 bytes, not 136, with
    /// them.
    std::vector<Affine> transforms;

    uint64_t triangles = 0;  // placed
    uint64_t bytes = 0;      // POV-Ray's memory: distinct representations and occurrences
    uint64_t originals = 0;  // of the chosen: drawn at LOD 0
    double largest_error_px = 0;
    uint32_t largest_error_node = kNoParent;
    std::map<std::string, uint64_t> kinds;  // word -> occurrences drawn

    const Affine& world(const CutNode& node) const { return transforms[node.transform]; }
};

/// What a cut may cost at most; 0: any number.
struct CutBudget {
    uint64_t triangles = 0;  // placed
    uint64_t bytes = 0;      // in POV-Ray's memory, as Cut::bytes

    bool fits(const Cut& cut) const {
        return (triangles == 0 || cut.triangles <= triangles) && (bytes == 0 || cut.bytes <= bytes);
    }
};

/// Chooses for the camera class, from the model's root. Pure: depends on its arguments only. A
/// group that is good enough is drawn by its stand-in, unless what its children would be drawn by
/// costs less (TableLevel::opens_from); it must be good enough for the most important thing below
/// it. Throws Error(InvalidArgument) for a view that makes no sense or a model without root. cost:
/// one visit per opened group and chosen occurrence. Thread-safe on a const model.
Cut choose_cut(const Model& model, const View& view, const Job& job = {});

/// The same with a whole table of the model for the view's kinds: without making one.
Cut choose_cut(const ChoiceTable& table, const View& view, const Job& job = {});

/// The same; nothing, and sooner, when it costs more than the budget.
std::optional<Cut> choose_cut_if_within(const ChoiceTable& table, const View& view,
                                        const CutBudget& budget, const Job& job = {});

/// The same for the part of the model below one object, in that object's frame.
Cut choose_below(const Model& model, ObjectIndex root, const View& view, const Job& job = {});

/// The same for several views: the table, for the views' kinds, gets what rows it needs.
Cut choose_below(ChoiceTable& table, ObjectIndex root, const View& view, const Job& job = {});

/// How many occurrences a level of an object is drawn by.
struct LevelUse {
    ObjectIndex object = kNoObject;
    uint32_t lod = 0;
    uint64_t occurrences = 0;
};

/// Of all levels that a cut draws, by object and LOD number, rising.
std::vector<LevelUse> level_uses(const Cut& cut);

/// Of a chosen node of a cut for this view, in pixels; 0 of an opened one.
double error_on_screen(const ChoiceTable& table, const View& view, const Cut& cut,
                       const CutNode& node);

/// Why a node is drawn as it is.
struct ChoiceReason {
    struct ReasonLevel {
        ObjectIndex object = kNoObject;
        uint32_t lod = 0;
        Kind kind = Kind::Mesh;
        double error = 0;     // metres, object's frame
        double error_px = 0;  // on screen
        double total = 1;  // its factors together: error_px * total is what is held to Pixel Error
    };
    ReasonLevel chosen;
    double z = 0;        // metres from the eye
    double pixel = 0;    // size of a pixel there, metres
    double stretch = 1;  // of its transform
    DetailFactors factors;
    /// The next coarser level of the same object, else the finest stand-in of the nearest group
    /// around it that has one.
    std::optional<ReasonLevel> coarser;
    bool pinned = false;  // that one is not allowed, by a decision on the placement
};

/// Of a node of a cut for this model and view, with the numbers it was chosen by. Throws
/// Error(InvalidArgument) for a cut of another view whose lenses hide it.
ChoiceReason explain_choice(const Model& model, const View& view, const Cut& cut, uint32_t node);

/// Names of the placements from the root to a node, joined by '/'.
std::string path_of(const Model& model, const Cut& cut, uint32_t node);
/// The same by the table that it was chosen from, whose model may be gone.
std::string path_of(const ChoiceTable& table, const Cut& cut, uint32_t node);

}  // namespace lodestone::choose

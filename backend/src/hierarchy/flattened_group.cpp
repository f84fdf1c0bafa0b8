// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/flattened_group.h"

#include "model/finish.h"

#include <cmath>
#include <limits>
#include <map>

namespace lodestone::hierarchy {
FlattenedGroup flatten_group(OpenedGroup& group, double error, const MeshSource& source,
                             const Job& job) {
    FlattenedGroup flat;
    const Model& model = group.model();
    const choose::Cut cut = group.cut(error, job);
    std::map<std::pair<uint32_t, bool>, uint16_t> slots;  // by material, and whether it is plain
    const auto slot_of = [&](uint32_t index, bool has_uvs) {
        const Material& material = model.materials.at(index);
        const bool plain = !has_uvs && textured(material);
        const auto [at, fresh] =
            slots.try_emplace({index, plain}, static_cast<uint16_t>(slots.size()));
        if (fresh) {
            flat.materials.push_back(plain ? without_textures(material) : material);
            flat.sources.push_back({index, plain});
        }
        return at->second;
    };
    for (const uint32_t index : cut.chosen) {
        job.check();
        const choose::CutNode& node = cut.nodes[index];
        const Object& object = model.objects[node.object];
        const Representation& representation = object.representations[node.lod];
        flat.child_error =
            std::max(flat.child_error, representation.summary.error * stretch(cut.world(node)));
        Mesh part = representation.summary.kind == Kind::Mesh
                        ? *source(representation)
                        : tessellated(representation, kDrawnSubdivisions);
        part.slots.resize(part.triangles.size(), 0);
        std::vector<uint16_t> moved;
        for (const uint32_t material : representation.materials) {
            if (slots.size() >= std::numeric_limits<uint16_t>::max())
                fail(Status::InvalidArgument, "group '", model.objects[group.index()].name,
                     "' uses more than 65535 materials");
            moved.push_back(slot_of(material, !part.uvs.empty()));
        }
        for (uint16_t& slot : part.slots)
            slot = slot < moved.size() ? moved[slot] : uint16_t{0};
        append(flat.mesh, part, cut.world(node));
        flat.occurrence.resize(flat.mesh.triangles.size(), static_cast<uint32_t>(flat.occurrences));
        ++flat.occurrences;
        flat.placement.push_back(0);
        flat.environment.push_back(0);
        for (uint32_t at = index; cut.nodes[at].parent != choose::kNoParent;
             at = cut.nodes[at].parent) {
            flat.placement.back() = cut.nodes[at].placement;
            if (model.objects[cut.nodes[at].object].role == ObjectRole::Environment)
                flat.environment.back() = 1;
        }
    }
    if (flat.materials.empty())
        flat.materials.emplace_back();
    return flat;
}

double error_to_flatten(OpenedGroup& group, uint64_t wanted, uint64_t most, const Job& job) {
    // The errors that are tried are powers of two, over the radius.
    // Taste: a larger one knows less of fine levels, for a search less.
    constexpr int kFinest = -12;
    // Taste: a larger one tries errors that are larger than any group is seen with.
    constexpr int kCoarsest = 3;
    // One mesh for a group has fewer triangles than its children at the same error, by this or
    // more.
    // Fitted: to 105 levels that were kept (by 1.4 in the worst case, by 4 in the middle); the
    // script was not kept.
    constexpr double kJoined = 1.5;
    // The error of the reference over that of the first stand-in.
    // Taste: a larger value flattens to fewer triangles, which errors are known less well by.
    constexpr double kFiner = 1.0 / 4;
    // The error of the reference, over the radius, of groups that only solids can stand for.
    // Taste: as kFiner.
    constexpr double kLeast = 1.0 / 8;
    // Taste: a larger number flattens small groups finer than the reference asks.
    constexpr uint64_t kFewTriangles = 1000;
    // Things that are larger than this power of two over the size are not fine: errors that are
    // measured against them would look as large. And an error is no use where it saves little: a
    // roof of boxes stays one.
    // Taste: a larger one flattens to fewer triangles.
    constexpr int kLastFine = -5;
    const CostModel& costs = group.model().costs;
    const double size = group.model().objects[group.index()].bound().radius;
    const double sharing = static_cast<double>(std::max<uint64_t>(1, group.uses()));
    const auto error_of = [&](int power) { return power < kFinest ? 0 : std::ldexp(size, power); };
    const auto drawn_at = [&](int power) { return group.drawn_within(error_of(power), job); };
    uint64_t enough = std::max(wanted, drawn_at(kLastFine).triangles * 5 / 4);
    if (enough > most)
        enough = std::max(most, drawn_at(kCoarsest - 1).triangles);
    double reference = kLeast * size;
    for (int power = kFinest - 1; power < kCoarsest; ++power) {
        const DrawnCosts drawn = drawn_at(power);
        const double stand_in =
            static_cast<double>(drawn.triangles * costs.triangle_bytes) / (kJoined * sharing) +
            static_cast<double>(costs.occurrence_bytes);
        if (stand_in < drawn.bytes) {
            reference = std::min(reference, kFiner * error_of(power));
            break;
        }
    }
    int power = kFinest - 1;
    for (; power + 1 < kCoarsest; ++power) {
        const uint64_t triangles = drawn_at(power).triangles;
        if (triangles <= enough && (triangles <= kFewTriangles || error_of(power) >= reference))
            break;
    }
    return error_of(power);
}

}  // namespace lodestone::hierarchy

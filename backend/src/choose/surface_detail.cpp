// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/surface_detail.h"

#include "base/parallel.h"
#include "choose/cut_chooser.h"
#include "choose/off_screen.h"
#include "geometry/closed_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace lodestone::choose {
namespace {

/// The LOD numbers of an object's levels whose chunks fit those of its finest and that the view can
/// draw, fine to coarse; fewer than two: it is no surface.
std::vector<uint32_t> levels_of_surface(const Object& object, const CutNode& node,
                                        const View& view) {
    std::vector<uint32_t> lods;
    if (object.representations.empty() || object.representations[0].surface == nullptr)
        return lods;
    const SurfaceTree& tree = *object.representations[0].surface->tree;
    uint32_t step = 0;
    for (uint32_t lod = 0; lod < object.representations.size(); ++lod) {
        const Representation& level = object.representations[lod];
        const SurfaceLevel* surface = level.surface.get();
        if (surface == nullptr || surface->tree->hash != tree.hash ||
            surface->tree->depth != tree.depth || level.summary.kind != Kind::Mesh ||
            (view.kinds & mask_of(Kind::Mesh)) == 0 ||
            surface->before.back() != level.summary.cost.triangles ||
            (lod > 0 && surface->step <= step))
            continue;
        step = surface->step;
        if (lod <= node.coarsest && lod >= std::min(node.finest, node.coarsest))
            lods.push_back(lod);
    }
    return lods;
}

/// The boxes of the nodes of a tree, for each shift.
std::vector<std::vector<Box3>> boxes_of(const SurfaceTree& tree) {
    std::vector<std::vector<Box3>> boxes{tree.boxes};
    for (uint32_t shift = 1; shift <= tree.depth; ++shift) {
        std::vector<Box3>& above = boxes.emplace_back(tree.chunks() >> shift);
        for (size_t node = 0; node < above.size(); ++node) {
            above[node] = boxes[shift - 1][2 * node];
            above[node].add(boxes[shift - 1][2 * node + 1]);
        }
    }
    return boxes;
}

/// Chooses the levels of one surface's chunks.
class ChunkChooser {
public:
    ChunkChooser(const View& view, FactorField& field, const OffScreenField* off_screen,
                 const FactorField::FactorPath& path, const Object& object,
                 const PlacedNode& placed, std::vector<uint32_t> lods)
        : view_(view),
          field_(field),
          off_screen_(off_screen),
          path_(path),
          object_(object),
          placed_(placed),
          enlarge_(stretch(placed.world)),
          lods_(std::move(lods)),
          boxes_(boxes_of(*object.representations[0].surface->tree)) {}

    SurfaceDetail run(uint32_t node) {
        detail_.node = node;
        const SurfaceTree& tree = *object_.representations[0].surface->tree;
        detail_.lods.resize(tree.chunks());
        choose(lods_.size() - 1, 0, tree.chunks());
        return std::move(detail_);
    }

private:
    /// Decides for the nodes of a level between two chunks.
    void choose(size_t at, uint32_t first, uint32_t last) {
        const Representation& level = object_.representations[lods_[at]];
        const uint32_t shift = level.surface->shift;
        const uint32_t step = 1u << shift;
        for (uint32_t chunk = first; chunk < last; chunk += step) {
            const Box3& box = boxes_[shift][chunk >> shift];
            const double error = level.surface->error_of(chunk >> shift, level.summary.error);
            double error_px = 0;
            if (at > 0 && !box.empty() && !good(box, error, lods_[at], error_px)) {
                choose(at - 1, chunk, chunk + step);
                continue;
            }
            std::fill_n(detail_.lods.begin() + chunk, step, lods_[at]);
            detail_.triangles += level.surface->triangles_of(chunk >> shift);
            detail_.largest_error_px = std::max(detail_.largest_error_px, error_px);
        }
    }

    bool good(const Box3& box, double error, uint32_t lod, double& error_px) {
        const glm::dvec3 half = 0.5 * box.size();
        const Bound bound{box.center(), glm::length(half), box};
        FactorField::FactorPath path = path_;
        OccurrenceSight sight;
        DetailFactors factors;
        if (!find_sight(view_, field_, placed_, false, bound, object_.demand, enlarge_, path, sight,
                        factors))
            return true;  // a lens hides it
        // The picture may show the surface and not this part of it.
        if (off_screen_ != nullptr && std::isfinite(sight.total)) {
            const Bound reach{
                bound.center, bound.radius + error, {box.low - error, box.high + error}};
            factors.off_screen =
                off_screen_->coarser(transformed(reach, placed_.world, enlarge_), sight.z);
            sight.total = factors.total();
        }
        error_px = error_on_screen(sight, error) / factors.off_screen;
        return good_enough(view_, sight, error, lod, object_.representations.size());
    }

    const View& view_;
    FactorField& field_;
    const OffScreenField* off_screen_;  // null: what the picture does not show counts as well
    const FactorField::FactorPath& path_;
    const Object& object_;
    const PlacedNode& placed_;
    double enlarge_;
    std::vector<uint32_t> lods_;
    std::vector<std::vector<Box3>> boxes_;
    SurfaceDetail detail_;
};

/// The facts along the path to a node of a cut, as when it was chosen.
FactorField::FactorPath path_of_node(FactorField& field, const Model& model, const View& view,
                                     const Cut& cut, uint32_t index) {
    std::vector<uint32_t> way;
    for (uint32_t at = index; at != kNoParent; at = cut.nodes.at(at).parent)
        way.push_back(at);
    FactorField::FactorPath path = field.root();
    for (size_t i = way.size(); i-- > 0;) {
        const CutNode& node = cut.nodes[way[i]];
        path = path_to(field, path, model, cut, node);
        if (i == 0)
            break;
        DetailFactors factors;
        OccurrenceSight sight;
        const Object& object = model.objects.at(node.object);
        const Affine& world = cut.world(node);
        find_sight(view, field, {node, world}, object.group(), object.bound(), object.demand,
                   stretch(world), path, sight, factors);
    }
    return path;
}

/// Leaves out the details of objects that are drawn so often that one level for all costs less.
void keep_cheaper(const Cut& cut, std::vector<SurfaceDetail>& details) {
    struct ObjectCosts {
        uint64_t whole = 0;  // the triangles of the distinct levels of the cut
        uint64_t parted = 0;
        std::vector<uint32_t> lods;
    };
    std::map<ObjectIndex, ObjectCosts> costs;
    for (const SurfaceDetail& detail : details) {
        const CutNode& node = cut.nodes[detail.node];
        ObjectCosts& of = costs[node.object];
        of.parted += detail.triangles;
        if (std::find(of.lods.begin(), of.lods.end(), node.lod) != of.lods.end())
            continue;
        of.lods.push_back(node.lod);
        of.whole += detail.whole.triangles;
    }
    std::erase_if(details, [&](const SurfaceDetail& detail) {
        const ObjectCosts& of = costs[cut.nodes[detail.node].object];
        return of.parted >= of.whole;
    });
}

/// Appends the materials that are missing; returns the place of each.
std::vector<uint16_t> join(const std::vector<uint32_t>& added, std::vector<uint32_t>& materials) {
    std::vector<uint16_t> places;
    for (const uint32_t material : added) {
        const auto at = std::find(materials.begin(), materials.end(), material);
        places.push_back(static_cast<uint16_t>(at - materials.begin()));
        if (at == materials.end())
            materials.push_back(material);
    }
    return places;
}

}  // namespace

std::vector<SurfaceDetail> surface_details(const Model& model, const View& view, const Cut& cut) {
    std::vector<SurfaceDetail> details;
    if (!by_error(view))
        return details;
    std::optional<FactorField> field;
    std::optional<OffScreenField> off_screen;
    for (const uint32_t index : cut.chosen) {
        const CutNode& node = cut.nodes[index];
        const Object& object = model.objects.at(node.object);
        if (node.lod >= object.representations.size() ||
            object.representations[node.lod].surface == nullptr)
            continue;
        std::vector<uint32_t> lods = levels_of_surface(object, node, view);
        if (lods.size() < 2)
            continue;
        if (!field) {
            field.emplace(model, view, true);
            if (view.modifiers.off_screen != OffScreen::Full)
                off_screen.emplace(model, view);
        }
        const FactorField::FactorPath path = path_of_node(*field, model, view, cut, index);
        const PlacedNode placed{node, cut.world(node)};
        details.push_back(ChunkChooser(view, *field, off_screen ? &*off_screen : nullptr, path,
                                       object, placed, std::move(lods))
                              .run(index));
        details.back().bytes = details.back().triangles * model.costs.triangle_bytes;
        details.back().whole = object.representations[node.lod].summary.cost;
    }
    keep_cheaper(cut, details);
    return details;
}

DetailedCut draw_surfaces(const Model& model, const Cut& cut,
                          std::span<const SurfaceDetail> details) {
    std::vector<std::optional<Representation>> made(details.size());
    parallel_for(details.size(), [&](size_t i) {
        const Object& object = model.objects.at(cut.nodes.at(details[i].node).object);
        std::vector<uint32_t> lods = details[i].lods;
        std::sort(lods.begin(), lods.end());
        lods.erase(std::unique(lods.begin(), lods.end()), lods.end());
        std::vector<geometry::SurfaceSource> sources;
        std::vector<uint32_t> materials = object.representations[0].materials;
        try {
            for (const uint32_t lod : lods) {
                const Representation& level = object.representations.at(lod);
                check(*level.surface, level.mesh().positions.size(), level.mesh().triangles.size());
                sources.push_back({level.mesh(), *level.surface});
                if (level.materials != object.representations[0].materials)
                    sources.back().slots = join(level.materials, materials);
            }
            std::vector<uint8_t> source_of;
            for (const uint32_t lod : details[i].lods)
                source_of.push_back(static_cast<uint8_t>(
                    std::lower_bound(lods.begin(), lods.end(), lod) - lods.begin()));
            Representation whole;
            whole.payload =
                std::make_shared<const Mesh>(geometry::closed_surface(sources, source_of));
            whole.materials = std::move(materials);
            made[i] = std::move(whole);
        } catch (const Error&) {  // another program has changed a file of the store
        }
    });
    DetailedCut out{model, cut};
    for (size_t i = 0; i < details.size(); ++i) {
        CutNode& node = out.cut.nodes[details[i].node];
        if (!made[i]) {
            node.lod = *std::min_element(details[i].lods.begin(), details[i].lods.end());
            continue;
        }
        Object object = model.objects[node.object];
        object.representations.clear();
        object.representations.push_back(std::move(*made[i]));
        summarize(object.representations[0], out.model);
        node.object = static_cast<ObjectIndex>(out.model.objects.size());
        node.lod = 0;
        out.model.objects.push_back(std::move(object));
    }
    return out;
}

}  // namespace lodestone::choose

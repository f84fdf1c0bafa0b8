// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/ray_class/ray_cut.h"

#include "base/error.h"
#include "choose/criterion.h"
#include "choose/ray_class/bound_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace lodestone::choose {
namespace {

// The distance in pixels below which a shadow is treated as a contact.
// Taste: a larger distance keeps more originals beside their neighbors.
constexpr double kContactPixels = 4;
// The depth, in parts of Pixel Error, below which a hollow hides nothing.
// Taste: a larger depth takes more meshes for convex, and their own shadows are missing.
constexpr double kFlatPixels = 0.1;

/// Whether nothing is seen through it anywhere.
bool opaque(const Model& model, const Representation& representation) {
    return std::all_of(
        representation.materials.begin(), representation.materials.end(), [&](uint32_t index) {
            const Material* part = &model.materials.at(index);
            for (int depth = 0; part != nullptr; ++depth, part = part->other.get()) {
                if (depth == 64 || part->transmission > 0 ||
                    (part->alpha_mode != AlphaMode::Opaque &&
                     (part->alpha < 1 || part->alpha_texture || part->vertex_colors)))
                    return false;
            }
            return true;
        });
}

/// Whether a rule is about images. Otherwise it is about shadows.
bool asks_for_images(RayRule rule) {
    switch (rule) {
        case RayRule::Mirror:
            return true;
        case RayRule::Shadow:
            return false;
        case RayRule::None:
            break;
    }
    fail(Status::Internal, "a class of rays without a rule meets nothing coarser");
}

/// The bounds of the nodes, in the world: of the level that is drawn; of an opened node, everything
/// below.
std::vector<Bound> bounds_of(const Model& model, const Cut& cut) {
    std::vector<Bound> bounds(cut.nodes.size());
    for (size_t i = cut.nodes.size(); i-- > 0;) {
        const CutNode& node = cut.nodes[i];
        if (!node.opened)
            bounds[i] = transformed(
                model.objects.at(node.object).representations.at(node.lod).summary.bound,
                cut.world(node));
        if (node.parent != kNoParent && !bounds[i].empty())
            bounds[node.parent] =
                bounds[node.parent].empty() ? bounds[i] : merged(bounds[node.parent], bounds[i]);
    }
    return bounds;
}

/// The factor by which each node is refined, whatever coarsens it.
class NodeRefinement {
public:
    NodeRefinement(const Model& model, const View& view, const Cut& cut)
        : model_(model), view_(plain(view)), cut_(cut), field_(model, view_) {
        if (field_.bends())
            paths_.resize(cut.nodes.size());
    }

    /// The nodes must be asked for in their order, each once.
    DetailFactors at(uint32_t index, const Bound& bound) {
        const CutNode& node = cut_.nodes[index];
        const Object& object = model_.objects[node.object];
        DetailFactors factors;
        if (field_.bends()) {
            FactorField::FactorPath& path = paths_[index];
            path = path_to(field_, node.parent == kNoParent ? field_.root() : paths_[node.parent],
                           model_, cut_, node);
            factors = field_
                          .at(node.object, object.group(), object.bound(), cut_.world(node), bound,
                              distance(bound, view_.camera.position), path)
                          .factors;
        }
        factors.importance = node.importance;
        factors.demand = object.demand;
        return factors;
    }

private:
    static View plain(View view) {
        // A new modifier breaks this line, so that its author switches off here what coarsens.
        auto& [criterion, lenses, screen_lenses, depth, focus, when_moving, closing, when_dark,
               off_screen, ray_classes] = view.modifiers;
        depth = 1;
        when_moving = when_dark = false;
        off_screen = OffScreen::Full;
        return view;
    }

    const Model& model_;
    View view_;
    const Cut& cut_;
    FactorField field_;
    std::vector<FactorField::FactorPath> paths_;
};

class RayChooser {
public:
    RayChooser(const Model& model, const View& view, const Cut& cut, const ShapeOf& shape_of,
               const Job& job)
        : model_(model),
          view_(view),
          cut_(cut),
          shape_of_(shape_of),
          job_(job),
          bounds_(bounds_of(model, cut)),
          need_(model, view, cut, bounds_),
          pyramid_(view),
          lit_(model.world.environment != nullptr ||
               std::any_of(model.lights.begin(), model.lights.end(), casts_shadows)) {
        View shadows = view;
        shadows.modifiers.off_screen = OffScreen::Shadows;
        if (!need_.mirrored() || (view.modifiers.ray_classes & classes_with(RayRule::Mirror)) != 0)
            off_screen_.emplace(model, shadows_view_ = std::move(shadows));
        triangles_.resize(cut.nodes.size(), 0);
        for (size_t i = cut.nodes.size(); i-- > 0;) {
            const CutNode& node = cut.nodes[i];
            if (!node.opened)
                triangles_[i] += level(node, node.lod).summary.cost.triangles;
            if (node.parent != kNoParent)
                triangles_[node.parent] += triangles_[i];
        }
    }

    RayCut run(RayMask rays) {
        RayCut out;
        out.rays = rays;
        out.states.reserve(cut_.chosen.size());
        const RayRule rule = rule_of(rays);
        NodeRefinement refinement(model_, view_, cut_);
        replaced_.assign(cut_.nodes.size(), 0);
        for (uint32_t i = 0; i < cut_.nodes.size(); ++i) {
            if ((i & 255u) == 0)
                job_.check();
            const CutNode& node = cut_.nodes[i];
            if (node.parent != kNoParent && replaced_[node.parent] != 0) {
                replaced_[i] = 1;
                if (!node.opened)
                    out.states.push_back(RayState::Group);
                continue;
            }
            const DetailFactors factors = refinement.at(i, bounds_[i]);
            RayState state = RayState::Need;
            if ((node.hidden & rays) != 0)
                state = RayState::Off;
            else if (rule != RayRule::None && unseen(i, factors, out))
                state = RayState::Own;
            else if (rule == RayRule::Shadow && !lit_)
                state = RayState::Need;  // there are no shadows
            else if (!node.opened && rule != RayRule::None)
                state = seen(i, rule, factors, out);
            replaced_[i] = state == RayState::Own ? 1 : 0;
            if (!node.opened)
                out.states.push_back(state);
        }
        count(out);
        return out;
    }

private:
    const Representation& level(const CutNode& node, uint32_t lod) const {
        return model_.objects[node.object].representations[lod];
    }

    bool usable(const CutNode& node, uint32_t lod) const {
        const Kind kind = level(node, lod).summary.kind;
        return kind != Kind::Assembly && (view_.kinds & mask_of(kind)) != 0 && lod <= node.coarsest;
    }

    /// Finds a coarser level for a thing that the picture shows by its shadows and images only.
    bool unseen(uint32_t index, DetailFactors factors, RayCut& out) {
        if (!off_screen_ || !pyramid_.outside(bounds_[index]))
            return false;
        const CutNode& node = cut_.nodes[index];
        const auto levels =
            static_cast<uint32_t>(model_.objects[node.object].representations.size());
        const uint32_t finest = node.opened ? 0 : node.lod;
        Bound all = bounds_[index];
        for (uint32_t lod = finest + 1; lod < levels; ++lod)
            all = merged(all, transformed(level(node, lod).summary.bound, cut_.world(node)));
        const double z = distance(all, view_.camera.position);
        factors.off_screen =
            std::min(off_screen_->coarser(all, z),
                     need_.mirrored() ? need_.image(all, shape_of_) / pixel_size(view_, z)
                                      : kMostImportance);
        if (!(factors.off_screen > 1))
            return false;
        const double enlarge = stretch(cut_.world(node));
        for (uint32_t lod = levels; lod-- > finest + 1;) {
            const RepresentationSummary& summary = level(node, lod).summary;
            if (!usable(node, lod) || summary.cost.triangles > triangles_[index] ||
                !good_enough(view_, summary.error, enlarge, z, factors.total()))
                continue;
            out.own.push_back(
                {index, lod, 1, summary.error * enlarge,
                 error_on_screen(view_, summary.error, enlarge, z) / factors.off_screen, false,
                 true});
            return true;
        }
        return false;
    }

    /// Finds a box or ellipsoid inside or around a thing that the picture shows.
    RayState seen(uint32_t index, RayRule rule, const DetailFactors& factors, RayCut& out) {
        const CutNode& node = cut_.nodes[index];
        const Representation& drawn = level(node, node.lod);
        const Object& object = model_.objects[node.object];
        std::vector<uint32_t> solids;
        for (uint32_t lod = node.lod + 1; lod < object.representations.size(); ++lod) {
            if (usable(node, lod) && std::holds_alternative<Primitive>(level(node, lod).payload))
                solids.push_back(lod);
        }
        const double total = factors.total();
        if (solids.empty() || std::isinf(total))
            return RayState::Need;
        if (drawn.summary.kind != Kind::Mesh || !opaque(model_, drawn))
            return RayState::Shape;
        const bool mirrored = asks_for_images(rule);
        if (mirrored && !need_.mirrored())
            return RayState::Need;
        const auto images = [&](uint32_t lod) {
            return imaged_share(model_, level(node, lod)) > 0;
        };
        if (mirrored && (images(node.lod) || std::any_of(solids.begin(), solids.end(), images)))
            return RayState::Shape;
        const Bound& bound = bounds_[index];
        const double z = distance(bound, view_.camera.position);
        const double clear = nearest(index, [](const Bound&) { return true; });
        const double pixel = pixel_size(view_, z);
        if (!(clear > kContactPixels * pixel_size(view_, z + 2 * bound.radius)))
            return RayState::Contact;
        const auto behind = [&](const SweptBall& sweep) {
            return nearest(index, [&](const Bound& other) {
                return touches(sweep, other.center, other.radius);
            });
        };
        RayNeed::ShadowEdge edge;
        if (mirrored)
            edge.sharp = edge.any = need_.image(bound, shape_of_);
        else
            edge = need_.shadow(bound, behind);
        const double most = view_.pixel_error / total * edge.any;
        if (!(most > 0))
            return RayState::Need;
        const double enlarge = stretch(cut_.world(node));
        RayChoice best{index, 0, 1, kInfinity, 0, false, false};
        for (const uint32_t lod : solids) {
            const RayShape shape = shape_of_(drawn, &level(node, lod));
            const auto& fitted = mirrored ? shape.around : shape.inside;
            if (!shape.convexity.convex || !fitted ||
                shape.convexity.hollow * enlarge * total > kFlatPixels * view_.pixel_error * pixel)
                return RayState::Shape;
            // The image in a mirror must look like the thing, too
            const double error =
                std::max(fitted->gap, mirrored ? level(node, lod).summary.error : 0);
            if (error * enlarge < best.error)
                best = {index, lod, fitted->scale, error * enlarge, 0, false, false};
        }
        if (mirrored && !(clear > best.error))
            return RayState::Contact;
        if (!(best.error <= most))
            return RayState::Need;
        best.error_px = std::isinf(most) ? 0 : best.error / edge.any;
        best.soft = best.error > view_.pixel_error / total * edge.sharp;
        out.own.push_back(best);
        return RayState::Own;
    }

    /// The distance to the next thing that is drawn, whichever rays see it.
    double nearest(uint32_t index, const std::function<bool(const Bound&)>& counts) {
        if (!tree_) {
            std::vector<Bound> drawn(cut_.nodes.size());
            for (const uint32_t chosen : cut_.chosen)
                drawn[chosen] = bounds_[chosen];
            tree_.emplace(std::move(drawn));
        }
        return tree_->nearest(bounds_[index], index, 2 * bounds_[0].radius, counts);
    }

    /// Sums up what the rays of the class meet: the camera's cut, except for the choices of their
    /// own.
    void count(RayCut& out) const {
        std::unordered_set<Hash> drawn;
        const auto add = [&](const Representation& met) {
            ++out.met;
            out.triangles += met.summary.cost.triangles;
            out.bytes += model_.costs.occurrence_bytes;
            if (drawn.insert(met.summary.hash).second || is_copied(met.summary.kind))
                out.bytes += met.summary.cost.bytes;
        };
        for (const uint32_t chosen : cut_.chosen) {
            if (replaced_[chosen] == 0)
                add(level(cut_.nodes[chosen], cut_.nodes[chosen].lod));
        }
        for (const RayChoice& own : out.own) {
            add(level(cut_.nodes[own.node], own.lod));
            out.largest_error_px = std::max(out.largest_error_px, own.error_px);
        }
    }

    const Model& model_;
    const View& view_;
    View shadows_view_;
    const Cut& cut_;
    const ShapeOf& shape_of_;
    const Job& job_;
    std::vector<Bound> bounds_;  // those of the nodes
    RayNeed need_;
    ViewPyramid pyramid_;
    bool lit_;                                  // some light throws shadows
    std::optional<OffScreenField> off_screen_;  // where only shadows count
    std::optional<BoundTree> tree_;
    // The triangles of all occurrences below a node, itself included.
    std::vector<uint64_t> triangles_;
    // By node: replaced by a choice of its own or of a group above.
    std::vector<uint8_t> replaced_;
};

}  // namespace

std::vector<RayCut> choose_rays(const Model& model, const View& view, const Cut& cut,
                                const ShapeOf& shape_of, const Job& job) {
    std::vector<RayCut> out;
    if (view.modifiers.ray_classes == 0)
        return out;
    const bool any = view.modifiers.criterion == DetailCriterion::Resolution &&
                     view.pixel_error > 0 && !cut.chosen.empty();
    std::optional<RayChooser> chooser;
    if (any)
        chooser.emplace(model, view, cut, shape_of, job);
    for (const RayMask rays : kRayClasses) {
        if ((view.modifiers.ray_classes & rays) == 0)
            continue;
        if (chooser)
            out.push_back(chooser->run(rays));
        else
            out.push_back({rays,
                           {},
                           std::vector<RayState>(cut.chosen.size(), RayState::Need),
                           cut.triangles,
                           cut.bytes,
                           cut.chosen.size(),
                           0});
    }
    return out;
}

ResidentSize resident_size(const Model& model, const Cut& cut, const std::vector<RayCut>& rays) {
    ResidentSize out{cut.triangles, cut.bytes};
    if (std::all_of(rays.begin(), rays.end(), [](const RayCut& own) { return own.own.empty(); }))
        return out;
    out = {};
    std::unordered_set<Hash> drawn;
    const auto add = [&](const CutNode& node, uint32_t lod) {
        const RepresentationSummary& summary =
            model.objects[node.object].representations[lod].summary;
        out.triangles += summary.cost.triangles;
        out.bytes += model.costs.occurrence_bytes;
        if (drawn.insert(summary.hash).second || is_copied(summary.kind))
            out.bytes += summary.cost.bytes;
    };
    std::vector<uint8_t> alone(cut.nodes.size(), 0);
    for (const RayCut& own : rays) {
        for (const RayChoice& choice : own.own) {
            if (alone[choice.node] == 0)  // such choices are in several classes
                add(cut.nodes[choice.node], choice.lod);
            alone[choice.node] |= choice.alone ? 1 : 0;
        }
    }
    for (size_t i = 0; i < cut.nodes.size(); ++i) {
        const CutNode& node = cut.nodes[i];
        if (node.parent != kNoParent)
            alone[i] |= alone[node.parent];
        if (!node.opened && alone[i] == 0)
            add(node, node.lod);
    }
    return out;
}

}  // namespace lodestone::choose

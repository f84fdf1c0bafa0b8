// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/cut.h"

#include "base/hash_set.h"
#include "quality/criterion.h"
#include "quality/factors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace lodestone::quality {
namespace {

// Nothing that is drawn costs less than this: a primitive, placed once.
constexpr uint64_t kLeastBytes = kBytesPerPrimitive + kBytesPerOccurrence;

constexpr size_t kKinds = static_cast<size_t>(Kind::Assembly) + 1;

struct Pick {
    const Representation* choice = nullptr;  // nothing can be drawn
    bool good = false;                       // within the error
};

/// The cheapest good representation that the view can draw, or the finest drawable one, or none.
/// Representations are ordered finest first with strictly rising errors and falling costs.
Pick pick(const Object& object, const View& view, const Node& node, const Sight& sight) {
    const Representation* finest = nullptr;
    const size_t levels =
        std::min<size_t>(object.representations.size(), node.coarsest + size_t{1});
    for (size_t i = levels; i-- > 0;) {
        const Representation& candidate = object.representations[i];
        if (candidate.summary.kind != Kind::Assembly &&
            (view.kinds & mask_of(candidate.summary.kind)) == 0)
            continue;
        finest = &candidate;
        if (good_enough(view, sight, candidate.summary.error, i, object.representations.size()))
            return {finest, true};
    }
    return {finest, false};
}

/// How a node is seen; nothing when a lens hides it. `path` becomes that of what is below it.
std::optional<Sight> seen(const Model& model, const View& view, FactorField& field,
                          const Node& node, FactorField::Path& path, Factors& factors) {
    const Object& object = model.objects[node.object];
    Sight sight;
    sight.stretch = stretch(node.world);
    const Bound bound = transformed(object.bound(), node.world, sight.stretch);
    sight.z = distance(bound, view.camera.position);
    bool open = false;
    if (field.bends()) {
        const FactorField::Effect effect =
            field.at(node.object, object.bound(), node.world, bound, sight.z, path);
        if (effect.gone)
            return std::nullopt;
        factors = effect.factors;
        open = effect.open;
    }
    factors.importance = node.importance;
    factors.demand = object.demand;
    sight.total = open ? std::numeric_limits<double>::infinity() : factors.total();
    if (view.modifiers.criterion == Criterion::Area)
        sight.share = field.frame().rect_of_box(bound).area() /
                      (field.frame().width() * field.frame().height());
    return sight;
}

/// Whether a group's children could cost less than this stand-in of theirs.
bool worth_opening(const Object& object, const Representation& stand_in) {
    return object.group() && stand_in.summary.kind != Kind::Assembly &&
           stand_in.summary.cost.bytes + kBytesPerOccurrence >
               kLeastBytes * object.representations[0].assembly().placements.size();
}

/// Visits what may be drawn, depth first. A group whose stand-in is good is entered nevertheless
/// where that might be cheaper.
class Chooser {
public:
    Chooser(const Model& model, const View& view, const Job& job)
        : model_(model), view_(view), job_(job), field_(model, view) {}

    Cut run(ObjectIndex root) {
        visit(root);
        if (close_dear())
            drop_unused();
        return total();
    }

private:
    struct Pending {
        Node node;
        FactorField::Path path;
    };

    void visit(ObjectIndex root) {
        std::vector<Pending> stack(1);
        stack.back().node.object = root;
        stack.back().path = field_.root();
        while (!stack.empty()) {
            auto [node, path] = stack.back();
            stack.pop_back();
            if ((nodes_.size() & 1023u) == 0)
                job_.check();
            const Object& object = model_.objects.at(node.object);
            if (object.representations.empty())
                continue;
            Factors factors;
            const std::optional<Sight> sight = seen(model_, view_, field_, node, path, factors);
            if (!sight)
                continue;
            const Pick picked = pick(object, view_, node, *sight);
            if (picked.choice == nullptr)
                continue;
            const Summary& summary = picked.choice->summary;
            node.lod = static_cast<uint32_t>(picked.choice - object.representations.data());
            node.kind = summary.kind;
            node.opened = node.kind == Kind::Assembly;
            node.need = !picked.good ? 0
                                     : threshold_for(view_, *sight, summary.error, node.lod,
                                                     object.representations.size());
            if (!node.opened)
                node.error_px = error_on_screen(view_, summary.error, sight->stretch, sight->z);
            const bool enter =
                node.opened || (picked.good && worth_opening(object, *picked.choice));
            const auto index = static_cast<uint32_t>(nodes_.size());
            nodes_.push_back(node);
            entered_.push_back(enter ? 1 : 0);
            if (!enter)
                continue;
            const std::vector<Placement>& placements =
                object.representations[0].assembly().placements;
            for (size_t i = placements.size(); i-- > 0;) {
                Pending pending;
                Node& child = pending.node;
                child.object = placements[i].object;
                child.parent = index;
                child.placement = static_cast<uint32_t>(i);
                child.world = node.world * placements[i].transform;
                child.hidden = static_cast<RayMask>(node.hidden | placements[i].hidden);
                child.importance = node.importance * placements[i].importance;
                child.coarsest = node.coarsest == 0 ? 0 : placements[i].coarsest;
                if (child.hidden == kAllRays)  // nothing would show it
                    continue;
                pending.path = field_.below(path, node.world, placements[i]);
                stack.push_back(std::move(pending));
            }
        }
    }

    /// Of everything entered, keeps the stand-in or what is below, whichever costs less. True when
    /// something was entered in vain.
    bool close_dear() {
        bool vain = false;
        std::vector<uint64_t> below(nodes_.size(), 0);
        for (size_t i = nodes_.size(); i-- > 0;) {  // children before parents
            Node& node = nodes_[i];
            uint64_t bytes = below[i];
            if (!node.opened) {
                const uint64_t own =
                    representation_of(node).summary.cost.bytes + kBytesPerOccurrence;
                if (entered_[i] != 0 && below[i] < own && below[i] > 0) {
                    node.opened = true;
                    node.lod = 0;
                    node.kind = Kind::Assembly;
                    node.error_px = 0;
                } else {
                    vain = vain || entered_[i] != 0;
                    entered_[i] = 0;
                    bytes = own;
                }
            }
            if (node.parent != kNoParent)
                below[node.parent] += bytes;
        }
        return vain;
    }

    const Representation& representation_of(const Node& node) const {
        return model_.objects[node.object].representations[node.lod];
    }

    /// Without what lies below closed nodes.
    void drop_unused() {
        std::vector<uint32_t> moved(nodes_.size(), kNoParent);
        uint32_t kept = 0;
        for (size_t i = 0; i < nodes_.size(); ++i) {
            const uint32_t parent = nodes_[i].parent;
            if (parent != kNoParent) {
                if (entered_[parent] == 0 || moved[parent] == kNoParent)
                    continue;
                nodes_[i].parent = moved[parent];
            }
            moved[i] = kept;
            if (kept != i)
                nodes_[kept] = nodes_[i];
            ++kept;
        }
        nodes_.resize(kept);
    }

    Cut total() {
        Cut cut;
        HashSet distinct(nodes_.size());
        std::array<uint64_t, kKinds> kinds{};
        for (size_t i = 0; i < nodes_.size(); ++i) {
            const Node& node = nodes_[i];
            if (node.opened)
                continue;
            const auto index = static_cast<uint32_t>(i);
            const Summary& summary = representation_of(node).summary;
            cut.chosen.push_back(index);
            cut.triangles += summary.cost.triangles;
            cut.bytes += kBytesPerOccurrence;
            // A composite is copied for each occurrence.
            if (distinct.insert(summary.hash) || summary.kind == Kind::Composite)
                cut.bytes += summary.cost.bytes;
            ++kinds[static_cast<size_t>(summary.kind)];
            if (node.error_px > cut.largest_error_px) {
                cut.largest_error_px = node.error_px;
                cut.largest_error_node = index;
            }
        }
        for (size_t kind = 0; kind < kKinds; ++kind) {
            if (kinds[kind] != 0)
                cut.kinds[name_of(static_cast<Kind>(kind))] = kinds[kind];
        }
        cut.nodes = std::move(nodes_);
        return cut;
    }

    const Model& model_;
    const View& view_;
    const Job& job_;
    FactorField field_;
    std::vector<Node> nodes_;       // a node's own come right after it
    std::vector<uint8_t> entered_;  // whether its children are there, and count
};

}  // namespace

Cut choose(const Model& model, const View& view, const Job& job) {
    if (model.root >= model.objects.size())
        fail(Status::InvalidArgument, "the model has no root object");
    return choose_below(model, model.root, view, job);
}

Reason why(const Model& model, const View& view, const Cut& cut, uint32_t index) {
    // The path from the root, so that the lenses that touch it are found as when it was chosen.
    std::vector<uint32_t> way;
    for (uint32_t at = index; at != kNoParent; at = cut.nodes.at(at).parent)
        way.push_back(at);
    FactorField field(model, view);
    FactorField::Path path = field.root();
    Reason reason;
    for (size_t i = way.size(); i-- > 0;) {
        const Node& node = cut.nodes[way[i]];
        if (i + 1 < way.size()) {
            const Node& group = cut.nodes[node.parent];
            path = field.below(path, group.world,
                               model.objects.at(group.object)
                                   .representations.at(0)
                                   .assembly()
                                   .placements.at(node.placement));
        }
        Factors factors;
        const Object& object = model.objects.at(node.object);
        const std::optional<Sight> sight = seen(model, view, field, node, path, factors);
        if (!sight)
            fail(Status::InvalidArgument, "the cut was made for another view");
        const size_t first = i == 0 ? node.lod + size_t{1} : size_t{1};
        for (size_t lod = first; lod < object.representations.size(); ++lod) {
            const Summary& summary = object.representations[lod].summary;
            if ((view.kinds & mask_of(summary.kind)) == 0)
                continue;
            reason.coarser =
                Reason::Level{node.object,
                              static_cast<uint32_t>(lod),
                              summary.kind,
                              summary.error,
                              error_on_screen(view, summary.error, sight->stretch, sight->z),
                              sight->total};
            reason.pinned = lod > node.coarsest;
            break;
        }
        if (i > 0)
            continue;
        const Summary& summary = object.representations.at(node.lod).summary;
        reason.z = std::max(sight->z, view.camera.near_clip);
        reason.pixel = pixel_size(view, sight->z);
        reason.stretch = sight->stretch;
        reason.factors = factors;
        reason.chosen = {node.object,   node.lod,      node.kind,
                         summary.error, node.error_px, sight->total};
    }
    return reason;
}

Cut choose_below(const Model& model, ObjectIndex root, const View& view, const Job& job) {
    if (view.width <= 0 || view.height <= 0)
        fail(Status::InvalidArgument, "a picture of ", view.width, " x ", view.height, " pixels");
    if (!(view.pixel_error >= 0))
        fail(Status::InvalidArgument, "Pixel Error is ", view.pixel_error,
             "; it must be 0 or more");
    const glm::dvec3& eye = view.camera.position;
    if (!std::isfinite(eye.x) || !std::isfinite(eye.y) || !std::isfinite(eye.z))
        fail(Status::InvalidArgument, "camera '", view.camera.name, "' is nowhere");
    return Chooser(model, view, job).run(root);
}

std::string path_of(const Model& model, const Cut& cut, uint32_t node) {
    std::string path;
    for (uint32_t at = node; at != kNoParent && cut.nodes.at(at).parent != kNoParent;
         at = cut.nodes[at].parent) {
        const Node& here = cut.nodes[at];
        const Object& group = model.objects[cut.nodes[here.parent].object];
        const std::string& name =
            group.representations[0].assembly().placements[here.placement].name;
        if (!path.empty())
            path.insert(path.begin(), '/');
        path.insert(0, name);
    }
    return path;
}

}  // namespace lodestone::quality

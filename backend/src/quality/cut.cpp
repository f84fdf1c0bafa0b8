// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/cut.h"

#include "quality/criterion.h"

#include <set>

namespace lodestone::quality {
namespace {

/// The cheapest good representation that the view can draw, or the finest drawable one, or none.
/// Representations are ordered finest first with strictly rising errors and falling costs.
const Representation* pick(const Object& object, const View& view, double enlarge, double z) {
    const Representation* finest = nullptr;
    for (size_t i = object.representations.size(); i-- > 0;) {
        const Representation& candidate = object.representations[i];
        if (candidate.summary.kind != Kind::Assembly &&
            (view.kinds & mask_of(candidate.summary.kind)) == 0)
            continue;
        finest = &candidate;
        if (good_enough(view, candidate.summary.error, enlarge, z))
            return finest;
    }
    return finest;
}

}  // namespace

Cut choose(const Model& model, const View& view, const Job& job) {
    if (model.root >= model.objects.size())
        fail(Status::InvalidArgument, "the model has no root object");
    return choose_below(model, model.root, view, job);
}

Cut choose_below(const Model& model, ObjectIndex root_object, const View& view, const Job& job) {
    if (view.width <= 0 || view.height <= 0)
        fail(Status::InvalidArgument, "a picture of ", view.width, " x ", view.height, " pixels");
    if (!(view.pixel_error >= 0))
        fail(Status::InvalidArgument, "Pixel Error is ", view.pixel_error,
             "; it must be 0 or more");
    Cut cut;
    std::set<Hash> distinct;
    std::vector<Node> stack;
    Node root;
    root.object = root_object;
    stack.push_back(root);
    while (!stack.empty()) {
        Node node = stack.back();
        stack.pop_back();
        if ((cut.nodes.size() & 1023u) == 0)
            job.check();
        const Object& object = model.objects.at(node.object);
        const double enlarge = stretch(node.world);
        if (object.representations.empty())
            continue;
        const double z = distance(transformed(object.bound(), node.world), view.camera.position);
        const Representation* choice = pick(object, view, enlarge, z);
        if (choice == nullptr)
            continue;
        node.lod = static_cast<uint32_t>(choice - object.representations.data());
        node.kind = choice->summary.kind;
        const auto index = static_cast<uint32_t>(cut.nodes.size());
        if (choice->summary.kind == Kind::Assembly) {
            node.opened = true;
            cut.nodes.push_back(node);
            const std::vector<Placement>& placements = choice->assembly().placements;
            for (size_t i = placements.size(); i-- > 0;) {
                Node child;
                child.object = placements[i].object;
                child.parent = index;
                child.placement = static_cast<uint32_t>(i);
                child.world = node.world * placements[i].transform;
                child.hidden = static_cast<RayMask>(node.hidden | placements[i].hidden);
                if (child.hidden != kAllRays)  // else nothing would show it
                    stack.push_back(child);
            }
            continue;
        }
        node.error_px = error_on_screen(view, choice->summary.error, enlarge, z);
        cut.nodes.push_back(node);
        cut.chosen.push_back(index);
        cut.triangles += choice->summary.cost.triangles;
        cut.bytes += kBytesPerOccurrence;
        if (distinct.insert(choice->summary.hash).second ||
            choice->summary.kind == Kind::Composite)  // copied for each
            cut.bytes += choice->summary.cost.bytes;
        ++cut.kinds[name_of(choice->summary.kind)];
        if (node.error_px > cut.largest_error_px) {
            cut.largest_error_px = node.error_px;
            cut.largest_error_node = index;
        }
    }
    return cut;
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

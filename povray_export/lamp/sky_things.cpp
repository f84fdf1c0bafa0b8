// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/sky_things.h"

#include "light/clear_materials.h"
#include "povray_export/lamp/placement_grades.h"
#include "povray_export/scene/invertible_transform.h"

#include <algorithm>

namespace lodestone::povray {
namespace {

// The triangles of copies, beyond kPlacementGrades of a mesh, that have shares of their own: a
// share of those of all distinct meshes, and some more.
// Taste: a larger value shades small things more truly, for a copy of the mesh each.
constexpr double kCopiedShare = 0.25;
constexpr double kCopiedTriangles = 5000;  // Taste: as kCopiedShare
// The same of the copies that are largest in a picture.
// Taste: as kCopiedShare; fewer leave out the second ball in a small room.
constexpr double kLargestTriangles = 20'000;
// The pixels across from which on a copy may have shares of its own because of a picture.
// Taste: a smaller value shades smaller copies more truly, for a mesh each.
constexpr double kCopyShows = 24;
// The triangles that splits may add: a share of those of all distinct meshes, and some more.
// Taste: a larger value draws sharper shade on large faces, for memory and parsing of each.
constexpr double kSplitShare = 0.25;
constexpr double kSplitTriangles = 2000;  // Taste: as kSplitShare
// Things of a scene that is looked through, at most.
// Taste: more would take longer than most pictures.
constexpr size_t kMostLeaves = 2'000'000;

/// A number with commas between thousands.
std::string grouped(uint64_t number) {
    const std::string digits = std::to_string(number);
    std::string out;
    for (size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0)
            out += ',';
        out += digits[i];
    }
    return out;
}

}  // namespace

void hash_transform(Hasher& hasher, const Affine& world) {
    double rows[12];
    world.to_rows(rows);
    for (const double value : rows)
        hasher.value(value);
}

SkyThings::SkyThings(const Model& model, const choose::Cut& cut, uint64_t most_triangles,
                     bool still, const Job& job)
    : model_(model), cut_(cut), still_(still), job_(job) {
    too_much_ = collect(most_triangles);
}

bool SkyThings::walk(ObjectIndex object, const Affine& world, RayMask hidden, bool below) {
    // Groups that place nothing, twice in each other over and over, have no leaves.
    if ((++visits_ & 1023u) == 0)
        job_.check();
    if (object >= model_.objects.size() || visits_ > 2 * kMostLeaves ||
        leaves_.size() >= kMostLeaves)
        return false;
    const Object& here = model_.objects[object];
    const bool moving = below || moves(here);
    if (here.representations.empty())
        return true;
    const Representation& finest = here.representations[0];
    if (finest.summary.kind != Kind::Assembly) {
        SkyLeaf leaf{object, world, !moving && (hidden & kShadowRays) == 0};
        leaf.hides = make_invertible(leaf.world) && leaf.hides;  // as it is drawn
        leaves_.push_back(leaf);
        return true;
    }
    if (!finest.resident())
        return true;
    for (const Placement& placement : finest.assembly().placements) {
        if (!walk(placement.object, world * placement.transform,
                  static_cast<RayMask>(hidden | placement.hidden), moving))
            return false;
    }
    return true;
}

std::string SkyThings::collect(uint64_t most_triangles) {
    // Whether a node is below something that moves, for parents come before children.
    std::vector<uint8_t> moving(cut_.nodes.size(), 0);
    for (size_t i = 0; i < cut_.nodes.size(); ++i) {
        const choose::CutNode& node = cut_.nodes[i];
        const bool above = node.parent != choose::kNoParent && moving[node.parent] != 0;
        moving[i] = above || moves(model_.objects.at(node.object)) ? 1 : 0;
    }
    for (const uint32_t index : cut_.chosen) {
        if ((things_.size() & 1023u) == 0)
            job_.check();
        const choose::CutNode& node = cut_.nodes.at(index);
        const Object& object = model_.objects.at(node.object);
        SkyThing thing;
        thing.representation = &object.representations.at(node.lod);
        thing.world = cut_.world(node);
        thing.seen = make_invertible(thing.world);
        thing.moves = moving[index] != 0;
        thing.group = object.group();
        thing.first = static_cast<uint32_t>(leaves_.size());
        if (!walk(node.object, cut_.world(node), node.hidden, thing.moves))
            return "more than " + grouped(kMostLeaves) + " things";
        thing.end = static_cast<uint32_t>(leaves_.size());
        if (thing.group)
            ++stand_ins_[thing.representation->summary.hash];
        things_.push_back(thing);
    }
    uint64_t triangles = 0;
    Hasher scene;
    for (const SkyLeaf& leaf : leaves_) {
        const RepresentationSummary& summary = finest_of(leaf).summary;
        PlacedMesh& mesh = placed_[summary.hash];
        mesh.triangles = summary.cost.triangles;
        if (mesh.count++ == 0)
            triangles += mesh.triangles;
        if (!leaf.hides)
            continue;
        scene.value(summary.hash);
        hash_transform(scene, leaf.world);
        sizes_ += transformed(summary.bound, leaf.world).radius;
    }
    scene_ = scene.result();
    triangles_ = triangles;
    choose_copied();
    return triangles <= most_triangles ? ""
                                       : grouped(triangles) + " distinct triangles, of " +
                                             grouped(most_triangles) + " at most";
}

const Representation& SkyThings::finest_of(const SkyLeaf& leaf) const {
    return model_.objects[leaf.object].representations[0];
}

const Representation& SkyThings::finest_of(const SkyThing& thing) const {
    return thing.group ? *thing.representation : finest_of(leaves_[thing.first]);
}

std::vector<light::SkyOccluder> SkyThings::occluders(size_t first, size_t end) const {
    std::vector<light::SkyOccluder> out;
    for (size_t i = first; i < end; ++i) {
        const SkyLeaf& leaf = leaves_[i];
        if (leaf.hides)
            out.push_back({&finest_of(leaf), leaf.world});
    }
    return out;
}

bool SkyThings::skipped(const SkyThing& thing) const {
    return thing.representation->summary.kind == Kind::Assembly || !thing.seen;
}

void SkyThings::choose_copied() {
    std::vector<std::pair<uint64_t, Hash>> order;  // with the triangles of all copies
    for (const auto& [hash, mesh] : placed_) {
        if (mesh.count > kPlacementGrades)
            order.emplace_back(mesh.count * mesh.triangles, hash);
    }
    std::sort(order.begin(), order.end());
    double rest = kCopiedTriangles + kCopiedShare * static_cast<double>(triangles_);
    for (const auto& [triangles, hash] : order) {
        rest -= static_cast<double>(triangles);
        if (rest < 0)
            break;
        placed_[hash].copied = true;
    }
}

bool SkyThings::in_place(const SkyThing& thing) const {
    if (thing.moves)
        return false;
    if (thing.group)
        return stand_ins_.at(thing.representation->summary.hash) == 1;
    const PlacedMesh& mesh = placed_.at(finest_of(leaves_[thing.first]).summary.hash);
    return mesh.count <= kPlacementGrades || mesh.copied;
}

bool SkyThings::clear(const Representation& representation) const {
    return std::any_of(representation.materials.begin(), representation.materials.end(),
                       [this](uint32_t number) {
                           return number < model_.materials.size() &&
                                  light::lets_light_through(model_.materials[number]);
                       });
}

std::vector<uint8_t> SkyThings::largest_copies(const std::function<double(size_t)>& pixels) const {
    std::vector<std::pair<double, size_t>> order;
    for (size_t i = 0; i < things_.size(); ++i) {
        const SkyThing& thing = things_[i];
        const Kind kind = thing.representation->summary.kind;
        if ((kind != Kind::Mesh && kind != Kind::Ellipsoid) || thing.group || thing.moves ||
            in_place(thing) || clear(*thing.representation))
            continue;
        const double across = pixels(i);
        if (across >= kCopyShows)
            order.emplace_back(-across, i);
    }
    std::sort(order.begin(), order.end());
    std::vector<uint8_t> out(things_.size(), 0);
    double rest = kLargestTriangles + kCopiedShare * static_cast<double>(triangles_);
    for (const auto& [across, i] : order) {
        // Finest levels count, so that about the same copies have them at all Pixel Errors.
        const auto triangles = static_cast<double>(light::drawn_triangles(finest_of(things_[i])));
        if (triangles > rest)
            continue;
        rest -= triangles;
        out[i] = 1;
    }
    return out;
}

size_t SkyThings::splits_of(const SkyThing& thing) const {
    if (!thing.group && placed_.at(finest_of(leaves_[thing.first]).summary.hash).count > 1)
        return 0;
    const double size = transformed(thing.representation->summary.bound, thing.world).radius;
    const double all = kSplitTriangles + kSplitShare * static_cast<double>(triangles_);
    return sizes_ > 0 ? static_cast<size_t>(limited(size / sizes_, 0, 1) * all) : 0;
}

}  // namespace lodestone::povray

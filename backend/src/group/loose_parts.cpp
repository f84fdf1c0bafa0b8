// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/loose_parts.h"

#include "base/parallel.h"
#include "group/group_structure.h"
#include "group/grouping_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>

namespace lodestone::group {
namespace {

// A mesh with fewer triangles stays one.
// Taste: all of it costs POV-Ray 12 MB and a twentieth of a second; a larger value spares more
// models the groups.
constexpr size_t kManyTriangles = 50000;
/// A mesh with fewer parts stays one.
/// Taste: a larger value leaves machines of many parts one object.
constexpr size_t kManyParts = 64;
/// Parts up to this share of the whole's extent are small.
/// Taste: a larger value splits meshes whose parts lie across each other.
constexpr double kSmallPart = 1.0 / 8;
/// Parts above this share of the extent lie across everything: they are clusters of their own.
/// Taste: a larger value gives clusters wide bounds.
constexpr double kLargePart = 1.0 / 4;
/// With fewer clusters no groups are made.
/// Taste: a larger value leaves small meshes one, a smaller one makes groups that hardly save
/// anything.
constexpr size_t kFewestClusters = 8;
/// Bins in which a cut is looked for.
/// Taste: a larger value finds slightly tighter clusters in more time.
constexpr int kBins = 32;
/// Cuts that lie one inside the other, at most; deeper ones go by number.
/// Taste: any value above the logarithm of the number of parts will do.
constexpr uint32_t kDeepestCut = 64;

struct LoosePart {
    Box3 box;
    size_t triangles = 0;
    glm::dvec3 middle{0.0};
    double extent = 0;
};

double extent_of(const Box3& box) {
    const glm::dvec3 size = box.size();
    return std::max({size.x, size.y, size.z});
}

std::vector<LoosePart> measured(const Mesh& mesh, const std::vector<uint32_t>& part_of) {
    std::vector<LoosePart> parts(1 + *std::max_element(part_of.begin(), part_of.end()));
    for (size_t i = 0; i < part_of.size(); ++i) {
        LoosePart& part = parts[part_of[i]];
        ++part.triangles;
        for (int corner = 0; corner < 3; ++corner)
            part.box.add(glm::dvec3(mesh.positions[mesh.triangles[i][corner]]));
    }
    for (LoosePart& part : parts) {
        part.middle = part.box.center();
        part.extent = extent_of(part.box);
    }
    return parts;
}

bool pays(const std::vector<LoosePart>& parts, size_t triangles) {
    if (triangles <= kManyTriangles || parts.size() <= kManyParts)
        return false;
    Box3 whole;
    for (const LoosePart& part : parts)
        whole.add(part.box);
    const double small = kSmallPart * extent_of(whole);
    size_t in_small = 0;
    for (const LoosePart& part : parts)
        in_small += part.extent <= small ? part.triangles : 0;
    return 2 * in_small >= triangles;
}

/// A cutter of lists of parts: it cuts them in two until each has few triangles, where the sum of
/// (surface of the bound) x (triangles) of both sides is least, so that near parts share a cluster
/// (4.5.3).
class PartCutter {
public:
    PartCutter(const std::vector<LoosePart>& parts, size_t triangles, const Job& job)
        : parts_(parts), wanted_(triangles), job_(job) {}

    void cut(std::vector<uint32_t> all) {
        std::vector<PartList> waiting;
        waiting.push_back({std::move(all), 0});
        while (!waiting.empty()) {
            PartList piece = std::move(waiting.back());
            waiting.pop_back();
            if (piece.list.empty())
                continue;
            if (piece.list.size() == 1 || count(piece.list) <= wanted_) {
                clusters_.push_back(std::move(piece.list));
                continue;
            }
            job_.check();
            std::vector<uint32_t> high = take_high(piece.list, piece.depth);
            waiting.push_back({std::move(high), piece.depth + 1});
            waiting.push_back({std::move(piece.list), piece.depth + 1});
        }
    }

    std::vector<std::vector<uint32_t>> take() { return std::move(clusters_); }

private:
    struct PartList {
        std::vector<uint32_t> list;
        uint32_t depth;
    };
    struct PartBin {
        Box3 box;
        size_t triangles = 0;
        void add(const PartBin& other) {
            box.add(other.box);
            triangles += other.triangles;
        }
    };

    size_t count(const std::vector<uint32_t>& list) const {
        size_t sum = 0;
        for (const uint32_t part : list)
            sum += parts_[part].triangles;
        return sum;
    }

    /// Takes the high side out of the list and leaves the low one. Neither is empty.
    std::vector<uint32_t> take_high(std::vector<uint32_t>& list, uint32_t depth) const {
        Box3 middles;
        for (const uint32_t part : list)
            middles.add(parts_[part].middle);
        const auto bin_of = [&](uint32_t part, int axis) {
            const double size = middles.size()[axis];
            const double at = (parts_[part].middle[axis] - middles.low[axis]) / size * kBins;
            return std::min(kBins - 1, static_cast<int>(at));
        };
        // A side with few triangles is taken only where there is no other way.
        using Cost = std::tuple<bool, double>;
        Cost best{true, std::numeric_limits<double>::infinity()};
        int best_axis = -1;
        int best_bin = 0;
        for (int axis = 0; axis < 3 && depth < kDeepestCut; ++axis) {
            if (!(middles.size()[axis] > 0))
                continue;
            std::array<PartBin, kBins> bins;
            for (const uint32_t part : list)
                bins[static_cast<size_t>(bin_of(part, axis))].add(
                    {parts_[part].box, parts_[part].triangles});
            std::array<PartBin, kBins> above;  // the bins from here on
            for (size_t i = kBins; i-- > 0;) {
                above[i] = bins[i];
                if (i + 1 < kBins)
                    above[i].add(above[i + 1]);
            }
            PartBin below;
            for (size_t i = 1; i < kBins; ++i) {
                below.add(bins[i - 1]);
                if (below.triangles == 0 || above[i].triangles == 0)
                    continue;
                const bool slight = 4 * std::min(below.triangles, above[i].triangles) < wanted_;
                const Cost cost{slight, weighed(below) + weighed(above[i])};
                if (cost < best) {
                    best = cost;
                    best_axis = axis;
                    best_bin = static_cast<int>(i);
                }
            }
        }
        const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
        auto at = middle;  // by their numbers where all are in one place, or too deep
        if (best_axis >= 0)
            at = std::stable_partition(list.begin(), list.end(), [&](uint32_t part) {
                return bin_of(part, best_axis) < best_bin;
            });
        std::vector<uint32_t> high(at, list.end());
        list.erase(at, list.end());
        return high;
    }

    static double weighed(const PartBin& bin) {
        return half_area(bin.box) * static_cast<double>(bin.triangles);
    }

    const std::vector<LoosePart>& parts_;
    size_t wanted_;
    const Job& job_;
    std::vector<std::vector<uint32_t>> clusters_;
};

std::vector<std::vector<uint32_t>> clusters_of(const std::vector<LoosePart>& parts,
                                               size_t triangles, const Job& job) {
    Box3 whole;
    for (const LoosePart& part : parts)
        whole.add(part.box);
    const double large = kLargePart * extent_of(whole);
    std::vector<uint32_t> small_ones;
    std::vector<uint32_t> large_ones;
    for (uint32_t i = 0; i < parts.size(); ++i)
        (parts[i].extent > large ? large_ones : small_ones).push_back(i);
    PartCutter cutter(parts, triangles, job);
    cutter.cut(std::move(small_ones));
    cutter.cut(std::move(large_ones));
    return cutter.take();
}

/// Takes some of a mesh's triangles, in their order, with the vertices they use in theirs. `moved`
/// has as many entries as the mesh has vertices, all kNone before and after.
constexpr uint32_t kNone = ~uint32_t{0};
Mesh taken(const Mesh& mesh, const std::vector<uint32_t>& triangles, std::vector<uint32_t>& moved) {
    std::vector<uint32_t> vertices;
    for (const uint32_t i : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = mesh.triangles[i][corner];
            if (moved[vertex] == kNone) {
                moved[vertex] = 0;
                vertices.push_back(vertex);
            }
        }
    }
    std::sort(vertices.begin(), vertices.end());
    Mesh out;
    const auto copy = [&](const auto& from, auto& to) {
        if (from.empty())
            return;
        to.reserve(vertices.size());
        for (const uint32_t vertex : vertices)
            to.push_back(from[vertex]);
    };
    copy(mesh.positions, out.positions);
    copy(mesh.normals, out.normals);
    copy(mesh.uvs, out.uvs);
    copy(mesh.colors, out.colors);
    for (uint32_t i = 0; i < vertices.size(); ++i)
        moved[vertices[i]] = i;
    out.triangles.reserve(triangles.size());
    for (const uint32_t i : triangles) {
        const Triangle& t = mesh.triangles[i];
        out.triangles.emplace_back(moved[t.x], moved[t.y], moved[t.z]);
        if (!mesh.slots.empty())
            out.slots.push_back(mesh.slots[i]);
    }
    for (const uint32_t vertex : vertices)
        moved[vertex] = kNone;
    return out;
}

/// Drops the materials that no triangle of the mesh shows.
void keep_used(Mesh& mesh, std::vector<uint32_t>& materials) {
    if (materials.size() < 2)
        return;
    std::vector<uint32_t> moved(materials.size(), kNone);
    std::vector<uint32_t> used;
    // A slot beyond the materials shows the first material, like a slot that is not given.
    const auto known = [&](size_t i) -> size_t {
        const uint16_t slot = mesh.slot(i);
        return slot < materials.size() ? slot : size_t{0};
    };
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        moved[known(i)] = 0;
    for (size_t slot = 0; slot < materials.size(); ++slot) {
        if (moved[slot] == kNone)
            continue;
        moved[slot] = static_cast<uint32_t>(used.size());
        used.push_back(materials[slot]);
    }
    for (size_t i = 0; i < mesh.slots.size(); ++i)
        mesh.slots[i] = static_cast<uint16_t>(moved[known(i)]);
    if (used.size() == 1)
        mesh.slots.clear();
    materials = std::move(used);
}

bool refracts(const Material& material) {
    return material.transmission > 0 || (material.other && refracts(*material.other));
}

bool may_split(const Model& model, const Object& object) {
    if (object.representations.empty() || object.deforms)
        return false;
    const Representation& finest = object.representations[0];
    const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&finest.payload);
    if (mesh == nullptr || *mesh == nullptr || (*mesh)->triangles.size() < 2)
        return false;
    return std::none_of(finest.materials.begin(), finest.materials.end(),
                        [&](uint32_t material) { return refracts(model.materials.at(material)); });
}

/// The result for a mesh; without clusters it stays one.
struct SplitMesh {
    size_t parts = 0;
    std::vector<Representation> clusters;
};

SplitMesh found_in(const Model& model, const Object& object, const LooseOptions& options,
                   const Job& job) {
    SplitMesh found;
    const Representation& finest = object.representations[0];
    const Mesh& mesh = finest.mesh();
    const size_t count = mesh.triangles.size();
    if (!options.always && count <= kManyTriangles)
        return found;
    const std::vector<uint32_t> part_of = loose_parts(mesh);
    job.check();
    const std::vector<LoosePart> parts = measured(mesh, part_of);
    const bool finite = std::all_of(parts.begin(), parts.end(), [](const LoosePart& part) {
        return std::isfinite(part.extent) && std::isfinite(glm::dot(part.middle, part.middle));
    });
    if (!finite)
        return found;
    if (parts.size() < 2 || !(options.always || pays(parts, count)))
        return found;
    const size_t wanted =
        std::max(options.fewest_triangles, count / std::max<size_t>(1, options.most_clusters));
    std::vector<std::vector<uint32_t>> clusters = clusters_of(parts, wanted, job);
    if (clusters.size() < 2)
        return found;
    std::vector<uint32_t> cluster_of(parts.size());
    for (uint32_t i = 0; i < clusters.size(); ++i) {
        for (const uint32_t part : clusters[i])
            cluster_of[part] = i;
    }
    std::vector<std::vector<uint32_t>> triangles(clusters.size());
    for (uint32_t i = 0; i < count; ++i)
        triangles[cluster_of[part_of[i]]].push_back(i);
    std::sort(triangles.begin(), triangles.end());  // sorted by their first triangle
    std::vector<uint32_t> moved(mesh.positions.size(), kNone);
    found.parts = parts.size();
    for (const std::vector<uint32_t>& own : triangles) {
        job.check();
        Representation part;
        part.summary.kind = Kind::Mesh;
        part.materials = finest.materials;
        Mesh made = taken(mesh, own, moved);
        keep_used(made, part.materials);
        part.payload = std::make_shared<const Mesh>(std::move(made));
        summarize(part, model);
        found.clusters.push_back(std::move(part));
    }
    return found;
}

}  // namespace

std::vector<ObjectIndex> leaves_of(const Model& model) {
    std::vector<ObjectIndex> out;
    const auto add = [&](ObjectIndex index) {
        if (!model.objects[index].representations.empty() && !model.objects[index].group())
            out.push_back(index);
    };
    if (model.root != kNoObject) {
        for (const ObjectIndex index : bottom_up(model))
            add(index);
        return out;
    }
    for (ObjectIndex index = 0; index < model.objects.size(); ++index)
        add(index);
    return out;
}

LooseReport split_loose_parts(Model& model, std::span<const ObjectIndex> leaves,
                              const LooseOptions& options, const Job& job) {
    std::vector<ObjectIndex> wanted;
    for (const ObjectIndex index : leaves) {
        if (index >= model.objects.size())
            fail(Status::InvalidArgument, "object ", index, " of ", model.objects.size());
        if (may_split(model, model.objects[index]))
            wanted.push_back(index);
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    LooseReport report;
    if (wanted.empty())
        return report;
    job.stage(JobStage::Group);
    std::vector<SplitMesh> found(wanted.size());
    parallel_for(wanted.size(), [&](size_t i) {
        found[i] = found_in(model, model.objects[wanted[i]], options, job);
    });

    Model next = model;  // payloads are shared
    std::set<std::string> uids;
    for (const Object& object : next.objects)
        uids.insert(object.uid);
    std::vector<ObjectIndex> split;
    for (size_t i = 0; i < wanted.size(); ++i) {
        if (found[i].clusters.empty())
            continue;
        const Object whole = next.objects[wanted[i]];
        auto assembly = std::make_shared<Assembly>();
        for (Representation& cluster : found[i].clusters) {
            Object part;
            for (uint32_t attempt = 0; part.uid.empty() || !uids.insert(part.uid).second; ++attempt)
                part.uid = hex16(
                    Hasher().text(whole.uid).value(cluster.summary.hash).value(attempt).result());
            part.name = text(whole.name, " part ", assembly->placements.size() + 1);
            part.role = whole.role;
            part.representations.push_back(std::move(cluster));
            Placement placement;
            placement.object = static_cast<ObjectIndex>(next.objects.size());
            placement.name = part.name;
            assembly->placements.push_back(std::move(placement));
            next.objects.push_back(std::move(part));
        }
        Object& group = next.objects[wanted[i]];
        group.made_of_parts = true;
        group.attributes.reset();
        group.pose.reset();
        group.representations.assign(1, {});
        group.representations[0].summary.kind = Kind::Assembly;
        group.representations[0].payload = std::shared_ptr<const Assembly>(std::move(assembly));
        group.build_hash = group.bind_hash = 0;
        split.push_back(wanted[i]);
        report.parts += found[i].parts;
    }
    report.split = split.size();
    if (split.empty())
        return report;
    StructureOptions structure;
    structure.fewest = kFewestClusters;
    structure_groups(next, split, structure, job);
    report.made = next.objects.size() - model.objects.size();
    model = std::move(next);
    return report;
}

}  // namespace lodestone::group

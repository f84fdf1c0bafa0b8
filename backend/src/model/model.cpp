// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/model.h"

#include "model/finish.h"

#include <algorithm>
#include <limits>

namespace lodestone {
namespace {

// Deeper nesting is a mistake of some program.
// Taste: a larger number would exhaust the stacks of tile viewers.
constexpr size_t kDeepest = 1000;

enum class VisitMark : uint8_t { New, Open, Done };

void visit(const Model& model, ObjectIndex index, std::vector<VisitMark>& marks,
           std::vector<ObjectIndex>& order) {
    // An explicit stack: hierarchies may be deeper than the thread's stack allows.
    struct VisitFrame {
        ObjectIndex object;
        size_t next;
    };
    std::vector<VisitFrame> stack{{index, 0}};
    while (!stack.empty()) {
        VisitFrame& frame = stack.back();
        const Object& object = model.objects[frame.object];
        marks[frame.object] = VisitMark::Open;
        if (object.group() && object.representations[0].resident()) {
            const auto& placements = object.representations[0].assembly().placements;
            if (frame.next < placements.size()) {
                const ObjectIndex child = placements[frame.next++].object;
                if (child >= model.objects.size())
                    fail(Status::InvalidArgument, "group '", object.name, "' places object ", child,
                         " of ", model.objects.size());
                if (marks[child] == VisitMark::Open)
                    fail(Status::InvalidArgument, "group '", object.name, "' contains '",
                         model.objects[child].name, "', which contains it");
                if (stack.size() >= kDeepest)
                    fail(Status::InvalidArgument, "group '", object.name,
                         "' is nested deeper than ", kDeepest, " levels");
                if (marks[child] == VisitMark::New)
                    stack.push_back({child, 0});
                continue;
            }
        }
        marks[frame.object] = VisitMark::Done;
        order.push_back(frame.object);
        stack.pop_back();
    }
}

/// Groups that place groups twice, over and over, have more occurrences than can be counted.
uint64_t capped_sum(uint64_t a, uint64_t b) {
    return a > std::numeric_limits<uint64_t>::max() - b ? std::numeric_limits<uint64_t>::max()
                                                        : a + b;
}

/// Whether for_each_occurrence() goes on to what an object places.
bool opened(const Object& object, OccurrenceUnit below) {
    return object.group() && !(object.made_of_parts && below == OccurrenceUnit::Objects);
}

/// How often for_each_occurrence() visits something below the root. `order` is bottom_up's.
uint64_t visits(const Model& model, const std::vector<ObjectIndex>& order, OccurrenceUnit below) {
    std::vector<uint64_t> out(model.objects.size(), 0);
    for (const ObjectIndex index : order) {
        const Object& object = model.objects[index];
        if (!opened(object, below)) {
            out[index] = object.representations.empty() ? 0 : 1;
            continue;
        }
        for (const Placement& placement : object.representations[0].assembly().placements)
            out[index] = capped_sum(out[index], out[placement.object]);
    }
    return out[model.root];
}

/// 1 for every object that `is` true of, or that places such an object at any depth.
template <typename Is>
std::vector<uint8_t> that_hold(const Model& model, const Is& is) {
    std::vector<uint8_t> out(model.objects.size(), 0);
    for (ObjectIndex index = 0; index < model.objects.size(); ++index)
        out[index] = is(model.objects[index]) ? 1 : 0;
    for (const ObjectIndex index : bottom_up(model)) {
        const Object& object = model.objects[index];
        if (!object.group())
            continue;
        for (const Placement& placement : object.representations[0].assembly().placements)
            out[index] |= out[placement.object];
    }
    return out;
}

DrawCost cost_of_children(const Representation& assembly, const Model& model) {
    DrawCost sum;
    for (const Placement& placement : assembly.assembly().placements) {
        const Object& child = model.objects[placement.object];
        if (child.representations.empty())
            continue;
        const DrawCost& part = child.representations[0].summary.cost;
        sum.triangles = capped_sum(sum.triangles, part.triangles);
        sum.bytes = capped_sum(sum.bytes, part.bytes);
    }
    return sum;
}

}  // namespace

std::vector<ObjectIndex> bottom_up(const Model& model) {
    std::vector<ObjectIndex> order;
    if (model.root == kNoObject)
        return order;
    if (model.root >= model.objects.size())
        fail(Status::InvalidArgument, "the root is object ", model.root, " of ",
             model.objects.size());
    std::vector<VisitMark> marks(model.objects.size(), VisitMark::New);
    visit(model, model.root, marks, order);
    return order;
}

std::vector<uint8_t> with_environment(const Model& model) {
    return that_hold(model,
                     [](const Object& object) { return object.role == ObjectRole::Environment; });
}

std::vector<uint8_t> with_deforming(const Model& model) {
    return that_hold(model, [](const Object& object) { return object.deforms; });
}

std::vector<uint8_t> with_hidden(const Model& model) {
    std::vector<uint8_t> out(model.objects.size(), 0);
    for (const ObjectIndex index : bottom_up(model)) {
        const Object& object = model.objects[index];
        if (!object.group())
            continue;
        for (const Placement& placement : object.representations[0].assembly().placements) {
            if (placement.hidden != 0 || out[placement.object] != 0)
                out[index] = 1;
        }
    }
    return out;
}

void summarize(Representation& representation, const Model& model, std::optional<Hash> mesh_hash) {
    RepresentationSummary& summary = representation.summary;
    Hasher hasher;
    hasher.value(summary.kind);
    summary.bound = bound_of(summary.kind, representation.payload);
    summary.cost = cost_of(summary.kind, representation.payload, model.costs);
    add_to_hash(hasher, summary.kind, representation.payload, mesh_hash);
    Hasher shape = hasher;
    for (const uint32_t index : representation.materials) {
        const Material& material = model.materials.at(index);
        hasher.value(hash_of(material));
        shape.value(look_hash_of(material));
    }
    summary.hash = hasher.result();
    summary.shape = shape.result();
}

void set_costs(Model& model, const CostModel& costs) {
    model.costs = costs;
    for (const ObjectIndex index : bottom_up(model)) {
        for (Representation& representation : model.objects[index].representations) {
            if (representation.summary.kind == Kind::Assembly)
                representation.summary.cost = cost_of_children(representation, model);
            else if (representation.resident())
                representation.summary.cost =
                    cost_of(representation.summary.kind, representation.payload, costs);
        }
    }
}

void set_demands(Model& model, const std::vector<ObjectIndex>& order) {
    for (const ObjectIndex index : order) {
        Object& object = model.objects[index];
        object.demand = 1;
        if (!object.group() || object.representations[0].assembly().placements.empty())
            continue;
        object.demand = 0;
        for (const Placement& placement : object.representations[0].assembly().placements) {
            const double demand =
                placement.coarsest == kAnyLevel && placement.finest == 0
                    ? placement.importance * model.objects[placement.object].demand
                    : std::numeric_limits<double>::infinity();
            object.demand = std::max(object.demand, demand);
        }
    }
}

void summarize_assemblies(Model& model, const std::vector<ObjectIndex>& order) {
    set_demands(model, order);
    for (const ObjectIndex index : order) {
        Object& object = model.objects[index];
        if (object.representations.empty())
            continue;
        Representation& finest = object.representations[0];
        Hasher hasher;
        hasher.value(object.role);
        Hasher shape = hasher;
        if (object.group()) {
            RepresentationSummary& summary = finest.summary;
            summary.bound = Bound{};
            Hasher content;
            content.value(summary.kind);
            Hasher shapes = content;
            for (const Placement& placement : finest.assembly().placements) {
                const Object& child = model.objects[placement.object];
                double rows[12];
                placement.transform.to_rows(rows);
                content.bytes(rows, sizeof rows).value(child.source_hash);
                shapes.bytes(rows, sizeof rows).value(child.shape_hash);
                if (placement.hidden != 0) {
                    content.value(placement.hidden);
                    shapes.value(placement.hidden);
                }
                if (child.representations.empty())
                    continue;
                const RepresentationSummary& part = child.representations[0].summary;
                summary.bound = merged(summary.bound, transformed(part.bound, placement.transform));
            }
            summary.cost = cost_of_children(finest, model);
            summary.hash = content.result();
            summary.shape = shapes.result();
        }
        object.source_hash = hasher.value(finest.summary.hash).result();
        object.shape_hash = shape.value(finest.summary.shape).result();
    }
}

ModelTotals totals(const Model& model) {
    ModelTotals out;
    std::vector<ModelTotals> below(model.objects.size());
    const std::vector<ObjectIndex> order = bottom_up(model);
    for (const ObjectIndex index : order) {
        const Object& object = model.objects[index];
        if (object.group()) {
            for (const Placement& placement : object.representations[0].assembly().placements) {
                ModelTotals& sums = below[index];
                const ModelTotals& part = below[placement.object];
                sums.occurrences = capped_sum(sums.occurrences, part.occurrences);
                sums.triangles_placed = capped_sum(sums.triangles_placed, part.triangles_placed);
            }
            if (object.made_of_parts)
                below[index].occurrences = 1;
        } else if (!object.representations.empty()) {
            const uint64_t triangles = object.representations[0].summary.cost.triangles;
            below[index].occurrences = 1;
            below[index].triangles_placed = triangles;
            out.triangles_unique += triangles;
        }
    }
    if (model.root == kNoObject)
        return out;
    out.occurrences = below[model.root].occurrences;
    out.triangles_placed = below[model.root].triangles_placed;
    std::vector<uint8_t> reached(model.objects.size(), 0);  // not only as parts
    reached[model.root] = 1;
    for (auto at = order.rbegin(); at != order.rend(); ++at) {  // parents before children
        const Object& object = model.objects[*at];
        if (reached[*at] == 0 || object.representations.empty())
            continue;
        ++out.objects;
        if (!object.group() || object.made_of_parts)
            continue;
        for (const Placement& placement : object.representations[0].assembly().placements)
            reached[placement.object] = 1;
    }
    return out;
}

void for_each_occurrence(const Model& model, const std::function<void(const Occurrence&)>& visit,
                         OccurrenceUnit below) {
    if (model.root == kNoObject)
        return;
    const uint64_t count = visits(model, bottom_up(model), below);  // refuses cycles
    if (count > kMostOccurrences)
        fail(Status::InvalidArgument, "'", model.objects[model.root].name, "' places ", count,
             " things, counting each copy; at most ", kMostOccurrences);
    struct PendingOccurrence {
        ObjectIndex object;
        Affine world;
        std::string path;
        RayMask hidden;
    };
    std::vector<PendingOccurrence> stack{{model.root, Affine{}, "", 0}};
    while (!stack.empty()) {
        const PendingOccurrence entry = std::move(stack.back());
        stack.pop_back();
        const Object& object = model.objects[entry.object];
        if (!opened(object, below)) {
            if (!object.representations.empty())
                visit({entry.object, entry.world, entry.path, entry.hidden});
            continue;
        }
        const auto& placements = object.representations[0].assembly().placements;
        for (size_t i = placements.size(); i-- > 0;) {
            const Placement& placement = placements[i];
            stack.push_back(
                {placement.object, entry.world * placement.transform,
                 entry.path.empty() ? placement.name : entry.path + '/' + placement.name,
                 static_cast<RayMask>(entry.hidden | placement.hidden)});
        }
    }
}

}  // namespace lodestone

// SPDX-License-Identifier: GPL-3.0-or-later
#include "build/stand_ins.h"

#include "approximate/bind.h"
#include "approximate/composite.h"
#include "approximate/replace.h"
#include "approximate/simplify.h"
#include "approximate/stand_in_material.h"
#include "approximate/standing.h"
#include "build/flatten.h"
#include "build/judge.h"
#include "build/prune.h"
#include "measure/visible.h"
#include "quality/cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace lodestone::build {
namespace {

// Fewer triangles than this are left to primitives.
constexpr size_t kFewestTriangles = 8;
// So many things drawn in a group may be a crowd.
constexpr size_t kManyChildren = 32;
// Where collapsing keeps a fifth of the triangles near the surface, parts are details of it.
constexpr double kCollapsed = 0.2;
constexpr double kNear = 1.0 / 8;  // over the radius
// A composite of eight is off by a fifth of the radius, more or less.
constexpr double kOff = 0.2;
// Rays from a triangle that decide whether anything outside can see it.
constexpr int kRaysPerTriangle = 24;

uint64_t bytes_of(const Candidate& candidate) {
    switch (candidate.kind) {
        case Kind::Mesh:
            return candidate.mesh->triangles.size() * kBytesPerTriangle;
        case Kind::Composite:
            return candidate.composite->solids.size() * kBytesPerPrimitive;
        default:
            return kBytesPerPrimitive;
    }
}

/// Of all its occurrences together.
double bytes_of(const Candidate& candidate, uint64_t uses) {
    const auto count = static_cast<double>(std::max<uint64_t>(1, uses));
    return count * bytes_each(candidate.kind, bytes_of(candidate), uses);
}

/// Triangles of a mesh that costs so many bytes for each of its occurrences.
size_t triangles_for(double bytes, uint64_t uses) {
    const double all = bytes * static_cast<double>(std::max<uint64_t>(1, uses));
    return static_cast<size_t>(std::clamp(all / kBytesPerTriangle, 0.0, 1e9));
}

std::vector<size_t> targets_of(size_t triangles, size_t first, double ratio) {
    std::vector<size_t> targets;
    auto target = static_cast<double>(first);
    while (target >= kFewestTriangles) {
        const auto count = static_cast<size_t>(target);
        if (count < triangles && (targets.empty() || count < targets.back()))
            targets.push_back(count);
        target *= ratio;
    }
    return targets;
}

bool shows_vertex_colors(const Material& material) {
    return material.vertex_colors || (material.other && shows_vertex_colors(*material.other));
}

/// Without colors that no material shows: they would only be in the way. `plain` holds the copy.
const Mesh& without_unseen_colors(const Mesh& mesh, const std::vector<Material>& materials,
                                  Mesh& plain) {
    if (mesh.colors.empty() || std::any_of(materials.begin(), materials.end(), shows_vertex_colors))
        return mesh;
    plain = mesh;
    plain.colors.clear();
    return plain;
}

/// From which error on a mesh of so many triangles is no use.
using Useless = std::function<double(size_t triangles)>;

void add_levels(std::vector<Candidate>& candidates, const Mesh& mesh,
                const std::vector<Material>& materials, const std::vector<size_t>& targets,
                const Useless& useless, Judge& judge, const Job& job) {
    if (targets.empty())
        return;
    Mesh plain;
    const Mesh& source = without_unseen_colors(mesh, materials, plain);
    for (Mesh& level : approximate::simplify_chain(source, targets, {}, job)) {
        if (level.empty())
            continue;
        judge.repaint(level, job);
        Candidate candidate;
        candidate.mesh = std::make_shared<Mesh>(std::move(level));
        candidate.materials = materials;
        judge.measure_mesh(candidate, job, useless(candidate.mesh->triangles.size()));
        if (std::isfinite(candidate.error) && judge.shows_as_much(*candidate.mesh, job))
            candidates.push_back(std::move(candidate));
    }
}

/// A box and an ellipsoid. `by_pictures`: of something that is not solid; there are clear ones too.
void add_primitives(std::vector<Candidate>& candidates, const Bound& bound, bool by_pictures,
                    Judge& judge, const Job& job) {
    const Material material = approximate::mean_material(judge.attributes());
    const auto add = [&](Kind kind, const Primitive& primitive, double opacity) {
        Candidate candidate;
        candidate.kind = kind;
        candidate.primitive = primitive;
        candidate.materials = {approximate::clear_material(material, opacity)};
        if (by_pictures)
            judge.compare_pictures(candidate, {}, job);
        else
            judge.measure_primitive(candidate, job);
        candidates.push_back(std::move(candidate));
    };
    // Nothing sinks into the plane that its original stands on. What floats above it may be the
    // better one (a tree's crown), or not (a table's top): the error decides.
    const double floor = bound.box.low.z;
    const auto add_standing = [&](Kind kind, const Primitive& primitive) {
        const bool is_box = kind == Kind::Box;
        const approximate::Reach reach = approximate::reach_of(primitive, is_box);
        add(kind, approximate::kept_above(primitive, is_box, floor), 1);
        constexpr double kStands = 0.01;  // over its height
        if (reach.low - floor > kStands * (reach.high - reach.low))
            add(kind, approximate::standing_on(primitive, is_box, floor), 1);
    };
    if (const auto box = approximate::fit_box(judge.attributes(), bound))
        add_standing(Kind::Box, *box);
    if (const auto ellipsoid = approximate::fit_ellipsoid(judge.attributes(), bound))
        add_standing(Kind::Ellipsoid, *ellipsoid);
    if (!by_pictures)
        return;
    if (const auto box = approximate::fit_clear_box(judge.attributes(), bound))
        add(Kind::Box, approximate::kept_above(box->primitive, true, floor), box->opacity);
    if (const auto ellipsoid = approximate::fit_clear_ellipsoid(judge.attributes(), bound))
        add(Kind::Ellipsoid, approximate::kept_above(ellipsoid->primitive, false, floor),
            ellipsoid->opacity);
}

/// `airy`: clear ones too, of these parts.
void add_composites(std::vector<Candidate>& candidates, const Mesh& mesh, bool airy,
                    const approximate::Crowd& crowd, double most, uint64_t seed, Judge& judge,
                    const Job& job) {
    // Between leaves one sees far into a crown: a solid with the same variances would be too small.
    approximate::CompositeOptions options{seed};
    options.shape = !airy;
    std::vector<approximate::Clustered> levels =
        approximate::composites(mesh, judge.skin(), judge.attributes(), options, job);
    if (airy) {
        for (approximate::Clustered& level : approximate::clear_composites(
                 mesh, judge.skin(), crowd.part_of, judge.attributes(), options, job))
            levels.push_back(std::move(level));
    }
    for (const approximate::Clustered& level : levels) {
        if (static_cast<double>(level.composite.solids.size() * kBytesPerPrimitive) > most)
            continue;  // no use, and comparing takes long
        Candidate candidate;
        candidate.kind = Kind::Composite;
        candidate.composite = std::make_shared<const Composite>(level.composite);
        for (size_t i = 0; i < level.attributes.size(); ++i)
            candidate.materials.push_back(approximate::clear_material(
                approximate::mean_material(level.attributes[i]), level.opacities[i]));
        judge.compare_pictures(candidate, {}, job);
        candidates.push_back(std::move(candidate));
    }
}

/// The cheapest candidate within an error; infinite when there is none.
double bytes_within(const std::vector<Candidate>& candidates, double error, uint64_t uses) {
    double out = std::numeric_limits<double>::infinity();
    for (const Candidate& candidate : candidates) {
        if (candidate.error <= error)
            out = std::min(out, bytes_of(candidate, uses));
    }
    return out;
}

/// What replacements must be better than.
struct Whole {
    Bound bound;
    uint64_t uses = 1;
    double bytes = 0;   // as one mesh
    double most = 0;    // bytes of an occurrence that are no use any more
    bool many = false;  // its parts are objects
};

/// Pruned levels, primitives and composites of what is no environment, where they promise more than
/// the levels among the candidates.
void add_replacements(std::vector<Candidate>& candidates, const Mesh& mesh,
                      const std::function<approximate::Crowd()>& crowd_in_mesh, const Whole& whole,
                      const std::vector<Material>& materials, const Settings& settings,
                      uint64_t seed, Judge& judge, const Job& job) {
    // Less than so many solids would cost is not worth a tenth of a second of pictures.
    constexpr double kFewSolids = 32;
    const bool worth_pictures = whole.bytes > kFewSolids * kBytesPerPrimitive && !judge.refracts();
    approximate::Crowd crowd;
    const auto dear = [&] {
        return bytes_within(candidates, kNear * whole.bound.radius, whole.uses) >
               kCollapsed * whole.bytes;
    };
    if (worth_pictures && (whole.many || dear()))
        crowd = crowd_in_mesh();
    const bool by_pictures = worth_pictures && (!crowd.empty() || !judge.solid());
    if (by_pictures)
        judge.take_pictures(mesh, crowd.empty(), job);
    if (!crowd.empty())
        add_pruned_levels(candidates, mesh, materials, crowd, settings.level_ratio,
                          triangles_for(whole.most, whole.uses), seed, judge, job);
    if (by_pictures || judge.solid())
        add_primitives(candidates, whole.bound, by_pictures, judge, job);
    // Solids that the same memory would hold. Few collapsed triangles beside a smooth thing are as
    // good, and comparing pictures takes long.
    const double solids = by_pictures ? 16 : 64;
    const double dearer =
        solids * kBytesPerPrimitive * static_cast<double>(std::max<uint64_t>(1, whole.uses));
    // The cheapest has four.
    const bool too_dear = whole.most < static_cast<double>(4 * kBytesPerPrimitive);
    if (!too_dear && !judge.refracts() && whole.bytes > 2 * dearer &&
        bytes_within(candidates, kOff * whole.bound.radius, whole.uses) > dearer) {
        if (!by_pictures)
            judge.take_pictures(mesh, true, job);
        add_composites(candidates, mesh, by_pictures, crowd, whole.most, seed, judge, job);
    }
}

/// What a group's children cost within rising errors.
class Children {
public:
    /// From `error` on.
    Children(const Model& model, ObjectIndex group, double error, const std::vector<uint64_t>& uses,
             const Job& job) {
        constexpr int kFinest = -10;  // powers of two, over the radius
        constexpr int kCoarsest = 3;
        const auto add = [&](double at) {
            steps_.push_back({at, drawn_within(model, group, at, uses, job).bytes});
        };
        add(error);
        for (int power = kFinest; power < kCoarsest; ++power) {
            const double at = std::ldexp(model.objects[group].bound().radius, power);
            if (at > error)
                add(at);
        }
    }

    double bytes() const { return steps_.front().bytes; }
    /// The error from which on they cost no more than `bytes`; a step too large rather than too small.
    double cheaper_from(double bytes) const {
        for (const Step& step : steps_) {
            if (step.bytes <= bytes)
                return step.error;
        }
        return std::numeric_limits<double>::infinity();
    }

private:
    struct Step {
        double error;
        double bytes;
    };
    std::vector<Step> steps_;
};

/// What no ray from outside reaches is left out (of the occurrences too); everything stays when
/// nothing would, and where there is glass, which ends rays but hides nothing.
Mesh without_hidden(const Mesh& mesh, std::vector<uint32_t>& occurrence, const ray::SkinPtr& skin,
                    uint64_t seed, const Job& job) {
    if (skin->transmits())
        return mesh;
    const ray::Scene scene(mesh, skin);
    const std::vector<uint8_t> seen =
        measure::seen_from_outside(mesh, scene, kRaysPerTriangle, seed, job);
    Mesh shell = subset(mesh, seen);
    if (shell.empty())
        return mesh;
    size_t kept = 0;
    for (size_t i = 0; i < seen.size(); ++i) {
        if (seen[i] != 0)
            occurrence[kept++] = occurrence[i];
    }
    occurrence.resize(kept);
    return shell;
}

/// Of a group: leaves and the like where that is what its children are made of, else the children.
approximate::Crowd crowd_in(const Mesh& mesh, const std::vector<uint32_t>& occurrence) {
    constexpr size_t kPartsOfFoliage = 16;  // of an occurrence, in the mean
    approximate::Crowd parts = approximate::crowd_of(mesh);
    const std::set<uint32_t> drawn(occurrence.begin(), occurrence.end());
    if (parts.parts.size() >= kPartsOfFoliage * drawn.size())
        return parts;
    return approximate::crowd_of(mesh, occurrence);
}

std::vector<Material> materials_of(const Model& model, const Representation& finest) {
    std::vector<Material> materials;
    for (const uint32_t material : finest.materials)
        materials.push_back(model.materials.at(material));
    if (materials.empty())
        materials.emplace_back();
    return materials;
}

/// Triangles of a leaf's levels.
std::vector<size_t> targets_of(const Mesh& mesh, const Settings& settings) {
    const size_t count = mesh.triangles.size();
    const auto first = static_cast<size_t>(static_cast<double>(count) * settings.level_ratio);
    return targets_of(count, first, settings.level_ratio);
}

/// Tells whether a level's error is one of materials: larger than that of the bare shape.
class LookError {
public:
    LookError(const Mesh& finest, const std::vector<Material>& materials, const Settings& settings,
              uint64_t seed, const Job& job) {
        const bool alike = materials.size() == 1 && finest.colors.empty() &&
                           !textured(materials[0]) && !materials[0].other;
        if (!alike)
            bare_.emplace(finest,
                          measure::DeviationOptions{settings.samples, settings.samples, seed},
                          measure::Surface{}, job);
    }

    /// Metres; 0 where the shape decides.
    double of(const Mesh& level, const std::vector<Material>& materials, Judge& judge,
              const Job& job) const {
        if (!bare_)
            return 0;
        Candidate candidate;
        candidate.mesh = std::make_shared<Mesh>(level);
        candidate.materials = materials;
        judge.measure_mesh(candidate, job);
        const double bare = bare_->of(level, {}, job).error;
        return candidate.error > 1.01 * bare ? candidate.error : 0;
    }

private:
    std::optional<measure::DeviationReference> bare_;
};

uint64_t seed_of(const Object& object, const Settings& settings) {
    return Hasher().value(object.source_hash).value(settings.seed).result();
}

}  // namespace

Hash hash_of(const Settings& settings) {
    constexpr uint32_t kAlgorithms = 16;  // raised whenever the same settings give other stand-ins
    return Hasher()
        .value(kAlgorithms)
        .value(settings.level_ratio)
        .value(settings.rays)
        .value(settings.samples)
        .value(settings.group_triangles)
        .value(settings.seed)
        .result();
}

void keep_useful(std::vector<Candidate>& candidates, uint64_t finest_bytes, uint64_t uses) {
    // A level that saves less than this over a better one is not worth its place on disk.
    constexpr double kSameCost = 1.02;
    const auto bytes = [&](const Candidate& candidate) { return bytes_of(candidate, uses); };
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](const Candidate& a, const Candidate& b) {
                         return bytes(a) != bytes(b) ? bytes(a) < bytes(b) : a.error < b.error;
                     });
    std::vector<Candidate> front;  // cheapest first, errors falling
    for (Candidate& candidate : candidates) {
        if (bytes(candidate) >= static_cast<double>(finest_bytes) ||
            (!front.empty() && candidate.error >= front.back().error))
            continue;
        if (!front.empty() && bytes(candidate) < kSameCost * bytes(front.back()))
            front.back() = std::move(candidate);
        else
            front.push_back(std::move(candidate));
    }
    std::reverse(front.begin(), front.end());
    candidates = std::move(front);
}

StandIns stand_ins_of_leaf(const Model& model, const Object& object, uint64_t uses,
                           const Settings& settings, const MeshSource& source,
                           image::TexelCache& texels, const Job& job) {
    StandIns out;
    const Representation& finest = object.representations.at(0);
    const std::shared_ptr<const Mesh> mesh = source(finest);
    if (mesh->empty())
        return out;
    const std::vector<Material> materials = materials_of(model, finest);
    Judge judge(*mesh, materials, texels, settings, object.role == Role::Environment,
                seed_of(object, settings), 0, job);
    judge.measure_finest(*mesh, job);
    judge.count_layers();
    out.attributes = judge.attributes();
    if (out.attributes.empty())
        return out;
    const auto never = [](size_t) { return std::numeric_limits<double>::infinity(); };
    add_levels(out.candidates, *mesh, materials, targets_of(*mesh, settings), never, judge, job);
    Whole whole{finest.summary.bound, uses};
    whole.bytes = static_cast<double>(mesh->triangles.size()) * kBytesPerTriangle;
    whole.most = bytes_each(Kind::Mesh, finest.summary.cost.bytes, uses);
    if (object.role != Role::Environment)
        add_replacements(
            out.candidates, *mesh, [&] { return approximate::crowd_of(*mesh); }, whole, materials,
            settings, seed_of(object, settings), judge, job);
    keep_useful(out.candidates, finest.summary.cost.bytes, uses);
    for (Candidate& candidate : out.candidates)
        judge.match_brightness(candidate, *mesh, job);
    return out;
}

StandIns stand_ins_of_group(const Model& model, ObjectIndex group, const Surroundings& surroundings,
                            const Settings& settings, const MeshSource& source,
                            image::TexelCache& texels, const Job& job) {
    StandIns out;
    if (surroundings.hidden[group] != 0)
        return out;  // always opened: rays of one class see other parts of it than those of another
    const Object& object = model.objects[group];
    const Summary& finest = object.representations.at(0).summary;
    const std::vector<uint64_t>& uses = surroundings.uses;
    const bool environment = surroundings.environment[group] != 0;
    const uint64_t budget =
        std::min(settings.group_triangles, std::max<uint64_t>(1000, finest.cost.triangles / 3));
    const double fine = error_to_flatten(model, group, budget, settings.group_triangles, uses, job);
    const Flat reference = flatten(model, group, fine, source, job);
    if (reference.mesh.empty())
        return out;
    const uint64_t seed = seed_of(object, settings);
    Judge judge(reference.mesh, reference.materials, texels, settings, environment, seed,
                reference.child_error, job);
    judge.measure_finest(reference.mesh, job);
    judge.count_layers();
    out.attributes = judge.attributes();
    if (out.attributes.empty())
        return out;

    std::vector<uint32_t> occurrence = reference.occurrence;
    Mesh shell = without_hidden(reference.mesh, occurrence, judge.skin(), seed, job);
    // A stand-in is off by as much as the reference or more, and no use where it costs more than
    // what the children use there.
    const Children children(model, group, reference.child_error, uses, job);
    Whole whole{finest.bound, uses[group]};
    whole.bytes = static_cast<double>(shell.triangles.size() * kBytesPerTriangle);
    whole.most = children.bytes() - static_cast<double>(kBytesPerOccurrence);
    whole.many = reference.occurrences >= kManyChildren;
    const size_t count = shell.triangles.size();
    const size_t first = std::min(count, triangles_for(whole.most, uses[group]));
    std::vector<size_t> targets = targets_of(count + 1, first, settings.level_ratio);
    const auto fifth = static_cast<size_t>(kCollapsed * static_cast<double>(count));
    if (!environment && !whole.many && first < fifth)
        targets.insert(targets.begin(), fifth);  // tells whether it is a crowd
    const size_t coarsest = targets.empty() ? 0 : targets.back();
    const auto useless = [&](size_t triangles) {
        // The coarsest is what there is where nothing is of use; the probe is no stand-in.
        if (triangles <= coarsest || triangles > first)
            return std::numeric_limits<double>::infinity();
        const double own = bytes_each(Kind::Mesh, triangles * kBytesPerTriangle, uses[group]) +
                           static_cast<double>(kBytesPerOccurrence);
        return std::max(children.cheaper_from(own), kOff * finest.bound.radius);
    };
    add_levels(out.candidates, shell, reference.materials, targets, useless, judge, job);
    if (!environment)
        add_replacements(
            out.candidates, shell, [&] { return crowd_in(shell, occurrence); }, whole,
            reference.materials, settings, seed, judge, job);

    // A stand-in that costs more than what the children would use instead is none: parts that many
    // groups share are cheap, one mesh for each of the groups is not. It is used from its own error
    // to the next one's; what children cost is asked for half way, on a scale of powers.
    std::vector<Candidate> useful = out.candidates;
    keep_useful(useful, finest.cost.bytes, uses[group]);
    double next = 0;  // 0: nothing is coarser
    for (size_t i = useful.size(); i-- > 0;) {
        const double own = bytes_each(useful[i].kind, bytes_of(useful[i]), uses[group]) +
                           static_cast<double>(kBytesPerOccurrence);
        const double error = useful[i].error;
        const double used = next > 0 ? std::sqrt(error * next) : error;
        if (own < drawn_within(model, group, used, uses, job).bytes)
            next = error;
        else
            useful.erase(useful.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (useful.empty()) {
        // Every group has a stand-in, even one that saves nothing but the occurrences: the cheapest.
        if (out.candidates.empty()) {
            Candidate all;
            all.mesh = std::make_shared<Mesh>(std::move(shell));
            all.materials = reference.materials;
            judge.measure_mesh(all, job);
            out.candidates.push_back(std::move(all));
        }
        keep_useful(out.candidates, ~uint64_t{0});
        useful = {out.candidates.back()};
    }
    out.candidates = std::move(useful);
    for (Candidate& candidate : out.candidates)
        judge.match_brightness(candidate, reference.mesh, job);
    return out;
}

segment::BoundLevels bound_levels_of_leaf(const Bind& bind, const Settings& settings,
                                          const MeshSource& source, image::TexelCache& texels,
                                          const Job& job) {
    segment::BoundLevels out;
    const Representation& finest = bind.object->representations.at(0);
    const std::shared_ptr<const Mesh> mesh = source(finest);
    if (mesh->empty())
        return out;
    const std::vector<size_t> targets = targets_of(*mesh, settings);
    if (targets.empty())
        return out;
    const std::vector<Material> materials = materials_of(*bind.model, finest);
    Judge judge(*mesh, materials, texels, settings, bind.object->role == Role::Environment,
                bind.hash, 0, job);
    judge.measure_finest(*mesh, job);
    if (judge.attributes().empty())
        return out;
    std::vector<std::vector<glm::vec3>> others;
    const std::vector<uint32_t> points = approximate::points_of(*mesh, *bind.object->pose);
    for (const Pose* pose : bind.others) {
        std::vector<glm::vec3>& positions = others.emplace_back();
        for (const uint32_t point : points)
            positions.push_back(pose->points.at(point));
    }
    Mesh plain;
    const Mesh& visible = without_unseen_colors(*mesh, materials, plain);
    const approximate::PoseSurface surface(*bind.object->pose);
    const approximate::Binder binder(visible, surface);
    const LookError look_error(visible, materials, settings, bind.hash, job);
    for (approximate::TracedLevel& level :
         approximate::simplify_traced(visible, others, targets, {}, job)) {
        if (level.mesh.empty())
            continue;
        judge.repaint(level.mesh, job);
        if (!judge.shows_as_much(level.mesh, job))
            continue;
        std::optional<approximate::BoundLevel> bound = binder.bind(std::move(level));
        if (!bound)
            continue;
        bound->look_error = look_error.of(bound->mesh, materials, judge, job);
        out.push_back(std::move(*bound));
    }
    return out;
}

std::vector<Candidate> followed_levels(const Model& model, const Object& object,
                                       const segment::BoundLevels& levels, const Job& job) {
    // A coarser level may be the better one in some frame, but levels keep their numbers.
    constexpr double kRise = 1 + 1e-9;
    std::vector<Candidate> out;
    const Representation& finest = object.representations.at(0);
    if (levels.empty() || object.pose == nullptr)
        return out;
    const std::vector<Material> materials = materials_of(model, finest);
    const approximate::PoseSurface surface(*object.pose);
    const auto counted = [&](double error) {
        return counted_error(error, object.role == Role::Environment, finest.summary.bound.radius);
    };
    for (const approximate::BoundLevel& level : levels) {
        job.check();
        std::optional<Mesh> followed = approximate::follow(level, surface);
        if (!followed || followed->triangles.size() >= finest.summary.cost.triangles)
            continue;
        const approximate::Strayed strayed = approximate::strayed(level, *followed, surface);
        Candidate candidate;
        candidate.mesh = std::make_shared<Mesh>(std::move(*followed));
        candidate.materials = materials;
        candidate.error =
            counted(std::max(strayed.error, level.look_error * std::max(1.0, strayed.growth)));
        if (!out.empty())
            candidate.error = std::max(candidate.error, kRise * out.back().error);
        candidate.max_error = std::max(counted(strayed.max), candidate.error);
        out.push_back(std::move(candidate));
    }
    return out;
}

}  // namespace lodestone::build

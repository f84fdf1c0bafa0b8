// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene_writer.h"

#include "base/files.h"
#include "base/parallel.h"
#include "povray_export/camera_writer.h"
#include "povray_export/finish.h"
#include "povray_export/invertible.h"
#include "povray_export/light_plan.h"
#include "povray_export/light_writer.h"
#include "povray_export/magnification.h"
#include "povray_export/number.h"
#include "povray_export/occurrence_text.h"
#include "povray_export/own_uses.h"
#include "povray_export/render_settings.h"
#include "povray_export/representation_writer.h"
#include "povray_export/scene_lights.h"
#include "povray_export/sky_writer.h"
#include "povray_export/texture_writer.h"
#include "quality/criterion.h"
#include "quality/light_arrival.h"

#include <glm/common.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>
#include <span>
#include <unordered_map>

namespace lodestone::povray {
namespace {

double thread_cpu_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Below an Environment group, or a stand-in for a group that holds Environment.
bool environment(const Model& model, const quality::Cut& cut,
                 const std::vector<uint8_t>& holds_environment, uint32_t node) {
    if (holds_environment[cut.nodes[node].object] != 0)
        return true;
    for (uint32_t at = node; at != quality::kNoParent; at = cut.nodes[at].parent) {
        if (model.objects[cut.nodes[at].object].role == Role::Environment)
            return true;
    }
    return false;
}

/// As much of an include file as can name its pictures.
constexpr size_t kBeginning = size_t{16} << 10u;
std::string beginning_of(const std::filesystem::path& path) {
    std::string text(kBeginning, ' ');
    std::ifstream file(path, std::ios::binary);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return text;
}

constexpr size_t kTypicalObject = 192;  // characters

struct Use {
    uint32_t node;
    uint32_t lod;
    size_t position;  // in cut.chosen
    size_t file;      // index of the include file
    Affine world;
    RayMask hidden;        // ray classes that do not see it
    RayMask in_place = 0;  // of what the camera sees, for these classes only
};

struct Include {
    const Representation* representation = nullptr;
    Hash hash = 0;
    std::string identifier;
    RepresentationOptions options = {};
    bool pictured = false;  // shows pictures, as fine as they are seen
    double texel = std::numeric_limits<double>::infinity();  // of its nearest use
    uint64_t bytes = 0;
    double cpu_s = 0;
    bool written = false;
    bool drawn = false;
    bool bumps_left_out = false;
};

class SceneWriter {
public:
    SceneWriter(const Model& model, const quality::Cut& cut, const View& view,
                const ExportOptions& options, Problems& problems, const Job& job)
        : model_(model),
          cut_(cut),
          view_(view),
          options_(options),
          problems_(problems),
          job_(job),
          shading_(filled_up(options.shading, options.antialiasing, view.pixel_error)),
          pictures_(options.folder) {}

    ExportReport write() {
        const double start = thread_cpu_s();
        job_.stage(Stage::Export);
        check_view(view_);
        if (!options_.colors.empty() && options_.colors.size() != cut_.chosen.size())
            fail(Status::InvalidArgument, options_.colors.size(), " colors for ",
                 cut_.chosen.size(), " chosen occurrences");
        make_folders();
        collect();
        const double before_files = thread_cpu_s();
        if (!options_.covered_only)
            sky_ = write_sky(view_world(), sky_sampling(), options_.folder, problems_);
        write_includes();
        hide_replaced();
        const double after_files = thread_cpu_s();
        name_problems();
        if (!sky_.file.empty()) {
            report_.bytes += sky_.bytes;
            ++report_.files;
            report_.written += sky_.written ? 1u : 0u;
        }
        write_text("scene.pov", scene());
        write_text("scene.ini",
                   render_settings(view_, shading_, options_.antialiasing, transparent()));
        ExportReport report = report_;
        for (const Include& include : includes_) {
            report.cpu_s += include.cpu_s;
            if (!include.drawn)
                continue;
            report.bytes += include.bytes;
            ++report.files;
            ++report.representations;
            report.written += include.written ? 1u : 0u;
        }
        const PictureFolder::Totals pictures = pictures_.totals();
        report.bytes += pictures.bytes;
        report.files += pictures.files;
        report.written += pictures.written;
        report.cpu_s += before_files - start + thread_cpu_s() - after_files;
        job_.progress(1);
        return report;
    }

private:
    void make_folders() const {
        std::error_code error;
        std::filesystem::create_directories(options_.folder / "r", error);
        if (error)
            fail(Status::Io, "cannot make the folder '", (options_.folder / "r").string(),
                 "': ", error.message());
    }

    /// What classes of rays meet, where there is light at all.
    std::span<const quality::RayCut> rays() const {
        return lit() ? options_.rays : std::span<const quality::RayCut>{};
    }

    void collect_own() {
        const bool softened =
            shading_.area_samples > 1 && shading_.shadow_error <= view_.pixel_error;
        for (const OwnUse& own : own_uses(model_, cut_, rays(), softened))
            add_use({own.node, own.lod, 0, 0, own.world, own.hidden, own.in_place}, own.textures);
    }

    /// Hides from classes what they meet something else in place of, which must be there.
    void hide_replaced() {
        std::vector<RayMask> replaced(cut_.nodes.size(), 0);
        for (const Use& use : uses_) {
            if (includes_[use.file].drawn)
                replaced[use.node] |= use.in_place;
        }
        replaced = spread(cut_, std::move(replaced));
        for (Use& use : uses_) {
            if (use.in_place == 0)
                use.hidden |= replaced[use.node];
        }
    }

    /// Of a representation of its node, in its file.
    void add_use(Use use, bool textures) {
        const quality::Node& node = cut_.nodes[use.node];
        const Representation& representation =
            model_.objects.at(node.object).representations.at(use.lod);
        if (!make_invertible(use.world)) {
            problems_.push_back({quality::path_of(model_, cut_, use.node), Severity::Warning,
                                 "singular_transform",
                                 "is scaled to nothing or to a line, so it is not drawn"});
            return;
        }
        // Copies of one representation share a file, those that are textured for their nearest
        const RepresentationOptions as{textures, options_.uvs, std::nullopt};
        const auto [at, fresh] =
            known_.try_emplace(file_hash(representation, as), includes_.size());
        if (fresh) {
            includes_.emplace_back().representation = &representation;
            includes_.back().options = as;
            includes_.back().pictured =
                shading_.texture_error > 0 && textures && pictured(includes_.back());
        }
        use.file = at->second;
        uses_.push_back(use);
        Include& include = includes_[use.file];
        if (include.pictured)
            include.texel = std::min(include.texel, texel_of(node, representation, use.world));
    }

    void collect() {
        const std::vector<uint8_t> holds_environment =
            options_.covered_only ? with_environment(model_) : std::vector<uint8_t>();
        const std::vector<uint8_t> nobody = left_out(cut_, rays());
        for (size_t position = 0; position < cut_.chosen.size(); ++position) {
            const uint32_t index = cut_.chosen[position];
            if ((uses_.size() & 1023u) == 0)
                job_.check();
            const quality::Node& node = cut_.nodes.at(index);
            const Object& object = model_.objects.at(node.object);
            const Representation& representation = object.representations.at(node.lod);
            if (representation.summary.kind == Kind::Assembly)
                continue;
            if (options_.covered_only && environment(model_, cut_, holds_environment, index))
                continue;
            if (nobody[index] != 0)
                continue;
            add_use({index, node.lod, position, 0, node.world, node.hidden}, !options_.false_color);
        }
        collect_own();
        for (Include& include : includes_) {
            if (include.pictured)
                include.options.texel = exponent_of(include.texel);
            include.hash = file_hash(*include.representation, include.options);
            include.identifier = identifier_of(include.hash);
        }
    }

    bool pictured(const Include& include) const {
        if (!include.options.uvs || include.representation->summary.kind != Kind::Mesh)
            return false;
        for (const uint32_t material : include.representation->materials) {
            if (material < model_.materials.size() && textured(model_.materials[material]))
                return true;
        }
        return false;
    }

    /// What a texel may cover of one occurrence, in metres of its own frame.
    double texel_of(const quality::Node& node, const Representation& representation,
                    const Affine& world) const {
        const Bound bound = transformed(representation.summary.bound, world);
        const double z = distance(bound, view_.camera.position);
        const double enlarged = stretch(world) * std::max(1.0, node.importance);
        return shading_.texture_error * quality::pixel_size(view_, z) / enlarged;
    }

    static int exponent_of(double texel) {
        constexpr int kMost = 60;
        return texel > 0 && std::isfinite(texel) ? std::clamp(std::ilogb(texel), -kMost, kMost)
                                                 : -kMost;
    }

    void write_includes() {
        std::atomic<size_t> done{0};
        parallel_for(includes_.size(), [&](size_t i) {
            job_.check();
            const double start = thread_cpu_s();
            Include& include = includes_[i];
            const std::filesystem::path path =
                options_.folder / "r" / (hex16(include.hash) + ".inc");
            std::error_code error;
            const uintmax_t found = std::filesystem::file_size(path, error);
            std::string text = error || found == 0 ? "" : beginning_of(path);
            if (!text.empty() && pictures_.found(pictures_named(text))) {
                include.bytes = found;
                include.drawn = true;
            } else {
                PictureWriter pictures;
                text = representation_text(model_, *include.representation, include.identifier,
                                           include.options, pictures, job_);
                if (!text.empty()) {
                    pictures.write(pictures_);
                    write_file(path, text);
                    include.bytes = text.size();
                    include.written = include.drawn = true;
                }
                text.resize(std::min(text.size(), kBeginning));
            }
            include.bumps_left_out = text.find(kBumpsLeftOut) != std::string::npos;
            include.cpu_s = thread_cpu_s() - start;
            job_.progress(static_cast<double>(++done) / static_cast<double>(includes_.size() + 1));
        });
    }

    /// Once for what several occurrences show.
    void name_problems() {
        std::vector<uint8_t> named(includes_.size(), 0);
        for (const Use& use : uses_) {
            if (!includes_[use.file].bumps_left_out || named[use.file]++ != 0)
                continue;
            problems_.push_back({quality::path_of(model_, cut_, use.node), Severity::Warning,
                                 "bump_not_flat",
                                 "is shown without its bumps: POV-Ray shows them on flat faces"});
        }
    }

    void write_text(const char* name, const std::string& text) {
        write_file(options_.folder / name, text);
        report_.bytes += text.size();
        ++report_.files;
        ++report_.written;
    }

    bool refracts() const {
        for (const Include& include : includes_) {
            for (const uint32_t material : include.representation->materials) {
                if (material < model_.materials.size() &&
                    refraction_of(model_.materials[material]) > 0)
                    return true;
            }
        }
        return false;
    }

    bool transparent() const { return options_.covered_only || view_world().transparent; }
    bool lit() const { return !options_.covered_only && !options_.false_color; }
    const World& view_world() const { return model_.world; }

    bool thorough() const { return options_.antialiasing == Antialiasing::Reference; }
    SkySampling sky_sampling() const {
        return {static_cast<size_t>(shading_.sky_lights), shading_.area_samples > 1};
    }

    /// Lights are chosen by what the camera sees, as if all rays met that.
    RayMask hidden_in_plan(const Use& use) const {
        const RayMask own = cut_.nodes[use.node].hidden;
        if (use.in_place != 0)
            return kAllRays;
        // What has flags is not parted; this one says nothing to lights
        return use.hidden == own ? own : static_cast<RayMask>(own | kRadiosityRays);
    }

    /// By which lights what is drawn; its numbers are those of the uses that are drawn.
    LightPlan light_plan(const std::vector<Bound>& occluders) {
        const double error = options_.light_error.value_or(view_.pixel_error);
        report_.lamps = static_cast<uint64_t>(
            std::count_if(model_.lights.begin(), model_.lights.end(), quality::lamp));
        report_.lights_each = static_cast<double>(report_.lamps);
        if (!lit() || !(error > 0) || report_.lamps < kFewLamps)
            return {};
        std::vector<Lit> drawn;
        drawn.reserve(occluders.size());
        for (const Use& use : uses_) {
            if (includes_[use.file].drawn)
                drawn.push_back(
                    {includes_[use.file].representation, use.world, hidden_in_plan(use)});
        }
        LightPlan plan = plan_lights(model_, drawn, view_, error, problems_, job_);
        if (!plan.empty())
            report_.lights_each = plan.lights_each;
        return plan;
    }

    /// Everything that is drawn, with the lights of its group around it.
    std::string grouped_objects(const LightPlan& plan, const std::vector<std::string>& lights,
                                double times) {
        std::string out;
        std::vector<const Use*> drawn;
        drawn.reserve(uses_.size());
        if (plan.empty())
            out.reserve(uses_.size() * kTypicalObject);
        for (const Use& use : uses_) {
            if (!includes_[use.file].drawn)
                continue;
            drawn.push_back(&use);
            report_.unseen += use.in_place != 0 ? 1 : 0;
            if (plan.empty())
                append_object(out, use, times);
        }
        report_.occurrences = drawn.size();
        std::vector<std::string> groups(plan.groups.size());
        for (const Piece& piece : plan.pieces)
            append_object(groups[piece.group], *drawn[piece.drawn], times, piece.within);
        return plan.empty() ? out : grouped_text(plan, lights, groups);
    }

    /// What of it is `within` a box (world frame).
    void append_object(std::string& out, const Use& use, double times,
                       const std::optional<Box3>& within = {}) const {
        out += "object{";
        out += includes_[use.file].identifier;
        out += ' ';
        if (options_.false_color) {
            const Kind kind = includes_[use.file].representation->summary.kind;
            append_flat_texture(out, options_.colors.empty() ? color_of(kind, use.lod)
                                                             : options_.colors[use.position]);
            out += ' ';
        }
        append_matrix(out, magnified(use.world, times));
        append_hidden(out, use.hidden);
        if (within) {
            out += " clipped_by{box{";
            append_vector(out, within->low * times, 15);
            out += ',';
            append_vector(out, within->high * times, 15);
            out += "}}";
        }
        out += "} // ";
        append_name(out, model_, cut_, use.node);
        out += ", LOD ";
        append_count(out, use.lod);
        out += use.in_place != 0 ? ", unseen\n" : "\n";
    }

    std::string scene() {
        Bound bound;
        std::vector<Bound> occluders;
        for (const Use& use : uses_) {
            if (!includes_[use.file].drawn)
                continue;
            const Summary& summary = includes_[use.file].representation->summary;
            occluders.push_back(transformed(summary.bound, use.world));
            bound = merged(bound, occluders.back());
        }
        const double times = magnification(view_, occluders);
        bound = magnified(bound, times);
        const LightPlan plan = light_plan(occluders);
        std::string lights;
        const SceneLights scene_lights(view_, occluders, bound, times, shading_, thorough(),
                                       problems_);
        const std::vector<std::string> names = scene_lights.declare(lights, plan);
        std::string objects = grouped_objects(plan, names, times);
        std::string out = "// Lodestone " LODESTONE_VERSION ": a fixed cut at Pixel Error ";
        append_number(out, view_.pixel_error, 6);
        out += "\n// ";
        append_count(out, report_.occurrences);
        out +=
            " occurrences; render it from this folder with: povray scene.ini\n"
            "#version 3.7;\n\n";
        if (times > 1) {
            out += "// All is ";
            append_count(out, static_cast<uint64_t>(times));
            out += " times as large: POV-Ray takes what is nearer than .001 for one point.\n";
        }
        out +=
            "// A sky of radiance L on all sides lights a surface of albedo a to a L: POV-Ray's "
            "ambient\n// with ambient_light = L. (Not shadowed: no occlusion of the sky.)\n"
            "global_settings{assumed_gamma 1 max_trace_level ";
        // Two surfaces of a glass are two levels.
        append_count(out, static_cast<uint64_t>(shading_.trace_depth) * (refracts() ? 2 : 1));
        if (shading_.reflection_error > 1) {
            out += " adc_bailout ";
            append_number(out, shading_.reflection_error / 255, 6);
        }
        out += " ambient_light rgb ";
        append_vector(out, sky_.ambient, 6);
        const glm::dvec3 background = sky_.statement.empty() ? sky_.ambient : glm::dvec3(0.0);
        out += transparent() ? "}\nbackground{rgbt <" : "}\nbackground{rgb <";
        for (int i = 0; i < 3; ++i) {
            append_number(out, background[i], 6);
            out += i < 2 ? "," : (transparent() ? ",1>}\n\n" : ">}\n\n");
        }
        if (!transparent())
            out += sky_.statement;
        append_camera(out, magnified(view_.camera, times), options_.antialiasing, problems_);
        if (lit()) {
            for (const Light& light : model_.lights) {
                if (plan.empty() || !quality::lamp(light))
                    scene_lights.append(out, light);
            }
            if (!plan.empty()) {
                out += "// Of ";
                append_count(out, report_.lamps);
                out += " lamps a point is lit by ";
                append_number(out, plan.lights_each, 3);
                out += " lights on average, some of which stand for several\n" + lights;
            }
            if (!sky_.lights.empty())
                out += "// The rest of the environment's light\n";
            for (const Light& light : sky_.lights)
                append_light(out, light, bound, {shading_.area_samples, thorough()}, problems_);
        }
        out += '\n';
        for (const Include& include : includes_) {
            if (include.drawn)
                out += "#include \"r/" + hex16(include.hash) + ".inc\"\n";
        }
        out += '\n';
        objects.insert(0, out);
        return objects;
    }

    const Model& model_;
    const quality::Cut& cut_;
    const View& view_;
    const ExportOptions& options_;
    Problems& problems_;
    const Job& job_;
    const Shading shading_;
    PictureFolder pictures_;
    std::vector<Use> uses_;
    std::vector<Include> includes_;
    std::unordered_map<Hash, size_t> known_;  // by file_hash without texel
    ExportReport report_;
    Sky sky_;
};

}  // namespace

ExportReport export_scene(const Model& model, const quality::Cut& cut, const View& view,
                          const ExportOptions& options, Problems& problems, const Job& job) {
    return SceneWriter(model, cut, view, options, problems, job).write();
}

}  // namespace lodestone::povray

// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/scene_writer.h"

#include "base/clock.h"
#include "base/files.h"
#include "base/parallel.h"
#include "image/kept_pixels.h"
#include "light/light_arrival.h"
#include "light/light_plan.h"
#include "povray_export/lamp/light_writer.h"
#include "povray_export/lamp/renderer_surfaces.h"
#include "povray_export/lamp/scene_lights.h"
#include "povray_export/lamp/scene_sky.h"
#include "povray_export/mesh/pixel_field.h"
#include "povray_export/occurrence/clear_surfaces.h"
#include "povray_export/occurrence/lit_uses.h"
#include "povray_export/occurrence/occurrence_look.h"
#include "povray_export/occurrence/occurrence_text.h"
#include "povray_export/occurrence/picture_needs.h"
#include "povray_export/occurrence/ray_class_uses.h"
#include "povray_export/scene/camera_writer.h"
#include "povray_export/scene/include_files.h"
#include "povray_export/scene/invertible_transform.h"
#include "povray_export/scene/magnification.h"
#include "povray_export/scene/povray_number.h"
#include "povray_export/scene/render_settings.h"
#include "povray_export/scene/scene_head.h"
#include "povray_export/texture/surface_finish.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace lodestone::povray {
namespace {

/// The characters of a typical object, for reserving memory.
/// Taste: a larger value reserves more than is used.
constexpr size_t kTypicalObject = 192;

/// The pixels by which the outline of a mask may be off at any Pixel Error, where a texel is smaller.
/// Taste: antialiasing tells no less; a larger value draws leaves far away with fewer corners.
constexpr double kUnseen = 0.25;

/// The share of the progress bar for the sky's light, where it is not known yet.
/// Taste: it takes about as long as files do, or more.
constexpr double kBakePart = 0.5;

class SceneWriter {
public:
    SceneWriter(const Model& model, const choose::Cut& cut, const View& view,
                const ExportOptions& options, Problems& problems, const Job& job)
        : model_(model),
          cut_(cut),
          view_(view),
          options_(options),
          problems_(problems),
          job_(job),
          shading_(shading_of(options, view.pixel_error)),
          renderer_(renderer_surfaces(model)),
          pixels_(model, view),
          includes_(model, options.folder, options.bakes) {
        report_.lamps = static_cast<uint64_t>(
            std::count_if(model_.lights.begin(), model_.lights.end(), light::is_lamp));
    }

    ExportReport write() {
        const double start = cpu_seconds();
        job_.stage(JobStage::Export);
        check_view(view_);
        if (!options_.colors.empty() && options_.colors.size() != cut_.chosen.size())
            fail(Status::InvalidArgument, options_.colors.size(), " colors for ",
                 cut_.chosen.size(), " chosen occurrences");
        make_folder(options_.folder / "r");
        if (!options_.covered_only)
            sky_.emplace(model_, shading_, lit(), options_.folder, problems_);
        find_needs();
        find_sky_light();
        collect();
        plan_lights();
        add_files();
        includes_.write(job_.part(sky_ && sky_->baked() ? kBakePart : 0, 1));
        hide_replaced();
        name_problems();
        if (!sky().file.empty()) {
            report_.bytes += sky().bytes;
            report_.texels += sky().texels;
            ++report_.files;
            report_.written += sky().written ? 1u : 0u;
        }
        const std::string text = scene();
        write_text("scene.pov", text);
        report_.text_bytes += text.size();
        write_text("scene.ini", render_settings(view_, options_.margin, shading_,
                                                options_.antialiasing, transparent()));
        ExportReport report = report_;
        includes_.add_to(report);
        report.cpu_s = cpu_seconds() - start;
        job_.progress(1);
        return report;
    }

private:
    static Shading shading_of(const ExportOptions& options, double pixel_error) {
        Shading out = filled_up(options.shading, options.antialiasing, pixel_error);
        if (!lit(options))
            out.bounces = 0;
        return out;
    }

    /// The representations that classes of rays meet, where there is light at all.
    std::span<const choose::RayCut> rays() const {
        return lit() ? options_.rays : std::span<const choose::RayCut>{};
    }

    /// Gathered light comes from what is not seen, too.
    void find_needs() {
        if (!lit() || shading_.bounces > 0)
            return;
        needs_.find(model_, renderer_, cut_, view_, all_lights(sky(), model_), options_.still,
                    job_);
        report_.left_out_bytes = needs_.bytes_left_out();
        report_.covered = needs_.covered();
    }

    void find_sky_light() {
        if (options_.covered_only)
            return;
        SkyOcclusionOptions wanted;
        wanted.file = (options_.bakes.empty() ? options_.folder : options_.bakes) / "sky_light.bin";
        wanted.still = options_.still;
        wanted.camera = options_.still ? &view_.camera : nullptr;
        wanted.load_finest = options_.load_finest;
        wanted.needs = &needs_;
        wanted.pixels = static_cast<double>(view_.width) * view_.height;
        wanted.texels = renderer_.texels;
        if (!sky_->find_light(cut_, wanted, pixels_, job_.part(0, kBakePart)))
            find_needs();
    }

    void collect_own() {
        const bool softened =
            shading_.area_samples > 1 && shading_.shadow_error <= view_.pixel_error;
        for (const OwnUse& own : own_uses(model_, cut_, rays(), softened))
            add_use({own.node, own.lod, kNoPosition, 0, own.world, own.hidden, own.in_place},
                    own.textures, sky_ ? sky_->mean_of_node(own.node) : nullptr);
    }

    /// Hides representations from classes that meet something else in their place, which must be
    /// there.
    void hide_replaced() {
        const std::vector<RayMask> replaced =
            replaced_by([&](const OccurrenceUse& use) { return includes_.at(use.file).drawn; });
        for (OccurrenceUse& use : uses_) {
            if (use.in_place == 0)
                use.hidden |= replaced[use.node];
        }
    }

    /// The classes, for each node, that meet one of some uses in its place.
    template <typename Some>
    std::vector<RayMask> replaced_by(const Some& some) const {
        std::vector<RayMask> replaced(cut_.nodes.size(), 0);
        for (const OccurrenceUse& use : uses_)
            replaced[use.node] |= some(use) ? use.in_place : RayMask{0};
        return replaced_ray_classes(cut_, std::move(replaced));
    }

    /// The path of a node's placements. The root has none and is called like its object.
    std::string called(uint32_t node) const {
        const std::string path = choose::path_of(model_, cut_, node);
        return path.empty() ? model_.objects.at(cut_.nodes[node].object).name : path;
    }

    const Representation& representation_of(const OccurrenceUse& use) const {
        return model_.objects.at(cut_.nodes[use.node].object).representations.at(use.lod);
    }

    /// Adds a use of a representation of its node.
    void add_use(OccurrenceUse use, bool textures, const SkyLightPtr& sky) {
        if (!make_invertible(use.world)) {  // nothing is seen of a line or a point anyway
            if (!use.world.finite())
                problems_.push_back({called(use.node), Severity::Warning, "bad_transform",
                                     "is not drawn: its transform is not a number"});
            return;
        }
        uses_.push_back(use);
        looks_.push_back({textures, sky, {}});
        bounds_.push_back(transformed(representation_of(use).summary.bound, use.world));
    }

    /// How a use looks.
    struct UseLook {
        bool textures = false;
        SkyLightPtr sky;
        light::LightAround around;  // that gloss and rough metal show
    };

    /// Lets each use be drawn from a file.
    void add_files() {
        // The shadow rays to lamps of a point of a thing from which on it has one texture, and
        // the lamps of one in the mean of the picture.
        // Taste: a larger value draws gloss better where lamps shine, and takes longer there.
        constexpr double kFewLampRays = 4;
        constexpr double kFewLamps = 3.6;  // Taste: as kFewLampRays
        const bool many = report_.lamps >= light::kManyLamps && !plan_.empty();
        const bool few = many && plan_.lights_each >= kFewLamps;
        const std::vector<double> rays = lamp_rays(bounds_, plan_);
        for (size_t i = 0; i < uses_.size(); ++i) {
            OccurrenceUse& use = uses_[i];
            const auto& [textures, sky, around] = looks_[i];
            const Bound& bound = bounds_[i];
            const double pixel = pixels_.at(bound) / enlarged(use);
            const bool cut = use.position != kNoPosition;
            const bool shadows =
                textures && lit() && shading_.bounces == 0 && use.in_place == 0 &&
                ((cut && !needs_.seen(use.position)) || pixels_.only_shadows(bound));
            use.file = includes_.add(
                representation_of(use),
                {.textures = textures,
                 .uvs = options_.uvs,
                 .coarse_crowds = view_.pixel_error > 0,
                 .sky = textures && !shadows ? sky : nullptr,
                 .around = textures && !shadows ? around : light::LightAround{},
                 .few_textures = textures && (few || (many && rays[i] >= kFewLampRays)),
                 .only_shadows = shadows},
                outline_of(pixel),
                cut ? needs_.triangles(use.position) : std::span<const uint8_t>{});
            if (includes_.at(use.file).pictured)
                includes_.note_texel(use.file, shading_.texture_error * pixel);
        }
        find_bands();
        includes_.name(options_.budget, cut_.bytes, job_);
    }

    void collect() {
        const std::vector<uint8_t> holds_environment =
            options_.covered_only ? with_environment(model_) : std::vector<uint8_t>();
        const std::vector<uint8_t> nobody = nodes_left_out(cut_, rays());
        for (size_t position = 0; position < cut_.chosen.size(); ++position) {
            const uint32_t index = cut_.chosen[position];
            if ((uses_.size() & 1023u) == 0)
                job_.check();
            const choose::CutNode& node = cut_.nodes.at(index);
            const Object& object = model_.objects.at(node.object);
            const Representation& representation = object.representations.at(node.lod);
            if (representation.summary.kind == Kind::Assembly)
                continue;
            if (options_.covered_only && is_environment(model_, cut_, holds_environment, index))
                continue;
            if (nobody[index] != 0)
                continue;
            if (needs_.left_out(position)) {
                ++report_.left_out;
                continue;
            }
            add_use({index, node.lod, position, 0, cut_.world(node), node.hidden},
                    !options_.false_color, sky_ ? sky_->of(position) : nullptr);
            // Gathering rays would otherwise look through a lamp, at what it lights behind itself.
            const std::optional<glm::dvec3> dull =
                shading_.bounces > 0 ? without_glow(model_, representation, node.hidden)
                                     : std::nullopt;
            if (dull)
                add_use({index, node.lod, kNoPosition, 0, cut_.world(node),
                         kAllRays & static_cast<RayMask>(~kRadiosityRays), kRadiosityRays, dull},
                        false, nullptr);
        }
        collect_own();
    }

    /// The factor by which a use shows its representation larger, with what it counts for.
    double enlarged(const OccurrenceUse& use) const {
        return stretch(use.world) * std::max(1.0, cut_.nodes[use.node].importance);
    }
    /// The metres by which the outline of a mask may be off where a pixel covers so many.
    double outline_of(double pixel) const { return std::max(view_.pixel_error, kUnseen) * pixel; }

    /// Finds what of large things may be coarser than their nearest parts.
    void find_bands() {
        std::vector<uint32_t> users(includes_.size(), 0);
        for (const OccurrenceUse& use : uses_)
            ++users[use.file];
        parallel_for(uses_.size(), [&](size_t i) {
            const OccurrenceUse& use = uses_[i];
            if (users[use.file] != 1 || !includes_.varies(use.file))
                return;
            job_.check();
            const Representation& shown = *includes_.at(use.file).representation;
            const Bound all = transformed(shown.summary.bound, use.world);
            if (const DetailBandsPtr bands = pixels_.bands(shown.mesh(), use.world, all)) {
                const double pixel = bands->finest() / enlarged(use);
                includes_.set_bands(use.file, bands, outline_of(pixel),
                                    shading_.texture_error * pixel);
            }
        });
    }

    /// Names each problem once for all occurrences that show the same.
    void name_problems() {
        std::vector<uint8_t> named(includes_.size(), 0);
        for (const OccurrenceUse& use : uses_) {
            const size_t file = includes_.own(use.file);
            if (!includes_.at(file).bumps_left_out || named[file]++ != 0)
                continue;
            problems_.push_back({called(use.node), Severity::Warning, "bump_not_flat",
                                 "is shown without its bumps: POV-Ray shows them on flat faces"});
        }
    }

    std::string layers_text() {
        std::vector<ClearOccurrence> clear;
        for (const OccurrenceUse& use : uses_) {
            const double layers = includes_.at(use.file).clear_layers;
            if (layers > 0 && (use.hidden & kCameraRays) == 0)
                clear.push_back({use.node, layers});
        }
        return clear_surfaces_text(model_, cut_, clear, problems_);
    }

    void write_text(const char* name, const std::string& text) {
        write_file(options_.folder / name, text);
        report_.bytes += text.size();
        ++report_.files;
        ++report_.written;
    }

    const WrittenSky& sky() const {
        static const WrittenSky kNone;
        return sky_ ? sky_->written() : kNone;
    }
    bool transparent() const { return options_.covered_only || model_.world.transparent; }
    static bool lit(const ExportOptions& options) {
        return !options.covered_only && !options.false_color;
    }
    bool lit() const { return lit(options_); }

    LightSampling light_sampling() const {
        return povray::light_sampling(shading_, options_.antialiasing, view_.camera);
    }

    /// How each use is seen that shows what is around it.
    std::vector<SurroundedThing> surrounded() const {
        std::vector<SurroundedThing> out;
        out.reserve(uses_.size());
        for (size_t i = 0; i < uses_.size(); ++i) {
            const size_t position = uses_[i].position;
            const bool seen =
                looks_[i].textures && position != kNoPosition && needs_.seen(position);
            out.push_back(
                {seen ? 2 * bounds_[i].radius / pixels_.at(bounds_[i]) : 0, looks_[i].sky});
        }
        return out;
    }

    /// Chooses lights by what the camera sees, and finds what gloss shows.
    void plan_lights() {
        report_.lights_each = static_cast<double>(report_.lamps);
        if (!lit())
            return;
        const std::vector<light::DrawnThing> drawn = drawn_things(
            model_, cut_, uses_, replaced_by([](const OccurrenceUse&) { return true; }));
        const std::vector<Light> lights = all_lights(sky(), model_);
        light::LightDemands demands =
            light_demands(sky(), shading_, light_sampling(),
                          options_.light_error.value_or(view_.pixel_error), lights);
        const std::vector<light::LightAround> around =
            lit_surroundings(model_, renderer_, drawn, surrounded(), demands, options_.still, job_);
        for (size_t i = 0; i < uses_.size(); ++i)
            looks_[i].around = around[i];
        if (options_.light_error == 0.0)
            return;
        demands.measured_suns = options_.antialiasing != Antialiasing::Reference;
        plan_ = light::plan_lights(model_, renderer_, drawn, view_, demands, problems_, job_);
        if (!plan_.empty())
            report_.lights_each = plan_.lights_each;
        report_.soft_lamps = soft_lamps(plan_);
    }

    /// The text of everything that is drawn, with the lights of its group around it.
    std::string grouped_objects(const std::map<light::GroupLight, std::string>& lights,
                                double times) {
        std::string out;
        if (plan_.empty())
            out.reserve(uses_.size() * kTypicalObject);
        for (const OccurrenceUse& use : uses_) {
            if (!includes_.at(use.file).drawn)
                continue;
            ++report_.occurrences;
            report_.unseen += use.in_place != 0 ? 1 : 0;
            if (plan_.empty())
                append_object(out, use, times);
        }
        if (plan_.empty())
            return out;
        std::vector<std::string> groups(plan_.groups.size());
        for (const LitUse& lit : lit_uses(uses_, plan_)) {
            if (includes_.at(lit.use.file).drawn)
                append_object(lit.group ? groups[*lit.group] : out, lit.use, times, lit.within);
        }
        return grouped_text(plan_, lights, groups) + out;
    }

    /// Appends an object, or its part `within` a box (world frame).
    void append_object(std::string& out, const OccurrenceUse& use, double times,
                       const std::optional<Box3>& within = {}) const {
        std::optional<glm::dvec3> flat;
        if (options_.false_color) {
            const Kind kind = includes_.at(use.file).representation->summary.kind;
            flat =
                options_.colors.empty() ? color_of(kind, use.lod) : options_.colors[use.position];
        }
        append_occurrence(out, includes_.at(use.file).identifier, use, flat, times, within);
        append_name(out, model_, cut_, use.node);
        out += ", LOD ";
        append_count(out, use.lod);
        out += use.in_place != 0 ? ", unseen\n" : "\n";
    }

    std::string scene() {
        Bound bound;
        std::vector<Bound> occluders;
        for (const OccurrenceUse& use : uses_) {
            if (!includes_.at(use.file).drawn)
                continue;
            const RepresentationSummary& summary = includes_.at(use.file).representation->summary;
            occluders.push_back(transformed(summary.bound, use.world));
            bound = merged(bound, occluders.back());
        }
        const double times = magnification(view_, occluders);
        bound = magnified(bound, times);
        std::string lights;
        if (lit()) {
            report_.lamp_rays = light::mean_lamp_rays(plan_, model_.lights);
            report_.sky_lights = sky().lights.size();
            report_.shadow_rays = static_cast<double>(report_.sky_lights) + report_.lamp_rays +
                                  light::mean_sun_rays(plan_, model_.lights);
        }
        const SceneLights scene_lights(view_, occluders, bound, times, shading_, light_sampling(),
                                       problems_);
        const std::map<light::GroupLight, std::string> names = scene_lights.declare(lights, plan_);
        std::string objects = grouped_objects(names, times);
        const Camera camera = magnified(view_.camera, times);
        const SceneHead head{view_.pixel_error,  report_.occurrences, times,
                             includes_.onward(), transparent(),       camera.position};
        std::string out = head_text(head, shading_, sky());
        append_camera(out, camera, options_.antialiasing, problems_);
        if (lit()) {
            for (uint32_t i = 0; i < model_.lights.size(); ++i) {
                if (plan_.empty() || !light::is_lamp(model_.lights[i]))
                    scene_lights.append(out, model_.lights[i], plan_.sun_rays(i));
            }
            if (!plan_.empty()) {
                out += "// Of ";
                append_count(out, report_.lamps);
                out += " lamps a point is lit by ";
                append_number(out, plan_.lights_each, 3);
                out += " lights on average, some of which stand for several\n" + lights;
            }
            if (!sky().lights.empty())
                out += "// The rest of the environment's light\n";
            for (const Light& light : sky().lights)
                scene_lights.append(out, light, 0);
        }
        out += layers_text();
        out += '\n';
        out += includes_.statements();
        out += '\n';
        objects.insert(0, out);
        return objects;
    }

    const Model& model_;
    const choose::Cut& cut_;
    const View& view_;
    const ExportOptions& options_;
    Problems& problems_;
    const Job& job_;
    const Shading shading_;
    const light::RendererSurfaces renderer_;
    const PixelField pixels_;
    PictureNeeds needs_;
    IncludeFiles includes_;
    std::vector<OccurrenceUse> uses_;
    std::vector<UseLook> looks_;  // by use
    std::vector<Bound> bounds_;   // by use, world frame
    light::LightPlan plan_;
    ExportReport report_;
    std::optional<SceneSky> sky_;
};

}  // namespace

ExportReport export_scene(const Model& model, const choose::Cut& cut, const View& view,
                          const ExportOptions& options, Problems& problems, const Job& job) {
    const image::KeptPixels decoded;  // masks, light and files look at the same pictures
    return SceneWriter(model, cut, view, options, problems, job).write();
}

}  // namespace lodestone::povray

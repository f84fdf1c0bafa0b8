// SPDX-License-Identifier: GPL-3.0-or-later
// Stand-in evaluator: measures stand-ins against the finest mesh they stand for.
#pragma once

#include "hierarchy/build_settings.h"
#include "hierarchy/candidate.h"
#include "measure/deviation/distinct_looks.h"
#include "measure/deviation/surface_deviation.h"
#include "measure/pictures/patch_light.h"
#include "measure/pictures/picture_agreement.h"
#include "measure/visible/visible_attributes.h"

#include <limits>
#include <optional>
#include <span>

namespace lodestone::hierarchy {

/// An error as it counts for something of that size (radius, metres): more for environment, and
/// never 0, which the finest alone has.
double counted_error(double error, bool environment, double size);

/// Whether a surface of such variances, across and through it, is 20 times thinner than wide.
bool is_flat(double across, double through);
bool is_flat(const Attributes& attributes);

/// Of one finest mesh, which must last until it is measured. It keeps no reference to the materials
/// or the settings, but one to the texels.
class StandInEvaluator {
public:
    /// `child_error`: by how much the mesh itself is off, metres. `rays_of_triangle`: as
    /// DeviationOptions.
    StandInEvaluator(const Mesh& finest, std::span<const Material> materials,
                     image::TexelCache& texels, const BuildSettings& settings, bool environment,
                     uint64_t seed, double child_error, const Job& job, int rays_of_triangle = 0);

    /// Measures the finest by rays, which attributes(), solid(), shows_as_much() and
    /// prove() need.
    void measure_finest(const Mesh& finest, const Job& job);

    /// Errors of a flat thing (road, carpet, wall) that lies in layers count as those of
    /// environment from here on. After measure_finest().
    void count_layers();

    /// Errors of meshes are those of half of the points from here on: of a group's, which are far
    /// off beside those of a leaf. What a solid of one color hides takes all points to be told.
    void measure_roughly() { rough_ = true; }

    const Attributes& attributes() const { return attributes_; }
    /// Whether something solid may stand for it.
    bool solid() const;
    /// Whether some of it bends light: nothing but its own surface shows that.
    bool refracts() const { return skin_->transmits(); }
    /// Of the finest's materials, which levels share.
    const ray::SkinPtr& skin() const { return skin_; }
    /// Of the finest, in its skin.
    const ray::MeshScene& finest_scene() const { return reference_.scene(); }
    /// As DeviationReference.
    const std::vector<uint8_t>& seen_triangles() const { return reference_.seen_triangles(); }

    /// As DeviationReference::repaint(), whose answer measure_mesh() may be told, with the
    /// `useless` error of that.
    measure::DeviationReference::RepaintResult repaint(
        Mesh& level, const Job& job,
        double useless = std::numeric_limits<double>::infinity()) const {
        return reference_.repaint(level, skin_.get(), job, rough_, distance_for(useless));
    }

    /// False for a level of the finest's materials that shows another amount of surface.
    bool shows_as_much(const Mesh& level, const Job& job) const;
    /// Likewise of a candidate that is a mesh. Otherwise its error is at least half as large as the
    /// patches that do not look like the finest's. `used_to`: the error from which on another is
    /// used.
    bool prove(StandInCandidate& candidate, double used_to, const Job& job) const;
    /// Fill the errors of a candidate; a mesh has the finest's materials, or these and others.
    /// Where the error is much larger than `useless` it may be infinite, which takes less time.
    void measure_mesh(StandInCandidate& candidate, const Job& job,
                      double useless = std::numeric_limits<double>::infinity(),
                      const measure::DeviationReference::RepaintResult& known = {});
    /// Infinite where another primitive measured here before is nearer: they cost the same.
    void measure_primitive(StandInCandidate& candidate, const Job& job);

    /// Sets area and centroid of solids right by many more rays. `finest`: the mesh measured as
    /// such; what stands at `floor` or would reach below it keeps its foot. Single solids stay
    /// where the finest was measured exactly, and all whose error is the radius or more.
    void settle(StandInCandidate& candidate, const Mesh& finest, double floor, const Job& job);

    /// Takes the pictures that compare_pictures() needs. `coarse`: four times faster, for
    /// candidates that will be far from the finest. `finest`: all of it, or what of it can be seen.
    void take_pictures(const Mesh& finest, bool coarse, const Job& job);
    /// Fills the errors of a candidate of what is not solid, with its own materials, by pictures.
    /// It is made as bright as the finest by its colors, first by those of the slots `tinted`.
    void compare_pictures(StandInCandidate& candidate, std::span<const uint16_t> tinted,
                          const Job& job);
    /// Makes any other candidate that is used from far enough (up to an error of `used_to`, where
    /// the next one takes over) as bright as the finest, by the colors of all its slots, and lets
    /// it glow as much. Shades that much alike are one look to errors; but of a mesh counts what is
    /// seen through gaps, and where it is off by a twelfth of the radius half of the pixel size
    /// from which on pictures agree: what is near something else may have been all that closed a
    /// gap.
    void match_brightness(StandInCandidate& candidate, const Mesh& finest, double used_to,
                          const Job& job);

    /// Makes an opaque box whose sides are not of one color a mesh of vertex colors, about as
    /// bright from each side as the finest. After measure_finest().
    void paint(StandInCandidate& candidate) const;

    /// Whether what is drawn of a group's children is about as bright as the finest, and looks like
    /// it in pictures of pixels of that error.
    bool looks_alike(const Mesh& drawn, std::span<const Material> materials, const Mesh& finest,
                     double error, const Job& job);

    /// Visible area by tag (one a triangle, below `tags`) of the finest, all of it or what of it
    /// can be seen.
    std::vector<double> visible_by_tag(const Mesh& finest, std::span<const uint32_t> by_triangle,
                                       size_t tags, const Job& job) const;
    /// Likewise of a level in the finest's materials.
    std::vector<double> visible_by_tag_of_level(const Mesh& level,
                                                std::span<const uint32_t> by_triangle, size_t tags,
                                                const Job& job) const;

private:
    bool shows_as_much(const Mesh& level, const ray::MeshScene& scene, const Job& job) const;
    void set_error(StandInCandidate& candidate, const measure::SurfaceDeviation& deviation) const;
    void take_pictures_of(const Mesh& finest, int side, const Job& job);
    /// Whether what is called the finest is all of it, for which a scene is there.
    bool is_whole(const Mesh& finest) const {
        return finest.triangles.size() == finest_scene().triangles();
    }
    measure::VisibleOptions visible_options(uint64_t rays) const;
    /// Whether match_brightness() does anything to what is used so far.
    bool is_matched(double used_to) const;
    /// The finest's, by so many rays or more.
    const Attributes& sure(const Mesh& finest, uint64_t rays, double settled, const Job& job);
    /// What a distance may be where an error is at most that.
    double distance_for(double error) const;
    ray::SkinPtr skin_of(std::span<const Material> materials) const;
    /// Of one whose colors are as they were made: the finest's own where it has no others.
    ray::SkinPtr skin_of(const StandInCandidate& unmatched) const;
    /// Makes what glows of a candidate glow as much as the finest does.
    void match_glow(StandInCandidate& candidate,
                    const measure::AgreementReference::TracedPictures& traced, const Mesh& finest,
                    const Job& job);

    image::TexelCache& texels_;
    measure::LookPalette looks_;
    double size_;
    double child_error_;
    bool environment_;
    bool layer_ = false;
    bool rough_ = false;
    double least_primitive_ = std::numeric_limits<double>::infinity();  // error of those measured
    uint64_t seed_;
    uint64_t rays_;
    std::vector<Material> materials_;
    ray::SkinPtr skin_;
    std::vector<uint16_t> finest_looks_;
    measure::DeviationReference reference_;
    std::optional<measure::AgreementReference> pictures_;
    std::optional<measure::LightPatches> patches_;
    std::optional<glm::dvec3> glow_;  // all light of the finest's pictures over what it emits
    double opacity_ = 0;
    std::vector<measure::CastPoints> cast_;  // what the first rays that measure the finest found
    Attributes attributes_;
    Attributes sure_;         // by many more rays
    uint64_t sure_rays_ = 0;  // so many
};

}  // namespace lodestone::hierarchy

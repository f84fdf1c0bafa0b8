// SPDX-License-Identifier: GPL-3.0-or-later
// PictureAgreement: the pixel size from which on pictures of a stand-in and of the finest look the
// same.
#pragma once

#include "base/job.h"
#include "ray/parallel_rays.h"

#include <array>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace lodestone::measure {

/// Pictures agree when, over the covered pixels of all of them, the mean difference of coverage
/// (0...1) is at most this.
/// Taste: a larger value lets foliage grow thin or thick before its levels are refused.
inline constexpr double kMostCoverageOff = 0.10;
/// Pictures agree when the mean difference of light, over the mean light of the finest, is at most
/// this.
/// Taste: a larger value lets stand-ins be darker, brighter or smoother for less cost.
inline constexpr double kMostLightOff = 0.20;

/// Where pictures are taken from, and over which areas their light is compared.
enum class PictureViews : uint8_t {
    /// Along all axes, half of them from below; light counts in pixels.
    AllAround,
    /// For what stands on something, which nobody sees from below: from above the horizon, under
    /// suns above it; light counts in pixels.
    FromAbove,
    /// For crowns, likewise from above (from below they cover the same). Which leaves of a crown
    /// are lit is chance, pixel by pixel: light counts over areas of kCrownPixels by kCrownPixels
    /// pixels, coverage in pixels.
    OfCrowns,
};

/// The side in pixels of the areas over which light counts in crowns.
/// Taste: a larger value lets the light of crowns be patchier.
inline constexpr int kCrownPixels = 4;

/// The answer of a comparison of pictures.
struct PictureAgreement {
    double error = 0;       // metres: the smallest pixel size at which pictures agree
    double coverage = 0;    // the covered area of the stand-in over that of the finest
    glm::dvec3 light{0.0};  // by color: the finest's mean light where covered over the stand-in's
};

struct PictureRect;  // picture_misses.h

/// The error of what is not solid: foliage, fences, crowds, things one can see through. If single
/// leaves are missing, the distance to the nearest other leaf tells nothing; how much of a pixel is
/// covered and how bright it is does.
///
/// Pictures are orthographic, along 13 axes (the opposite directions cover the same), of a diffuse
/// surface under a uniform sky, which gives a quarter of the light, and a sun that stands obliquely
/// beside the viewer (of what stands, anywhere above), with shadows; glass refracts what lies
/// behind it. Both meshes are sampled by the same rays. Larger pixels are means of smaller ones.
/// Sampling noise is taken out of the differences.
class AgreementReference {
public:
    /// Axes along which pictures are taken.
    /// Law: the faces, edges and corners of a cube, one of each opposite pair (3 + 6 + 4).
    static constexpr size_t kViews = 13;

    /// Samples along a side of the finest's bounding square; the smallest pixel is two samples
    /// wide.
    /// Taste: a larger value resolves smaller errors, for time that grows with its square.
    static constexpr int kSide = 90;
    /// Samples along a side for what agrees at the smallest pixel of kSide, and is drawn often.
    /// Taste: twice kSide, four times slower.
    static constexpr int kFineSide = 180;
    /// Samples along a side for objects whose levels are coarse anyway.
    /// Taste: half of kSide, four times faster; a smaller value cannot tell errors below a
    /// twentieth of the size.
    static constexpr int kCoarseSide = 45;
    /// Samples along a side where only the brightness counts, or pixels of a sixth of the size.
    /// Taste: a third of kSide, nine times faster; a smaller value adds noise to brightness.
    static constexpr int kBrightSide = 30;
    /// Samples along a side where the brightness of 16 pixels or fewer a side counts.
    /// Taste: three times faster than kBrightSide; a smaller value adds noise to brightness, and
    /// knows no pixels of a sixteenth of the size.
    static constexpr int kFewSide = 18;

    /// Keeps the pictures alone. `side` is one of the five numbers above. Throws Error:
    /// InvalidArgument, RaysUnavailable, Cancelled.
    AgreementReference(const Mesh& finest, const ray::SkinPtr& skin, uint64_t seed,
                       int side = kSide, const Job& job = {});
    /// Takes a scene that was made from this mesh and this skin before.
    AgreementReference(const Mesh& finest, const ray::MeshScene& scene, const ray::SkinPtr& skin,
                       uint64_t seed, int side, const Job& job,
                       PictureViews views = PictureViews::AllAround);

    /// The agreement of a stand-in with the finest. The bits are the same on any number of threads.
    /// Two meshes that show nothing agree at every size. If the pictures agree at no size, the
    /// error is one to two sides of the picture, the more they differ.
    PictureAgreement of(const Mesh& stand_in, const ray::SkinPtr& skin, const Job& job = {}) const;

    /// The smallest pixel size at which pictures are compared, in metres: no agreement has less
    /// error. 0 where the finest shows nothing.
    double least_error() const;

    /// The point of a stand-in that each sample of the pictures shows, and how much light falls on
    /// it. Tracing takes most of the time, and the result is the same for all skins with the same
    /// transparency.
    class TracedPictures;
    /// Traces the pictures of a stand-in. Keeps a reference to the mesh. The bits are the same on
    /// any number of threads.
    TracedPictures trace(const Mesh& stand_in, const ray::SkinPtr& skin, const Job& job = {}) const;
    /// The agreement of traced pictures. `skin` is the one they were traced in, or one that differs
    /// from it in colors and scales of textures alone.
    PictureAgreement of(const TracedPictures& stand_in, const ray::SkinPtr& skin) const;
    /// The error of gaps alone, in metres. The pictures compared are the finest's and one that
    /// differs from it only where the finest shows a point that has no visible point of the
    /// stand-in within twice `off` metres (and the distance of samples). Returns the smallest pixel
    /// size at which they agree (0: all sizes), or the error of of() if the stand-in covers much
    /// less in all.
    double gap_error(const TracedPictures& stand_in, const ray::SkinPtr& skin, double off) const;
    /// The color of each of so many sides of an opaque, matte stand-in (`side_of`: by triangle)
    /// with which it shows about as much light as the finest in each pixel of 15 by 15 a picture:
    /// gaps and their shadows darken it. The fourth number is the light that falls on the side; 0:
    /// no picture shows it. `stand_in` was traced in any colors.
    std::vector<glm::dvec4> side_colors(const TracedPictures& stand_in,
                                        std::span<const uint32_t> side_of, size_t sides) const;
    /// The agreement without the error: coverage and light alone, which is faster.
    PictureAgreement brightness_of(const TracedPictures& stand_in, const ray::SkinPtr& skin) const;

private:
    AgreementReference(const Mesh& finest, const ray::MeshScene* scene, const ray::SkinPtr& skin,
                       uint64_t seed, int side, const Job& job, PictureViews views);
    TracedPictures trace(const Mesh& stand_in, const ray::MeshScene* scene,
                         const ray::SkinPtr& skin, const Job& job) const;
    /// Fills the samples of an opaque mesh of few triangles, or in its scene those of any mesh.
    void draw(const Mesh& mesh, TracedPictures& out, const Job& job) const;
    void search(const Mesh& mesh, const ray::MeshScene& scene, const ray::SkinPtr& skin,
                TracedPictures& out, const Job& job) const;
    /// Where the ray of a sample starts.
    glm::dvec3 origin_of(const glm::dmat3& frame, const glm::dvec2& place) const;
    /// The rays of the samples of each view; those outside of the circle are not finite.
    const std::vector<ray::ParallelRays>& rays() const;

    /// Coverage and light (premultiplied) of each sample of each view.
    using Pictures = std::vector<glm::vec4>;
    Pictures shown(const TracedPictures& traced, const ray::MeshSkin* skin) const;
    /// The sum of light and coverage over all samples of all views.
    static glm::dvec4 total(const TracedPictures& traced, const ray::MeshSkin* skin);
    /// The point that each sample shows, in metres from the middle; not finite where there is
    /// nothing.
    std::vector<glm::vec3> points_of(const TracedPictures& traced) const;
    /// The size at which pictures agree.
    struct AgreementSize {
        double error = 0;      // metres, for PictureAgreement::error
        bool smallest = true;  // true: they agree at the smallest size
    };
    AgreementSize agreement_size(const Pictures& other) const;
    /// How far pictures of that pixel differ over what is allowed: above 1 they do not agree.
    double misses_of(const Pictures& other, const std::vector<PictureRect>& parts, int pixel) const;

    glm::dvec3 center_{0.0};
    double radius_ = 0;
    int side_;
    PictureViews views_;
    /// The place of each sample in its picture, in half sides from the middle.
    std::vector<glm::dvec2> places_;
    Pictures finest_;
    std::vector<glm::vec3> finest_points_;
    glm::dvec4 finest_total_{0.0};
    mutable std::once_flag aimed_;  // fills rays_ when they are first asked for
    mutable std::vector<ray::ParallelRays> rays_;
};

class AgreementReference::TracedPictures {
    friend AgreementReference;

    struct TracedSample {
        uint32_t triangle = ray::kNoTriangle;  // kNoTriangle: nothing is there
        float u = 0;
        float v = 0;
        float light = 0;
    };
    /// The sums over all samples of one slot.
    struct SlotLight {
        double light = 0;
        double count = 0;
    };
    explicit TracedPictures(const Mesh& mesh) : mesh_(&mesh) {}

    const Mesh* mesh_;
    std::vector<TracedSample> samples_;
    std::vector<SlotLight> by_slot_;
};

}  // namespace lodestone::measure

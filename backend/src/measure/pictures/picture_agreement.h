// SPDX-License-Identifier: GPL-3.0-or-later
// PictureAgreement: from which pixel size on pictures of a stand-in and of the finest look the same.
#pragma once

#include "base/job.h"
#include "ray/mesh_scene.h"

#include <array>
#include <vector>

namespace lodestone::measure {

/// Pictures agree when, over the covered pixels of all of them, the mean difference of coverage
/// (0...1) is at most this, ...
inline constexpr double kMostCoverageOff = 0.10;
/// ... and that of light, over the mean light of the finest's, at most this.
inline constexpr double kMostLightOff = 0.20;

struct PictureAgreement {
    double error = 0;       // the smallest pixel size at which pictures agree, metres
    double coverage = 0;    // all covered area of the stand-in over that of the finest
    glm::dvec3 light{0.0};  // the finest's mean light where covered over the stand-in's, by color
};

/// The error of what is not solid: foliage, fences, crowds, things one can see through. If single
/// leaves are missing, the distance to the nearest other leaf tells nothing; how much of a pixel is
/// covered and how bright it is does.
///
/// Pictures are orthographic, along 13 axes (the opposite directions cover the same), of a diffuse
/// surface under a uniform sky, which gives a quarter of the light, and a sun that stands obliquely
/// beside the viewer, with shadows; glass refracts what lies behind it. Both meshes are sampled by
/// the same rays. Larger pixels are means of smaller ones. Sampling noise is taken out of the
/// differences.
class AgreementReference {
public:
    /// Samples along a side of the finest's bounding square; the smallest pixel is two wide.
    static constexpr int kSide = 90;
    /// Enough for what is coarse anyway, four times faster.
    static constexpr int kCoarseSide = 45;
    /// Enough for how bright something is, and for pixels of a sixth of its size.
    static constexpr int kBrightSide = 30;

    /// Keeps the pictures alone. `side` is one of these. Throws Error: InvalidArgument,
    /// RaysUnavailable, Cancelled.
    AgreementReference(const Mesh& finest, const ray::SkinPtr& skin, uint64_t seed,
                       int side = kSide, const Job& job = {});
    /// The same with a scene made from this mesh, and this skin, before.
    AgreementReference(const Mesh& finest, const ray::MeshScene& scene, const ray::SkinPtr& skin,
                       uint64_t seed, int side, const Job& job);

    /// Same bits on any number of threads. Two meshes that show nothing agree at every size. If the
    /// pictures agree at no size, the error is one to two sides of the picture, the more they
    /// differ.
    PictureAgreement of(const Mesh& stand_in, const ray::SkinPtr& skin, const Job& job = {}) const;

    /// Which point of a stand-in each sample of the pictures shows, and how much light falls on it.
    /// This takes most of the time, and is the same for all skins with the same transparency.
    class TracedPictures;
    /// Keeps a reference to the mesh. Same bits on any number of threads.
    TracedPictures trace(const Mesh& stand_in, const ray::SkinPtr& skin, const Job& job = {}) const;
    /// `skin` is the one it was traced in, or differs from that in colors and scales of textures
    /// alone.
    PictureAgreement of(const TracedPictures& stand_in, const ray::SkinPtr& skin) const;
    /// The error of gaps alone. The pictures compared are the finest's and one that differs from it
    /// only where the finest shows a point that has no visible point of the stand-in within twice
    /// `off` (and the distance of samples). Returns the smallest pixel size at which they agree (0:
    /// all sizes), or the error of of() if the stand-in covers much less in all.
    double gap_error(const TracedPictures& stand_in, const ray::SkinPtr& skin, double off) const;
    /// As of(), without the error.
    PictureAgreement brightness_of(const TracedPictures& stand_in, const ray::SkinPtr& skin) const;

private:
    static constexpr size_t kViews = 13;

    TracedPictures trace(const Mesh& stand_in, const ray::MeshScene& scene,
                         const ray::SkinPtr& skin, const Job& job) const;

    /// Coverage and light (premultiplied) of each sample of each view.
    using Pictures = std::vector<glm::vec4>;
    Pictures shown(const TracedPictures& traced, const ray::MeshSkin* skin) const;
    /// All of it.
    static glm::dvec4 total(const TracedPictures& traced, const ray::MeshSkin* skin);
    /// Of each sample, from the middle; not finite where there is nothing.
    std::vector<glm::vec3> points_of(const TracedPictures& traced) const;
    struct AgreementSize {
        double error = 0;      // as PictureAgreement::error
        bool smallest = true;  // they agree at the smallest size
    };
    AgreementSize agreement_size(const Pictures& other) const;

    glm::dvec3 center_{0.0};
    double radius_ = 0;
    int side_;
    std::vector<glm::dvec2>
        places_;  // of each sample in its picture, in half sides from the middle
    Pictures finest_;
    std::vector<glm::vec3> finest_points_;
    glm::dvec4 finest_total_{0.0};
};

class AgreementReference::TracedPictures {
    friend AgreementReference;

    struct TracedSample {
        uint32_t triangle = ray::kNoTriangle;  // none: nothing is there
        float u = 0;
        float v = 0;
        float light = 0;
    };
    /// What the samples of a slot have together.
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

// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that each part of a surface has a deviation of its own.
#include "base/parallel.h"
#include "measure/deviation/part_deviations.h"
#include "scenes/fine_grids.h"
#include "scenes/with_rays.h"

#include <algorithm>

using namespace lodestone;

namespace {

class PartDeviations : public WithRays {
protected:
    /// The parts of a mesh: the triangles that begin left of each line, and those right of all.
    struct Parts {
        std::vector<uint32_t> order;
        std::vector<uint32_t> before{0};
    };
    static Parts parts_of(const Mesh& mesh, const std::vector<float>& lines) {
        Parts out;
        float from = -1;
        for (size_t i = 0; i <= lines.size(); ++i) {
            const float to = i < lines.size() ? lines[i] : 2;
            for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
                const float x = mesh.positions[mesh.triangles[t].x].x;
                if (x >= from && x < to)
                    out.order.push_back(t);
            }
            out.before.push_back(static_cast<uint32_t>(out.order.size()));
            from = to;
        }
        return out;
    }
    static std::vector<measure::SurfaceDeviation> deviations(const Mesh& finest, const Mesh& other,
                                                             const std::vector<float>& lines) {
        const ray::MeshScene scene(finest);
        const ray::MeshScene other_scene(other);
        const Parts parts = parts_of(finest, lines);
        const Parts others = parts_of(other, lines);
        return measure::part_deviations({finest, scene, parts.order, parts.before},
                                        {other, other_scene, others.order, others.before}, 1, {});
    }
};

/// A unit square, lifted by a tenth where x is over a half.
Mesh step(uint32_t n) {
    Mesh mesh = shapes::grid(n);
    for (glm::vec3& position : mesh.positions)
        position.z = position.x > 0.5f ? 0.1f : 0;
    return mesh;
}

}  // namespace

TEST_F(PartDeviations, APartOfNothingIsNotOff) {
    const Mesh mesh = shapes::grid(8);
    const auto found = deviations(mesh, step(8), {-0.5f});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].error, 0);
    EXPECT_EQ(found[0].max, 0);
}

TEST_F(PartDeviations, TheSameIsNowhereOff) {
    const Mesh mesh = step(16);
    for (const measure::SurfaceDeviation& part : deviations(mesh, mesh, {0.25f, 0.5f, 0.75f}))
        EXPECT_LT(part.max, 1e-6);
}

TEST_F(PartDeviations, EachPartIsAsFarOffAsWhatIsInIt) {
    const auto found = deviations(shapes::grid(16), step(16), {0.25f, 0.75f});
    ASSERT_EQ(found.size(), 3u);
    EXPECT_LT(found[0].error, 1e-6);
    EXPECT_NEAR(found[2].error, 0.1, 1e-6);
    EXPECT_LE(found[1].error, found[1].max);
    EXPECT_NEAR(found[1].max, 0.1, 1e-3);
}

TEST_F(PartDeviations, WhatIsGoneIsMissedAndWhatIsNewIsSeen) {
    const Mesh mesh = shapes::grid(16);
    Mesh with = mesh;
    append(with, shapes::moved(shapes::grid(2), {0.5, 0.5, 3}), {});  // a roof, from 0.5 to 1.5
    for (const auto& found : {deviations(with, mesh, {0.5f}), deviations(mesh, with, {0.5f})}) {
        EXPECT_LT(found[0].error, 1e-6);
        EXPECT_NEAR(found[1].error, 3, 0.1);
    }
}

TEST_F(PartDeviations, ThreadsChangeNothing) {
    const Mesh mesh = shapes::grid(32);
    const std::vector<float> lines{0.2f, 0.4f, 0.6f, 0.8f};
    const auto many = deviations(mesh, step(20), lines);
    const ThreadLimit one(1);
    const auto alone = deviations(mesh, step(20), lines);
    for (size_t i = 0; i < many.size(); ++i) {
        EXPECT_EQ(many[i].error, alone[i].error);
        EXPECT_EQ(many[i].max, alone[i].max);
    }
}

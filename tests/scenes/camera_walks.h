// SPDX-License-Identifier: GPL-3.0-or-later
// Walks of a camera, whose cut goes along with it and is compared with one made anew.
#pragma once

#include "choose/follow/cut_stepper.h"
#include "choose/ray_class/ray_cut.h"
#include "scenes/random_models.h"

#include <functional>
#include <map>
#include <tuple>

namespace lodestone::forest {

inline std::shared_ptr<const choose::ChoiceTable> table_of(const Model& model) {
    return std::make_shared<const choose::ChoiceTable>(
        choose::ChoiceTable::whole(model, model.root, kAllKinds));
}

/// A camera that is turned around the vertical: its pixels differ in the last bits.
inline void turn(View& view, double angle) {
    const glm::dvec3 across(std::cos(angle), std::sin(angle), 0);
    view.camera.right = glm::length(view.camera.right) * across;
    view.camera.direction = glm::cross(glm::dvec3(0, 0, 1), across);
    view.camera.up = {0, 0, glm::length(view.camera.up)};
}

/// What ray classes meet is the same; returns how much of it is their own.
inline size_t expect_same_rays(const Model& model, const View& view, const choose::Cut& a,
                               const choose::Cut& b, const choose::ShapeOf& shape_of) {
    const auto rays = choose::choose_rays(model, view, a, shape_of);
    const auto anew = choose::choose_rays(model, view, b, shape_of);
    size_t own = 0;
    EXPECT_EQ(rays.size(), anew.size());
    for (size_t i = 0; i < std::min(rays.size(), anew.size()); ++i) {
        EXPECT_EQ(rays[i].rays, anew[i].rays);
        EXPECT_EQ(rays[i].states, anew[i].states);
        EXPECT_EQ(rays[i].triangles, anew[i].triangles);
        EXPECT_EQ(rays[i].bytes, anew[i].bytes);
        EXPECT_EQ(rays[i].met, anew[i].met);
        EXPECT_EQ(rays[i].largest_error_px, anew[i].largest_error_px);
        EXPECT_EQ(rays[i].own.size(), anew[i].own.size());
        for (size_t k = 0; k < std::min(rays[i].own.size(), anew[i].own.size()); ++k) {
            const choose::RayChoice& one = rays[i].own[k];
            const choose::RayChoice& other = anew[i].own[k];
            EXPECT_EQ(std::tie(one.node, one.lod, one.scale, one.error, one.error_px, one.soft,
                               one.alone),
                      std::tie(other.node, other.lod, other.scale, other.error, other.error_px,
                               other.soft, other.alone));
        }
        own += rays[i].own.size();
    }
    return own;
}

/// Each mesh and solid is measured once.
inline choose::ShapeOf measured_once() {
    using Key = std::pair<const Representation*, const Representation*>;
    auto known = std::make_shared<std::map<Key, choose::RayShape>>();
    return [known](const Representation& mesh, const Representation* solid) {
        const auto found = known->find({&mesh, solid});
        if (found != known->end())
            return found->second;
        return known->emplace(Key{&mesh, solid}, choose::shape_of(mesh, solid)).first->second;
    };
}

struct Walked {
    double looked = 0;  // share of nodes that was looked at in steps from a known cut
    size_t own = 0;     // that rays met and the camera did not
};

/// Walks over a forest, most steps short, some far, and compares every cut and what rays meet of
/// it. `change`: what else becomes of the view between steps.
inline Walked walk(
    Forest& forest, View view, int steps, const std::function<void(View&)>& change = [](View&) {}) {
    Walked walked;
    const auto table = table_of(forest.model);
    const choose::ShapeOf shape_of = measured_once();
    choose::CutStepper stepper(table);
    choose::Cut cut;
    double looked = 0;
    double all = 0;
    size_t most = 0;
    for (int step = 0; step < steps; ++step) {
        stepper.step(view, cut);
        const choose::Cut anew = choose::choose_cut(*table, view);
        expect_same(cut, anew);
        if (view.modifiers.ray_classes != 0)
            walked.own += expect_same_rays(forest.model, view, cut, anew, shape_of);
        most = std::max(most, cut.nodes.size());
        EXPECT_LE(cut.transforms.size(), most) << "those of what is gone are used again";
        if (testing::Test::HasFailure()) {
            ADD_FAILURE() << "at step " << step;
            return {1, 0};
        }
        looked += step > 0 ? static_cast<double>(stepper.decided_nodes()) : 0;
        all += step > 0 ? static_cast<double>(cut.nodes.size()) : 0;
        const double far = forest.any() < 0.1 ? 400 : std::exp2(8 * forest.any() - 6);
        for (int axis = 0; axis < 3; ++axis)
            view.camera.position[axis] += far * (forest.any() - 0.5);
        if (forest.any() < 0.3)
            turn(view, 6 * forest.any());
        change(view);
    }
    walked.looked = looked / all;
    return walked;
}

}  // namespace lodestone::forest

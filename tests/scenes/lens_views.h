// SPDX-License-Identifier: GPL-3.0-or-later
// Models and views for what bends quality, shared by its tests.
#pragma once

#include "choose/cut.h"
#include "scenes/small_models.h"

namespace lodestone::bent {

constexpr ObjectIndex kBall = 0;
constexpr ObjectIndex kPair = 1;

/// Two pairs of balls of radius 1 at x = 0, 3, 6, 9. LOD 1 of a ball is off by .1 m, LOD 2 by .2, a
/// pair's by .4: from 300 m a pixel is .47 m, and each pair is drawn as one.
inline Model pairs(int balls = 4) {
    Model model = models::row_of_balls(balls);
    models::add_level(model, kBall, 0.1, shapes::sphere(1, 1));
    models::add_level(model, kBall, 0.2, shapes::sphere(1, 0));
    models::add_level(model, kPair, 0.4, shapes::cube());
    summarize_assemblies(model, bottom_up(model));
    return model;
}

/// Path and level of everything drawn, e.g. "pair 0/left 2, pair 1 1".
inline std::string drawn(const Model& model, const choose::Cut& cut) {
    std::string out;
    for (const uint32_t index : cut.chosen) {
        out += out.empty() ? "" : ", ";
        out += choose::path_of(model, cut, index) + ' ' + std::to_string(cut.nodes[index].lod);
    }
    return out;
}

inline std::string drawn(const Model& model, const View& view) {
    return drawn(model, choose::choose_cut(model, view));
}

inline DetailLens lens(double x, double radius, double strength) {
    DetailLens made;
    made.name = "lens";
    made.transform = models::moved(x, 0, 0);
    made.radius = radius;
    made.strength = strength;
    return made;
}

inline ScreenLens screen_lens(double x, double y, double radius, double strength) {
    return {"disc", {x, y}, radius, strength, 1};
}

/// Bends quality in one way after the other, `way` counting them from 0. False: there are no more.
inline bool bend(QualityModifiers& modifiers, int way) {
    // A new modifier breaks this line, so that its author adds a case. Lenses have tests of their
    // own, and classes of rays leave the camera's cut as it is.
    auto& [criterion, lenses, screen_lenses, depth, depth_focus, when_moving, closing, when_dark,
           off_screen, ray_classes] = modifiers;
    switch (way) {
        case 0:
            screen_lenses = {screen_lens(320, 180, 200, 3)};
            return true;
        case 1:
            depth = 1.5;
            depth_focus = 20;
            return true;
        case 2:
            when_moving = true;
            return true;
        case 3:
            when_dark = true;
            return true;
        case 4:
            off_screen = OffScreen::Shadows;
            return true;
        case 5:
            criterion = DetailCriterion::Area;
            return true;
        case 6:
            criterion = DetailCriterion::Feature;
            return true;
        default:
            return false;
    }
}
inline int ways_to_bend() {
    QualityModifiers any;
    int ways = 0;
    while (bend(any, ways))
        ++ways;
    return ways;
}

/// Bound of a ball.
inline Bound ball(const glm::dvec3& center, double radius) {
    Bound bound;
    bound.center = center;
    bound.radius = radius;
    bound.box = {center - radius, center + radius};
    return bound;
}

inline void move(Model& model, ObjectIndex group, size_t position, const Affine& closing) {
    Representation& finest = model.objects[group].representations[0];
    auto changed = std::make_shared<Assembly>(finest.assembly());
    changed->placements[position].closing = std::make_shared<const Affine>(closing);
    finest.payload = std::shared_ptr<const Assembly>(changed);
}

}  // namespace lodestone::bent

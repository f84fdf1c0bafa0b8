// SPDX-License-Identifier: GPL-3.0-or-later
// Furnished models: things in openings, of which little of the sky is seen.
#pragma once

#include "scenes/small_models.h"

namespace lodestone::models {

inline void add_box(Mesh& mesh, const glm::dvec3& low, const glm::dvec3& size) {
    append(mesh, shapes::box(low, low + size), {});
}

/// A chair with four legs and a back of slats, 0.9 m high.
inline Mesh chair() {
    constexpr double kLeg = 0.035;
    Mesh mesh;
    for (const double x : {0.0, 0.42 - kLeg}) {
        add_box(mesh, {x, 0, 0}, {kLeg, kLeg, 0.45});
        add_box(mesh, {x, 0.42 - kLeg, 0}, {kLeg, kLeg, 0.9});
    }
    add_box(mesh, {0, 0, 0.45}, {0.42, 0.42, 0.03});
    for (int i = 0; i < 5; ++i)
        add_box(mesh, {0, 0.4, 0.52 + 0.08 * i}, {0.42, 0.015, 0.04});
    return mesh;
}

inline Mesh table() {
    Mesh mesh;
    for (const double x : {0.0, 1.53}) {
        for (const double y : {0.0, 0.73})
            add_box(mesh, {x, y, 0}, {0.07, 0.07, 0.72});
    }
    add_box(mesh, {0, 0, 0.72}, {1.6, 0.8, 0.03});
    return mesh;
}

/// Shelves 0.9 m wide with books that stand at all depths.
inline Mesh bookcase() {
    Mesh mesh;
    add_box(mesh, {-0.03, 0, 0}, {0.03, 0.3, 2});
    add_box(mesh, {0.9, 0, 0}, {0.03, 0.3, 2});
    add_box(mesh, {0, 0.28, 0}, {0.9, 0.02, 2});
    for (int shelf = 0; shelf < 5; ++shelf) {
        const double z = 0.4 * shelf;
        add_box(mesh, {0, 0, z}, {0.9, 0.28, 0.02});
        for (int book = 0; book < 18; ++book) {
            const int number = 18 * shelf + book;
            if (number % 7 == 3)
                continue;
            add_box(mesh, {0.05 * book, 0.03 + 0.01 * (number * 5 % 9), z + 0.02},
                    {0.044, 0.15, 0.2 + 0.01 * (number * 3 % 11)});
        }
    }
    return mesh;
}

/// Without a ceiling, as interiors are looked into: 6 x 4 m, with what stands in it.
inline Model furnished_room() {
    Model model;
    Mesh walls;
    add_box(walls, {-0.2, -0.2, -0.1}, {6.4, 4.4, 0.1});
    add_box(walls, {-0.2, -0.2, 0}, {6.4, 0.2, 2.6});
    add_box(walls, {-0.2, 4, 0}, {6.4, 0.2, 2.6});
    add_box(walls, {-0.2, 0, 0}, {0.2, 4, 2.6});
    add_box(walls, {6, 0, 0}, {0.2, 4, 2.6});
    const ObjectIndex shell = add_leaf(model, "walls", walls, colored("wall", glm::dvec3(0.7)));
    const ObjectIndex one_chair =
        add_leaf(model, "chair", chair(), colored("wood", {0.4, 0.2, 0.1}));
    const ObjectIndex one_table =
        add_leaf(model, "table", table(), colored("wood", {0.5, 0.3, 0.1}));
    const ObjectIndex books =
        add_leaf(model, "bookcase", bookcase(), colored("books", {0.3, 0.3, 0.5}));
    const ObjectIndex lamp =
        add_leaf(model, "lamp", shapes::sphere(0.2, 3), colored("lamp", glm::dvec3(0.8)));
    std::vector<Placement> placements{{shell, {}, "walls"},
                                      {one_table, moved(2, 1.6, 0), "table"},
                                      {lamp, moved(2.8, 2, 0.95), "lamp"},
                                      {books, moved(0.5, 3.7, 0), "left case"},
                                      {books, moved(4.5, 3.7, 0), "right case"}};
    for (int i = 0; i < 6; ++i)
        placements.push_back({one_chair, moved(1.5 + 0.6 * (i % 3), i < 3 ? 0.9 : 2.6, 0),
                              "chair " + std::to_string(i)});
    model.root = add_group(model, "room", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    return model;
}

/// A bookcase whose boards and books are objects.
inline Model bookcase_of_books() {
    Model model;
    Mesh boards;
    add_box(boards, {-0.03, 0, 0}, {0.03, 0.3, 2});
    add_box(boards, {0.9, 0, 0}, {0.03, 0.3, 2});
    add_box(boards, {0, 0.28, 0}, {0.9, 0.02, 2});
    for (int shelf = 0; shelf < 5; ++shelf)
        add_box(boards, {0, 0, 0.4 * shelf}, {0.9, 0.28, 0.02});
    Mesh pages = shapes::book(6, 0.006f);
    for (glm::vec3& point : pages.positions)
        point *= glm::vec3(0.15f, 0.17f, 1);
    const ObjectIndex frame = add_leaf(model, "boards", boards, colored("wood", {0.4, 0.2, 0.1}));
    const ObjectIndex book = add_leaf(model, "book", pages, colored("paper", glm::dvec3(0.8)));
    std::vector<Placement> placements{{frame, {}, "boards"}};
    for (int i = 0; i < 70; ++i) {
        Placement one{
            book, moved(0.06 * (i % 14) + 0.06, 0.02 + 0.01 * (i * 5 % 9), 0.4 * (i / 14) + 0.02),
            "book " + std::to_string(i)};
        // Upright, the back to the wall.
        one.transform.linear = glm::dmat3(0, 1, 0, 0, 0, 1, -1, 0, 0);
        placements.push_back(std::move(one));
    }
    model.root = add_group(model, "bookcase", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    return model;
}

/// A body with open windows, seats inside and wheels below.
inline Model car() {
    Model model;
    Mesh body = shapes::ellipsoid({2.2, 0.9, 0.7}, 4);
    std::erase_if(body.triangles, [&](const Triangle& t) {
        const glm::vec3 middle =
            (body.positions[t.x] + body.positions[t.y] + body.positions[t.z]) / 3.0f;
        return middle.z > 0.15f && middle.z < 0.5f && std::abs(middle.x) < 1.2f;
    });
    const ObjectIndex shell = add_leaf(model, "body", body, colored("paint", {0.6, 0.1, 0.1}));
    Mesh seat;
    add_box(seat, {-0.25, -0.25, 0}, {0.5, 0.5, 0.15});
    add_box(seat, {0.2, -0.25, 0}, {0.1, 0.5, 0.6});
    append(seat, shapes::sphere(0.09, 2), {glm::dmat3(1.0), {0.25, 0, 0.66}});
    const ObjectIndex one_seat = add_leaf(model, "seat", seat, colored("cloth", glm::dvec3(0.2)));
    Mesh ring = shapes::torus(24, 8);
    for (glm::vec3& point : ring.positions)
        point = {0.3f * point.x, 0.3f * point.z, 0.3f * point.y};
    for (Triangle& t : ring.triangles)
        std::swap(t.y, t.z);
    const ObjectIndex wheel = add_leaf(model, "wheel", ring, colored("rubber", glm::dvec3(0.05)));
    std::vector<Placement> placements{{shell, moved(0, 0, 0.9), "body"}};
    for (int i = 0; i < 4; ++i) {
        const double x = i % 2 == 0 ? 1 : -1;
        const double y = i < 2 ? 1 : -1;
        placements.push_back({wheel, moved(1.3 * x, 0.75 * y, 0.35), "wheel " + std::to_string(i)});
        placements.push_back(
            {one_seat, moved(0.45 * x, 0.35 * y, 0.5), "seat " + std::to_string(i)});
    }
    model.root = add_group(model, "car", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    return model;
}

}  // namespace lodestone::models

// SPDX-License-Identifier: GPL-3.0-or-later
// Guards meshes whose corners have textures of their own: POV-Ray weighs them right wherever a
// mesh stands and however large it is.
#include "povray/povray_scenes.h"
#include "scenes/with_rays.h"

#include <glm/geometric.hpp>

#include <regex>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

namespace {

/// A wall of `width` x `height` cells of `cell` metres on the ground at `place`, that stands
/// upright, turned by `angle`.
struct AslantWall {
    glm::dvec3 place{-37.1, -140.3, 0.45};
    double cell = 2.3;
    int width = 6;
    int height = 5;
    double angle = 0.7;

    glm::dvec3 along() const { return {std::cos(angle), std::sin(angle), 0}; }
    glm::dvec3 out() const { return {std::sin(angle), -std::cos(angle), 0}; }
    glm::dvec3 middle() const {
        return place + along() * (width * cell / 2) + glm::dvec3(0, 0, height * cell / 2);
    }

    Mesh mesh() const {
        Mesh mesh;
        for (int y = 0; y <= height; ++y) {
            for (int x = 0; x <= width; ++x)
                mesh.positions.emplace_back(place + along() * (x * cell) +
                                            glm::dvec3(0, 0, y * cell));
        }
        const auto at = [&](int x, int y) { return static_cast<uint32_t>(y * (width + 1) + x); };
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
                mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
            }
        }
        return mesh;
    }

    /// Sees the wall from its front, and nothing beside it.
    View view() const {
        View view;
        view.width = 48;
        view.height = 40;
        view.camera.orthographic = true;
        view.camera.position = middle() + out() * (10 * cell);
        view.camera.direction = -out();
        view.camera.right = along() * (width * cell * 0.96);
        view.camera.up = {0, 0, height * cell * 0.96};
        return view;
    }
};

class CornerTextures : public WithRays {
protected:
    CornerTextures() {
        std::filesystem::remove_all(own_scratch());
        options.folder = own_scratch() / "scene";
        options.shading.sky_rays = 128;
    }

    /// A wall on the ground, with the sky as its only light.
    const Model& model_of(const AslantWall& wall, const Texture& bumps = {}) {
        builder.model.world.color = glm::dvec3(0.5);
        const uint32_t gray = builder.matte({.8, .8, .8});
        Material material = builder.model.materials[gray];
        material.bump_texture = bumps;
        material.bump_distance = 0.1;
        Mesh mesh = wall.mesh();
        for (const glm::vec3& at : mesh.positions)
            mesh.uvs.emplace_back(at.x, at.z);
        builder.place(builder.mesh(mesh, {builder.material(material)}));
        const double reach = wall.cell * 90;
        const ObjectIndex ground =
            builder.mesh(shapes::box({-reach, -reach, -wall.cell}, {reach, reach, 0}), {gray});
        builder.place_at(ground, wall.middle() - glm::dvec3(0, 0, wall.height * wall.cell / 2));
        // A hedge before the wall, which the camera does not see.
        const glm::dvec3 hedge = wall.place + wall.along() * (2.5 * wall.cell);
        builder.place(
            builder.mesh(shapes::box(glm::dvec3(-wall.cell), glm::dvec3(wall.cell)), {gray}),
            {glm::dmat3(1.0), hedge + wall.out() * (1.6 * wall.cell)}, "hedge", kCameraRays);
        return builder.finish();
    }

    Builder builder;
    ExportOptions options;
};

}  // namespace

// The walls of a house that stood aslant had triangles twice as bright as their neighbours.
TEST_F(CornerTextures, WallsThatStandAslantWerePatchy) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    for (const double size : {0.01, 1.0, 5.0, 40.0}) {
        for (const double angle : {0.2, 0.7, 1.3}) {
            AslantWall wall;
            wall.angle = angle;
            wall.place *= size;
            wall.cell *= size;
            builder = {};
            options.folder = own_scratch() / text(size, "-", angle);
            const scenes::Image image = scenes::render(model_of(wall), wall.view(), options);
            double least = 1;
            double most = 0;
            for (int y = 0; y < image.height; ++y) {
                for (int x = 0; x < image.width; ++x) {
                    least = std::min(least, image.at(x, y).x);
                    most = std::max(most, image.at(x, y).x);
                }
            }
            // A wall before a ground sees the upper half of the sky, and less behind a hedge.
            EXPECT_NEAR(most, 0.235, 0.005) << size << ", " << angle;
            EXPECT_NEAR(least, 0.065, 0.02) << size << ", " << angle;
        }
    }
}

TEST_F(CornerTextures, PositionsAreAFewUnitsFromTheMiddleOfTheMesh) {
    for (const double size : {1.0, 0.001, 5000.0}) {
        AslantWall wall;
        wall.place *= size;
        wall.cell *= size;
        builder = {};
        Problems problems;
        scenes::write(model_of(wall), wall.view(), options, problems);
        size_t meshes = 0;
        for (const auto& file : std::filesystem::directory_iterator(options.folder / "r")) {
            const std::string text = read_file(file.path());
            if (text.find("texture_list") == std::string::npos)
                continue;
            ++meshes;
            EXPECT_NE(text.find("scale "), std::string::npos);
            const size_t begin = text.find("vertex_vectors{");
            const size_t end = text.find('}', begin);
            ASSERT_NE(end, std::string::npos);
            double largest = 0;
            static const std::regex kPoint(R"(<([-.\d]+),([-.\d]+),([-.\d]+)>)");
            for (std::sregex_iterator it(text.begin() + static_cast<ptrdiff_t>(begin),
                                         text.begin() + static_cast<ptrdiff_t>(end), kPoint);
                 it != std::sregex_iterator(); ++it) {
                for (int axis = 1; axis <= 3; ++axis)
                    largest = std::max(largest, std::abs(std::stod((*it)[axis])));
            }
            EXPECT_LE(largest, 2.001) << size;
            EXPECT_GE(largest, 0.999) << size;
        }
        EXPECT_GE(meshes, 1u) << size;
        std::filesystem::remove_all(options.folder);
    }
}

// Patches of bumps were 26 steps of 255 off: a mesh that is scaled has flatter bumps.
TEST_F(CornerTextures, MeshesWithBumpsKeepTheirUnits) {
    for (const bool bumped : {false, true}) {
        builder = {};
        Problems problems;
        const Model& model = model_of({}, bumped ? scenes::checker() : Texture{});
        scenes::write(model, AslantWall{}.view(), options, problems);
        size_t scaled = 0;
        for (const auto& file : std::filesystem::directory_iterator(options.folder / "r")) {
            const std::string text = read_file(file.path());
            const bool list = text.find("texture_list") != std::string::npos;
            scaled += list && text.find("scale ") != std::string::npos ? 1 : 0;
        }
        EXPECT_EQ(scaled, bumped ? 1u : 2u);  // the ground has none
        std::filesystem::remove_all(options.folder);
    }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is kept of pictures: a later process finds it, and damage or nonsense is found anew.
#include "base/files.h"
#include "base/findings_file.h"
#include "image/bake/baked_image.h"
#include "image/picture_findings.h"
#include "image/texture_sampler.h"
#include "scratch.h"

using namespace lodestone;
using namespace lodestone::image;
namespace fs = std::filesystem;

namespace {

/// A folder in which nothing is kept, and pictures of which nobody knows anything.
class PictureFindings : public testing::Test {
protected:
    void SetUp() override { fs::remove_all(folder()); }
    void TearDown() override { keep_pictures(own_scratch() / "nothing"); }

    static fs::path folder() { return own_scratch() / "store"; }
    static fs::path file() { return folder() / "pictures.bin"; }

    static Image image(float red) {
        Image out;
        out.width = 3;
        out.height = 2;
        out.linear = true;
        for (int i = 0; i < 6; ++i)
            out.pixels.insert(out.pixels.end(), {red, 0.25f * static_cast<float>(i % 4), 0, 1});
        return out;
    }

    /// What the next process has: a folder that was written and is looked at again.
    static void another_process() {
        keep_pictures(folder());
        keep_pictures(own_scratch() / "elsewhere");
    }
};

}  // namespace

TEST_F(PictureFindings, WhatIsKeptIsFoundByTheNextProcess) {
    const PictureFacts facts{3, 2, {0.1, 0.2, 0.3, 1}};
    keep_pictures(folder());
    EXPECT_FALSE(known_facts(71));
    add_facts(71, facts);
    EXPECT_FALSE(fs::exists(file()));
    another_process();
    FindingsFile kept(file(), read_file(file()).substr(0, 8));
    ASSERT_TRUE(kept.find(71));
    // What the file says counts before what this process remembers.
    const PictureFacts other{5, 4, {0.4, 0.5, 0.6, 1}};
    kept.add(71, std::string(reinterpret_cast<const char*>(&other), sizeof other));
    kept.save();
    keep_pictures(folder());
    ASSERT_TRUE(known_facts(71));
    EXPECT_EQ(known_facts(71)->width, 5);
    EXPECT_EQ(known_facts(71)->mean, other.mean);
}

TEST_F(PictureFindings, NonsenseIsNotFound) {
    keep_pictures(folder());
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    add_facts(81, {0, 2, {}});
    add_facts(82, {2, -1, {}});
    add_facts(83, {1 << 30, 1 << 30, {}});
    add_facts(84, {2, 2, {0, nothing, 0, 0}});
    add_facts(85, {2, 2, {}});
    another_process();
    FindingsFile kept(file(), read_file(file()).substr(0, 8));
    kept.add(85, "short");
    kept.save();
    const PicturePtr made =
        make_picture(packed(image(0.1f)), PngEffort::Quick, ColorSpace::Srgb, "one");
    const PictureFacts wrong{7, 7, {9, 9, 9, std::numeric_limits<double>::infinity()}};
    kept.add(made->hash, std::string(reinterpret_cast<const char*>(&wrong), sizeof wrong));
    kept.save();
    keep_pictures(folder());
    const PicturePtr again = make_picture(made->bytes, ColorSpace::Srgb, "one");
    EXPECT_EQ(again->width, 3);
    EXPECT_EQ(again->mean, made->mean);
    EXPECT_EQ(known_facts(85)->width, 2);  // this process knows
}

TEST_F(PictureFindings, BakesAreKeptAndBakedAnewWhereTheyAreDamaged) {
    const auto bake = [](float red) {
        std::vector<BakeStep> steps(2);
        steps[0].op = BakeOp::Texel;
        steps[1].op = BakeOp::Channel;
        Texture texture;
        texture.picture =
            make_picture(packed(image(red)), PngEffort::Quick, ColorSpace::Srgb, "from");
        return bake_picture(steps, {texture}, 3, 2, ColorSpace::Srgb, "to");
    };
    keep_pictures(folder());
    const PicturePtr made = bake(0.5f);
    ASSERT_EQ(std::distance(fs::directory_iterator(folder() / "baked"), {}), 1);
    const fs::path png = fs::directory_iterator(folder() / "baked")->path();
    EXPECT_EQ(read_file(png), made->bytes);
    EXPECT_EQ(kept_bake(1), std::nullopt);
    keep_bake(1, "no picture");
    EXPECT_EQ(kept_bake(1), "no picture");
    write_file(png, "no picture");
    another_process();
    keep_pictures(folder());
    EXPECT_EQ(bake(0.5f)->bytes, made->bytes);
}

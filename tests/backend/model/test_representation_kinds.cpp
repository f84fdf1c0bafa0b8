// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the table of kinds: every kind has every entry, and what is told of its payload agrees.
#include "model/representation_kinds.h"
#include "povray_export/scene/representation_writer.h"
#include "povray_export/texture/surface_finish.h"
#include "scenes/small_models.h"
#include "segment/store_payloads.h"
#include "view/shown_mesh.h"

#include <gtest/gtest.h>
#include <set>

namespace lodestone {
namespace {

// Any costs that are not zero.
const CostModel kCosts{.triangle_bytes = 7, .primitive_bytes = 11, .occurrence_bytes = 13};
const Primitive kThing{{1, 2, 3}, glm::dmat3(1.0), {0.5, 0.25, 0.125}};

/// A payload of a kind. A new kind does not compile without one.
Payload sample_of(Kind kind) {
    switch (kind) {
        case Kind::Mesh:
            return std::make_shared<const Mesh>(tessellate_box(kThing));
        case Kind::Box:
        case Kind::Ellipsoid:
            return kThing;
        case Kind::Composite:
            return std::make_shared<const Composite>(
                Composite{{{true, kThing, 0}, {false, kThing, 0}}});
        case Kind::Assembly:
            return std::make_shared<const Assembly>(Assembly{{{0, models::moved(1, 2, 3), "it"}}});
    }
    return {};
}

std::vector<KindRow> drawn_rows() {
    std::vector<KindRow> rows;
    for (const KindRow& row : kKindRows) {
        if (row.drawn)
            rows.push_back(row);
    }
    return rows;
}

}  // namespace

TEST(RepresentationKinds, EachHasAWordOfItsOwn) {
    std::set<std::string> words;
    for (const KindRow& row : kKindRows) {
        EXPECT_TRUE(words.insert(row.word).second) << row.word;
        EXPECT_EQ(kind_named(row.word), row.kind);
        EXPECT_STREQ(name_of(row.kind), row.word);
        EXPECT_TRUE(is_kind(static_cast<int64_t>(row.kind)));
        EXPECT_EQ(&row_of(row.kind), &row);
    }
    EXPECT_FALSE(is_kind(0) || is_kind(-1) || is_kind(static_cast<int64_t>(kKindLimit)));
    EXPECT_THROW(kind_named("unknown"), Error);
    EXPECT_THROW(row_of(Kind{0}), Error);
}

TEST(RepresentationKinds, EachPayloadIsBoundedCostedHashedAndTessellated) {
    std::set<Hash> hashes;
    for (const KindRow& row : drawn_rows()) {
        const Payload payload = sample_of(row.kind);
        const Bound bound = bound_of(row.kind, payload);
        EXPECT_NEAR(bound.center.x, 1, 1e-9) << row.word;
        EXPECT_GT(cost_of(row.kind, payload, kCosts).bytes, 0u) << row.word;
        Hasher hasher;
        hasher.value(row.kind);
        add_to_hash(hasher, row.kind, payload);
        EXPECT_TRUE(hashes.insert(hasher.result()).second) << row.word;
        const Mesh mesh = tessellated(row.kind, payload, 2);
        EXPECT_FALSE(mesh.empty()) << row.word;
        for (const glm::vec3& position : mesh.positions)
            EXPECT_LE(glm::length(glm::dvec3(position) - bound.center), bound.radius + 1e-6)
                << row.word;
    }
}

TEST(RepresentationKinds, EachMovesWithItsPlace) {
    const Affine place = models::moved(10, 0, 0);
    for (const KindRow& row : drawn_rows()) {
        const Payload payload = sample_of(row.kind);
        const Payload there = moved(row.kind, payload, place);
        EXPECT_NEAR(bound_of(row.kind, there).center.x, 11, 1e-6) << row.word;
        EXPECT_TRUE(is_same(payload, payload) && !is_same(payload, there)) << row.word;
    }
}

TEST(RepresentationKinds, AssembliesAreNotDrawnThemselves) {
    const Payload payload = sample_of(Kind::Assembly);
    EXPECT_THROW(bound_of(Kind::Assembly, payload), Error);
    EXPECT_THROW(tessellated(Kind::Assembly, payload), Error);
    EXPECT_THROW(cost_of(Kind::Assembly, Payload(), kCosts), Error);
    EXPECT_EQ(kDrawnKinds & mask_of(Kind::Assembly), 0u);
}

TEST(RepresentationKinds, EachPayloadComesBackFromAStore) {
    for (const KindRow& row : kKindRows) {
        Representation from;
        from.summary.kind = row.kind;
        from.payload = sample_of(row.kind);
        segment::Json json = segment::Json::object();
        segment::write_payload(json, from);
        const Payload back = segment::read_payload(json, row.kind, {1, 1});
        if (row.kind == Kind::Mesh) {  // in a file of its own
            EXPECT_TRUE(json.empty() && back.index() == 0);
            continue;
        }
        EXPECT_EQ(back.index(), from.payload.index()) << row.word;
        Representation again = from;
        again.payload = back;
        segment::Json twice = segment::Json::object();
        segment::write_payload(twice, again);
        EXPECT_EQ(json.dump(), twice.dump()) << row.word;
        EXPECT_FALSE(json.empty()) << row.word;
    }
}

TEST(RepresentationKinds, EachIsWrittenForPovrayAndHasAFalseColor) {
    std::set<std::string> colors;
    for (const KindRow& row : drawn_rows()) {
        Representation representation;
        representation.summary.kind = row.kind;
        representation.payload = sample_of(row.kind);
        povray::PictureWriter pictures;
        povray::MaskOutlines outlines;
        const std::string text = povray::representation_text(
            {}, representation, "It", {false, false, std::nullopt}, pictures, outlines, {});
        EXPECT_EQ(text.rfind("#declare It = ", 0), 0u) << row.word;
        std::string color;
        povray::append_rgb(color, povray::color_of(row.kind, 1));
        EXPECT_TRUE(colors.insert(color).second) << row.word << " looks like another kind";
    }
}

TEST(RepresentationKinds, ViewersKnowHowManyTrianglesEachTakes) {
    for (const KindRow& row : drawn_rows()) {
        Representation representation;
        representation.summary.kind = row.kind;
        representation.payload = sample_of(row.kind);
        representation.summary.cost = cost_of(row.kind, representation.payload, kCosts);
        const size_t shown = view::shown_mesh(representation).triangles.size();
        EXPECT_GE(view::shown_triangles(representation.summary), shown) << row.word;
        if (!row.copied) {  // of several solids it is a guess from above
            EXPECT_EQ(view::shown_triangles(representation.summary), shown) << row.word;
        }
    }
}

}  // namespace lodestone

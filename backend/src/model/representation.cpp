// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/representation.h"

namespace lodestone {
namespace {

[[noreturn]] void wrong_payload(const Representation& representation, const char* wanted) {
    fail(Status::Internal, "a ", name_of(representation.summary.kind), " representation ",
         representation.resident() ? "was read as " : "is not resident: wanted ", wanted);
}

}  // namespace

const char* name_of(Kind kind) {
    switch (kind) {
        case Kind::Mesh:
            return "mesh";
        case Kind::Box:
            return "box";
        case Kind::Ellipsoid:
            return "ellipsoid";
        case Kind::Composite:
            return "composite";
        case Kind::Assembly:
            return "assembly";
    }
    return "unknown";
}

Kind kind_named(const std::string& word) {
    for (const Kind kind :
         {Kind::Mesh, Kind::Box, Kind::Ellipsoid, Kind::Composite, Kind::Assembly}) {
        if (word == name_of(kind))
            return kind;
    }
    fail(Status::BadFile, "'", word.substr(0, 40), "' is no kind of representation");
}

const Mesh& Representation::mesh() const {
    const auto* held = std::get_if<std::shared_ptr<const Mesh>>(&payload);
    if (held == nullptr || *held == nullptr)
        wrong_payload(*this, "mesh");
    return **held;
}

const Primitive& Representation::primitive() const {
    const auto* held = std::get_if<Primitive>(&payload);
    if (held == nullptr)
        wrong_payload(*this, "primitive");
    return *held;
}

const Assembly& Representation::assembly() const {
    const auto* held = std::get_if<std::shared_ptr<const Assembly>>(&payload);
    if (held == nullptr || *held == nullptr)
        wrong_payload(*this, "assembly");
    return **held;
}

const Composite& Representation::composite() const {
    const auto* held = std::get_if<std::shared_ptr<const Composite>>(&payload);
    if (held == nullptr || *held == nullptr)
        wrong_payload(*this, "composite");
    return **held;
}

Mesh tessellated(const Representation& representation, int subdivisions) {
    switch (representation.summary.kind) {
        case Kind::Box:
            return tessellate_box(representation.primitive());
        case Kind::Ellipsoid:
            return tessellate_ellipsoid(representation.primitive(), subdivisions);
        case Kind::Composite:
            return tessellate(representation.composite(), subdivisions);
        case Kind::Mesh:
        case Kind::Assembly:
            break;
    }
    return representation.mesh();
}

}  // namespace lodestone

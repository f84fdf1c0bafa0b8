// SPDX-License-Identifier: GPL-3.0-or-later
// Store payloads: the solids and placements of representations in the words of the store. Meshes
// lie in files of their own.
#pragma once

#include "model/representation.h"
#include "segment/json_values.h"

namespace lodestone::segment {

/// The numbers of the objects and slots that a payload may name.
struct PayloadLimits {
    size_t objects = 0;
    size_t slots = 0;
};

void write_payload(Json& json, const Representation& representation);

/// A mesh is not resident.
Payload read_payload(const Json& json, Kind kind, const PayloadLimits& limits);

}  // namespace lodestone::segment

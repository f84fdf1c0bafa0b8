// SPDX-License-Identifier: GPL-3.0-or-later
// PackedCache: decoded pictures that are shared.
#pragma once

#include "image/packed_image.h"
#include "model/picture.h"

namespace lodestone::image {

/// A decoded picture that is shared; it never changes once made.
using PackedPtr = std::shared_ptr<const PackedImage>;

/// The picture as its file holds it. Errors call it by its name. Throws Error(BadFile).
PackedPtr packed(const Picture& picture);

}  // namespace lodestone::image

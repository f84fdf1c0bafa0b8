// SPDX-License-Identifier: GPL-3.0-or-later
// Pigment pictures: the pictures that are made for pigments which their textures' own do not show.
#pragma once

#include "povray_export/texture/picture_writer.h"

namespace lodestone::povray {

/// Whether the content is one number a texel.
bool is_number(PigmentContent content);

/// The texels along a side of a picture that is halved so often.
int halved(int side, int halvings);

/// The PNG of a texture's content, halved so often. Throws Error(BadFile).
std::string pigment_picture(const Texture& texture, PigmentContent content, int halvings);

/// The largest number of a picture that can hold more than 1 (EXR); else 1. Throws Error(BadFile).
double brightest_of(const Picture& picture);

}  // namespace lodestone::povray

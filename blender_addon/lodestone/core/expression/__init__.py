# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors computed from images' texels: the terms, Blender's node maths as terms, and textures from them."""

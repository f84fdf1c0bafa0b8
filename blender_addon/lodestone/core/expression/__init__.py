# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors computed from images: terms, Blender's node math as terms, textures made of them."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's properties of Lodestone: on scenes, objects, collections, cameras and screens."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's data to plain buffers and back: the only folder that reads meshes and materials."""

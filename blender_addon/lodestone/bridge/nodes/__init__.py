# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's materials: node trees, images and looks, as the backend's materials."""

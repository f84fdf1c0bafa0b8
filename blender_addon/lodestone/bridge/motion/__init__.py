# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion: what moves and deforms in the course of an animation, and while the shutter is open."""

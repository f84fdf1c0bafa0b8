# SPDX-License-Identifier: GPL-3.0-or-later
"""Rules of the add-on that need no Blender: tested with plain Python, used by every operator."""

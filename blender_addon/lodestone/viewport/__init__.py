# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn into 3D Viewports: levels, false colors and the rims of lenses."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""Light: a scene's lights, and its world as a background."""

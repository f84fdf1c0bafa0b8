# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as it is now, between two renders: for viewports and for panels."""

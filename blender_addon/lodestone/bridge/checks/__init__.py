# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of a file, a scene or an extraction, which find what is wrong without rendering."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""Render engines: the one of F12, and one that only reads the scene."""

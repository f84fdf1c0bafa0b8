# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as a depsgraph shows it, read into a model of the backend: objects, groups, cameras."""

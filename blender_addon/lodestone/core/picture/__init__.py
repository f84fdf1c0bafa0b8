# SPDX-License-Identifier: GPL-3.0-or-later
"""The making of a picture from a model and a camera: its controls, its cost, what it drew and
why."""

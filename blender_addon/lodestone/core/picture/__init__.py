# SPDX-License-Identifier: GPL-3.0-or-later
"""From a model and a camera to a picture: its controls, its cost, what it drew and why."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""What lights a scene: its lights, and its world as a background."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview in viewports: where objects stand in a store, and the thread that draws its
levels."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""What viewports show of a store: where its objects stand, and the thread that draws them."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""What the running add-on remembers of its scenes until it is disabled; never part of a file."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""The memory of the running add-on about its scenes until it is disabled; never part of a file."""

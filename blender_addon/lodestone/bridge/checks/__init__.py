# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a file, a scene or an extraction, found without rendering."""

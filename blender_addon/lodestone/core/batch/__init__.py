# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything of batch.py outside Blender: its command line, its children, logs and reports."""

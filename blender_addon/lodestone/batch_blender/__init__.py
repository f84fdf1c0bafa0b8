# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of batch.py that runs inside Blender: file_run.py is its script."""

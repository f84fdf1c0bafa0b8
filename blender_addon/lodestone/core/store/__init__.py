# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder of computed levels: where it lies, which levels it holds, its motion.json."""

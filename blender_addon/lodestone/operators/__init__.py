# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators: each only calls a function that scripts and tests may call as well."""

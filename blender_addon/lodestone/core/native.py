# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place that knows where lodestone_native lies: in the package, or in the checkout."""

import sys
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]

if (_PACKAGE / "lodestone_native" / "__init__.py").is_file():
    from .. import lodestone_native
else:
    _CHECKOUT = _PACKAGE.parents[1] / "backend" / "python"
    if str(_CHECKOUT) not in sys.path:
        sys.path.append(str(_CHECKOUT))
    import lodestone_native

__all__ = ["lodestone_native"]

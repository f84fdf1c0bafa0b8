# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place that knows where lodestone_native lies: in the package, or where it was built."""

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

_PACKAGE = Path(__file__).resolve().parents[1]

if TYPE_CHECKING:
    import lodestone_native
elif (_PACKAGE / "lodestone_native" / "__init__.py").is_file():
    from .. import lodestone_native
else:
    _BUILD = os.environ.get("LODESTONE_BUILD") or _PACKAGE.parents[1] / "build" / "release"
    if str(Path(_BUILD) / "python") not in sys.path:
        sys.path.append(str(Path(_BUILD) / "python"))
    import lodestone_native

__all__ = ["lodestone_native"]

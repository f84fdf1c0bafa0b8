# SPDX-License-Identifier: GPL-3.0-or-later
"""What all benches share: the spread of rounds, how a table tells it, the JSON beside it."""

import json
import os
import statistics
from collections.abc import Sequence
from pathlib import Path
from typing import Any

ORDER = ("min", "median", "max")


def turns(rounds: int, kinds: Sequence[str]) -> list[tuple[int, str]]:
    """Which kind runs when: now the one first, now the other, so that a busy machine slows both."""
    return [
        (number, kind)
        for number in range(rounds)
        for kind in (kinds if number % 2 == 0 else tuple(reversed(kinds)))
    ]


def spread(numbers: Sequence[float]) -> dict[str, float]:
    return {"min": min(numbers), "median": statistics.median(numbers), "max": max(numbers)}


def cell(found: dict[str, float], unit: float = 1.0, digits: int = 2) -> str:
    """Minimum / median / maximum."""
    return " / ".join(f"{found[key] / unit:.{digits}f}" for key in ORDER)


def load() -> float:
    """Processes that want a core, on average of the last minute: above 1, times are noisy."""
    return os.getloadavg()[0]


def said(rounds: int, busy: float) -> str:
    return (
        f"minimum / median / maximum of {rounds} rounds; {os.cpu_count()} cores, load {busy:.1f} "
        "before the first"
    )


def write(path: Path, busy: float, data: dict[str, Any]) -> None:
    """The report of a bench, with what all of them have."""
    path.parent.mkdir(parents=True, exist_ok=True)
    whole = {
        "schema": 1,
        "verb": "bench",
        "cores": os.cpu_count(),
        "load_before": busy,
        **data,
    }
    path.write_text(json.dumps(whole, indent=1) + "\n", "utf-8")
    print(f"\n{path}")

"""pivotrig owns its environment: its package `control` must not meet another package of that name."""

from __future__ import annotations

import sys
from importlib.metadata import PackageNotFoundError, distribution


def check_environment() -> None:
    """End with a clear message when python-control, which is also imported as `control`, is installed here."""
    try:
        found = distribution("control")
    except PackageNotFoundError:
        return
    sys.exit(
        f"pivotrig: the package python-control ({found.version}) is installed in this environment and has the "
        "same import name as a part of pivotrig. Give pivotrig an environment of its own: `make setup` makes one."
    )

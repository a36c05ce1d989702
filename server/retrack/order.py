"""What the server and the process that looks at a run again say to each other."""

from __future__ import annotations

from typing import Any

import msgspec


class Order(msgspec.Struct, frozen=True):
    """changes: as `Changes.to_json` has them.  plugins: files with controllers that the server has loaded."""

    changes: dict[str, Any]
    plugins: list[str] = []


class Said(msgspec.Struct, frozen=True):
    """One line: how far it is (0 to 1), or the result, whose parts are passed on unread."""

    progress: float = 1.0
    changes: msgspec.Raw = msgspec.Raw()
    comparison: msgspec.Raw = msgspec.Raw()
    series: msgspec.Raw = msgspec.Raw()

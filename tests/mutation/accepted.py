"""Survivors that have been looked at, and why they may live: `survivors.toml`.

An entry names a file, optionally a function, and a regular expression for the change ("old line -> new line").
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

LIST = Path(__file__).with_name("survivors.toml")


@dataclass(frozen=True, slots=True)
class Entry:
    file: str
    change: re.Pattern[str]
    reason: str
    function: str = ""

    def covers(self, file: str, change: str, function: str = "") -> bool:
        return (
            re.fullmatch(self.file, file) is not None
            and self.function in ("", function)
            and self.change.fullmatch(change) is not None
        )


def entries() -> list[Entry]:
    values = tomllib.loads(LIST.read_text(encoding="utf-8"))["survivor"]
    return [
        Entry(v["file"], re.compile(v["change"], re.DOTALL), v["reason"], v.get("function", ""))
        for v in values
    ]

"""Definitions to start from, one TOML file each."""

from __future__ import annotations

from pathlib import Path

FOLDER = Path(__file__).parent


def examples() -> dict[str, str]:
    """Text of each definition by the name of its file, without the ending."""
    return {file.stem: file.read_text(encoding="utf-8") for file in sorted(FOLDER.glob("*.toml"))}

"""One part of a report: what was found, and the pictures, tables and words that show it."""

from __future__ import annotations

from dataclasses import dataclass, field

from server.reports.findings import Finding
from server.reports.page import Picture
from server.reports.tables import Table


@dataclass(frozen=True, slots=True)
class Part:
    """tables: by the names of their CSV files.  body: pieces of HTML.  unknowns: what the paper leaves open."""

    findings: tuple[Finding, ...]
    pictures: tuple[Picture, ...]
    tables: dict[str, Table]
    body: tuple[str, ...]
    unknowns: tuple[str, ...]
    raw: dict[str, bytes] = field(default_factory=dict)
    """Further files, by their names."""

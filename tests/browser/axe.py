"""What axe-core finds on a page: rules of WCAG 2.2 AA, and what is thought to be good practice."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from playwright.sync_api import Page

REPOSITORY = Path(__file__).parents[2]
AXE = REPOSITORY / ".stamps" / "javascript" / "node_modules" / "axe-core" / "axe.min.js"
RULES = ("wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice")
SERIOUS = ("serious", "critical")
LEFT_OUT = "label-content-name-mismatch"
"""An experiment of axe's that takes signs of keys and arrows, which are hidden from readers, for words of the label."""


def bring_axe(page: Page) -> None:
    """To be done again after each load of the page."""
    page.evaluate(AXE.read_text(encoding="utf-8"))


def examined(page: Page) -> list[str]:
    """What axe finds to be serious: rule, place and its advice."""
    found: dict[str, Any] = page.evaluate(
        "([rules, leftOut]) => axe.run(document, { runOnly: rules, rules: { [leftOut]: { enabled: false } },"
        " resultTypes: ['violations'], iframes: false })",
        [RULES, LEFT_OUT],
    )
    return [
        f"{rule['id']}: {node['html'][:150]} – {node['failureSummary'].splitlines()[-1].strip()}"
        for rule in found["violations"]
        if rule["impact"] in SERIOUS
        for node in rule["nodes"]
    ]

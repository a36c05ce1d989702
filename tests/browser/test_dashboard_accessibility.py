"""Every main view, in every window: nobody is kept out, nothing is cut or covered, STOP is in reach."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from axe import bring_axe, examined
from dashboard_visit import OpenTab, Visit
from playwright.sync_api import Page
from rooms import ROOMS, Room
from views import VIEWS, House, tab_of

pytestmark = pytest.mark.exclusive

LAYOUT_FAULTS = (Path(__file__).parent / "layout_faults.js").read_text(encoding="utf-8")
EXAMINED = (Room(1440, 900, "light"), Room(390, 844, "dark"))
"""Where axe looks in an everyday test: both schemes, both ends of the sizes."""

ZOOMED = Room(720, 450)
"""The desk's window at 200 %."""
FOCUSED = """() => {
  const at = document.activeElement;
  if (!at || at === document.body) return null;
  const box = at.getBoundingClientRect();
  const isOutlined = (element) => element && parseFloat(getComputedStyle(element).outlineWidth) > 0
    && getComputedStyle(element).outlineStyle !== "none";
  return {
    words: `${at.tagName} ${at.getAttribute("aria-label") ?? at.textContent ?? ""} ${at.id}`.trim().slice(0, 60),
    isSeen: at.tagName === "IFRAME"
      || [at, at.nextElementSibling, at.parentElement, at.closest("label")].some(isOutlined),
    isInWindow: box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth,
  };
}"""
"""Where the keys are, and whether a person sees it."""
STATIONS = 250
"""More than twice the places for the keys on a page that is at rest."""


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[House]:
    house = House.furnished(tmp_path_factory.mktemp("house"))
    yield house
    house.rig.stop()


@pytest.fixture(scope="module")
def visit(house: House, open_lasting_tab: OpenTab) -> Visit:
    visit = open_lasting_tab(house.rig.url, scene=False)
    load(visit.page, house)
    return visit


def load(page: Page, house: House) -> None:
    enter(page, ROOMS[0])
    page.goto(house.rig.url)
    bring_axe(page)


@pytest.fixture(scope="module", params=VIEWS)
def page(request: pytest.FixtureRequest, house: House, visit: Visit) -> Iterator[Page]:
    """One of the views; when it does not open, the next one begins on a new page."""
    with contextlib.ExitStack() as opened:
        opened.callback(enter, visit.page, ROOMS[0])
        try:
            opened.enter_context(VIEWS[request.param](visit.page, house))
        except BaseException:
            house.rig.rest()
            load(visit.page, house)
            raise
        yield visit.page


def enter(page: Page, room: Room) -> None:
    """The same page in another window; colours change at once for who wants no motion."""
    page.set_viewport_size({"width": room.width, "height": room.height})
    page.emulate_media(color_scheme=room.scheme, reduced_motion="reduce")
    page.evaluate("scrollTo(0, 0)")


def test_axe_finds_nothing_serious(page: Page, full: bool) -> None:
    found: dict[str, list[str]] = {}
    for room in ROOMS if full else EXAMINED:
        enter(page, room)
        found[str(room)] = examined(page)
    assert not any(found.values()), report(found)


def test_nothing_is_cut_covered_or_out_of_reach(page: Page) -> None:
    found: dict[str, list[str]] = {}
    for room in (*ROOMS[:3], ZOOMED):
        enter(page, room)
        found[str(room)] = page.evaluate(LAYOUT_FAULTS)
    assert not any(found.values()), report(found)


def test_with_keys_alone_one_comes_round_the_page_and_sees_where_one_is(visit: Visit) -> None:
    page = visit.page
    tab_of(page, "Runs").click()
    passed: list[dict[str, Any]] = []
    while [station["words"] for station in passed].count("BUTTON STOP") < 2:
        assert len(passed) < STATIONS, "the keys come round again"
        page.keyboard.press("Tab")
        if station := page.evaluate(FOCUSED):  # between the page's end and its beginning there is none
            passed.append(station)
    for words in ("Arm", "Camera picture", "Set up camera", "Runs"):
        assert any(words in station["words"] for station in passed), words
    assert [station for station in passed if not (station["isSeen"] and station["isInWindow"])] == []


def report(found: dict[str, list[str]]) -> str:
    return "\n" + "\n".join(f"{room}:\n  " + "\n  ".join(faults) for room, faults in found.items() if faults)

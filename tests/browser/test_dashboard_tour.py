"""The tour of a first visit: three steps, in nobody's way, once and never again unless asked for."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, rig_state
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive

TOUR = "Tour"


def tour(page: Page) -> Locator:
    return page.get_by_role("region", name=TOUR, exact=True)


def button(page: Page, name: str) -> Locator:
    return page.get_by_role("button", name=name, exact=True)


@pytest.fixture
def newcomer(served: ServedRig, open_tab: OpenTab) -> Iterator[Visit]:
    served.rest()
    visit = open_tab(served.url, scene=False, tour=True)
    yield visit
    assert visit.complaints == []


def test_two_clicks_still_lead_to_a_walking_robot_and_the_tour_follows(newcomer: Visit) -> None:
    page = newcomer.page
    expect(tour(page)).to_contain_text("1 of 3")
    button(page, "Arm").click()
    expect(tour(page)).to_contain_text("2 of 3")
    button(page, "Start walking").click()
    expect(rig_state(page)).to_contain_text("running")
    expect(tour(page)).to_contain_text("3 of 3")
    page.keyboard.press("Escape")
    expect(rig_state(page)).to_contain_text("fault")
    expect(tour(page)).to_have_count(0)


def test_who_has_skipped_the_tour_does_not_see_it_again_and_can_ask_for_it(newcomer: Visit) -> None:
    page = newcomer.page
    button(page, "Skip the tour").click()
    expect(tour(page)).to_have_count(0)
    page.reload()
    expect(button(page, "Arm")).to_be_enabled()
    expect(tour(page)).to_have_count(0)
    page.keyboard.press("?")
    button(page, "Show the tour").click()
    expect(tour(page)).to_contain_text("1 of 3")
    button(page, "Next").click()
    button(page, "Next").click()
    button(page, "Done").click()
    expect(tour(page)).to_have_count(0)


def test_on_a_phone_no_step_covers_the_buttons_or_stop(served: ServedRig, open_tab: OpenTab) -> None:
    served.rest()
    page = open_tab(served.url, 390, 844, scene=False, tour=True).page
    for count in ("1 of 3", "2 of 3", "3 of 3"):
        expect(tour(page)).to_contain_text(count)
        for name in ("Arm", "STOP"):
            assert not overlap(tour(page), button(page, name)), f"{count} covers {name}"
        if count != "3 of 3":
            button(page, "Next").click()


def overlap(one: Locator, other: Locator) -> bool:
    a, b = one.bounding_box(), other.bounding_box()
    assert a is not None
    assert b is not None
    return (
        a["x"] < b["x"] + b["width"]
        and b["x"] < a["x"] + a["width"]
        and a["y"] < b["y"] + b["height"]
        and b["y"] < a["y"] + a["height"]
    )

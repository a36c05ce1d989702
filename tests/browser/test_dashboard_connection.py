"""A server that dies and comes back, and the page on a phone."""

from __future__ import annotations

import pytest
from dashboard_visit import OpenTab, ServedRig, eventually, rig_state
from playwright.sync_api import Locator, expect

pytestmark = pytest.mark.exclusive

PHONE = (390, 844)


def test_a_dead_server_greys_the_page_and_its_return_brings_the_page_back(
    own_server: ServedRig, open_tab: OpenTab
) -> None:
    page = open_tab(own_server.url, scene=False).page
    expect(rig_state(page)).to_contain_text("disarmed")
    expect(page.get_by_text("waiting for the first frame")).to_be_hidden()
    own_server.kill()
    lost = page.get_by_role("alert").filter(has_text="No connection: the server does not answer")
    expect(lost).to_be_visible()
    eventually(lambda: opacity(page.locator("main")) < 0.7, "the page is grey")
    expect(page.get_by_role("button", name="STOP", exact=True)).to_be_visible()
    expect(page.get_by_text("no frame for")).to_be_visible()
    own_server.start()
    expect(page.get_by_role("alert").filter(has_text="No connection")).to_have_count(0)
    eventually(lambda: opacity(page.locator("main")) == 1.0, "the page has its colours back")
    expect(page.get_by_text("no frame for")).to_be_hidden()
    page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(page)).to_contain_text("armed")


def opacity(place: Locator) -> float:
    return float(place.evaluate("element => getComputedStyle(element).opacity"))


def test_a_phone_shows_stop_camera_and_the_next_step_without_scrolling(
    served: ServedRig, open_tab: OpenTab
) -> None:
    served.rest()
    visit = open_tab(served.url, *PHONE, scene=False)
    page = visit.page
    shown = [
        page.get_by_role("button", name="STOP", exact=True),
        page.get_by_role("img", name="Camera picture"),
        page.get_by_role("button", name="Arm", exact=True),
    ]
    for place in shown:
        expect(place).to_be_visible()
        assert fits(place)
    page.mouse.wheel(0, 2000)
    eventually(lambda: page.evaluate("scrollY") > 300, "the page scrolls")
    assert fits(shown[0])
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE[0]
    assert visit.foreign(served.url) == []


def fits(place: Locator) -> bool:
    box = place.bounding_box()
    assert box is not None
    inside_x = 0 <= box["x"] <= PHONE[0] - box["width"]
    return inside_x and 0 <= box["y"] <= PHONE[1] - box["height"]

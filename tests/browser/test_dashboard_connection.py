"""What is shown can be believed, or says how far not: a server that dies, falls silent or is upgraded; two tabs."""

from __future__ import annotations

import re

import pytest
from dashboard_visit import OpenTab, ServedRig, eventually, rig_state
from playwright.sync_api import Locator, WebSocketRoute, expect

pytestmark = pytest.mark.exclusive

PHONE = (390, 844)


def test_a_dead_server_greys_the_page_and_its_return_brings_the_page_back(
    own_server: ServedRig, open_tab: OpenTab
) -> None:
    page = open_tab(own_server.url, scene=False).page
    expect(rig_state(page)).to_contain_text("disarmed")
    expect(page.get_by_text("waiting for the first frame")).to_be_hidden()
    page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))
    own_server.kill()
    lost = page.get_by_role("alert").filter(has_text="No connection: the server does not answer")
    expect(lost).to_be_visible()
    eventually(lambda: opacity(page.locator("main")) < 0.7, "the page is grey")
    expect(page.get_by_role("button", name="STOP", exact=True)).to_be_visible()
    expect(page.get_by_text("no frame for")).to_be_visible()
    own_server.start()
    expect(page.get_by_role("alert").filter(has_text="No connection")).to_have_count(0)
    expect(page.get_by_role("alert").filter(has_text="pivotrig was restarted")).to_be_visible()
    expect(rig_state(page)).to_contain_text("disarmed")
    eventually(lambda: opacity(page.locator("main")) == 1.0, "the page has its colours back")
    expect(page.get_by_text("no frame for")).to_be_hidden()
    page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))


def test_a_server_that_falls_silent_is_told_before_it_counts_as_lost(
    own_server: ServedRig, open_tab: OpenTab
) -> None:
    page = open_tab(own_server.url, scene=False).page
    expect(rig_state(page)).to_contain_text("disarmed")
    own_server.freeze()
    expect(page.get_by_text("Waiting: no telemetry for")).to_be_visible()
    lost = page.get_by_role("alert").filter(has_text="No connection: no telemetry for")
    expect(lost).to_contain_text("What is shown below is old. It is")
    page.keyboard.press("h")
    page.get_by_role("button", name="STOP", exact=True).click()
    expect(page.get_by_role("alert").filter(has_text="Switch the supply off if it moves")).to_be_visible()
    own_server.thaw()
    expect(page.get_by_role("alert").filter(has_text="No connection")).to_have_count(0)
    expect(rig_state(page)).to_contain_text("fault")


def test_what_one_tab_chooses_the_other_shows_and_says(served: ServedRig, open_tab: OpenTab) -> None:
    served.rest()
    first, second = (open_tab(served.url, scene=False).page for _ in range(2))
    for page in (first, second):
        expect(rig_state(page)).to_contain_text("disarmed")
        expect(page.get_by_role("textbox", name="Sweep")).not_to_have_value("")
    first.get_by_role("textbox", name="Sweep").fill("17")
    expect(second.get_by_role("textbox", name="Sweep")).to_have_value("17")
    expect(second.get_by_text("Gait changed in another tab.")).to_be_visible()
    expect(first.get_by_text("changed in another tab")).to_have_count(0)
    first.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(second)).to_contain_text(re.compile(r"\barmed"))
    second.keyboard.press("Escape")
    expect(rig_state(first)).to_contain_text("fault")


def test_a_page_of_the_version_before_says_so_and_still_stops(served: ServedRig, open_tab: OpenTab) -> None:
    """The server's first words are changed on their way, as if it had been upgraded under the open page."""
    served.rest()
    page = open_tab(served.url, scene=False).page
    expect(rig_state(page)).to_contain_text("disarmed")
    updated = page.get_by_role("alert").filter(
        has_text="pivotrig was updated. This page is still of the version before"
    )
    expect(updated).to_have_count(0)
    page.route_web_socket(re.compile("/api/v1/telemetry"), upgraded)
    page.reload()
    expect(updated).to_contain_text("STOP works all the same")
    expect(updated.get_by_role("button", name="Reload")).to_be_visible()
    page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))
    page.keyboard.press("Escape")
    expect(rig_state(page)).to_contain_text("fault")


def upgraded(socket: WebSocketRoute) -> None:
    server = socket.connect_to_server()
    server.on_message(lambda message: socket.send(re.sub(r'"page":"\w+"', '"page":"another"', str(message))))


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

"""The fault panel of a simulated rig: put in with a click, seen to be kept, taken away with a click."""

from __future__ import annotations

import contextlib
import re
import urllib.error
from collections.abc import Iterator

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, eventually, rig_state
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive


STEPS = {"disarmed": "/arm", "armed": "/runs", "held": "/runs/current/resume"}
"""What leads from each state towards a robot that walks."""
WALKS_FOR = 0.5
"""Before a fault, s: the field is up after 0.3 s."""


@pytest.fixture(scope="module")
def tab(served: ServedRig, open_lasting_tab: OpenTab) -> Visit:
    return open_lasting_tab(served.url, scene=False)


@pytest.fixture
def page(tab: Visit, served: ServedRig) -> Iterator[Page]:
    served.rest()
    expect(rig_state(tab.page)).to_contain_text("disarmed")
    tab.page.get_by_role("tab", name="Faults").click()
    yield tab.page
    served.send("DELETE", "/simulation/faults")
    assert tab.complaints == []


def button(page: Page, name: str | re.Pattern[str]) -> Locator:
    return page.get_by_role("button", name=name)


def now_in(page: Page) -> Locator:
    return page.get_by_role("region", name="Put in now")


def badge(page: Page) -> Locator:
    return page.get_by_role("banner").get_by_role("button", name="put in")


def walk(page: Page, served: ServedRig) -> None:
    """Not by clicks: a computer that is busy just then lets the rig hold, and it is let go on until it walks."""

    def walks() -> bool:
        state = served.ask("/state")
        if state["rig"] == "running" and state["run"]["elapsed_s"] > WALKS_FOR:
            return True
        step = STEPS.get(state["rig"])
        if step is not None and state["tracking"] == "locked":
            with contextlib.suppress(urllib.error.HTTPError):
                served.send("POST", step)
        return False

    eventually(walks, "the robot walks", timeout=30.0)
    expect(rig_state(page)).to_contain_text("running")


def test_a_camera_that_is_unplugged_with_a_click_holds_the_robot_and_comes_back_with_another(
    page: Page, served: ServedRig
) -> None:
    walk(page, served)
    button(page, re.compile("^Unplug the camera")).click()
    expect(rig_state(page)).to_contain_text("held")
    expect(rig_state(page)).to_contain_text("no frame for")
    expect(badge(page)).to_have_text("1 fault put in")
    expect(page.get_by_role("region", name="Camera", exact=True)).to_contain_text("no frame for")
    kept = page.get_by_role("listitem", name="Camera unplugged")
    expect(kept).to_contain_text("The rig holds within 104 ms, and no current flows after 255 ms.")
    expect(kept).to_contain_text(
        re.compile(r"The rig holds after \d+ ms, and no current flowed after \d+ ms")
    )
    expect(kept.get_by_role("status")).to_have_text(re.compile("Kept|Not kept|Cannot say"))
    now_in(page).get_by_role("button", name="Take away: Camera unplugged").click()
    expect(now_in(page)).to_contain_text("Nothing: the rig works as it should.")
    expect(badge(page)).to_have_count(0)
    expect(page.get_by_role("region", name="Camera", exact=True)).not_to_contain_text("no frame for")
    button(page, "Resume").click()
    expect(rig_state(page)).to_contain_text("running")


def test_a_rig_at_rest_says_that_its_promise_is_for_a_robot_that_walks(page: Page) -> None:
    expect(page.get_by_text("arm and start a run first")).to_be_visible()
    button(page, re.compile("^Freeze the camera")).click()
    kept = page.get_by_role("listitem", name="Picture frozen")
    expect(kept.get_by_role("status")).to_have_text(re.compile("At rest"))
    button(page, re.compile("^Freeze the camera")).click()
    expect(now_in(page)).to_contain_text("Nothing")


def test_a_fault_is_found_by_its_words_and_put_in_with_values_for_a_while(
    page: Page, served: ServedRig
) -> None:
    page.get_by_role("searchbox", name="Search the faults").fill("supply sags")
    expect(page.get_by_text("Messages lost")).to_have_count(0)
    page.get_by_text("The coils' supply sags.").click()
    values = page.get_by_role("region", name="Board, supply and coils")
    values.get_by_role("textbox", name="Supply").fill("200")
    expect(values.get_by_role("button", name="Put in: Supply low")).to_be_disabled()
    values.get_by_role("textbox", name="Supply").fill("6")
    values.get_by_role("textbox", name="For", exact=True).fill("1.5")
    values.get_by_role("button", name="Put in: Supply low").click()
    expect(now_in(page)).to_contain_text("Supply low")
    eventually(lambda: "supply" in served.ask("/state")["reason"], "the rig sees the supply")
    expect(now_in(page)).to_contain_text("Nothing: the rig works as it should.")
    page.get_by_role("searchbox", name="Search the faults").fill("")


def test_several_faults_are_counted_and_taken_away_at_once(page: Page) -> None:
    button(page, re.compile("^Hide the robot")).click()
    button(page, re.compile("^Scatter debris")).click()
    expect(badge(page)).to_have_text("2 faults put in")
    page.get_by_role("tab", name="Runs").click()
    badge(page).click()
    expect(page.get_by_role("tab", selected=True)).to_have_accessible_name("Faults")
    now_in(page).get_by_role("button", name="Take all away").click()
    expect(badge(page)).to_have_count(0)

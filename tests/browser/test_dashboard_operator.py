"""One page operates the rig at a time: who it is, how it passes on, and what the others may do meanwhile."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from axe import bring_axe, examined
from dashboard_visit import CLIENT, OpenTab, ServedRig, Visit, eventually, rig_state
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive

LAYOUT_FAULTS = (Path(__file__).parent / "layout_faults.js").read_text(encoding="utf-8")
PHONE = (390, 844)
TAKE_OVER = 13e3
"""Whoever asks and has no answer may take over 10 s later, ms."""
HIDES = """hidden => {
  Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden });
  document.dispatchEvent(new Event("visibilitychange"));
}"""
"""As a tab does that goes behind another one."""


@pytest.fixture
def rig(workshop: ServedRig) -> ServedRig:
    """At rest, and nobody operates it; whoever did in the test before is silent before long."""
    eventually(lambda: operates(workshop), "the test may take control")
    workshop.rest()
    workshop.send("DELETE", "/operator")
    return workshop


def operates(rig: ServedRig) -> bool:
    """Asks for control as the tests' own client; whether it has it."""
    rig.send("POST", "/operator")
    holder = rig.ask("/operator")["holder"]
    return holder is not None and holder["name"] == CLIENT


@pytest.fixture
def anna(rig: ServedRig, open_tab: OpenTab) -> Visit:
    return open_tab(rig.url, scene=False, client="")


@pytest.fixture
def ben(rig: ServedRig, open_tab: OpenTab) -> Iterator[Visit]:
    visit = open_tab(rig.url, *PHONE, scene=False, client="")
    yield visit
    assert visit.complaints == []


def sign(page: Page, words: str | re.Pattern[str]) -> Locator:
    """In the bar; its words are read out the same on a phone."""
    return page.get_by_role("banner").get_by_role("button", name=words)


def wish(page: Page, what: str, name: str, note: str = "") -> None:
    """By the panel under the sign."""
    page.get_by_role("banner").get_by_role("button", name=re.compile("operate")).click()
    panel = page.get_by_role("region", name="Control of the rig")
    panel.get_by_label("Your name").fill(name)
    panel.get_by_label("What for").fill(note)
    panel.get_by_role("button", name=what).click()


def button(page: Page, name: str) -> Locator:
    return page.get_by_role("button", name=name, exact=True)


def arm(page: Page) -> None:
    expect(rig_state(page)).to_contain_text("robot locked")
    button(page, "Arm").click()
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))


def test_a_free_rig_is_taken_by_the_first_command_and_the_others_see_by_whom(anna: Visit, ben: Visit) -> None:
    watcher = ben.page
    expect(sign(watcher, "Nobody operates")).to_be_visible()
    arm(anna.page)
    expect(sign(anna.page, "You operate")).to_be_visible()
    expect(sign(watcher, "Dashboard at 127.0.0.1 operates")).to_be_visible()
    wish(anna.page, "Save", "Anna", "calibrating")
    expect(sign(watcher, "Anna operates calibrating")).to_be_visible()
    expect(button(watcher, "Start walking")).to_be_disabled()
    expect(watcher.get_by_text("Anna operates. Ask for control in the bar")).to_be_visible()
    run = watcher.get_by_role("region", name="Run", exact=True)
    expect(run.get_by_label("Controller", exact=True)).to_be_disabled()
    button(watcher, "Disarm").click()
    expect(rig_state(anna.page)).to_contain_text("disarmed")


def test_whoever_asks_is_given_control_by_a_click(anna: Visit, ben: Visit) -> None:
    wish(anna.page, "Take control", "Anna")
    expect(sign(ben.page, "Anna operates")).to_be_visible()
    wish(ben.page, "Ask for control", "Ben", "my turn")
    expect(ben.page.get_by_role("group", name="Asking for control")).to_contain_text(
        "Anna is asked for control."
    )
    question = anna.page.get_by_role("alert").filter(has_text="Ben asks for control: “my turn”.")
    expect(question).to_be_visible()
    for page in (anna.page, ben.page):
        bring_axe(page)
        assert examined(page) == []
        assert page.evaluate(LAYOUT_FAULTS) == []
    question.get_by_role("button", name="Give").press("Enter")
    expect(sign(ben.page, "You operate my turn")).to_be_visible()
    expect(sign(anna.page, "Ben operates my turn")).to_be_visible()
    expect(anna.page.get_by_role("alert")).to_have_count(0)
    expect(ben.page.get_by_role("group", name="Asking for control")).to_have_count(0)


def test_a_question_takes_the_focus_from_nobody_and_may_be_refused(anna: Visit, ben: Visit) -> None:
    wish(anna.page, "Take control", "Anna")
    gain = anna.page.get_by_role("textbox", name="Gain k")
    gain.focus()
    wish(ben.page, "Ask for control", "Ben")
    question = anna.page.get_by_role("alert").filter(has_text="Ben asks for control.")
    expect(question).to_be_visible()
    expect(gain).to_be_focused()
    question.get_by_role("button", name="Keep").click()
    expect(ben.page.get_by_role("alert")).to_contain_text("Anna keeps control.")
    expect(sign(anna.page, "You operate")).to_be_visible()
    expect(question).to_have_count(0)


def test_a_question_can_be_taken_back(anna: Visit, ben: Visit) -> None:
    wish(anna.page, "Take control", "Anna")
    wish(ben.page, "Ask for control", "Ben")
    question = anna.page.get_by_role("alert").filter(has_text="Ben asks for control.")
    expect(question).to_be_visible()
    button(ben.page, "Cancel").click()
    expect(question).to_have_count(0)
    expect(ben.page.get_by_role("alert")).to_have_count(0)


def test_without_an_answer_control_may_be_taken_over_and_the_former_operator_hears_why(
    anna: Visit, ben: Visit
) -> None:
    wish(anna.page, "Take control", "Anna")
    wish(ben.page, "Ask for control", "Ben", "fire drill")
    take = button(ben.page, "Take over")
    expect(take).to_be_disabled()
    expect(ben.page.get_by_text(re.compile(r"You may take over in \d+ s\."))).to_be_visible()
    take.click(timeout=TAKE_OVER)
    expect(sign(ben.page, "You operate")).to_be_visible()
    expect(anna.page.get_by_role("alert")).to_contain_text("Ben has taken control: “fire drill”.")
    anna.page.get_by_role("alert").get_by_role("button", name="Ask for control").click()
    expect(ben.page.get_by_role("alert")).to_contain_text("Anna asks for control.")


def test_an_operator_who_is_gone_is_silent_and_may_be_relieved_at_once(anna: Visit, ben: Visit) -> None:
    wish(anna.page, "Take control", "Anna")
    expect(sign(ben.page, "Anna operates")).to_be_visible()
    anna.page.close()
    expect(sign(ben.page, re.compile(r"Anna operates silent for \d+ s"))).to_be_visible()
    wish(ben.page, "Take over", "Ben")
    expect(sign(ben.page, "You operate")).to_be_visible()
    arm(ben.page)


def test_a_page_that_is_loaded_anew_still_operates_and_its_twin_does_not(anna: Visit, ben: Visit) -> None:
    page = anna.page
    wish(page, "Take control", "Anna")
    page.reload()
    expect(sign(page, "You operate")).to_be_visible()
    with page.expect_popup() as opened:
        page.evaluate("open(location.href)")  # with a copy of what the tab keeps, as a duplicated one
    expect(sign(opened.value, "Anna operates")).to_be_visible()
    expect(sign(page, "You operate")).to_be_visible()
    expect(ben.page.get_by_role("alert")).to_have_count(0)


def test_a_run_that_nobody_can_see_is_held_and_goes_on_when_its_operator_says_so(
    anna: Visit, ben: Visit
) -> None:
    page = anna.page
    arm(page)
    button(page, "Start walking").click()
    expect(rig_state(page)).to_contain_text("running")
    page.evaluate(HIDES, True)
    expect(rig_state(ben.page)).to_contain_text("held")
    expect(rig_state(ben.page)).to_contain_text("has not been heard for 2 s")
    page.evaluate(HIDES, False)
    button(page, "Resume").click()
    expect(rig_state(ben.page)).to_contain_text("running")


def test_a_watcher_stops_the_rig(anna: Visit, ben: Visit) -> None:
    arm(anna.page)
    button(anna.page, "Start walking").click()
    expect(rig_state(ben.page)).to_contain_text("running")
    ben.page.get_by_role("region", name="Run", exact=True).get_by_role("button", name="Pause").click()
    expect(rig_state(ben.page)).to_contain_text("held")
    expect(button(ben.page, "Resume")).to_be_disabled()
    button(ben.page, "STOP").click()
    expect(rig_state(anna.page)).to_contain_text("fault")
    expect(button(ben.page, "Reset")).to_be_disabled()
    button(anna.page, "Reset").click()
    expect(rig_state(anna.page)).to_contain_text("disarmed")


def test_what_is_refused_all_the_same_offers_to_ask_for_control(anna: Visit, ben: Visit) -> None:
    wish(anna.page, "Take control", "Anna")
    expect(sign(ben.page, "Anna operates")).to_be_visible()
    ben.page.get_by_role("tab", name="Faults").click()
    ben.page.get_by_role("button", name="Freeze the camera").click()
    notice = ben.page.get_by_role("alert").filter(has_text="Anna operates the rig: nothing was done.")
    notice.get_by_role("button", name="Ask for control").click()
    expect(notice).to_have_count(0)
    expect(anna.page.get_by_role("alert")).to_contain_text("asks for control.")

"""Keys of the page: what works now stands in the sheet, and nothing is heeded that was meant for something else."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, rig_state
from playwright.sync_api import APIResponse, Locator, Page, Route, expect

pytestmark = pytest.mark.exclusive


@pytest.fixture(scope="module")
def tab(served: ServedRig, open_lasting_tab: OpenTab) -> Visit:
    return open_lasting_tab(served.url, scene=False)


@pytest.fixture
def page(tab: Visit, served: ServedRig) -> Iterator[Page]:
    served.rest()
    expect(rig_state(tab.page)).to_contain_text("disarmed")
    yield tab.page
    assert tab.complaints == []


def opened(page: Page) -> Locator:
    return page.get_by_role("tab", selected=True)


def sheet(page: Page) -> Locator:
    return page.get_by_role("dialog", name="Keys")


def test_the_tabs_are_opened_by_their_numbers(page: Page) -> None:
    for number, name in enumerate(["Runs", "Studies", "Calibration", "Rig", "Log", "Faults"], 1):
        page.keyboard.press(str(number))
        expect(opened(page)).to_have_accessible_name(name)
        expect(page.get_by_role("tab", name=name)).to_be_focused()


def test_a_number_that_is_typed_into_a_field_opens_no_tab(page: Page) -> None:
    page.keyboard.press("1")
    sweep = page.get_by_role("textbox", name="Sweep")
    sweep.fill("")
    sweep.press_sequentially("22")
    expect(sweep).to_have_value("22")
    expect(opened(page)).to_have_accessible_name("Runs")


def test_a_key_with_a_modifier_is_the_browsers(page: Page) -> None:
    page.get_by_role("tab", name="Runs").click()
    for modifier in ("Control", "Alt", "Meta"):
        page.keyboard.press(f"{modifier}+5")
    expect(opened(page)).to_have_accessible_name("Runs")


def test_the_sheet_shows_what_works_now_by_groups_and_covers_nothing_of_stop(page: Page) -> None:
    page.get_by_role("tab", name="Runs").click()
    page.keyboard.press("?")
    stop = sheet(page).get_by_role("region", name="STOP")
    expect(stop).to_contain_text("Escape")
    expect(sheet(page).get_by_role("region", name="Tabs")).to_contain_text("Studies")
    expect(sheet(page)).not_to_contain_text("turn left about A")
    page.keyboard.press("5")
    expect(opened(page)).to_have_accessible_name("Runs")
    page.keyboard.press("Escape")
    expect(sheet(page)).to_have_count(0)
    expect(rig_state(page)).to_contain_text("fault")


def test_a_run_is_held_by_a_key_and_let_go_by_a_click_alone(page: Page) -> None:
    page.get_by_role("button", name="Arm", exact=True).click()
    page.get_by_role("button", name="Start walking", exact=True).click()
    expect(rig_state(page)).to_contain_text("running")
    page.keyboard.press("h")
    expect(rig_state(page)).to_contain_text("held")
    page.keyboard.press("h")
    page.keyboard.press("?")
    expect(sheet(page)).not_to_contain_text("Hold the run")
    sheet(page).get_by_role("button", name="Close").click()
    expect(rig_state(page)).to_contain_text("held")


def test_a_hold_waits_for_no_answer_to_the_start(page: Page) -> None:
    unanswered: list[tuple[Route, APIResponse]] = []
    runs = re.compile(r"/api/v1/runs$")

    def keep_the_answer(route: Route) -> None:
        if route.request.method == "POST":
            unanswered.append((route, route.fetch()))
        else:
            route.fallback()

    page.route(runs, keep_the_answer)
    page.get_by_role("button", name="Arm", exact=True).click()
    page.get_by_role("button", name="Start walking", exact=True).click()
    expect(rig_state(page)).to_contain_text("running")
    expect(page.get_by_role("button", name="Disarm", exact=True)).to_be_enabled()
    page.keyboard.press("h")
    expect(rig_state(page)).to_contain_text("held")
    [(route, answer)] = unanswered
    route.fulfill(response=answer)
    page.unroute(runs)
    expect(page.get_by_role("button", name="Resume", exact=True)).to_be_enabled()

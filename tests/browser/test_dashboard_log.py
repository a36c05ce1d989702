"""The log: what happened in this session of the server, found again, taken along, and never shoved about."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, rig_state
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive


@pytest.fixture(scope="module")
def visit(workshop: ServedRig, open_lasting_tab: OpenTab) -> Iterator[Visit]:
    for _ in range(3):
        workshop.send("POST", "/estop")
        workshop.send("POST", "/reset")
    visit = open_lasting_tab(workshop.url, scene=False)
    expect(rig_state(visit.page)).to_contain_text("disarmed")
    yield visit
    assert visit.complaints == []


@pytest.fixture
def page(visit: Visit, workshop: ServedRig) -> Page:
    workshop.rest()
    return visit.page


def tab(page: Page) -> Locator:
    return page.get_by_role("tab", name="Log")


def log(page: Page) -> Locator:
    return page.get_by_role("region", name="Log", exact=True)


def lines(page: Page) -> Locator:
    return log(page).get_by_role("group", name="Lines of the log").get_by_role("listitem")


def test_what_nobody_has_seen_is_counted_on_the_tab_until_it_is_looked_at(
    page: Page, workshop: ServedRig
) -> None:
    page.get_by_role("tab", name="Runs").click()
    workshop.send("POST", "/estop")
    workshop.send("POST", "/reset")
    expect(tab(page)).to_contain_text("new")
    tab(page).click()
    expect(tab(page)).to_have_text("Log")
    expect(lines(page).first).to_contain_text("Reset", ignore_case=True)


def test_what_happened_before_the_page_was_opened_is_there_and_a_reload_comes_back_to_it(page: Page) -> None:
    tab(page).click()
    page.reload()
    expect(tab(page)).to_have_attribute("aria-selected", "true")
    stops = lines(page).filter(has_text="emergency stop")
    expect(stops.nth(2)).to_be_visible()


def test_lines_are_found_by_severity_and_words(page: Page) -> None:
    tab(page).click()
    log(page).get_by_text("Faults", exact=True).click()
    expect(lines(page).filter(has_text="reset; arm to go on")).to_have_count(0)
    expect(lines(page).first).to_contain_text("emergency stop", ignore_case=True)
    find = log(page).get_by_role("searchbox", name="Find in the log")
    find.fill("no such words")
    expect(log(page).get_by_text("No line is like that.")).to_be_visible()
    find.fill("")
    log(page).get_by_text("All", exact=True).click()
    expect(lines(page).filter(has_text="reset; arm to go on").first).to_be_visible()


def test_a_line_of_a_run_leads_to_the_run(page: Page, workshop: ServedRig) -> None:
    tab(page).click()
    page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))
    workshop.send("POST", "/runs", {"duration_s": 30, "label": "the one"})
    workshop.send("POST", "/estop")
    run = workshop.ask("/runs")["runs"][0]["id"]
    link = (
        lines(page).filter(has_text="emergency stop").first.get_by_role("button", name=f"Show the run {run}")
    )
    link.click()
    expect(page.get_by_role("tab", name="Runs")).to_have_attribute("aria-selected", "true")
    expect(page.get_by_role("button", name="the one", exact=True)).to_have_attribute("aria-expanded", "true")


def test_new_lines_do_not_shove_what_somebody_reads(page: Page, workshop: ServedRig) -> None:
    for _ in range(12):
        workshop.send("POST", "/estop")
        workshop.send("POST", "/reset")
    tab(page).click()
    scroll = log(page).get_by_role("group", name="Lines of the log")
    read = lines(page).nth(20)
    read.scroll_into_view_if_needed()
    scroll.evaluate("list => { list.scrollTop += 40; }")
    expect(read).to_be_visible()
    before, words = read.bounding_box(), read.inner_text()
    workshop.send("POST", "/estop")
    workshop.send("POST", "/reset")
    fresh = log(page).get_by_role("button", name="newer line")
    expect(fresh).to_be_visible()
    assert read.bounding_box() == before
    assert read.inner_text().split("\n")[-1] == words.split("\n")[-1]
    fresh.click()
    expect(fresh).to_have_count(0)


def test_the_log_is_taken_along_as_a_text_that_reads_from_its_beginning(page: Page) -> None:
    tab(page).click()
    with page.expect_download() as download:
        log(page).get_by_role("button", name="Download").click()
    assert download.value.suggested_filename == "The-paper-s-rig-log.txt"
    text = Path(download.value.path()).read_text().splitlines()
    assert text[0] < text[-1]
    assert any("emergency stop" in line for line in text)


def test_an_open_fault_stands_above_the_lines(page: Page, workshop: ServedRig) -> None:
    tab(page).click()
    workshop.send("POST", "/estop")
    expect(log(page).get_by_role("list", name="Open faults")).to_contain_text(
        "emergency stop", ignore_case=True
    )
    workshop.send("POST", "/reset")
    expect(log(page).get_by_role("list", name="Open faults")).to_have_count(0)

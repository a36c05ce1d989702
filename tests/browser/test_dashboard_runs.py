"""The tab of runs: what was recorded is found, looked at, edited, taken away, started again and tidied up."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from dashboard_visit import PATIENCE, OpenTab, ServedRig, Visit, eventually, rig_state
from playwright.sync_api import Locator, Page, expect

from server.catalogue.catalogue import Catalogue
from server.catalogue.records import RunRecord

pytestmark = pytest.mark.exclusive

OLD_RUNS = 70
"""In the catalogue beside the recorded ones, without a recording: more than one page of the list."""
A_YEAR = timedelta(days=365)
LABELS = ("wet plate", "dry plate")


@dataclass(frozen=True, slots=True)
class Library:
    """A served rig with runs that were made before. recorded: their ids, oldest first."""

    rig: ServedRig
    recorded: list[str]


def recorded_walk(rig: ServedRig, label: str) -> str:
    """A real walk of a second; its id."""
    rig.rest()
    eventually(lambda: rig.ask("/state")["tracking"] == "locked", "the camera sees the robot")
    rig.send("POST", "/arm")
    rig.send("POST", "/runs", {"duration_s": 1.0, "label": label, "tags": ["paper"]})
    newest = lambda: rig.ask("/runs?limit=1")["runs"][0]  # noqa: E731
    eventually(lambda: newest()["recording"]["state"] == "complete", "a recorded run", told=rig.story)
    return newest()["id"]


def add_old_runs(catalogue: Catalogue) -> None:
    """One a day, long ago; every tenth is pinned."""
    for number in range(OLD_RUNS):
        catalogue.add(
            RunRecord(
                id=f"old-{number:03}",
                started_at=datetime.now(UTC) - A_YEAR - timedelta(days=number),
                state="aborted" if number == 7 else "finished",
                reason="robot lost" if number == 7 else "",
                pinned=number % 10 == 0,
                controller="geometric",
                trajectory="eight",
            )
        )


@pytest.fixture(scope="module")
def library(served: ServedRig) -> Library:
    recorded = [recorded_walk(served, label) for label in LABELS]
    with contextlib.closing(Catalogue.open(served.data)) as catalogue:
        add_old_runs(catalogue)
    return Library(served, recorded)


def button(place: Page | Locator, name: str) -> Locator:
    return place.get_by_role("button", name=name, exact=True)


def field(place: Locator, name: str) -> Locator:
    return place.get_by_role("textbox", name=name, exact=True)


def names(page: Page) -> Locator:
    return page.locator(".run-name")


def details(page: Page) -> Locator:
    return page.get_by_role("complementary")


def show_replay(page: Page, id: str) -> None:
    page.evaluate("id => void (location.hash = `#replay=${id}`)", id)
    expect(page.get_by_role("region", name="Replay")).to_contain_text("The rig itself: armed")


@pytest.fixture(scope="module")
def office(library: Library, open_lasting_tab: OpenTab) -> Visit:
    return open_lasting_tab(library.rig.url, scene=False)


@pytest.fixture
def visit(library: Library, office: Visit) -> Iterator[Visit]:
    """All runs are listed and none is looked at, beside a rig at rest; at the end nobody has complained."""
    library.rig.rest()
    for name in ("Show all runs", "Close", "Untick"):
        if button(office.page, name).is_visible():
            button(office.page, name).click()
    expect(names(office.page).filter(has_text="dry plate").first).to_be_visible()
    yield office
    assert office.complaints == []
    assert office.foreign(library.rig.url) == []


def test_a_run_is_found_looked_at_edited_and_taken_away(library: Library, visit: Visit) -> None:
    page = visit.page
    expect(page.locator(".runs-foot")).to_contain_text(f"{library.rig.ask('/runs')['totals']['runs']} runs")
    page.get_by_label("Search runs").fill("old-")
    expect(page.get_by_text(f"{OLD_RUNS} found")).to_be_visible()
    expect(names(page)).to_have_count(50)
    button(page, "Show more").scroll_into_view_if_needed()
    expect(names(page)).to_have_count(OLD_RUNS)
    page.get_by_label("State").select_option("aborted")
    expect(names(page)).to_have_text(["old-007"])
    button(page, "Show all runs").click()
    page.get_by_label("Search runs").fill("wet plate")
    expect(names(page)).to_have_text(["wet plate"])

    names(page).first.press("Enter")
    shown = details(page)
    expect(shown.get_by_role("heading", name="wet plate")).to_be_visible()
    expect(shown.locator("div").filter(has_text=re.compile(r"^Mean error\?\d+\.\d{3} mm$"))).to_be_visible()
    figure = shown.get_by_role("img", name="Path, error over time")
    eventually(
        lambda: bool(figure.evaluate("image => image.naturalWidth > 100")),
        "a figure of the run",
        2 * PATIENCE,
    )
    expect(shown.get_by_text("as the rig is now")).to_be_visible()
    expect(button(shown, "Run again")).to_be_disabled()

    shown.get_by_text("Download").click()
    with page.expect_download() as started:
        shown.get_by_role("link", name="Table, CSV").click()
    table = Path(started.value.path()).read_text()
    assert table.startswith("time_s,")
    assert started.value.suggested_filename.endswith(".csv")

    edit_and_undo(library, page)


def edit_and_undo(library: Library, page: Page) -> None:
    shown, id = details(page), library.recorded[0]
    field(shown, "Label").fill("wet plate, again")
    expect(shown.get_by_text("Saved")).to_be_visible()
    assert library.rig.ask(f"/runs/{id}")["label"] == "wet plate, again"
    expect(names(page)).to_have_text(["wet plate, again"])
    button(shown, "Undo").click()
    expect(shown.get_by_text("As before")).to_be_visible()
    assert library.rig.ask(f"/runs/{id}")["label"] == "wet plate"
    shown.get_by_label("Tags", exact=True).press_sequentially("demo,wet,blue,")
    tags = ["paper", "demo", "wet", "blue"]
    eventually(
        lambda: library.rig.ask(f"/runs/{id}")["tags"] == tags, "all tags, however fast they were typed"
    )
    expect(button(shown, "Remove the tag demo")).to_be_visible()
    button(shown, "Pin this run").click()
    expect(button(shown, "Delete…")).to_be_disabled()
    button(shown, "Pin this run").click()
    expect(button(shown, "Delete…")).to_be_enabled()
    notes = lambda: library.rig.ask(f"/runs/{id}")["notes"]  # noqa: E731
    field(shown, "Notes").fill("water on the plate")
    button(shown, "Close").click()
    eventually(lambda: notes() == "water on the plate", "notes from just before the details were closed")


def test_a_run_is_started_again_which_gives_the_page_back_to_the_rig_and_listed_while_it_goes_on(
    library: Library, visit: Visit
) -> None:
    page = visit.page
    names(page).filter(has_text="dry plate").click()
    shown = details(page)
    expect(shown).to_contain_text("arm the rig first")
    library.rig.send("POST", "/arm")
    show_replay(page, library.recorded[0])
    button(shown, "Run again").click()
    expect(page.get_by_role("region", name="Replay")).to_have_count(0)
    expect(rig_state(page)).to_contain_text("running")
    expect(page.locator(".recording-sign")).to_contain_text("REC")
    expect(shown).to_contain_text("Started again")
    newest = page.get_by_role("row").nth(1)
    expect(newest).to_contain_text("dry plate again")
    eventually(lambda: "finished" in newest.inner_text(), "it is over", told=library.rig.story)
    expect(newest.locator("svg.sparkline")).to_be_visible()
    button(shown, "Show it").click()
    expect(button(details(page), "Replay")).to_be_enabled()


def test_the_bar_says_why_a_run_is_not_recorded_any_more(library: Library, visit: Visit) -> None:
    page = visit.page
    library.rig.send("POST", "/arm")
    library.rig.send("POST", "/runs", {"label": "no room"})
    expect(page.locator(".recording-sign")).to_contain_text("REC")
    try:
        library.rig.send("POST", "/simulation/faults", {"name": "disk_full"})
        expect(page.get_by_role("alert").filter(has_text="Not recorded")).to_be_visible()
    finally:
        library.rig.send("DELETE", "/simulation/faults/disk_full")
    expect(page.get_by_role("row").nth(1)).to_contain_text("aborted")
    names(page).first.click()
    expect(details(page)).to_contain_text("its recording has failed")


def test_runs_are_compared_deleted_and_pruned_and_stop_stays_in_reach(library: Library, visit: Visit) -> None:
    page = visit.page
    for name in ("old-001", "old-010"):
        page.get_by_label(f"Select {name}").press("Enter")
    expect(button(page, "Compare")).to_be_disabled()
    button(page, "Delete…").click()
    asked = page.get_by_role("dialog")
    expect(asked).to_contain_text("Delete old-001?")
    expect(asked).to_contain_text("old-010 stays")
    button(page, "STOP").click()
    expect(rig_state(page)).to_contain_text("fault")
    button(asked, "Delete").click()
    expect(names(page).filter(has_text="old-001")).to_have_count(0)
    expect(names(page).filter(has_text="old-010")).to_have_count(1)
    library.rig.send("PATCH", "/runs/old-010", {"pinned": False})
    library.rig.send("DELETE", "/runs/old-010")
    expect(button(page, "Untick")).to_have_count(0)

    page.get_by_label("Search runs").fill("old-")
    expect(page.get_by_text(f"{OLD_RUNS - 2} found")).to_be_visible()
    button(page, "Show more").scroll_into_view_if_needed()
    expect(names(page)).to_have_count(OLD_RUNS - 2)
    oldest = {"older_than_days": A_YEAR.days + OLD_RUNS - 6, "dry_run": False}
    library.rig.send("POST", "/runs/prune", oldest)
    expect(names(page).filter(has_text="old-069")).to_have_count(0)
    button(page, "Show all runs").click()

    button(page, "Prune…").click()
    asked.get_by_label("Older than").fill("300")
    unpinned = OLD_RUNS - 2 - 6 - 6
    expect(asked).to_contain_text(f"{unpinned} runs, 0 kB would go")
    button(asked, f"Delete {unpinned} runs").click()
    expect(asked).to_have_count(0)
    expect(names(page).filter(has_text="old-002")).to_have_count(0)
    assert library.rig.ask("/runs?text=old-")["total"] == 6

    for label in LABELS:
        page.get_by_label(f"Select {label}", exact=True).press("Enter")
    button(page, "Compare").click()
    expect(page).to_have_url(re.compile(f"#replay={','.join(library.recorded)}"))
    button(page, "Back to live").click()


def test_on_a_phone_the_details_are_a_sheet_under_the_bar_that_a_replay_puts_away(
    library: Library, open_tab: OpenTab
) -> None:
    page = open_tab(library.rig.url, 390, 844, scene=False).page
    names(page).filter(has_text="wet plate").click()
    sheet, bar = details(page).bounding_box(), page.get_by_role("banner").bounding_box()
    assert sheet is not None
    assert bar is not None
    assert sheet["y"] >= bar["height"]
    assert sheet["width"] == 390
    expect(button(page, "STOP")).to_be_in_viewport()
    expect(details(page).get_by_role("heading", name="wet plate")).to_be_focused()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    button(details(page), "Close").click()
    expect(names(page).filter(has_text="wet plate")).to_be_focused()
    names(page).filter(has_text="wet plate").click()
    button(details(page), "Replay").click()
    expect(page.get_by_role("img", name="Recorded camera picture")).to_be_in_viewport()
    expect(details(page)).to_have_count(0)

    names(page).filter(has_text="wet plate").click()
    field(details(page), "Notes").fill("half a litre")
    page.goto("about:blank")
    eventually(
        lambda: library.rig.ask(f"/runs/{library.recorded[0]}")["notes"] == "half a litre",
        "notes that were typed just before the page was closed",
    )

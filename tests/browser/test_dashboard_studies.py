"""The tab of studies: one is made by the form and watched to its end; a campaign on the rig is stopped and resumed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from dashboard_visit import PATIENCE, OpenTab, ServedRig, Visit, eventually
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive

COMPUTED_WITHIN = 90.0
"""A batch of some short runs, its process started at a low priority, s."""


@pytest.fixture(scope="module")
def office(served: ServedRig, open_lasting_tab: OpenTab) -> Visit:
    return open_lasting_tab(served.url, scene=False)


@pytest.fixture
def visit(served: ServedRig, office: Visit) -> Iterator[Visit]:
    """The list of studies, beside a rig at rest; at the end nobody has complained."""
    served.rest()
    office.page.get_by_role("tab", name="Studies").click()
    back = button(office.page, "‹ All studies")
    if back.is_visible():
        back.click()
    expect(button(office.page, "New study")).to_be_enabled()
    yield office
    assert office.complaints == []
    assert office.foreign(served.url) == []


def button(place: Page | Locator, name: str) -> Locator:
    return place.get_by_role("button", name=name, exact=True)


def field(place: Page | Locator, name: str) -> Locator:
    return place.get_by_role("textbox", name=name, exact=True)


def short_study(page: Page, name: str, *, seconds: float, repeats: int = 2) -> Locator:
    """The form of a study of short runs, two sweeps; the part that says how many runs that are."""
    button(page, "New study").click()
    form = page.get_by_role("article", name="New study")
    field(form, "Name").fill(name)
    form.get_by_label("Axis", exact=True).select_option("gait.sweep_deg")
    field(form, "Values in °").fill("20, 30")
    field(form, "Runs of each set").fill(str(repeats))
    form.get_by_text("Order, length and limits").click()
    field(form, "A run ends after").fill(str(seconds))
    return form


def test_a_batch_is_made_by_the_form_watched_to_its_end_and_reported(
    served: ServedRig, visit: Visit, tmp_path: Path
) -> None:
    page = visit.page
    wait_for_the_robot(served)
    form = short_study(page, "two sweeps", seconds=3)
    size = form.get_by_role("complementary", name="Before it starts")
    expect(size).to_contain_text("4 runs")
    expect(size).to_contain_text("2 sets × 2")
    what_is_wrong_is_said_beside_the_field(form)
    keep_and_take_back(page, form, tmp_path)
    vary_a_controller_too(form)
    expect(size).to_contain_text("8 runs")
    button(form, "Start study").click()

    study = page.get_by_role("article", name="two sweeps")
    expect(study.get_by_text("8 of 8 runs")).to_be_visible(timeout=COMPUTED_WITHIN * 1e3)
    expect(study.locator(".study-state")).to_have_text("finished")
    cells = study.locator(".heat-cell[data-state=known]")
    expect(cells).to_have_count(4)
    expect(cells.first).to_contain_text("n 2")
    expect(study.locator(".heat-legend")).to_contain_text("ME in robot lengths")
    study.get_by_text("Lines", exact=True).click()
    expect(study.locator(".lines .mark")).to_have_count(4)
    study.get_by_text("Table", exact=True).click()
    expect(study.get_by_role("row")).to_have_count(5)
    look_at_the_report(page, study)

    button(study, "Delete…").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    expect(page.get_by_text("No study yet.")).to_be_visible()
    assert served.ask("/studies")["studies"] == []


def test_a_search_shows_all_that_it_tried_before_what_it_has_learned_and_its_answer(
    served: ServedRig, visit: Visit
) -> None:
    ranges = {"gait.sweep_deg": (10, 40), "gait.tilt_deg": (10, 35), "controller.gain": (1, 8)}
    definition = {
        "name": "three ranges", "design": "tune", "duration_s": 3.0, "gait": {"time_law": "wait"},
        "axes": [{"of": name, "from": low, "to": high} for name, (low, high) in ranges.items()],
        "tune": {"budget": 8, "first": 5, "at_once": 2, "confirm": 1},
    }  # fmt: skip
    served.send("POST", "/studies", {"definition": definition})
    (made,) = served.ask("/studies")["studies"]
    page = visit.page
    page.get_by_role("button", name="three ranges").first.click()
    study = page.get_by_role("article", name="three ranges")
    expect(study.get_by_text("8 of 8 runs")).to_be_visible(timeout=COMPUTED_WITHIN * 1e3)
    expect(study.get_by_text("The search's answer")).to_contain_text(
        "measured there in 1 run", timeout=COMPUTED_WITHIN * 1e3
    )
    expect(study.locator(".dot")).to_have_count(len(served.ask(f"/studies/{made['id']}")["sets"]))
    expect(study.locator(".surface rect")).to_have_count(41 * 41)
    picture, learned = (study.locator(one).bounding_box() for one in (".scatter svg", ".surface"))
    assert picture is not None
    assert learned is not None
    assert picture["x"] + 50 <= learned["x"]
    served.send("DELETE", f"/studies/{made['id']}")


def wait_for_the_robot(served: ServedRig) -> None:
    """The page's selection, which a new study begins with; by a time law for which nobody waits for a compiler."""
    selection = served.ask("/selection")
    served.send("PUT", "/selection", {**selection, "gait": {**selection["gait"], "time_law": "wait"}})


def what_is_wrong_is_said_beside_the_field(form: Locator) -> None:
    repeats = field(form, "Runs of each set")
    repeats.fill("0")
    expect(form.locator(".field-error", has_text="greater than or equal to 1").first).to_be_visible()
    expect(repeats).to_have_attribute("aria-invalid", "true")
    expect(button(form, "Start study")).to_be_disabled()
    repeats.fill("2")
    expect(button(form, "Start study")).to_be_enabled()


def keep_and_take_back(page: Page, form: Locator, folder: Path) -> None:
    """The definition as a file, and the same form from that file."""
    with page.expect_download() as started:
        button(form, "Export TOML").click()
    assert started.value.suggested_filename == "two-sweeps.toml"
    path = folder / "study.toml"
    started.value.save_as(path)
    path.write_text(path.read_text().replace("repeats = 2", "repeats = 5"))
    form.get_by_label("Study definition").set_input_files(path)
    expect(field(form, "Runs of each set")).to_have_value("5")
    expect(field(form, "Values in °")).to_have_value("20, 30")
    field(form, "Runs of each set").fill("2")


def vary_a_controller_too(form: Locator) -> None:
    button(form, "Add an axis").click()
    second = form.get_by_role("group", name="Axis 2")
    for name in ("geometric", "gradient"):
        expect(second.get_by_label(name)).to_be_checked()


def look_at_the_report(page: Page, study: Locator) -> None:
    with page.context.expect_page(timeout=COMPUTED_WITHIN * 1e3) as opened:
        study.get_by_role("link", name="Report").click()
    report = opened.value
    expect(report.locator("h1")).to_contain_text("two sweeps")
    report.close()


def test_a_campaign_walks_the_rig_is_stopped_by_stop_and_resumed_by_a_person(
    served: ServedRig, visit: Visit
) -> None:
    page = visit.page
    eventually(lambda: served.ask("/state")["tracking"] == "locked", "the camera sees the robot")
    form = short_study(page, "on the rig", seconds=1, repeats=20)
    form.get_by_label("On", exact=True).select_option("This rig, run by run")
    expect(form.get_by_label("Plant")).to_have_count(0)
    button(form, "Start study").click()
    study = page.get_by_role("article", name="on the rig")
    expect(study.locator(".study-now")).to_contain_text(re.compile("run 1 of 40", re.IGNORECASE))
    sign = page.get_by_role("group", name="Study under way")
    expect(sign).to_contain_text("on the rig")

    page.keyboard.press("Escape")
    expect(study.locator(".study-state")).to_have_text("stopped")
    expect(page.get_by_role("status").first).to_contain_text("fault")
    expect(sign).to_have_count(0)
    done = served.ask("/studies")["studies"][0]["done"]

    button(study, "Resume study").click()
    expect(study.locator(".study-now")).to_contain_text("waiting for a person", ignore_case=True)
    button(page, "Reset").click()
    button(page, "Arm").click()
    eventually(
        lambda: served.ask("/studies")["studies"][0]["done"] > done,
        "another run of the study",
        8 * PATIENCE,
    )
    button(study, "Stop study").click()
    expect(study.locator(".study-state")).to_have_text("stopped")
    button(study, "Its runs").click()
    expect(page.locator(".run-name").first).to_contain_text("on the rig: run")
    expect(page.get_by_role("button", name="Study: on the rig")).to_be_visible()
    button(page, "Show all runs").click()

"""The camera's setup on a page that is left, on two pages at once, and on one without its server."""

from __future__ import annotations

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, eventually
from playwright.sync_api import expect
from setup_visit import button, open_setup, panel

pytestmark = pytest.mark.exclusive


@pytest.fixture
def visit(workshop: ServedRig, open_tab: OpenTab) -> Visit:
    """With the camera as it comes."""
    workshop.rest()
    workshop.send("PATCH", "/rig", {"simulation": None, "camera": None})
    return open_tab(workshop.url, scene=False)


def test_a_board_that_was_left_by_a_page_that_was_closed_can_be_taken_away(
    visit: Visit, workshop: ServedRig
) -> None:
    page = visit.page
    workshop.send("PUT", "/simulation/board", {"shown": True, "pose": "next"})
    workshop.send("POST", "/estop")
    setup = open_setup(page, "Camera")
    setup.get_by_role("group", name="Printed board").get_by_role("button", name="Take the board away").click()
    expect(setup.get_by_role("group", name="Printed board")).to_have_count(0)
    eventually(lambda: workshop.ask("/state")["tracking"] == "locked", "the robot is seen again")

    workshop.rest()
    page.get_by_role("tab", name="Plane").click()
    button(page, "Lay the printed board on the plate").click()
    expect(button(page, "Take the board away")).to_be_visible()
    page.reload()
    eventually(lambda: workshop.ask("/state")["tracking"] == "locked", "a page that is left takes it away")


def test_the_overview_says_what_is_measured_and_leads_to_the_step_that_measures_it(
    visit: Visit, workshop: ServedRig
) -> None:
    page = visit.page
    page.get_by_role("tab", name="Calibration").click()
    overview = page.get_by_role("region", name="Calibration", exact=True)
    plane = overview.get_by_role("listitem", name="Plane", exact=True)
    expect(plane).to_contain_text("assumed")
    expect(overview.get_by_role("listitem", name="Field of the coils")).to_contain_text(
        "pivotrig calibrate coils"
    )
    plane.get_by_role("button", name="Calibrate: Plane").click()
    expect(page.get_by_role("tab", name="Plane")).to_have_attribute("aria-selected", "true")
    expect(panel(page)).to_be_visible()
    button(page, "Lay the printed board on the plate").click()
    expect(button(page, "Take the board away")).to_be_visible()
    button(page, "Look for the board").click()
    button(page, "Save the plane").click()
    expect(plane).to_contain_text("from the printed board")
    expect(plane).to_contain_text("today")
    # Pictures of another size are not those that it was found in.
    workshop.send("PATCH", "/rig", {"camera": {"size_px": [320, 240]}})
    expect(plane).to_contain_text("needs attention")
    expect(plane).to_contain_text("Not used: it was made for")
    assert visit.complaints == []


def test_two_pages_see_each_other_s_saves_and_neither_undoes_the_other_s(
    visit: Visit, workshop: ServedRig, open_tab: OpenTab
) -> None:
    page, other = visit.page, open_tab(workshop.url, scene=False).page
    workshop.send("PATCH", "/rig", {"name": "Bench 6"})
    setup, watching = open_setup(page, "Plane"), open_setup(other, "Plane")
    button(page, "Lay the printed board on the plate").click()
    expect(button(page, "Take the board away")).to_be_visible()
    button(page, "Look for the board").click()
    button(page, "Save the plane").click()
    expect(watching.get_by_role("region", name="Saved now")).to_contain_text("the printed board")
    expect(other.get_by_role("tab", name="Plane")).to_contain_text("done")
    workshop.send("PATCH", "/rig", {"name": "Bench 7"})
    button(page, "Undo").click()
    expect(setup.get_by_text("Somebody else has changed the rig file since")).to_be_visible()
    assert workshop.ask("/rig")["name"] == "Bench 7"
    assert visit.complaints == []


def test_without_a_connection_the_setup_is_out_of_reach_as_the_rest_of_the_page(
    own_server: ServedRig, open_tab: OpenTab
) -> None:
    page = open_tab(own_server.url, scene=False).page
    open_setup(page, "Lens")
    own_server.kill()
    expect(page.get_by_role("alert").filter(has_text="No connection")).to_be_visible()
    expect(page.locator("main[inert] .wizard")).to_have_count(1)
    expect(page.get_by_role("button", name="STOP", exact=True)).to_be_enabled()

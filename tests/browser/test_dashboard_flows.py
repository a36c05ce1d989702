"""What people come for, from the first click to the last, in the windows that they have: by roles and texts alone.

An everyday test walks each flow in one window, and the windows take turns; the full one walks each in all of them.
"""

from __future__ import annotations

import contextlib
import math
import re
from collections.abc import Iterator

import pytest
from camera_visit import Plate, PlateMM, board, tool
from dashboard_visit import PATIENCE, OpenTab, ServedRig, Visit, eventually, rig_state
from playwright.sync_api import Locator, Page, expect
from rooms import Room
from setup_visit import button as setup_button
from setup_visit import click_robot, open_setup
from views import TABS, tab_of

pytestmark = pytest.mark.exclusive

HALF_A_ROBOT = 5.0
"""mm"""
HAND = 1.5
"""A path by hand is this near to the line that was drawn, mm."""
A_WHILE = 6 * PATIENCE
"""For what a process of its own computes, or what the robot walks, s."""


@pytest.fixture
def visit(room: Room, workshop: ServedRig, open_tab: OpenTab) -> Iterator[Visit]:
    """A rig at rest with the camera as it comes; at the end nobody has complained."""
    workshop.rest()
    workshop.send("DELETE", "/simulation/faults")
    workshop.send("PATCH", "/rig", {"camera": None})
    visit = open_tab(workshop.url, scene=False, room=room)
    expect(rig_state(visit.page)).to_contain_text("disarmed")
    expect(rig_state(visit.page)).to_contain_text("locked")
    yield visit
    assert visit.complaints == []


@pytest.fixture
def page(visit: Visit) -> Page:
    return visit.page


def button(place: Page | Locator, name: str) -> Locator:
    return place.get_by_role("button", name=name, exact=True)


def field(place: Locator, name: str) -> Locator:
    return place.get_by_role("textbox", name=name, exact=True)


def state_is(page: Page, word: str) -> None:
    expect(rig_state(page)).to_contain_text(re.compile(rf"\b{word}"))


def open_page(page: Page, name: str) -> Locator:
    tab_of(page, name).click()
    return page.get_by_role("tabpanel", name=name)


def arm(page: Page) -> None:
    button(page, "Arm").click()
    state_is(page, "armed")


def reset(page: Page) -> None:
    """Again, when a stop that was on its way comes after the first."""
    fault = rig_state(page).filter(has_text="fault")
    while fault.count() > 0:
        button(page, "Reset").click()
        with contextlib.suppress(AssertionError):
            expect(fault).to_have_count(0, timeout=3e3)
    state_is(page, "disarmed")


def walk(page: Page) -> None:
    button(page, "Arm").click()
    button(page, "Start walking").click()
    state_is(page, "running")


def place(rig: ServedRig) -> PlateMM:
    pose = rig.ask("/state")["pose"]
    return pose["x_mm"], pose["y_mm"]


def test_from_the_first_visit_it_is_two_clicks_to_a_walking_robot(
    room: Room, workshop: ServedRig, open_tab: OpenTab
) -> None:
    workshop.rest()
    page = open_tab(workshop.url, scene=False, tour=True, room=room).page
    expect(page.get_by_text("SIM", exact=True)).to_be_visible()
    expect(page.get_by_role("region", name="Tour")).to_be_visible()
    walk(page)
    start = place(workshop)
    eventually(lambda: math.dist(start, place(workshop)) > HALF_A_ROBOT, "the robot has left its place", 60)
    expect(page.get_by_role("progressbar")).to_be_visible()


def test_a_path_is_drawn_with_one_stroke_and_walked(page: Page, workshop: ServedRig) -> None:
    tool(page, "Draw a path").click()
    x, y = place(workshop)
    ahead, aside = (
        -math.copysign(0.6, x),
        -math.copysign(16.0, y),
    )  # inwards, wherever earlier walks have ended
    line = [(x + ahead * step, y + aside * math.sin(math.pi * step / 60)) for step in range(61)]
    board(page).get_by_role("radio", name="Freehand").locator("xpath=..").click()
    Plate(workshop).drag(page, line)
    expect(board(page)).to_contain_text(re.compile(r"\d\d mm long"))
    button(board(page), "Use this path").click()
    eventually(
        lambda: workshop.ask("/selection")["trajectory"]["name"] == "waypoints", "the rig has the path"
    )
    tool(page, "Draw a path").click()
    walk(page)
    eventually(
        lambda: math.dist(line[0], place(workshop)) > 2 * HALF_A_ROBOT, "the robot follows the line", A_WHILE
    )
    assert min(math.dist(place(workshop), at) for at in line) < 3 * HAND


def test_the_plane_is_calibrated_with_the_printed_board(page: Page, workshop: ServedRig) -> None:
    open_page(page, "Calibration").get_by_role("button", name=re.compile("Calibrate: .*[Pp]lane")).click()
    setup_button(page, "Lay the printed board on the plate").click()
    setup_button(page, "Look for the board").click()
    setup_button(page, "Save the plane").click()
    setup = page.get_by_role("region", name="Set up the camera")
    expect(setup.get_by_role("region", name="Saved now")).to_contain_text("the printed board")
    expect(page.get_by_role("tab", name="Plane")).to_contain_text("done")
    setup_button(page, "Close").click()
    eventually(lambda: workshop.ask("/state")["tracking"] == "locked", "the robot is tracked again")
    assert workshop.ask("/calibration")["plane"]["fits"]


def test_the_colour_is_picked_by_a_click_on_the_robot(page: Page, workshop: ServedRig) -> None:
    before = workshop.ask("/vision")["colour"]
    tool(page, "Pick the robot’s colour").click()
    expect(page.get_by_text("Click the robot", exact=True)).to_be_visible()
    click_robot(page, workshop)
    setup_button(page, "Use this colour").click()
    expect(page.get_by_text("Saved in the rig file.")).to_be_visible()
    assert workshop.ask("/vision")["colour"] != before
    setup_button(page, "Undo").click()
    expect(page.get_by_text("The rig file is as it was before.")).to_be_visible()
    assert workshop.ask("/vision")["colour"] == before


def test_a_run_is_made_found_and_replayed(page: Page, workshop: ServedRig) -> None:
    walk(page)
    eventually(lambda: (workshop.ask("/state")["run"] or {}).get("elapsed_s", 0) > 2, "two seconds of a run")
    button(page, "Stop run").click()
    newest = lambda: workshop.ask("/runs?limit=1")["runs"][0]  # noqa: E731
    eventually(lambda: newest()["recording"]["state"] == "complete", "a recorded run")

    runs = open_page(page, "Runs")
    runs.get_by_label("Search runs").fill(newest()["id"])
    expect(runs.get_by_text("1 found")).to_be_visible()
    button(runs, newest()["id"]).click()
    button(page.get_by_role("complementary"), "Replay").click()
    time = page.get_by_role("slider", name="Time in the recording")
    expect(time).to_be_visible()
    state_is(page, "armed")
    button(page, "Play").click()
    eventually(lambda: float(time.get_attribute("aria-valuenow") or 0) > 0.5, "the recording plays")
    button(page, "Back to live").click()
    expect(page.get_by_role("img", name="Camera picture")).to_be_visible()


def test_a_study_is_started_stopped_and_resumed(page: Page, workshop: ServedRig, room: Room) -> None:
    button(open_page(page, "Studies"), "New study").click()
    form = page.get_by_role("article", name="New study")
    name = f"sweeps {room}"
    field(form, "Name").fill(name)
    form.get_by_label("Axis", exact=True).select_option("gait.sweep_deg")
    field(form, "Values in °").fill("20, 30")
    field(form, "Runs of each set").fill("5000")
    form.get_by_text("Order, length and limits").click()
    field(form, "A run ends after").fill("3")
    button(form, "Start study").click()

    study = page.get_by_role("article", name=name)
    done = lambda: sum(each["done"] for each in workshop.ask("/studies")["studies"] if each["name"] == name)  # noqa: E731
    eventually(lambda: done() > 0, "a run of the study", A_WHILE)
    button(study, "Stop study").click()
    expect(button(study, "Resume study")).to_be_enabled(timeout=A_WHILE * 1e3)
    halfway = done()
    assert halfway < 10_000
    button(study, "Resume study").click()
    eventually(lambda: done() > halfway, "another run of the study", A_WHILE)
    button(study, "Stop study").click()
    expect(button(study, "Delete…")).to_be_enabled(timeout=A_WHILE * 1e3)
    button(study, "Delete…").click()
    button(page.get_by_role("dialog"), "Delete").click()
    expect(page.get_by_role("article", name=name)).to_have_count(0)


def test_a_key_stops_the_rig_from_every_tab(page: Page) -> None:
    for number, name in enumerate(TABS):
        arm(page)
        open_page(page, name)
        page.keyboard.press(("Escape", "Space")[number % 2])
        state_is(page, "fault")
        expect(tab_of(page, name)).to_have_attribute("aria-selected", "true")
        reset(page)
    arm(page)
    open_setup(page, "Colour")
    page.keyboard.press("Escape")
    state_is(page, "fault")


def test_a_jog_ends_when_the_page_loses_the_focus(page: Page, workshop: ServedRig) -> None:
    jog = page.get_by_role("region", name="Jog")
    jog.get_by_role("button", name="Jog").click()
    arm(page)
    pad = jog.get_by_role("button", name="Turn left about A")
    expect(pad).to_be_enabled()
    pad.hover()
    page.mouse.down()
    eventually(lambda: turning(workshop), "the field turns")
    page.evaluate("dispatchEvent(new Event('blur'))")
    eventually(lambda: not turning(workshop), "the field stands still", timeout=2.0)
    page.mouse.up()
    state_is(page, "armed")


def turning(rig: ServedRig) -> bool:
    return rig.ask("/state")["command"]["rate_deg_s"] != 0


def test_a_camera_that_is_lost_holds_the_robot_and_comes_back(page: Page) -> None:
    walk(page)
    faults = open_page(page, "Faults")
    unplug = faults.get_by_role("button", name=re.compile("^Unplug the camera"))
    unplug.click()
    state_is(page, "held")
    expect(page.get_by_role("region", name="Camera", exact=True)).to_contain_text("no frame for")
    unplug.click()
    expect(page.get_by_role("region", name="Camera", exact=True)).not_to_contain_text("no frame for")
    button(page, "Resume").click()
    state_is(page, "running")


def test_a_server_that_is_killed_and_started_again_finds_its_page_as_it_was(
    room: Room, own_server: ServedRig, open_tab: OpenTab
) -> None:
    page = open_tab(own_server.url, scene=False, room=room).page
    arm(page)
    own_server.kill()
    lost = page.get_by_role("alert").filter(has_text="No connection")
    expect(lost).to_be_visible()
    expect(button(page, "STOP")).to_be_in_viewport(ratio=1.0)
    own_server.start()
    expect(lost).to_have_count(0)
    state_is(page, "disarmed")
    arm(page)

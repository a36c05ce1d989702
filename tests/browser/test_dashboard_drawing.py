"""Paths drawn into the camera picture and walked, distances measured, and pictures looked at closely."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from camera_visit import Plate, PlateMM, board, farthest_from, ready, tool, zoom_button
from dashboard_visit import OpenTab, ServedRig, Visit, eventually, rig_state
from picture import pixels
from playwright.sync_api import Page, expect
from setup_visit import picture

pytestmark = pytest.mark.exclusive

HAND = 1.5
"""A path by hand is this near to the line that was drawn, mm."""
WALK = 2.0
"""Mean error of a robot that follows it, mm."""
CLICK = 0.4
"""A click is this near to its place on the plate, mm; a CSS pixel is 0.3 mm."""


@pytest.fixture(scope="module")
def visit(workshop: ServedRig, open_lasting_tab: OpenTab) -> Visit:
    visit = open_lasting_tab(workshop.url, scene=False)
    ready(visit.page)
    return visit


@pytest.fixture
def page(visit: Visit, workshop: ServedRig) -> Page:
    """The board is empty, the picture is whole, the rig rests."""
    workshop.rest()
    page = visit.page
    if tool(page, "Draw a path").get_attribute("aria-pressed") != "true":
        tool(page, "Draw a path").click()
    if button(page, "Clear").is_enabled():
        button(page, "Clear").click()
    expect(board(page)).to_contain_text("Nothing is drawn yet")
    return page


@pytest.fixture(scope="module")
def plate(workshop: ServedRig) -> Plate:
    return Plate(workshop)


def button(page: Page, name: str):
    return board(page).get_by_role("button", name=name, exact=True)


def choose(page: Page, way: str) -> None:
    board(page).get_by_role("radio", name=way).locator("xpath=..").click()


def selected(rig: ServedRig) -> dict:
    return rig.ask("/selection")["trajectory"]


def bow(start: PlateMM) -> list[PlateMM]:
    """To the right and up, as a hand would draw it."""
    x, y = start
    return [(x + 40 * step / 30, y + 18 * math.sin(math.pi * step / 30)) for step in range(31)]


def test_a_line_drawn_by_hand_is_walked(page: Page, plate: Plate, workshop: ServedRig) -> None:
    pose = workshop.ask("/state")["pose"]
    line = bow((pose["x_mm"], pose["y_mm"]))
    choose(page, "Freehand")
    plate.drag(page, line)
    expect(board(page)).to_contain_text(re.compile(r"\d\d mm long"))
    button(page, "Use this path").click()
    expect(board(page)).to_contain_text("Selected: the next run walks it.")
    eventually(lambda: selected(workshop)["name"] == "waypoints", "the path is selected")
    chosen = selected(workshop)["parameters"]
    assert chosen["kind"] == "spline"
    assert not chosen["closed"]
    assert farthest_from(line, chosen["points_mm"]) < HAND

    page.get_by_role("button", name="Arm", exact=True).click()
    page.get_by_role("button", name="Start walking", exact=True).click()
    expect(rig_state(page)).to_contain_text("running")
    eventually(
        lambda: (workshop.ask("/state")["run"] or {}).get("passes_done", 0) > 0.3, "a third of the way", 60
    )
    assert workshop.ask("/state")["run"]["mean_error_mm"] < WALK


def test_points_are_clicked_dragged_put_between_and_removed_and_each_step_is_undone(
    page: Page, plate: Plate, workshop: ServedRig
) -> None:
    choose(page, "Points")
    expect(page.get_by_text("Click the first point of the path")).to_be_visible()
    for at in [(-30.0, 0.0), (0.0, 25.0), (30.0, 0.0)]:
        plate.click(page, at)
    expect(board(page)).to_contain_text("3 points")
    plate.drag(page, [(30.0, 0.0), (33.0, -6.0), (35.0, -15.0)])
    button(page, "Use this path").click()
    eventually(lambda: selected(workshop)["name"] == "waypoints", "the path is selected")
    last = selected(workshop)["parameters"]["points_mm"][-1]
    assert math.dist(last, (35.0, -15.0)) < CLICK

    board(page).get_by_label("Curved").uncheck()
    expect(board(page)).to_contain_text(re.compile(r"\d\d mm long"))
    plate.click(page, (-15.0, 12.5))
    expect(board(page)).to_contain_text("4 points")
    page.mouse.dblclick(*plate.on_page(page, (0.0, 25.0)))
    expect(board(page)).to_contain_text("3 points")
    for count in ("4 points", "3 points"):
        button(page, "Undo").click()
        expect(board(page)).to_contain_text(count)
    picture(page).focus()
    page.keyboard.press("Control+y")
    expect(board(page)).to_contain_text("4 points")
    page.keyboard.press("Control+z")
    expect(board(page)).to_contain_text("3 points")
    button(page, "Clear").click()
    expect(board(page)).to_contain_text("Nothing is drawn yet")
    button(page, "Undo").click()
    expect(board(page)).to_contain_text("3 points")


def test_a_point_beyond_the_plate_is_told_of_and_not_walked(page: Page, plate: Plate) -> None:
    choose(page, "Points")
    for at in [(-20.0, 0.0), (20.0, 10.0)]:
        plate.click(page, at)
    expect(button(page, "Use this path")).to_be_enabled()
    plate.drag(page, [(20.0, 10.0), (50.0, 10.0), (72.0, 10.0)])
    expect(board(page)).to_contain_text("One point lies outside the workspace, ±60 mm: move it inside.")
    expect(button(page, "Use this path")).to_be_disabled()
    expect(button(page, "Save as…")).to_be_disabled()
    page.keyboard.press("Control+z")
    expect(button(page, "Use this path")).to_be_enabled()


def test_without_a_mouse_arrows_and_enter_draw_and_delete_removes(page: Page) -> None:
    choose(page, "Points")
    picture(page).focus()
    page.keyboard.press("Enter")
    for _ in range(6):
        page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Enter")
    expect(board(page)).to_contain_text("2 points")
    expect(board(page)).to_contain_text(re.compile(r"\d\d mm long"))
    page.keyboard.press("Delete")
    expect(board(page)).to_contain_text("1 point")


def test_a_saved_path_stands_in_the_list_and_survives_a_restart(
    own_server: ServedRig, open_tab: OpenTab
) -> None:
    visit = open_tab(own_server.url, scene=False)
    page, plate = visit.page, Plate(own_server)
    ready(page)
    tool(page, "Draw a path").click()
    choose(page, "Points")
    board(page).get_by_label("Closed").check()
    for at in [(-20.0, -20.0), (-20.0, 20.0), (25.0, 0.0)]:
        plate.click(page, at)
    save_as(page, "three stones")
    expect(board(page)).to_contain_text("Saved and selected as “three stones”.")
    trajectory = page.get_by_role("region", name="Run", exact=True).get_by_label("Trajectory", exact=True)
    expect(trajectory.locator("option:checked")).to_have_text("three stones")
    save_as(page, "three stones")
    expect(board(page).get_by_role("alert")).to_contain_text("already")

    own_server.stop()
    own_server.start()
    page.reload()
    ready(page)
    expect(trajectory.locator("option", has_text="three stones")).to_have_count(1)
    tool(page, "Draw a path").click()
    board(page).get_by_text("Saved paths").click()
    button(page, "Edit three stones").click()
    expect(board(page)).to_contain_text("3 points")
    expect(board(page).get_by_label("Closed")).to_be_checked()

    button(page, "Rename three stones").click()
    board(page).get_by_label("New name of three stones").fill("four stones")
    button(page, "Rename").click()
    button(page, "Delete four stones").click()
    expect(board(page).get_by_text("“four stones” is deleted.")).to_be_visible()
    expect(trajectory.locator("option", has_text="four stones")).to_have_count(0)
    button(page, "Undo delete").click()
    expect(trajectory.locator("option", has_text="four stones")).to_have_count(1)


def save_as(page: Page, name: str) -> None:
    button(page, "Save as…").click()
    board(page).get_by_label("Name of the path").fill(name)
    button(page, "Save").click()


def figures(page: Page) -> tuple[float, float, float, float]:
    """Distance, in x, in y, mm, and the angle, degrees."""
    texts = page.get_by_role("region", name="Measure a distance").get_by_role("definition").all_inner_texts()
    length, x, y, angle = (float(re.sub(r"[^\d.−-]", "", text).replace("−", "-")) for text in texts)
    return length, x, y, angle


def measure(page: Page, plate: Plate, ends: list[PlateMM]) -> None:
    panel = page.get_by_role("region", name="Measure a distance")
    clear = panel.get_by_role("button", name="Clear")
    if clear.is_visible():
        clear.click()
    for at in ends:
        plate.click(page, at)
    expect(panel.get_by_text("Distance", exact=True)).to_be_visible()


def test_a_distance_is_measured_on_the_plate_and_an_end_can_be_moved(page: Page, plate: Plate) -> None:
    tool(page, "Measure a distance").click()
    panel = page.get_by_role("region", name="Measure a distance")
    expect(panel).to_contain_text("is not calibrated")
    measure(page, plate, [(-20.0, -10.0), (10.0, 30.0)])
    assert figures(page) == pytest.approx((50.0, 30.0, 40.0, 53.1), abs=2 * CLICK)
    plate.drag(page, [(10.0, 30.0), (5.0, 10.0), (4.0, -3.0)])
    assert figures(page)[0] == pytest.approx(25.0, abs=2 * CLICK)


def test_a_zoomed_picture_is_pointed_at_as_well(page: Page, plate: Plate) -> None:
    tool(page, "Measure a distance").click()
    there, here = (-40.0, 20.0), (15.0, -12.0)
    measure(page, plate, [there, here])
    whole = figures(page)
    page.get_by_role("region", name="Measure a distance").get_by_role("button", name="Clear").click()
    page.mouse.move(*plate.on_page(page, here))
    for _ in range(6):
        page.mouse.wheel(0, -100)
    expect(zoom_button(page, "Show the whole picture")).to_be_visible()
    plate.click(page, here)  # what lies under the pointer stays there
    picture(page).focus()
    page.keyboard.press("0")
    expect(zoom_button(page, "Show the whole picture")).to_have_count(0)
    plate.click(page, there)
    again = figures(page)
    assert again[0] == pytest.approx(whole[0], abs=CLICK)
    assert again[1:3] == pytest.approx((-whole[1], -whole[2]), abs=CLICK)


def test_the_robots_colour_is_picked_from_the_camera_card(page: Page) -> None:
    tool(page, "Pick the robot’s colour").click()
    expect(page.get_by_role("tab", name="Colour")).to_have_attribute("aria-selected", "true")
    expect(page.get_by_text("Click the robot", exact=True)).to_be_visible()
    page.get_by_role("region", name="Set up the camera").get_by_role("button", name="Close").click()
    expect(tool(page, "Draw a path")).to_be_visible()


# The overlay lies where the robot was when its picture was taken ------------------------------------

BLUE, ORANGE = (233, 180, 86), (0, 159, 230)
"""Ends A and B of the overlay, BGR."""
LOOKS = 16
LEAN = 4.0
"""Median angle between robot and overlay, degrees; the newest pose would lie some 10 degrees beside the picture."""
SLOW_PICTURES = """
  const Plain = WebSocket;
  window.WebSocket = class extends Plain {
    set onmessage(hear) {
      const late = this.url.includes("/camera") ? 250 : 0;
      super.onmessage = late ? (event) => setTimeout(() => hear(event), late) : hear;
    }
  };
"""
"""Pictures come a quarter of a second late, as over a poor network; telemetry does not."""


def middle(shown: np.ndarray, colour: tuple[int, int, int], within: int) -> np.ndarray | None:
    """Of what has this colour, as (x, y)."""
    found = np.argwhere(np.abs(shown.astype(int) - np.array(colour)).max(axis=2) <= within)
    return found.mean(axis=0)[::-1] if len(found) > 12 else None


def lean(shown: np.ndarray) -> float | None:
    """Angle between the red body in the picture and the line from A to B over it, degrees."""
    ends = [middle(shown, colour, 30) for colour in (BLUE, ORANGE)]
    red = np.argwhere((shown[..., 2] > 130) & (shown[..., 1] < 90) & (shown[..., 0] < 90))[:, ::-1]
    if ends[0] is None or ends[1] is None or len(red) < 60:
        return None
    line = ends[1] - ends[0]
    values, axes = np.linalg.eigh(np.cov((red - red.mean(axis=0)).T))
    body = axes[:, values.argmax()]
    angle = abs(math.degrees(math.atan2(body[1], body[0]) - math.atan2(line[1], line[0]))) % 180
    return min(angle, 180 - angle)


def test_over_a_walking_robot_the_overlay_lies_on_the_picture_of_it(
    page: Page, plate: Plate, workshop: ServedRig
) -> None:
    page.add_init_script(SLOW_PICTURES)
    page.reload()
    ready(page)
    pose = workshop.ask("/state")["pose"]
    page.mouse.move(*plate.on_page(page, (pose["x_mm"], pose["y_mm"])))
    for _ in range(5):
        page.mouse.wheel(0, -100)
    page.mouse.move(5, 5)
    page.get_by_role("button", name="Arm", exact=True).click()
    page.get_by_role("button", name="Start walking", exact=True).click()
    expect(rig_state(page)).to_contain_text("running")
    leans = [found for _ in range(LOOKS) if (found := lean(pixels(picture(page)))) is not None]
    picture(page).focus()
    page.keyboard.press("0")
    assert len(leans) >= LOOKS / 4
    assert float(np.median(leans)) < LEAN, sorted(leans)

"""The camera's setup to its end: lens and plane from the printed board, four corners, and STOP throughout."""

from __future__ import annotations

import re
from typing import Literal

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, eventually, rig_state
from playwright.sync_api import Page, expect
from setup_visit import (
    button,
    click_picture,
    distance_from,
    open_setup,
    panel,
    picture,
    place_on_page,
    robot_place,
)

pytestmark = pytest.mark.exclusive

A_WHILE = 60e3
"""Taking and solving a dozen views, ms; the machine also simulates the camera and the browser."""


@pytest.fixture
def visit(workshop: ServedRig, open_tab: OpenTab) -> Visit:
    """With the camera as it comes, and nobody else on the plate."""
    workshop.rest()
    workshop.send("PATCH", "/rig", {"simulation": None, "camera": None})
    return open_tab(workshop.url, scene=False)


def take_all_views(page: Page) -> None:
    button(page, "Take views").click()
    expect(button(page, "Pause")).to_be_visible()
    expect(button(page, "Take views")).to_be_visible(timeout=A_WHILE)


def test_lens_and_plane_are_calibrated_with_the_shown_board_and_the_robot_is_tracked_with_them(
    visit: Visit, workshop: ServedRig
) -> None:
    page = visit.page
    setup = open_setup(page, "Lens")
    expect(setup.get_by_role("link", name="Print the board")).to_be_visible()
    take_all_views(page)
    button(page, "Work out the lens").click()
    expect(setup.get_by_role("region", name="Found")).to_contain_text("good", timeout=A_WHILE)
    button(page, "Save the lens").click()
    expect(setup.get_by_text("Saved. The plane comes next")).to_be_visible(timeout=A_WHILE)
    expect(setup.get_by_role("region", name="Saved now")).to_contain_text("simulated camera")

    page.get_by_role("tab", name="Plane").click()
    button(page, "Lay the printed board on the plate").click()
    button(page, "Look for the board").click()
    expect(setup.get_by_role("region", name="Found")).to_contain_text(
        re.compile(r"(below )?0\.0\d mm.*good", re.DOTALL)
    )
    button(page, "Save the plane").click()
    expect(setup.get_by_role("region", name="Saved now")).to_contain_text("the printed board")
    expect(page.get_by_role("tab", name="Plane")).to_contain_text("done")

    saved = workshop.ask("/calibration")
    assert saved["lens"]["fits"]
    assert saved["plane"]["fits"]
    eventually(lambda: workshop.ask("/state")["tracking"] == "locked", "the robot is tracked again")
    assert visit.complaints == []


def corners_of_the_workspace(rig: ServedRig) -> list[tuple[float, float]]:
    """Where the page draws the corners of the 120 mm square, without the lens's distortion, px."""
    model = rig.ask("/camera")["model"]
    turn, place = model["rotation"], model["translation_mm"]

    def seen(x: float, y: float) -> tuple[float, float]:
        across, down, away = (turn[3 * i] * x + turn[3 * i + 1] * y + place[i] for i in range(3))
        return model["fx"] * across / away + model["cx"], model["fy"] * down / away + model["cy"]

    return [seen(x, y) for x, y in ((-60, 60), (60, 60), (60, -60), (-60, -60))]


def test_four_clicked_corners_give_a_plane_whose_square_is_drawn_and_a_corner_can_be_dragged(
    visit: Visit, workshop: ServedRig
) -> None:
    page = visit.page
    setup = open_setup(page, "Plane")
    setup.get_by_text("Four corners", exact=True).click()
    expect(page.get_by_text("Click the upper left corner")).to_be_visible()
    for corner in corners_of_the_workspace(workshop):
        click_picture(page, *corner)
    expect(page.get_by_text("Drag the corners until they fit")).to_be_visible()
    button(page, "Work out the plane").click()
    found = setup.get_by_role("region", name="Found")
    expect(found).to_contain_text("mm")
    first = found.inner_text()

    drag_a_corner(page, workshop)
    button(page, "Work out the plane").click()
    expect(found).not_to_have_text(first)
    assert workshop.ask("/calibration")["plane"] is None, "nothing is saved before somebody says so"
    assert visit.complaints == []


def test_corners_are_set_and_moved_by_keys_alone(visit: Visit) -> None:
    page = visit.page
    setup = open_setup(page, "Plane")
    setup.get_by_text("Four corners", exact=True).click()
    picture(page).focus()

    def press(*keys: str) -> None:
        for key in keys:
            page.keyboard.press(key)

    ten = "Shift+Arrow"
    press(*[f"{ten}Left"] * 9, *[f"{ten}Up"] * 9, "Enter")
    for way in ("Right", "Down", "Left"):
        press(*[f"{ten}{way}"] * 18, "Enter")
    expect(page.get_by_text("Drag the corners until they fit")).to_be_visible()
    places = ["230, 150 px", "410, 150 px", "410, 330 px", "230, 330 px"]
    expect(setup.locator("ol.points .soft")).to_have_text(places)
    press("Enter", f"{ten}Left", "ArrowDown", "Enter", f"{ten}Up")
    expect(setup.locator("ol.points .soft")).to_have_text([*places[:3], "220, 331 px"])
    button(page, "Work out the plane").click()
    expect(setup.get_by_role("region", name="Found")).to_contain_text("mm")


def drag_a_corner(page: Page, rig: ServedRig) -> None:
    box = picture(page).bounding_box()
    assert box is not None
    x, y = place_on_page(page, *corners_of_the_workspace(rig)[0])
    page.mouse.move(box["x"] + x, box["y"] + y)
    page.mouse.down()
    page.mouse.move(box["x"] + x + 15, box["y"] + y + 10, steps=4)
    page.mouse.up()


def test_an_armed_rig_is_disarmed_by_the_setup_only_on_request(dashboard: Visit, served: ServedRig) -> None:
    page = dashboard.page
    page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))
    setup = open_setup(page, "Camera")
    expect(setup).to_contain_text("can be changed only while it is disarmed")
    expect(setup.get_by_role("radio").first).to_be_disabled()
    assert served.ask("/state")["rig"] == "armed"
    button(page, "Disarm").click()
    expect(rig_state(page)).to_contain_text("disarmed")
    expect(setup).not_to_contain_text("can be changed only")
    expect(setup.get_by_role("radio").first).to_be_enabled()


def test_escape_and_the_button_stop_while_the_setup_is_open(dashboard: Visit) -> None:
    page = dashboard.page
    setup = open_setup(page, "Robot")
    expect(page.get_by_role("button", name="STOP", exact=True)).to_be_in_viewport()
    for stop in (lambda: page.keyboard.press("Escape"), page.get_by_role("button", name="STOP").click):
        button(page, "Arm").click()
        expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))
        stop()
        expect(rig_state(page)).to_contain_text("fault")
        expect(setup).to_be_visible()
        button(page, "Reset").click()
        expect(rig_state(page)).to_contain_text("disarmed")


def test_the_setup_is_opened_walked_through_and_closed_by_keys_alone(dashboard: Visit) -> None:
    page = dashboard.page
    expect(rig_state(page)).to_contain_text("disarmed")
    opener = page.get_by_role("button", name="Set up camera")
    opener.focus()
    page.keyboard.press("Enter")
    expect(panel(page).get_by_role("heading", level=2)).to_be_focused()
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    expect(page.get_by_role("tab", name="Camera")).to_be_focused()
    page.keyboard.press("ArrowRight")
    expect(page.get_by_role("tab", name="Colour")).to_be_focused()
    expect(page.get_by_role("tabpanel", name="Colour")).to_be_visible()
    button(page, "Close").press("Enter")
    expect(panel(page)).to_have_count(0)
    expect(opener).to_be_focused()


def test_a_walk_that_is_stopped_says_why_and_offers_nothing_to_save(dashboard: Visit) -> None:
    page = dashboard.page
    setup = open_setup(page, "Robot")
    star = setup.get_by_role("region", name="Star")
    expect(star.get_by_role("button", name="Walk a star")).to_be_disabled()
    button(page, "Arm").click()
    star.get_by_role("button", name="Walk a star").click()
    expect(star.get_by_role("progressbar", name="The robot walks a star")).to_be_visible()
    expect(rig_state(page)).to_contain_text("running")
    page.keyboard.press("Escape")
    expect(star.get_by_role("alert")).to_contain_text("walk was")
    expect(star.get_by_role("button", name="Save")).to_have_count(0)


def test_a_measured_delay_is_shown_with_its_uncertainty_and_saved_once_disarmed(
    visit: Visit, workshop: ServedRig
) -> None:
    page = visit.page
    workshop.send("PATCH", "/rig", {"simulation": {"stamps": "arrival"}})
    eventually(lambda: workshop.ask("/state")["reason"] == "ready to arm", "the rebuilt rig is ready")
    workshop.send("POST", "/arm")
    workshop.send("POST", "/calibration/latency", {"turns": 8})
    setup = open_setup(page, "Robot")
    delay = setup.get_by_role("region", name="Camera delay")
    expect(delay).to_contain_text(re.compile(r"\d\.\d ± \d+\.\d ms"), timeout=A_WHILE)
    save = delay.get_by_role("button", name="Save")
    expect(save).to_be_disabled()
    button(page, "Disarm").click()
    save.click()
    expect(delay.get_by_text("Saved in the rig file.")).to_be_visible()
    expect(setup.get_by_role("region", name="Saved now")).to_contain_text("standard error")
    assert workshop.ask("/vision")["latency_ms"] > 0
    button(page, "Undo").click()
    expect(setup.get_by_role("region", name="Saved now")).to_contain_text("not measured")
    expect(save).to_be_enabled()
    assert visit.complaints == []


def test_of_two_robots_that_look_alike_a_click_says_which_one_it_is(
    visit: Visit, workshop: ServedRig
) -> None:
    page = visit.page
    expect(rig_state(page)).to_contain_text("ready to arm")
    place = robot_place(workshop)
    workshop.send("PATCH", "/rig", {"simulation": {"scene": "standing_twins"}})
    expect(page.get_by_text("Click the robot: the one to follow")).to_be_visible()
    click_picture(page, *place)
    expect(page.get_by_text("Click the robot: the one to follow")).to_have_count(0)
    eventually(lambda: workshop.ask("/state")["tracking"] == "locked", "the robot is followed")
    assert distance_from(robot_place(workshop), place) < 3


FAINT_TEXT = """() => {
  const channels = (colour) => colour.match(/[\\d.]+/g).map(Number);
  const light = ([r, g, b]) => [r, g, b].map((c) => c / 255)
    .map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const ground = (node) => {
    for (let at = node; at; at = at.parentElement) {
      const [r, g, b, a = 1] = channels(getComputedStyle(at).backgroundColor);
      if (a > 0.99) return [r, g, b];
    }
    return [255, 255, 255];
  };
  const shown = (node) => node.checkVisibility() && node.getBoundingClientRect().width > 2;
  return [...document.querySelectorAll('.wizard *')]
    .filter((node) => [...node.childNodes].some((child) => child.nodeType === 3 && child.data.trim()) && shown(node))
    .filter((node) => !node.closest(':disabled'))
    .map((node) => {
      const [a, b] = [light(channels(getComputedStyle(node).color)), light(ground(node))].sort((x, y) => y - x);
      return [(a + 0.05) / (b + 0.05), node.textContent.trim().slice(0, 40)];
    })
    .filter(([contrast]) => contrast < 4.5);
}"""
"""Texts of the panel with less contrast than WCAG asks for."""


def test_on_a_phone_on_its_side_the_state_and_stop_are_free(dashboard: Visit) -> None:
    page = dashboard.page
    page.set_viewport_size({"width": 844, "height": 390})
    open_setup(page, "Lens")
    word, figures, stop = (
        page.locator(f".bar {part}").bounding_box() for part in (".state-word", ".vitals", ".stop")
    )
    assert word is not None
    assert figures is not None
    assert stop is not None
    assert word["x"] + word["width"] <= figures["x"]
    assert stop["x"] + stop["width"] <= 844


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_on_a_phone_each_step_fits_its_width_and_its_texts_can_be_read(
    served: ServedRig, open_tab: OpenTab, scheme: Literal["light", "dark"]
) -> None:
    served.rest()
    page = open_tab(served.url, width=390, height=844, scene=False).page
    page.emulate_media(color_scheme=scheme)
    setup = open_setup(page, "Camera")
    for step in ("Camera", "Colour", "Lens", "Plane", "Robot"):
        page.get_by_role("tab", name=step).click()
        expect(page.get_by_role("tabpanel", name=step)).to_be_visible()
        expect(setup.get_by_text("Asking for")).to_have_count(0)
        for summary in setup.locator("summary").all():
            summary.click()
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
        assert page.evaluate(FAINT_TEXT) == []
        setup.get_by_role("button", name="Back").scroll_into_view_if_needed()
        expect(picture(page)).to_be_in_viewport(ratio=0.99)
        expect(page.get_by_role("button", name="STOP", exact=True)).to_be_in_viewport()

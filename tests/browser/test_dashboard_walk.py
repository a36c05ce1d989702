"""The first minute with the simulated rig, by what a person sees."""

from __future__ import annotations

import math
import re

import pytest
from dashboard_visit import Visit, becomes_true, eventually, rig_state
from picture import colours, pixels, share_like
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive

CURVE_BLUE = (178, 114, 0)
"""The first curve of each chart in the light theme, BGR."""
HALF_A_ROBOT = 5.0
"""mm"""
ROBOT_RED = (45, 45, 190)


def button(page: Page, name: str) -> Locator:
    return page.get_by_role("button", name=name, exact=True)


def state(page: Page) -> Locator:
    return rig_state(page)


def reading(page: Page, name: str) -> str:
    """The number beside a name in the camera's line of readings."""
    card = page.get_by_role("region", name="Camera")
    row = card.locator("div").filter(has=page.get_by_text(name, exact=True)).last
    return row.get_by_role("definition").inner_text()


def place(page: Page) -> tuple[float, float]:
    """Where the page says that the robot is, mm."""
    x, y = (reading(page, name).removesuffix(" mm").replace("−", "-") for name in ("x", "y"))
    return float(x), float(y)


def scene_is_drawn(page: Page) -> bool:
    return colours(pixels(page.get_by_title("3D scene of coils, field and robot"))) > 24


def walk(page: Page) -> None:
    """Two clicks."""
    button(page, "Arm").click()
    button(page, "Start walking").click()
    expect(state(page)).to_contain_text("running")


def camera(page: Page) -> Locator:
    return page.get_by_role("img", name="Camera picture")


def test_two_clicks_after_the_first_visit_the_robot_walks_the_eight(dashboard_with_scene: Visit) -> None:
    page = dashboard_with_scene.page
    eventually(lambda: scene_is_drawn(page), "a drawn scene")
    expect(state(page)).to_contain_text("disarmed")
    expect(page.get_by_text("SIM", exact=True)).to_be_visible()
    eventually(lambda: "locked" in reading(page, "Tracking"), "the camera sees the robot")
    walk(page)
    eventually(lambda: bool(re.fullmatch(r"\d+\.\d\d mm", reading(page, "Error"))), "an error in mm")
    start = place(page)
    eventually(lambda: math.dist(start, place(page)) > HALF_A_ROBOT, "the robot has left its place")
    expect(page.get_by_role("progressbar")).to_be_visible()
    expect(page.get_by_role("row", name="running")).to_contain_text("eight")


def test_the_camera_picture_is_alive_and_shows_the_robot(dashboard: Visit) -> None:
    page = dashboard.page
    page.get_by_label("Overlay").uncheck()
    eventually(lambda: colours(pixels(camera(page))) > 8, "a picture on the canvas")
    assert share_like(pixels(camera(page)), ROBOT_RED, within=45) > 0.0005
    first = pixels(camera(page))
    eventually(lambda: bool((pixels(camera(page)) != first).mean() > 0.2), "the picture changes")


def test_each_chart_draws_what_comes_in(dashboard: Visit) -> None:
    page = dashboard.page
    expect(state(page)).to_contain_text("disarmed")
    walk(page)
    for name in ("Error", "Pose", "Currents"):
        chart = page.get_by_role("img", name=f"{name} over the last")
        eventually(lambda chart=chart: share_like(pixels(chart), CURVE_BLUE) > 5e-4, f"a curve in {name}")


def test_the_scene_draws_coils_and_field(dashboard_with_scene: Visit) -> None:
    page = dashboard_with_scene.page
    if not becomes_true(lambda: scene_is_drawn(page)):
        page.reload()
        eventually(lambda: scene_is_drawn(page), "a drawn scene, after one reload")

"""The camera's setup as a person uses it: its panel, its steps, and places in the camera picture."""

from __future__ import annotations

import math

from dashboard_visit import ServedRig, eventually, rig_state
from playwright.sync_api import Locator, Page, expect

PICTURE = (640, 480)
"""Size of the simulated camera's picture, px."""


def panel(page: Page) -> Locator:
    return page.get_by_role("region", name="Set up the camera")


def open_setup(page: Page, step: str) -> Locator:
    """The panel at one of its steps."""
    expect(rig_state(page)).not_to_contain_text("connecting")
    page.get_by_role("button", name="Set up camera").click()
    page.get_by_role("tab", name=step).click()
    return panel(page)


def button(page: Page, name: str) -> Locator:
    return panel(page).get_by_role("button", name=name, exact=True)


def picture(page: Page) -> Locator:
    return page.get_by_role("img", name="Camera picture")


def place_on_page(page: Page, u: float, v: float) -> tuple[float, float]:
    """Where on its canvas a pixel of the camera is drawn: the picture lies in the middle, as large as it goes."""
    box = picture(page).bounding_box()
    assert box is not None
    scale = min(box["width"] / PICTURE[0], box["height"] / PICTURE[1])
    left, top = (box["width"] - scale * PICTURE[0]) / 2, (box["height"] - scale * PICTURE[1]) / 2
    return left + scale * u, top + scale * v


def click_picture(page: Page, u: float, v: float) -> None:
    x, y = place_on_page(page, u, v)
    picture(page).click(position={"x": x, "y": y})


def robot_place(rig: ServedRig) -> tuple[float, float]:
    """Where the robot's centre is in the picture, px."""
    eventually(lambda: rig.ask("/state")["measurement"] is not None, "the camera sees the robot")
    u, v = rig.ask("/state")["measurement"]["centre_px"]
    return u, v


def click_robot(page: Page, rig: ServedRig) -> None:
    """Beside its centre, where a mark may be painted."""
    u, v = robot_place(rig)
    click_picture(page, u + 4, v)


def distance_from(place: tuple[float, float], other: tuple[float, float]) -> float:
    return math.dist(place, other)

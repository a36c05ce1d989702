"""The camera card as a person uses it: its tools, and places of the plate in its picture."""

from __future__ import annotations

import itertools
import math

import cv2
import numpy as np
from dashboard_visit import ServedRig, rig_state
from playwright.sync_api import Locator, Page, expect
from setup_visit import picture, place_on_page

PlateMM = tuple[float, float]


def tool(page: Page, name: str) -> Locator:
    return page.get_by_role("toolbar", name="Camera tools").get_by_role("button", name=name, exact=True)


def zoom_button(page: Page, name: str) -> Locator:
    return page.get_by_role("toolbar", name="Zoom").get_by_role("button", name=name, exact=True)


def board(page: Page) -> Locator:
    """What belongs to drawing a path."""
    return page.get_by_role("region", name="Draw a path")


def ready(page: Page) -> None:
    expect(rig_state(page)).not_to_contain_text("connecting")
    expect(tool(page, "Draw a path")).to_be_enabled()


class Plate:
    """Where places of the plate (mm) are in the picture of a rig, by OpenCV."""

    def __init__(self, rig: ServedRig) -> None:
        model = rig.ask("/camera")["model"]
        turn, _ = cv2.Rodrigues(np.reshape(np.array(model["rotation"]), (3, 3)))
        focal = np.array([[model["fx"], 0.0, model["cx"]], [0.0, model["fy"], model["cy"]], [0.0, 0.0, 1.0]])
        self._view = turn, np.array(model["translation_mm"]), focal, np.array(model["distortion"])

    def pixel(self, at: PlateMM) -> tuple[float, float]:
        seen, _ = cv2.projectPoints(np.array([(*at, 0.0)]), *self._view)
        u, v = seen.ravel().tolist()
        return u, v

    def on_page(self, page: Page, at: PlateMM) -> tuple[float, float]:
        """In the window, for the mouse; the whole picture is shown."""
        box = picture(page).bounding_box()
        assert box is not None
        x, y = place_on_page(page, *self.pixel(at))
        return box["x"] + x, box["y"] + y

    def click(self, page: Page, at: PlateMM) -> None:
        page.mouse.click(*self.on_page(page, at))

    def drag(self, page: Page, line: list[PlateMM]) -> None:
        first, *others = [self.on_page(page, at) for at in line]
        page.mouse.move(*first)
        page.mouse.down()
        for place in others:
            page.mouse.move(*place)
        page.mouse.up()


def farthest_from(line: list[PlateMM], points: list[list[float]]) -> float:
    """How far the points are from the line at most, mm."""
    fine = np.concatenate([np.linspace(a, b, 20) for a, b in itertools.pairwise(line)])
    return max(min(math.dist(point, at) for at in fine.tolist()) for point in points)

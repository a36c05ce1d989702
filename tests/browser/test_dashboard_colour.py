"""The robot's colour by one click, and what belongs to it: mask, sliders, profiles."""

from __future__ import annotations

import re

import numpy as np
import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, eventually
from picture import pixels
from playwright.sync_api import Page, expect
from setup_visit import (
    button,
    click_picture,
    click_robot,
    open_setup,
    panel,
    picture,
    place_on_page,
    robot_place,
)

pytestmark = pytest.mark.exclusive

LIT = (233, 180, 86)
"""The mask's colour, BGR."""


def lit_places(page: Page) -> np.ndarray:
    """Where the mask is lit on the canvas, (n, 2) as (y, x)."""
    shown = pixels(picture(page)).astype(int)
    return np.argwhere(np.abs(shown - np.array(LIT)).max(axis=2) < 45)


@pytest.fixture
def visit(workshop: ServedRig, open_tab: OpenTab) -> Visit:
    workshop.rest()
    return open_tab(workshop.url, scene=False)


def test_one_click_on_the_robot_finds_its_colour_and_lights_it_up(visit: Visit, workshop: ServedRig) -> None:
    page = visit.page
    setup = open_setup(page, "Colour")
    expect(page.get_by_text("Click the robot", exact=True)).to_be_visible()
    click_robot(page, workshop)
    expect(setup.get_by_text("Separation")).to_be_visible()
    expect(setup.get_by_text(re.compile("good|fair")).first).to_be_visible()
    eventually(lambda: len(lit_places(page)) > 200, "a lit robot")
    lit, (x, y) = lit_places(page), place_on_page(page, *robot_place(workshop))
    assert np.hypot(*(np.median(lit, axis=0) - (y, x))) < 12, "what is lit is the robot"

    before = workshop.ask("/vision")["colour"]
    button(page, "Use this colour").click()
    expect(setup.get_by_text("Saved in the rig file.")).to_be_visible()
    assert workshop.ask("/vision")["colour"] != before
    eventually(
        lambda: workshop.ask("/state")["tracking"] == "locked", "the robot is tracked by its new colour"
    )
    button(page, "Undo").click()
    expect(setup.get_by_text("The rig file is as it was before.")).to_be_visible()
    assert workshop.ask("/vision")["colour"] == before
    assert visit.complaints == []


def test_a_click_on_the_bare_plate_says_so_beside_the_buttons(visit: Visit) -> None:
    page = visit.page
    setup = open_setup(page, "Colour")
    expect(page.get_by_text("Click the robot", exact=True)).to_be_visible()
    click_picture(page, 100, 100)
    expect(setup.locator(".field-error")).not_to_be_empty()
    expect(button(page, "Use this colour")).to_be_disabled()
    assert visit.complaints == []


def test_arrow_keys_and_enter_point_as_the_mouse_does(visit: Visit, workshop: ServedRig) -> None:
    page = visit.page
    setup = open_setup(page, "Colour")
    u, v = robot_place(workshop)
    picture(page).focus()
    for key, far in (("ArrowRight", u - 320), ("ArrowDown", v - 240)):
        opposite = key.replace("Right", "Left").replace("Down", "Up")
        for _ in range(round(abs(far) / 10)):
            page.keyboard.press(f"Shift+{key if far > 0 else opposite}")
    page.keyboard.press("Enter")
    expect(setup.get_by_text("Separation")).to_be_visible()


def test_a_slider_moves_the_mask_at_once_and_cancel_takes_it_back(visit: Visit, workshop: ServedRig) -> None:
    page = visit.page
    open_setup(page, "Colour")
    eventually(lambda: len(lit_places(page)) > 200, "the robot is lit")
    panel(page).get_by_text("Adjust by hand").click()
    panel(page).get_by_role("slider", name="Saturation from").fill("250")
    eventually(lambda: len(lit_places(page)) < 50, "nothing is that colourful")
    assert workshop.ask("/vision")["colour"]["saturation"][0] < 250
    button(page, "Cancel").click()
    eventually(lambda: len(lit_places(page)) > 200, "the saved colour again")


def test_a_lighting_profile_is_saved_chosen_and_after_a_question_deleted(
    visit: Visit, workshop: ServedRig
) -> None:
    page = visit.page
    setup = open_setup(page, "Colour")
    setup.get_by_text("Lighting profiles").click()
    setup.get_by_label("Name of the profile").fill("evening")
    button(page, "Save as").click()
    expect(setup.get_by_role("radio", name="evening")).to_be_checked()
    assert workshop.ask("/vision")["profile"] == "evening"
    setup.get_by_role("radio", name="default").check()
    eventually(lambda: workshop.ask("/vision")["profile"] == "default", "back to the default")
    button(page, "Delete evening").click()
    expect(setup.get_by_text("Delete the profile “evening”?")).to_be_visible()
    button(page, "Keep").click()
    assert "evening" in workshop.ask("/vision")["profiles"]
    button(page, "Delete evening").click()
    button(page, "Delete").click()
    eventually(lambda: "evening" not in workshop.ask("/vision")["profiles"], "the profile is gone")
    assert visit.complaints == []

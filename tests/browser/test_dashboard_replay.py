"""Recorded runs in the page, in place of the rig: by what a person sees, hears and presses."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, eventually, rig_state
from picture import colours, pixels, share_like
from playwright.sync_api import FloatRect, Locator, Page, expect
from recorded_runs import walk

from server.archive import Archive
from server.recording.reading.recording import Recording
from server.recording.topics import as_tick

pytestmark = pytest.mark.exclusive

PHONE = (390, 844)
CURVE_BLUE = (178, 114, 0)
"""The first curve of each chart in the light theme, BGR."""
ROBOT_RED = (45, 45, 190)
WALKS = (("narrow sweeps", 30.0, 4.0), ("wide sweeps", 45.0, 3.0))
"""Label, sweep in degrees, duration in s."""
LOOKED_WITHIN = 40e3
"""The pictures of a run of 4 s, by a computer that draws a scene meanwhile, ms."""
A_DIGIT = 0.1
"""Of a place in the page's readings, mm."""


@dataclass(frozen=True, slots=True)
class Library:
    """A served rig with recorded runs. ids: of the walks.  archive: where they are kept."""

    rig: ServedRig
    ids: list[str]
    archive: Archive

    def address(self, *ids: str) -> str:
        return f"{self.rig.url}/#replay={','.join(ids)}"


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Library]:
    data = tmp_path_factory.mktemp("recorded")
    archive = Archive.open(data, patient=True)
    ids = [walk(archive, *each) for each in WALKS]
    archive.close()
    rig = ServedRig(data)
    rig.start()
    yield Library(rig, ids, archive)
    rig.stop()


@pytest.fixture(scope="module")
def theatre(library: Library, open_lasting_tab: OpenTab) -> Visit:
    """One tab for all tests that look at the player; the scene has a test, and a tab, of its own."""
    return open_lasting_tab(library.address(library.ids[0]), scene=False)


def button(page: Page, name: str) -> Locator:
    return page.get_by_role("button", name=name, exact=True)


def slider(page: Page) -> Locator:
    return page.get_by_role("slider", name="Time in the recording")


def bar(page: Page) -> Locator:
    return page.get_by_role("region", name="Replay")


def picture(page: Page) -> Locator:
    return page.get_by_role("img", name="Recorded camera picture").first


def chart(page: Page, name: str) -> Locator:
    return page.get_by_role("img", name=f"{name} of the recording")


def shown_time(page: Page) -> float:
    """As the scrubber says it, s."""
    return float(slider(page).get_attribute("aria-valuenow") or "nan")


def reading(page: Page, name: str) -> str:
    row = page.locator(".readings > div").filter(has=page.get_by_text(name, exact=True)).first
    return row.get_by_role("definition").inner_text()


def place(page: Page) -> tuple[float, float]:
    """Where the robot was, as the page says it, mm; nan while it says nothing."""
    texts = [reading(page, name).removesuffix(" mm").replace("−", "-") for name in ("x", "y")]
    x, y = (math.nan if text == "–" else float(text) for text in texts)
    return x, y


def show(page: Page, *ids: str) -> None:
    """By the address, as a link would."""
    page.evaluate("hash => void (location.hash = hash)", f"#replay={','.join(ids)}")


def at_its_start(page: Page) -> Page:
    """Standing still."""
    expect(bar(page).get_by_role("button", name=re.compile("^(Play|Pause)$"))).to_be_visible()
    if button(page, "Pause").is_visible():
        page.keyboard.press("k")
    expect(button(page, "Play")).to_be_visible()
    slider(page).press("Home")
    return page


def test_a_recording_fills_the_page_of_the_rig_and_one_click_gives_the_page_back(
    library: Library, open_tab: OpenTab
) -> None:
    visit = open_tab(library.address(library.ids[0]))
    page = visit.page
    expect(bar(page)).to_contain_text("narrow sweeps")
    expect(bar(page)).to_contain_text("geometric · circle")
    expect(page.get_by_text("Replay", exact=True)).to_have_count(5)
    eventually(lambda: reading(page, "Tracking") == "locked", "what was known of the robot")
    page.get_by_label("Overlay").uncheck()
    eventually(
        lambda: share_like(pixels(picture(page)), ROBOT_RED, within=45) > 0.0005, "the robot's picture"
    )
    for name in ("Error", "Pose", "Currents"):
        eventually(
            lambda name=name: share_like(pixels(chart(page, name)), CURVE_BLUE) > 5e-4, f"a curve in {name}"
        )
    scene = page.get_by_title("3D scene of coils, field and robot")
    eventually(lambda: colours(pixels(scene)) > 24, "a drawn scene")
    expect(button(page, "Arm")).to_have_count(0)
    expect(button(page, "STOP")).to_be_visible()
    button(page, "Back to live").click()
    expect(button(page, "Arm")).to_be_visible()
    assert "replay" not in page.url
    page.go_back()
    expect(bar(page)).to_contain_text("narrow sweeps")
    assert visit.foreign(library.rig.url) == []
    assert visit.complaints == []


def test_what_the_page_says_of_a_time_is_what_was_recorded_at_that_time(
    library: Library, theatre: Visit
) -> None:
    page = at_its_start(theatre.page)
    with Recording.open(library.archive.path_of(library.ids[0])) as recording:
        for key, at in (("End", recording.duration), ("ArrowLeft", recording.duration - 1.0), ("Home", 0.0)):
            slider(page).press(key)
            recorded = place_recorded(recording, at)
            eventually(
                lambda there=recorded: math.dist(place(page), there) <= A_DIGIT, f"the place at {at:g} s"
            )


def place_recorded(recording: Recording, at: float) -> tuple[float, float]:
    """Of the robot, mm."""
    messages = recording.tick_at(at)
    assert messages is not None
    pose = as_tick(messages)["pose"]
    return pose["x_mm"], pose["y_mm"]


def test_keys_and_clicks_step_play_seek_and_loop(theatre: Visit) -> None:
    page = at_its_start(theatre.page)
    page.keyboard.press(".")
    page.keyboard.press(".")
    eventually(lambda: 0.0 < shown_time(page) < 1.0, "two pictures on")
    there = shown_time(page)
    page.keyboard.press("k")
    eventually(lambda: shown_time(page) > there, "it plays")
    page.keyboard.press("k")
    box = chart(page, "Error").locator(".u-over")
    box.click(position={"x": 0.75 * box_of(box)["width"], "y": 40})
    eventually(lambda: 3.0 <= shown_time(page) < 4.0, "the time that was clicked at")
    page.keyboard.press("[")
    page.get_by_label("Speed").select_option("10")
    page.keyboard.press("k")
    page.wait_for_timeout(600)
    assert shown_time(page) >= 3.0, "ten times as fast it has been through the loop's second many times"
    expect(button(page, "Pause")).to_be_visible()
    button(page, "No loop").click()


def test_space_stops_the_rig_and_not_the_replay(library: Library, theatre: Visit) -> None:
    library.rig.rest()
    page = at_its_start(theatre.page)
    page.get_by_label("Speed").select_option("0.1")
    button(page, "Play").press("Enter")
    page.keyboard.press(" ")
    expect(rig_state(page)).to_contain_text("fault")
    expect(bar(page)).to_contain_text("The rig itself: fault")
    expect(button(page, "Pause")).to_be_visible()
    library.rig.rest()


def test_the_pictures_are_looked_at_again_and_what_comes_of_it_is_drawn_beside_the_run(
    theatre: Visit,
) -> None:
    page = at_its_start(theatre.page)
    button(page, "Look again…").click()
    question = page.get_by_role("dialog", name="Look at the pictures again")
    question.get_by_text("Colour of the robot").click()
    for name, hue in (("Hue from", "200"), ("Hue to", "240")):
        question.get_by_label(name).fill(hue)
    question.get_by_role("button", name="Look again", exact=True).click()
    seen = question.get_by_role("row", name="Seen in pictures")
    expect(seen).to_have_text(re.compile(r"100\.0.*0\.0.*−100\.0"), timeout=LOOKED_WITHIN)
    question.get_by_role("button", name="Close").click()
    expect(page.get_by_text("narrow sweeps, seen again")).to_be_visible()
    button(page, "Look again…").click()
    question.get_by_role("button", name="Forget it").click()
    question.get_by_role("button", name="Close").click()
    expect(page.get_by_text("narrow sweeps, seen again")).to_have_count(0)


def test_a_drag_in_a_chart_looks_closer_in_all_of_them(theatre: Visit) -> None:
    page = at_its_start(theatre.page)
    box = box_of(chart(page, "Pose").locator(".u-over"))
    page.mouse.move(box["x"] + 0.25 * box["width"], box["y"] + 50)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 60, steps=4)
    page.mouse.up()
    expect(page.get_by_text(re.compile(r"^0:01\.\d – 0:02\.\d$"))).to_be_visible()
    button(page, "Loop this part").click()
    expect(button(page, "No loop")).to_be_enabled()
    eventually(lambda: 1.0 <= shown_time(page) < 2.0, "the replay is where the loop begins")
    button(page, "No loop").click()
    button(page, "Whole run").click()
    expect(page.get_by_text("drag: a closer look")).to_be_visible()


def test_two_runs_stand_side_by_side_on_one_time_axis(library: Library, theatre: Visit) -> None:
    show(theatre.page, *library.ids)
    expect(theatre.page.get_by_role("img", name="Recorded camera picture")).to_have_count(2)
    page = at_its_start(theatre.page)
    for name, values in (("Sweep °", ["30", "45", "+15"]), ("Duration s", ["4.0", "3.0", "−1.0"])):
        cells = page.get_by_role("row", name=name).get_by_role("cell")
        expect(cells).to_have_text(values)
    slider(page).press("End")
    expect(page.get_by_text(re.compile(r"this run was over at 3\.\d s"))).to_be_visible()
    assert theatre.complaints == []


def test_a_recording_that_is_not_there_is_said_and_the_rig_is_shown(theatre: Visit) -> None:
    page = theatre.page
    show(page, "never-was")
    gone = page.get_by_role("alert").filter(has_text="The recording cannot be shown")
    expect(gone.first).to_be_visible()
    expect(bar(page)).to_have_count(0)
    assert "replay" not in page.url


def test_a_phone_has_stop_above_the_picture_and_the_player_below(library: Library, open_tab: OpenTab) -> None:
    page = at_its_start(open_tab(library.address(*library.ids), *PHONE, scene=False).page)
    for shown in (
        *(button(page, name) for name in ("STOP", "Play", "Back to live")),
        slider(page),
        picture(page),
    ):
        assert fits(shown), shown
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE[0]


def fits(shown: Locator) -> bool:
    box = box_of(shown)
    inside_x = 0 <= box["x"] <= PHONE[0] - box["width"]
    return inside_x and 0 <= box["y"] <= PHONE[1] - box["height"]


def box_of(shown: Locator) -> FloatRect:
    box = shown.bounding_box()
    assert box is not None
    return box


@pytest.fixture
def mortal(library: Library) -> Iterator[ServedRig]:
    """The same server once more, for the last test: it may be killed, and is gone afterwards."""
    yield library.rig
    library.rig.stop()


def test_a_replay_goes_on_where_it_was_when_the_server_comes_back_and_ends_when_its_run_is_gone(
    library: Library, mortal: ServedRig, theatre: Visit, open_tab: OpenTab
) -> None:
    show(theatre.page, library.ids[0])
    expect(bar(theatre.page)).to_contain_text("narrow sweeps")
    page = at_its_start(theatre.page)
    slider(page).press("ArrowRight")
    other = open_tab(library.address(library.ids[1]), scene=False).page
    expect(bar(other)).to_contain_text("wide sweeps")
    mortal.kill()
    expect(bar(page).get_by_role("alert")).to_contain_text("cannot be read just now")
    expect(bar(page)).to_contain_text("The rig itself: not known")
    library.archive.path_of(library.ids[1]).unlink()
    mortal.start()
    expect(bar(page).get_by_role("alert")).to_have_count(0)
    eventually(lambda: shown_time(page) == 1.0, "the time from before")
    slider(page).press("End")
    eventually(lambda: shown_time(page) > 3.9, "it can be scrubbed again")
    gone = "The recording cannot be shown"
    expect(other.get_by_role("alert").filter(has_text=gone).first).to_be_visible()
    expect(bar(other)).to_have_count(0)
    mortal.send("DELETE", f"/runs/{library.ids[0]}")
    expect(page.get_by_role("alert").filter(has_text="was deleted")).to_contain_text(gone)
    expect(bar(page)).to_have_count(0)

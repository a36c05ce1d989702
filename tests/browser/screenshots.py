"""`make screenshots`: a picture of each main view, of a real server with real runs, for the README."""

from __future__ import annotations

import contextlib
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import numpy as np
from camera_visit import board
from conftest import CHROMIUM_ARGS, TOUR_SEEN
from dashboard_visit import ServedRig, becomes_true, rig_state
from picture import colours, pixels
from playwright.sync_api import Browser, Locator, Page, expect, sync_playwright
from recorded_runs import record
from rooms import Room
from setup_visit import click_robot, open_setup
from views import COMPUTED_WITHIN, button, tab_of

PICTURES = Path(__file__).parent / "pictures"
QUALITY = 86
"""Of WebP: text stays sharp, and a picture of a whole window stays under 150 kB."""
DESK, DESK_BY_NIGHT = Room(1440, 900, "light"), Room(1440, 900, "dark")
PHONE = Room(390, 844, "light")
WALKED_S = 20
"""Until a path and its error are there to be seen, s."""
RUNS = (("first walk", 30.0), ("wide sweeps", 45.0), ("narrow sweeps", 18.0), ("second walk", 30.0))
"""Label and sweep in degrees."""
STUDY = {
    "name": "Which sweep and tilt?",
    "duration_s": 12.0,
    "gait": {"time_law": "wait"},
    "repeats": 2,
    "axes": [
        {"of": "gait.sweep_deg", "values": [15, 25, 35, 45]},
        {"of": "gait.tilt_deg", "values": [10, 20, 30]},
    ],
}


class Studio:
    """A served rig with runs and a study, and a browser that looks at it."""

    def __init__(self, rig: ServedRig, browser: Browser, runs: list[str]) -> None:
        self.rig, self.runs = rig, runs
        self._browser = browser

    @contextlib.contextmanager
    def window(self, room: Room, *, fresh: bool = False) -> Iterator[Page]:
        """Of a rig at rest. fresh: its robot is at its first place."""
        if fresh:
            self.rig.stop()
            self.rig.start()
        self.rig.rest()
        context = self._browser.new_context(
            **room.window(), reduced_motion="reduce", device_scale_factor=2 if room.is_phone else 1
        )
        context.add_init_script(TOUR_SEEN)
        page = context.new_page()
        page.set_default_timeout(60e3)
        page.goto(self.rig.url)
        expect(rig_state(page)).to_contain_text("locked")
        yield page
        context.close()


def scene_stands(page: Page) -> None:
    scene = page.get_by_title("3D scene of coils, field and robot")
    expect(scene).to_be_visible()
    becomes_true(lambda: colours(pixels(scene)) > 24, 60)


def set_out(page: Page) -> None:
    button(page, "Arm").click()
    button(page, "Start walking").click()
    expect(rig_state(page)).to_contain_text("running")
    page.wait_for_timeout(WALKED_S * 1e3)


def save(name: str, shown: Page | Locator) -> None:
    picture = cv2.imdecode(np.frombuffer(shown.screenshot(), np.uint8), cv2.IMREAD_COLOR)
    assert picture is not None
    path = PICTURES / f"{name}.webp"
    cv2.imwrite(str(path), picture, [cv2.IMWRITE_WEBP_QUALITY, QUALITY])
    height, width = picture.shape[:2]
    print(f"{path.name}: {width} x {height}, {path.stat().st_size / 1000:.0f} kB")


def live(studio: Studio) -> None:
    for name, room in (("live", DESK), ("live-dark", DESK_BY_NIGHT)):
        with studio.window(room, fresh=True) as page:
            scene_stands(page)
            set_out(page)
            save(name, page)


def phone(studio: Studio) -> None:
    with studio.window(PHONE, fresh=True) as page:
        set_out(page)
        save("phone", page)


def journal(page: Page, tab: str) -> Locator:
    tab_of(page, tab).click()
    card = page.get_by_role("region", name="Runs, studies, calibration, rig and log")
    expect(card.get_by_role("tabpanel", name=tab)).not_to_contain_text("Loading")
    return card


def runs(studio: Studio) -> None:
    with studio.window(DESK) as page:
        card = journal(page, "Runs")
        button(card, "wide sweeps").click()
        expect(card.get_by_text("Drawing the figure")).to_have_count(0)
        page.wait_for_timeout(1000)
        save("runs", card)


def replay(studio: Studio) -> None:
    with studio.window(DESK) as page:
        page.evaluate("ids => void (location.hash = `#replay=${ids}`)", ",".join(studio.runs[:2]))
        time = page.get_by_role("slider", name="Time in the recording")
        button(page, "Pause").click()  # it plays as soon as it is open
        for key in ("Home", "PageUp", *["ArrowRight"] * 8):
            time.press(key)
        page.wait_for_timeout(3000)
        scene_stands(page)
        save("replay", page)


def study(studio: Studio) -> None:
    with studio.window(DESK) as page:
        card = journal(page, "Studies")
        card.get_by_role("button", name=str(STUDY["name"])).first.click()
        expect(page.get_by_role("article", name=str(STUDY["name"]))).to_contain_text(
            "finished", timeout=4 * COMPUTED_WITHIN
        )
        page.wait_for_timeout(1000)
        save("study", card)


def drawing(studio: Studio) -> None:
    with studio.window(DESK) as page:
        page.get_by_role("toolbar", name="Camera tools").get_by_role("button", name="Draw a path").click()
        board(page).get_by_role("radio", name="Points").locator("xpath=..").click()
        canvas = page.get_by_role("img", name="Camera picture")
        box = canvas.bounding_box()
        assert box is not None
        for x, y in ((0.3, 0.35), (0.45, 0.25), (0.6, 0.45), (0.7, 0.7), (0.5, 0.65)):
            page.mouse.click(box["x"] + x * box["width"], box["y"] + y * box["height"])
        page.evaluate("scrollTo(0, 0)")
        scene_stands(page)
        expect(page.get_by_text("no frame for")).to_have_count(0)
        save("draw-a-path", page)


def calibration(studio: Studio) -> None:
    with studio.window(DESK) as page:
        open_setup(page, "Colour")
        click_robot(page, studio.rig)
        expect(page.get_by_text("Separation")).to_be_visible()
        page.wait_for_timeout(1000)
        save("calibration", page)


def rig(studio: Studio) -> None:
    with studio.window(DESK) as page:
        card = journal(page, "Rig")
        button(card.get_by_role("navigation", name="Settings"), "Coils").click()
        save("rig", card)


def faults(studio: Studio) -> None:
    with studio.window(DESK_BY_NIGHT, fresh=True) as page:
        card = journal(page, "Faults")
        set_out(page)
        card.get_by_role("button", name="Unplug the camera").click()
        expect(card.get_by_role("listitem", name="Camera unplugged").get_by_role("status")).to_contain_text(
            "ept"
        )
        page.evaluate("scrollTo(0, 0)")
        save("faults", card)
        save("log", journal(page, "Log"))
    studio.rig.send("DELETE", "/simulation/faults")


SHOTS: dict[str, Callable[[Studio], None]] = {
    shot.__name__: shot for shot in (runs, replay, study, drawing, calibration, rig, live, phone, faults)
}


def main(wanted: list[str]) -> None:
    """wanted: names of shots; all of them when it is empty."""
    PICTURES.mkdir(exist_ok=True)
    with contextlib.ExitStack() as stack:
        data = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        ids = [record(data, label, sweep, 25.0, "eight") for label, sweep in RUNS]
        served = ServedRig(data)
        served.start()
        stack.callback(served.stop)
        served.send("POST", "/studies", {"definition": STUDY})
        browser = stack.enter_context(sync_playwright()).chromium.launch(
            executable_path=shutil.which("chromium"), args=list(CHROMIUM_ARGS)
        )
        stack.callback(browser.close)
        for name in wanted or SHOTS:
            SHOTS[name](Studio(served, browser, ids))


if __name__ == "__main__":
    main(sys.argv[1:])

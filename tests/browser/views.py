"""Every main view of the dashboard, and how a person comes to it and leaves it again."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path

from dashboard_visit import ServedRig, rig_state
from playwright.sync_api import Locator, Page, expect
from recorded_runs import record
from setup_visit import open_setup, panel

TABS = ("Runs", "Studies", "Calibration", "Rig", "Log", "Faults")
STEPS = ("Camera", "Colour", "Lens", "Plane", "Robot")
COMPUTED_WITHIN = 90e3
"""A batch of some short runs, ms."""
STUDY = "two sweeps"


@dataclass(frozen=True, slots=True)
class House:
    """A served rig with runs and a study. runs: their ids."""

    rig: ServedRig
    runs: list[str]

    @classmethod
    def furnished(cls, data: Path) -> House:
        runs = [record(data, "narrow sweeps", 30.0, 3.0), record(data, "wide sweeps", 45.0, 2.0)]
        rig = ServedRig(data)
        rig.start()
        axis = {"of": "gait.sweep_deg", "values": [20, 30]}
        definition = {"name": STUDY, "duration_s": 2.0, "gait": {"time_law": "wait"}, "axes": [axis]}
        rig.send("POST", "/studies", {"definition": definition})
        return cls(rig, runs)


Opened = AbstractContextManager[None]


def button(place: Page | Locator, name: str) -> Locator:
    return place.get_by_role("button", name=name, exact=True)


def tab_of(page: Page, name: str) -> Locator:
    """A log with news says so in its name."""
    return page.get_by_role("tab", name=re.compile(rf"^{name}( \d+ (new|open))?$"))


@contextmanager
def live(page: Page, _: House) -> Iterator[None]:
    expect(rig_state(page)).to_contain_text("disarmed")
    yield


@contextmanager
def walking(page: Page, house: House) -> Iterator[None]:
    button(page, "Arm").click()
    button(page, "Start walking").click()
    expect(page.get_by_role("progressbar")).to_be_visible()
    yield
    house.rig.rest()


@contextmanager
def stopped(page: Page, house: House) -> Iterator[None]:
    button(page, "STOP").click()
    expect(rig_state(page)).to_contain_text("fault")
    yield
    house.rig.rest()
    expect(rig_state(page)).to_contain_text("disarmed")


@contextmanager
def jogging(page: Page, house: House) -> Iterator[None]:
    switch = page.get_by_role("region", name="Jog").get_by_role("button", name="Jog")
    switch.click()
    button(page, "Arm").click()
    expect(page.get_by_role("button", name="Turn left about A")).to_be_enabled()
    yield
    switch.click()
    house.rig.rest()


def tab(name: str) -> Callable[[Page, House], Opened]:
    @contextmanager
    def opened(page: Page, _: House) -> Iterator[None]:
        tab_of(page, name).click()
        expect(page.get_by_role("tabpanel", name=name)).not_to_contain_text("Loading")
        yield
        tab_of(page, "Runs").click()

    return opened


def setup(step: str) -> Callable[[Page, House], Opened]:
    @contextmanager
    def opened(page: Page, _: House) -> Iterator[None]:
        open_setup(page, step)
        yield
        button(panel(page), "Close").click()
        expect(panel(page)).to_have_count(0)

    return opened


def tool(name: str) -> Callable[[Page, House], Opened]:
    @contextmanager
    def opened(page: Page, _: House) -> Iterator[None]:
        switch = page.get_by_role("toolbar", name="Camera tools").get_by_role("button", name=name)
        switch.click()
        expect(page.get_by_role("region", name=name)).to_be_visible()
        yield
        switch.click()

    return opened


@contextmanager
def keys(page: Page, _: House) -> Iterator[None]:
    page.keyboard.press("?")
    yield
    button(page.get_by_role("dialog", name="Keys"), "Close").click()


@contextmanager
def help_of_a_value(page: Page, _: House) -> Iterator[None]:
    button(page, "What is sweep?").click()
    expect(page.get_by_role("dialog")).to_be_visible()
    yield
    close = page.get_by_role("dialog").get_by_role("button", name="Close")
    if close.is_visible():  # it also closes when what it stands beside moves
        close.click()


@contextmanager
def tour(page: Page, _: House) -> Iterator[None]:
    page.keyboard.press("?")
    button(page, "Show the tour").click()
    expect(page.get_by_role("region", name="Tour")).to_be_visible()
    yield
    button(page, "Skip the tour").click()


@contextmanager
def details_of_a_run(page: Page, _: House) -> Iterator[None]:
    tab_of(page, "Runs").click()
    button(page, "wide sweeps").click()
    expect(button(page.get_by_role("complementary"), "Close")).to_be_visible()
    yield
    button(page.get_by_role("complementary"), "Close").click()


@contextmanager
def deletion(page: Page, house: House) -> Iterator[None]:
    with details_of_a_run(page, house):
        button(page.get_by_role("complementary"), "Delete…").click()
        asked = page.get_by_role("dialog")
        expect(button(asked, "Keep")).to_be_visible()
        yield
        button(asked, "Keep").click()


@contextmanager
def lost_connection(page: Page, house: House) -> Iterator[None]:
    house.rig.stop()
    notice = page.get_by_role("alert").filter(has_text="No connection")
    expect(notice).to_be_visible()
    yield
    house.rig.start()
    expect(notice).to_have_count(0, timeout=COMPUTED_WITHIN)
    expect(rig_state(page)).to_contain_text("disarmed")


@contextmanager
def replay(page: Page, house: House) -> Iterator[None]:
    page.evaluate("ids => void (location.hash = `#replay=${ids}`)", ",".join(house.runs))
    expect(page.get_by_role("slider", name="Time in the recording")).to_be_visible()
    yield
    button(page, "Back to live").click()
    expect(page.get_by_role("region", name="Replay")).to_have_count(0)


@contextmanager
def study_form(page: Page, _: House) -> Iterator[None]:
    tab_of(page, "Studies").click()
    button(page, "New study").click()
    expect(page.get_by_role("article", name="New study")).to_be_visible()
    yield
    button(page, "‹ All studies").click()


@contextmanager
def open_study(page: Page, _: House) -> Iterator[None]:
    tab_of(page, "Studies").click()
    page.get_by_role("button", name=STUDY).first.click()
    study = page.get_by_role("article", name=STUDY)
    expect(study.get_by_text("2 of 2 runs")).to_be_visible(timeout=COMPUTED_WITHIN)
    yield
    button(page, "‹ All studies").click()


VIEWS: dict[str, Callable[[Page, House], Opened]] = {
    "live": live,
    "walking": walking,
    "stopped": stopped,
    "jogging": jogging,
    **{f"tab {name}": tab(name) for name in TABS},
    "details of a run": details_of_a_run,
    "deletion": deletion,
    "study form": study_form,
    "open study": open_study,
    "replay": replay,
    **{f"setup {step}": setup(step) for step in STEPS},
    **{name: tool(name) for name in ("Draw a path", "Measure a distance")},
    "lost connection": lost_connection,
    "keys": keys,
    "help": help_of_a_value,
    "tour": tour,
}
"""By name: views that can follow one another on one page."""

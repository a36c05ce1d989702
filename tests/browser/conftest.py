"""A real server process with the simulated rig, and a real browser that looks at it."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from dashboard_visit import CLIENT, PATIENCE, OpenTab, ServedRig, Visit
from playwright.sync_api import Browser, expect, sync_playwright
from rooms import Room, spread_over_rooms

CHROMIUM_ARGS = ("--no-sandbox", "--use-angle=gl-egl", "--ignore-gpu-blocklist", "--disable-gpu-compositing")
"""WebGL in software for the scene; without a graphics card, composing the page itself is cheaper without it."""

TOUR_SEEN = 'localStorage.setItem("pivotrig.tour", "done")'
"""What a browser remembers of a person who has been here before."""

CALLED = """client => {
  try { sessionStorage.setItem("pivotrig.client", client) } catch { /* a frame without an address */ }
}"""
"""What a tab calls itself, as if its page had been loaded before."""

SCENE_PAGE = re.compile(r"^https?://[^/]+/scene/")

expect.set_options(timeout=PATIENCE * 1e3)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    spread_over_rooms(metafunc, everywhere=os.environ.get("PIVOTRIG_FULL") == "1")


@pytest.fixture(scope="session")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServedRig]:
    rig = ServedRig(tmp_path_factory.mktemp("rig-data"))
    rig.start()
    yield rig
    rig.stop()


@pytest.fixture
def own_server(tmp_path: Path) -> Iterator[ServedRig]:
    """A server that the test may kill."""
    rig = ServedRig(tmp_path)
    rig.start()
    yield rig
    rig.stop()


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServedRig]:
    """A server whose rig file the tests of one module may change."""
    rig = ServedRig(tmp_path_factory.mktemp("workshop"))
    rig.start()
    yield rig
    rig.stop()


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if chromium is None:
        pytest.fail("the browser tests need Chromium: apt-get install chromium")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=chromium, args=list(CHROMIUM_ARGS))
        yield started
        started.close()


@contextlib.contextmanager
def tabs(browser: Browser) -> Iterator[OpenTab]:
    """Opens a page of a server in a window of a size; everything is closed afterwards.

    scene: where it is not looked at it may stay empty, since drawing it in software costs more than all the rest.
    tour: the browser has not seen it yet.
    room: the window, in place of a size.
    client: what the tab calls itself; empty: what the page makes up.
    """
    visits: list[Visit] = []
    with contextlib.ExitStack() as stack:

        def open_tab(
            url: str,
            width: int = 1440,
            height: int = 900,
            *,
            scene: bool = True,
            tour: bool = False,
            room: Room | None = None,
            client: str = CLIENT,
        ) -> Visit:
            context = browser.new_context(**(room or Room(width, height)).window())
            stack.callback(context.close)
            if client:
                context.add_init_script(f"({CALLED})({json.dumps(client)})")
            if not tour:
                context.add_init_script(TOUR_SEEN)
            page = context.new_page()
            if not scene:
                page.route(SCENE_PAGE, lambda route: route.fulfill(content_type="text/html", body=""))
            page.set_default_timeout(PATIENCE * 1e3)
            visit = Visit(page)
            visit.watch(context)
            visits.append(visit)
            page.goto(url)
            return visit

        yield open_tab
        for visit in visits:
            assert visit.elsewhere() == [], "a page asks its own server alone"
            assert visit.refused == [], "a page keeps to its own policy"


@pytest.fixture
def open_tab(browser: Browser) -> Iterator[OpenTab]:
    with tabs(browser) as open_tab:
        yield open_tab


@pytest.fixture(scope="module")
def open_lasting_tab(browser: Browser) -> Iterator[OpenTab]:
    """For tests of one module that share a page: to load it takes longer than most of them."""
    with tabs(browser) as open_tab:
        yield open_tab


@pytest.fixture
def dashboard(served: ServedRig, open_tab: OpenTab) -> Iterator[Visit]:
    """A first visit to a rig at rest; at the end nothing has left the server and nobody has complained."""
    yield from first_visit(served, open_tab, scene=False)


@pytest.fixture
def dashboard_with_scene(served: ServedRig, open_tab: OpenTab) -> Iterator[Visit]:
    """The same, and the scene is drawn."""
    yield from first_visit(served, open_tab, scene=True)


def first_visit(served: ServedRig, open_tab: OpenTab, *, scene: bool) -> Iterator[Visit]:
    served.rest()
    visit = open_tab(served.url, scene=scene)
    yield visit
    assert visit.foreign(served.url) == []
    assert visit.complaints == []

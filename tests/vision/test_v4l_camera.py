"""V4L cameras: OpenCV's own V4L code, in front of a driver that is preloaded in place of a kernel's."""

from __future__ import annotations

import os
import statistics
import struct
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import astuple, dataclass, replace
from itertools import pairwise
from pathlib import Path

import pytest

from tests.vision.camera_watch import Watch, watched
from vision.sources.live import CLOSING_TIME
from vision.sources.v4l import DriverClock, pixel_format
from vision.sources.v4l_ioctl import Mode

URI = "v4l:///dev/full"
"""The device that the driver answers for."""
SOURCE = Path(__file__).with_name("v4l_driver.c")


@dataclass(frozen=True)
class Behaviour:
    """Of the driver; as in v4l_driver.c."""

    present: int = 1
    hangs: int = 0
    width: int = 64
    height: int = 48
    rate: int = 30
    clock: int = 0
    age_ms: int = 0
    longest_exposure: int = 200


@dataclass(frozen=True)
class Driver:
    """library: to be preloaded.  state: the file that says how it behaves."""

    library: Path
    state: Path

    def behave(self, behaviour: Behaviour) -> None:
        """All at once: a driver that reads meanwhile finds the old or the new."""
        fresh = self.state.with_suffix(".new")
        fresh.write_bytes(struct.pack("=8i", *astuple(behaviour)))
        os.replace(fresh, self.state)

    @contextmanager
    def watched(self, behaviour: Behaviour, *arguments: object) -> Iterator[Watch]:
        """The camera opened with 64x48 px at 30 frames/s, or as the arguments say."""
        self.behave(behaviour)
        with watched(
            URI, *(arguments or (64, 48, 30)), LD_PRELOAD=str(self.library), V4L_DRIVER=str(self.state)
        ) as watch:
            yield watch


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    built = tmp_path_factory.mktemp("driver") / "v4l.so"
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", built, SOURCE, "-ldl"], check=True)
    return built


@pytest.fixture
def driver(library: Path, tmp_path: Path) -> Driver:
    return Driver(library, tmp_path / "behaviour")


def test_a_frame_bears_the_time_at_which_the_driver_took_it(driver: Driver) -> None:
    """Pictures that have waited for 40 ms in the driver are 40 ms old when they come, and say so."""
    with driver.watched(Behaviour(age_ms=40)) as watch:
        ages = [frame["at"] - frame["captured_at"] for frame in watch.frames(20)]
        assert 0.040 <= statistics.median(ages) <= 0.060


def test_a_picture_that_has_lain_in_the_driver_for_seconds_is_as_old_as_it_is(driver: Driver) -> None:
    """As after a standstill of the program, in which nobody emptied the buffers: not taken for a new one."""
    with driver.watched(Behaviour()) as watch:
        watch.frames(3)
        driver.behave(Behaviour(clock=3))
        ages = [frame["at"] - frame["captured_at"] for frame in watch.frames(10)[5:]]
        assert all(3.0 <= age <= 3.5 for age in ages)


@pytest.mark.parametrize("clock", [1, 2])
def test_a_driver_with_another_clock_is_not_believed(driver: Driver, clock: int) -> None:
    """The time of day, and no time at all: the frame's time is then that of its arrival."""
    with driver.watched(Behaviour(clock=clock)) as watch:
        ages = [frame["at"] - frame["captured_at"] for frame in watch.frames(10)]
        assert 0.0 <= statistics.median(ages) <= 0.020


def test_the_frames_are_one_after_the_other_and_none_comes_twice(driver: Driver) -> None:
    with driver.watched(Behaviour()) as watch:
        frames = watch.frames(15)
        assert [frame["index"] for frame in frames] == sorted({frame["index"] for frame in frames})
        assert len({frame["captured_at"] for frame in frames}) == 15
        assert frames[0]["grey"] < frames[-1]["grey"]


def test_a_camera_that_is_unplugged_is_missed_and_taken_again_when_it_is_back(driver: Driver) -> None:
    with driver.watched(Behaviour()) as watch:
        before = watch.frame()
        driver.behave(Behaviour(present=0))
        watch.note("gives no pictures any more")
        watch.trouble("is not plugged in")
        driver.behave(Behaviour())
        watch.note("is there")
        assert watch.frame()["index"] > before["index"]


def test_a_camera_that_comes_back_with_another_size_is_named_and_not_used(driver: Driver) -> None:
    with driver.watched(Behaviour()) as watch:
        watch.frame()
        driver.behave(Behaviour(present=0))
        watch.trouble("is not plugged in")
        driver.behave(Behaviour(width=128, height=96))
        watch.trouble("gives 128x96 px where 64x48 px was asked")
        seen = len(watch.lines)
        assert not any("index" in watch.next() for _ in range(20))
        driver.behave(Behaviour())
        assert watch.frame()["index"] > 0
        assert len(watch.lines) > seen


def test_a_camera_that_is_missing_at_the_start_is_found_when_it_is_plugged_in(driver: Driver) -> None:
    with driver.watched(Behaviour(present=0)) as watch:
        watch.trouble("is not plugged in")
        driver.behave(Behaviour())
        watch.frame()


def test_a_camera_that_fails_in_an_unforeseen_way_is_tried_again(driver: Driver) -> None:
    """Its driver lets OpenCV in, and then nobody who asks for its settings."""
    with driver.watched(Behaviour(present=2)) as watch:
        watch.trouble("Device or resource busy")
        driver.behave(Behaviour())
        watch.frame()


def test_a_driver_that_hangs_keeps_nobody_waiting(driver: Driver) -> None:
    """While it hangs, every read comes back in its time; closing does, too."""
    with driver.watched(Behaviour()) as watch:
        watch.frame()
        driver.behave(Behaviour(hangs=1))
        waits = [watch.until(lambda line: "trouble" in line)["at"] for _ in range(20)]
        assert statistics.median(b - a for a, b in pairwise(waits)) < 0.1
        assert watch.close() <= CLOSING_TIME + 0.5


def test_a_setting_that_the_camera_has_not_is_told_with_what_it_offers(driver: Driver) -> None:
    """30 ms exposure of a camera that offers 20 ms at most, and 60 frames/s of one that makes 30."""
    with driver.watched(Behaviour(), 64, 48, 60, 0.030) as watch:
        watch.frame()
        assert any("rate_Hz = 60 was asked, and the camera has 30" in note for note in watch.notes)
        assert any(
            "exposure_ms = 30 was asked, and the camera has 20; it offers 0.1 to 20" in note
            for note in watch.notes
        )


def test_a_setting_that_the_camera_takes_is_not_spoken_of(driver: Driver) -> None:
    with driver.watched(Behaviour(), 64, 48, 30, 0.008) as watch:
        watch.frame()
        assert watch.notes == []


def test_a_setting_that_the_camera_does_not_have_is_said_to_be_missing(driver: Driver) -> None:
    with driver.watched(replace(Behaviour(), longest_exposure=0), 64, 48, 30, 0.008) as watch:
        watch.frame()
        assert any("has no such setting" in note for note in watch.notes)


@pytest.mark.parametrize(
    ("stamp", "grabbed_at", "captured_at"),
    [
        (99.96, 100.0, 99.96),
        (100.0, 100.0, 100.0),
        (98.0, 100.0, 98.0),
        (97.9, 100.0, 100.0),
        (100.001, 100.0, 100.0),
        (0.0, 100.0, 100.0),
        (1.7e9, 100.0, 100.0),
        (float("nan"), 100.0, 100.0),
    ],
)
def test_a_stamp_counts_only_where_it_can_be_true(
    stamp: float, grabbed_at: float, captured_at: float
) -> None:
    assert DriverClock().capture_time(stamp, grabbed_at) == captured_at


def test_raw_pictures_are_taken_where_they_are_fast_enough() -> None:
    offered = [Mode("MJPG", (640, 480), (60.0, 30.0)), Mode("YUYV", (640, 480), (30.0,))]
    assert pixel_format(offered, (640, 480), 30.0) == "YUYV"
    assert pixel_format(offered, (640, 480), 60.0) == "MJPG"
    assert pixel_format(offered, (1280, 720), 30.0) == "MJPG"
    assert pixel_format([Mode("YUYV", (640, 480), (29.97,))], (640, 480), 30.0) == "YUYV"
    assert pixel_format([], (640, 480), 30.0) == "MJPG"

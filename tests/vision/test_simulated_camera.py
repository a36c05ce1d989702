from __future__ import annotations

import dataclasses
import math
import threading
import time

import cv2
import numpy as np
import pytest
from scripted_scene import OPTICS, SCENE, ScriptedWorld, circling

from control.model import Frame
from vision.simulated.camera import AsFastAsItGoes, RealTime, SyntheticCamera
from vision.simulated.disturbance import Disturbance
from vision.simulated.rendering import Painter
from vision.simulated.scenes import SCENES

TIMEOUT = 0.1


def camera(**scene) -> SyntheticCamera:
    return SyntheticCamera(ScriptedWorld(), OPTICS, dataclasses.replace(SCENE, **scene))


def frames(source: SyntheticCamera, count: int) -> list[Frame]:
    read = [source.read(TIMEOUT) for _ in range(count)]
    return [frame for frame in read if frame is not None]


def test_the_same_seed_gives_the_same_bytes_and_another_seed_others():
    once, again, other = (frames(camera(seed=seed), 3) for seed in (1, 1, 2))
    assert all(np.array_equal(a.image, b.image) for a, b in zip(once, again, strict=True))
    assert not any(np.array_equal(a.image, b.image) for a, b in zip(once, other, strict=True))


def test_frames_come_at_the_rate_in_order_each_once_and_late_by_the_latency():
    source = camera()
    for index in range(40):
        frame = source.read(TIMEOUT)
        assert frame is not None
        assert frame.index == index
        assert -1e-9 <= index / 60 - frame.captured_at < 1e-3
        assert -1e-9 <= frame.captured_at + 0.035 - source.now() < 1e-3


def test_a_frame_shows_the_world_as_it_was_at_its_capture_time():
    painter = Painter(OPTICS, SCENE)
    for frame in frames(camera(), 12):
        assert np.array_equal(frame.image, painter.paint(circling(frame.captured_at), frame.index))


def test_sensor_noise_lies_on_every_pixel_and_has_the_strength_that_is_asked():
    painter = Painter(OPTICS, SCENE)
    stack = np.stack([painter.paint(None, index) for index in range(40)]).astype(np.float32)
    spread = stack.std(axis=0)
    assert spread.min() > 0.5
    assert spread.mean() == pytest.approx(SCENE.noise, rel=0.05)


def test_the_empty_plate_is_lit_unevenly_and_never_saturated():
    image = Painter(OPTICS, SCENE).paint(None, 0)
    assert image.max() < 255
    assert image.min() > 0
    assert image[:, 600:].mean() > image[:, :40].mean() + 5


def test_a_robot_half_out_of_the_picture_or_far_away_is_drawn_as_far_as_it_is_seen():
    painter = Painter(OPTICS, SCENE)
    empty = painter.paint(None, 0)
    for x, seen in ((0.085, True), (0.2, False)):
        body = dataclasses.replace(circling(0.0), pose=dataclasses.replace(circling(0.0).pose, x=x))
        assert np.array_equal(painter.paint(body, 0), empty) is not seen


def test_a_picture_cannot_be_written_to():
    (frame,) = frames(camera(), 1)
    with pytest.raises(ValueError, match="read-only"):
        frame.image[0, 0] = 0


def test_a_frame_that_is_due_later_than_the_timeout_is_not_lost():
    source = camera()
    assert source.read(0.020) is None
    assert source.now() == pytest.approx(0.020)
    frame = source.read(0.020)
    assert frame is not None
    assert frame.index == 0
    assert source.now() == pytest.approx(0.035)


def test_an_unplugged_camera_gives_nothing_while_time_goes_on_and_comes_back():
    source = camera()
    frames(source, 10)
    source.disturbance.unplugged = True
    start = source.now()
    assert [source.read(TIMEOUT) for _ in range(3)] == [None] * 3
    assert source.now() == pytest.approx(start + 3 * TIMEOUT)
    source.disturbance.unplugged = False
    back = source.read(TIMEOUT)
    assert back is not None
    assert back.captured_at >= start + 3 * TIMEOUT - 1e-3
    assert back.index > 20


def test_a_frozen_camera_repeats_its_last_picture_with_new_times():
    source = camera()
    (last, *_) = frames(source, 5)[::-1]
    source.disturbance.frozen = True
    repeated = frames(source, 4)
    assert all(np.array_equal(frame.image, last.image) for frame in repeated)
    assert [frame.index for frame in repeated] == [5, 6, 7, 8]
    assert repeated[-1].captured_at > last.captured_at + 0.06
    source.disturbance.frozen = False
    assert not np.array_equal(frames(source, 1)[0].image, last.image)


def test_a_hidden_robot_is_not_in_the_picture():
    source = camera()
    source.disturbance.hidden = True
    (frame,) = frames(source, 1)
    assert np.array_equal(frame.image, Painter(OPTICS, SCENE).paint(None, 0))


def test_extra_latency_delays_frames_and_when_it_ends_the_newest_one_comes():
    source = camera()
    frames(source, 10)
    source.disturbance.extra_latency = 0.2
    late = next(frame for _ in range(10) if (frame := source.read(TIMEOUT)) is not None)
    assert source.now() - late.captured_at == pytest.approx(0.235, abs=2e-3)
    source.disturbance.extra_latency = 0.0
    fresh = source.read(TIMEOUT)
    assert fresh is not None
    assert source.now() - fresh.captured_at < 0.035 + 1 / 60 + 1e-3
    assert fresh.index > late.index + 8


class Wristwatch(AsFastAsItGoes):
    """Real time whose clock the test sets; who waits is let go at the time he waits for."""

    def __init__(self) -> None:
        self.time = 100.0
        self.offset = 0.0

    def begin(self, world_time: float) -> None:
        self.offset = self.time - world_time

    def now(self, world_time: float) -> float:
        return self.time + 0.0 * world_time

    def wait_until(self, rig_time: float) -> None:
        self.time = max(self.time, rig_time)


def test_in_real_time_frames_that_nobody_fetched_are_dropped_and_the_newest_is_given():
    watch = Wristwatch()
    source = SyntheticCamera(ScriptedWorld(), OPTICS, SCENE, watch)
    first = source.read(TIMEOUT)
    assert first is not None
    assert first.captured_at == pytest.approx(100.0)
    watch.time += 0.5
    frame = source.read(TIMEOUT)
    assert frame is not None
    assert watch.time == pytest.approx(100.535)
    assert 100.5 - 1 / 60 - 1e-3 <= frame.captured_at <= 100.5


def test_a_world_that_cannot_catch_up_goes_on_from_where_it_is():
    watch = Wristwatch()
    world = ScriptedWorld()
    source = SyntheticCamera(world, OPTICS, SCENE, watch)
    frames(source, 5)
    before = world.now
    watch.time += 3600.0
    frame = source.read(TIMEOUT)
    assert frame is not None
    assert frame.captured_at > 3700.0
    assert world.now < before + 0.1


def test_in_real_time_frames_carry_the_monotonic_clock_and_keep_the_pace():
    start = time.monotonic()
    source = SyntheticCamera(ScriptedWorld(), OPTICS, SCENE, RealTime())
    read = frames(source, 6)
    assert time.monotonic() - start >= 5 / 60 + 0.035 - 2e-3
    assert all(start - 1e-3 <= frame.captured_at <= time.monotonic() - 0.034 for frame in read)
    source.close()


def test_closing_ends_a_read_that_waits():
    source = SyntheticCamera(ScriptedWorld(), OPTICS, SCENE, RealTime())
    source.disturbance.unplugged = True
    closing = threading.Timer(0.02, source.close)
    closing.start()
    assert source.read(10.0) is None
    assert source.read(10.0) is None
    closing.join()


def test_a_busy_computer_stops_the_world_instead_of_ageing_its_frames():
    source = SyntheticCamera(ScriptedWorld(), OPTICS, SCENE, RealTime(stands_still=0.07))
    for _ in range(5):
        source.read(0.1)
    before = source.now()
    time.sleep(0.25)
    after = source.now()
    assert after - before < 0.02
    frame = source.read(0.1)
    assert frame is not None
    assert source.now() - frame.captured_at < 0.1
    source.close()


def test_a_board_with_its_own_clock_is_never_made_to_wait():
    source = SyntheticCamera(ScriptedWorld(), OPTICS, SCENE, RealTime())
    source.read(0.1)
    before = source.now()
    time.sleep(0.15)
    assert source.now() - before >= 0.15
    source.close()


# What disturbs it


def picture(source: SyntheticCamera) -> np.ndarray:
    (frame,) = frames(source, 1)
    return frame.image.astype(float)


def reds(image: np.ndarray) -> list[tuple[float, float]]:
    """Centres (u, v) px of what has the robot's red and at least half its size."""
    mask = ((image[:, :, 2] - image[:, :, 0] > 60) & (image[:, :, 2] - image[:, :, 1] > 60)).astype(np.uint8)
    _, _, statistics, centres = cv2.connectedComponentsWithStats(mask)
    return [tuple(c) for c, s in zip(centres[1:], statistics[1:], strict=True) if s[cv2.CC_STAT_AREA] > 250]


def test_the_scene_that_is_called_clean_is_none() -> None:
    staged = SyntheticCamera(ScriptedWorld(), OPTICS, SCENE, staged=SCENES["clean"])
    for one, other in zip(frames(staged, 5), frames(camera(), 5), strict=True):
        assert np.array_equal(one.image, other.image)


def test_a_scene_before_the_camera_plays_for_ever_and_alike() -> None:
    once, again = (
        SyntheticCamera(ScriptedWorld(), OPTICS, SCENE, staged=SCENES["standing_twins"]) for _ in range(2)
    )
    for one, other in zip(frames(once, 5), frames(again, 5), strict=True):
        assert np.array_equal(one.image, other.image)
        assert len(reds(one.image.astype(float))) == 4


@pytest.mark.parametrize(
    ("switch", "value"), [("light", 0.03), ("exposure", 0.5), ("flicker", 0.5), ("glare", True), ("litter", True)]
)  # fmt: skip
def test_what_disturbs_the_picture_is_gone_when_it_is_taken_away(switch: str, value: object) -> None:
    disturbed, usual = camera(), camera()
    setattr(disturbed.disturbance, switch, value)
    assert not np.array_equal(picture(disturbed), picture(usual))
    setattr(disturbed.disturbance, switch, getattr(Disturbance(), switch))
    assert np.array_equal(picture(disturbed), picture(usual))


def test_half_the_exposure_halves_every_grey_level() -> None:
    darkened, usual = camera(), camera()
    darkened.disturbance.exposure = 0.5
    assert picture(darkened).mean() == pytest.approx(0.5 * picture(usual).mean(), rel=0.01)


def test_without_light_the_picture_is_nearly_black() -> None:
    source = camera()
    source.disturbance.light = 0.03
    assert picture(source).mean() < 15, "the noise has a mean of 12"


def test_a_twin_lies_as_far_away_as_asked_and_stays_where_it_is() -> None:
    source = camera()
    source.disturbance.twin = 0.020
    first, later = (reds(picture(source)), [reds(image) for image in map(picture, [source] * 60)][-1])
    ((u0, v0), (u1, v1)) = first
    assert math.hypot(u1 - u0, v1 - v0) == pytest.approx(0.020 * OPTICS.scale_at(0.0, 0.0, 0.003), rel=0.03)
    stayed = [one for one in later if any(math.dist(one, before) < 0.5 for before in first)]
    assert len(stayed) == 1


def test_a_hand_comes_in_within_a_fifth_of_a_second_and_stays_over_the_robot() -> None:
    source = camera()
    source.disturbance.hand = True
    seen = [len(reds(picture(source))) for _ in range(40)]
    assert seen[0] == 1
    assert seen[13:] == [0] * 27
    source.disturbance.hand = False
    assert len(reds(picture(source))) == 1

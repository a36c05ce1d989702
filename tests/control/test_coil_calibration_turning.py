"""From how the robot turns to what is wrong: every fault, on an ideal robot, from any heading."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.axes import AXES
from control.calibration.heading_offset import corrected, heading_offset
from control.calibration.robot_turn import PROBE
from control.calibration.turning import Evidence, Station, Unclear, gather
from control.calibration.verdict import Cause, diagnose
from control.coils import command_field
from control.model import PIVOT_A, PIVOT_B, Pose, opposite, pivot_point, wrap
from control.registration import Registration

patient = settings(deadline=None)
"""What an example takes on a busy computer is no matter here."""

LENGTH = 0.010
headings = st.floats(-math.pi, math.pi)


class IdealRobot:
    """Lies along the field that the faulty rig makes and turns about the end that it presses.

    wiring: pairs on the three drivers.  turned: of the camera against the coils, rad.
    """

    def __init__(self, heading, wiring=AXES, turned=0.0, magnet_reversed=False, mirrored=False, play=0.0):
        self.wiring, self.turned, self.magnet_reversed, self.mirrored = (
            wiring,
            turned,
            magnet_reversed,
            mirrored,
        )
        self.play = play
        self.pose = Pose(0.001, -0.002, self._true(heading))
        self.name = heading

    def _true(self, seen_heading):
        """Heading on the plate (camera's frame unmirrored) of a robot put down as `seen_heading`."""
        return -seen_heading if self.mirrored else seen_heading

    def follow(self, pivot, heading, direction):
        field = command_field(pivot, heading, 0.4, 0.01)
        through = dict.fromkeys(AXES, 0.0)
        for lead, value in zip(self.wiring, field, strict=True):
            through[lead[-1]] = -value if lead.startswith("-") else value
        bx, by, bz = (through[axis] for axis in AXES)
        if self.magnet_reversed:
            bx, by, bz = -bx, -by, -bz
        target = math.atan2(-bx, by) + self.turned - direction * 0.5 * self.play
        pressed = PIVOT_B if bz > 0.0 else PIVOT_A
        x, y = pivot_point(self.pose, pressed, LENGTH)
        arm = 0.5 * LENGTH * pressed
        self.pose = Pose(x + arm * math.sin(target), y - arm * math.cos(target), target)
        return self.seen()

    def seen(self):
        """As the camera sees it: a picture turned left for right, and ends named by continuity."""
        pose = self.pose
        x, heading = (-pose.x, -pose.heading) if self.mirrored else (pose.x, pose.heading)
        if math.cos(heading - self.name) < 0.0:
            heading += math.pi
        self.name = heading
        return Pose(x, pose.y, wrap(heading))


def probe(robot, start):
    stations, last = [], start
    robot.follow(PIVOT_A, start, 1)
    for pivot in (PIVOT_A, PIVOT_B):
        for angle in (0.0, *PROBE, *PROBE[-2::-1], 0.0):
            direction = 1 if start + angle >= last else -1
            last = start + angle
            stations.append(Station(last, pivot, direction, robot.follow(pivot, last, direction)))
    return stations


def evidence(heading, **faults) -> Evidence:
    robot = IdealRobot(heading, **faults)
    before = robot.seen()
    return gather(before, probe(robot, before.heading), LENGTH)


@patient
@given(headings)
def test_a_rig_in_order_shows_nothing(heading):
    assert diagnose(evidence(heading)).causes == (Cause.NONE,)
    assert diagnose(evidence(heading, play=math.radians(3.0))).causes == (Cause.NONE,)


@patient
@given(headings, st.floats(-0.4, 0.4))
@pytest.mark.parametrize(
    ("wiring", "cause"),
    [
        (("-x", "y", "z"), Cause.X_SWAPPED),
        (("x", "-y", "z"), Cause.Y_SWAPPED),
        (("x", "y", "-z"), Cause.Z_SWAPPED),
        (("y", "x", "z"), Cause.XY_EXCHANGED),
    ],
)
def test_each_fault_of_the_wiring_is_named_even_by_a_camera_that_is_turned(wiring, cause, heading, turned):
    found = evidence(heading, wiring=wiring, turned=turned)
    assert diagnose(found, picture_is_mirrored=False).causes == (cause,)
    assert not diagnose(found, picture_is_mirrored=False).is_usable


@patient
@given(headings)
@pytest.mark.parametrize("wiring", [("-x", "y", "z"), ("x", "-y", "z"), ("y", "x", "z")])
def test_without_a_look_at_the_picture_a_mirror_is_named_as_well(wiring, heading):
    assert Cause.MIRRORED in diagnose(evidence(heading, wiring=wiring)).causes


@patient
@given(headings)
def test_a_mirrored_picture_is_named_once_somebody_has_looked(heading):
    found = evidence(heading, mirrored=True)
    assert found.sense == -1
    assert diagnose(found, picture_is_mirrored=True).causes == (Cause.MIRRORED,)
    assert Cause.MIRRORED in diagnose(found).causes


@patient
@given(headings, st.floats(-0.6, 0.6))
def test_a_reversed_magnet_is_told_from_half_a_turn_of_the_camera(heading, turned):
    reversed_ = evidence(heading, magnet_reversed=True, turned=turned)
    assert diagnose(reversed_).causes == (Cause.MAGNET_REVERSED,)
    assert wrap(reversed_.offset + math.pi) == pytest.approx(turned, abs=1e-6)
    half_turn = evidence(heading, turned=turned + math.pi)
    assert diagnose(half_turn).causes == (Cause.TURNED,)
    assert diagnose(half_turn).is_usable


@patient
@given(headings, st.floats(-math.pi, math.pi).filter(lambda angle: abs(angle) > 0.06))
def test_a_turned_camera_shows_its_angle(heading, turned):
    found = evidence(heading, turned=turned)
    assert diagnose(found).causes == (Cause.TURNED,)
    assert abs(wrap(found.offset - turned)) < 1e-6


def test_more_than_one_fault_is_called_a_mixture():
    two = evidence(1.0, wiring=("-x", "y", "-z"))
    assert diagnose(two).causes == (Cause.MIRRORED, Cause.MIXED)
    assert diagnose(two, picture_is_mirrored=False).causes == (Cause.MIXED,)
    assert diagnose(evidence(1.0, wiring=("x", "y", "-z"), turned=1.5)).causes == (Cause.MIXED,)


def test_a_robot_that_spun_out_of_sight_is_to_be_put_down_again():
    robot = IdealRobot(1.0)
    before = Pose(0.02, 0.02, 1.0)
    found = gather(before, probe(robot, 1.0), LENGTH)
    assert not found.names_are_sure
    verdict = diagnose(found)
    assert "put it down with end A" in verdict.message
    assert verdict.causes == (Cause.NONE,)
    assert not verdict.is_usable, "nobody knows which way round the magnet lies"


def stuck(stations):
    return [Station(s.field_heading, s.pivot, s.direction, stations[0].pose) for s in stations]


def test_a_robot_that_does_not_follow_allows_no_verdict():
    stations = probe(IdealRobot(1.0), 1.0)
    with pytest.raises(Unclear, match="it does not follow"):
        gather(stations[0].pose, stuck(stations), LENGTH)


def test_a_robot_that_turns_about_its_middle_has_no_pressed_end():
    stations = [
        Station(s.field_heading, s.pivot, s.direction, Pose(0.0, 0.0, s.pose.heading))
        for s in probe(IdealRobot(1.0), 1.0)
    ]
    with pytest.raises(Unclear, match="both ends move"):
        gather(stations[0].pose, stations, LENGTH)


def test_an_end_that_is_pressed_whatever_is_commanded_means_no_current_in_the_z_coils():
    stations = [
        Station(s.field_heading, pivot, s.direction, s.pose)
        for pivot in (PIVOT_A, PIVOT_B)
        for s in probe(IdealRobot(1.0), 1.0)[:7]
    ]
    with pytest.raises(Unclear, match="z coils"):
        gather(stations[0].pose, stations, LENGTH)


def circle(turned=0.0, play=0.0, noise=lambda _: 0.0, count=12):
    stations = []
    for direction in (1, -1):
        for number in range(count):
            field = 0.3 + 2.0 * math.pi * number / count
            seen = field + turned - direction * 0.5 * play + noise(number)
            stations.append(Station(field, PIVOT_A, direction, Pose(0.0, 0.0, wrap(seen))))
    return stations


@patient
@given(headings, st.floats(0.0, 0.12))
def test_the_rotation_comes_out_whatever_the_play(turned, play):
    found = heading_offset(circle(turned, play))
    assert abs(wrap(found.offset - turned)) < 1e-9
    assert found.play == pytest.approx(play, abs=1e-9)
    assert found.residual < 1e-9


def test_a_registration_needs_turns_both_ways_and_enough_of_them():
    with pytest.raises(Unclear, match="turns both ways"):
        heading_offset(circle()[:12])
    with pytest.raises(Unclear, match="6 headings were seen, 8"):
        heading_offset(circle(count=3))
    assert heading_offset(circle(count=4)).stations == 8


def test_headings_that_scatter_are_refused():
    with pytest.raises(Unclear, match="the headings scatter by"):
        heading_offset(circle(noise=lambda number: 0.2 * (-1) ** number))


@patient
@given(headings, st.floats(-1.5, 1.5), st.booleans(), st.booleans())
def test_after_the_correction_field_and_robot_agree(start, turned, was_reversed, is_reversed):
    """Under the corrected registration the rotation is the true one, and so is the polarity."""
    old = Registration(rotation=start, magnet_reversed=was_reversed)
    differs = was_reversed != is_reversed
    offset = wrap(turned + (math.pi if differs else 0.0))
    new = corrected(old, offset, differs)
    assert new.magnet_reversed == is_reversed
    assert abs(wrap(new.rotation - start - turned)) < 1e-9


def test_an_end_has_an_opposite():
    assert opposite(opposite(PIVOT_A)) == PIVOT_A

"""Limits and arbiter in the whole program on the simulated rig, headless: what an operator meets."""

import math
from collections.abc import Iterator

import numpy as np
import pytest

from control.coil_heat import CoilHeat
from control.controllers import Decision
from control.controllers.manual import Jog
from control.gait import Gait
from control.model import PIVOT_A, PIVOT_B, Frame, Pose, Tracking
from control.runs import Choice, RunRequest, RunState, Selection
from control.safety import Refused
from control.simulation.plant import SlipPlant
from control.simulation.slip import SLIP_TABLE
from control.snapshot import RigState
from server.assembly import build_machine
from server.headless import run_headless
from server.settings import RigFile, VisionSection
from tests.faults.fault_bench import EIGHT, GAIT, FaultBench, fault_bench

EAST = 0.0
SWING = math.radians(60.0)


@pytest.fixture
def bench() -> Iterator[FaultBench]:
    facing_east = RigFile(vision=VisionSection(heading_hint_deg=0.0)).with_simulation(
        seed=3, start_heading_deg=0.0
    )
    with fault_bench(facing_east) as ready:
        yield ready


def put(bench: FaultBench, x: float, y: float, heading: float) -> None:
    """Lay the robot down somewhere by hand, and let the camera find it."""
    bench.world.nudge(Pose(x, y, heading))
    bench.run_for(0.5)
    bench.until(lambda snapshot: snapshot.tracking is Tracking.LOCKED)


def codes(bench: FaultBench) -> list[str]:
    return [event.code for event in bench.trace.events]


def expect_no_current(bench: FaultBench) -> None:
    bench.run_for(0.2)
    assert bench.board.drive_is_zero
    assert max(abs(current) for current in bench.world.currents) < 0.4


def jog_for(bench: FaultBench, jog: Jog, duration: float) -> None:
    until = bench.now + duration
    while bench.now < until:
        bench.loop.jog(jog)
        bench.tick()


# The workspace -----------------------------------------------------------------------------------


def test_a_jog_that_leads_out_is_refused_and_the_robot_stays_inside(bench: FaultBench) -> None:
    put(bench, 0.060, 0.0, EAST)
    bench.arm()
    bench.run_for(0.5)
    with pytest.raises(Refused, match="this swing leads out of the workspace"):
        jog_for(bench, Jog(PIVOT_A, SWING), 3.0)
    assert bench.loop.state is RigState.ARMED
    assert bench.world.body().pose.x <= 0.0622


def test_a_swing_that_begins_inside_stops_at_the_soft_margin(bench: FaultBench) -> None:
    """A jog is let off while it leads nowhere bad; where it would go on out, the robot stands still."""
    put(bench, 0.0600, 0.0, math.radians(60.0))
    bench.arm()
    bench.run_for(0.5)
    furthest = 0.0
    for _ in range(240):
        try:
            bench.loop.jog(Jog(PIVOT_B, SWING * 0.3))
        except Refused:
            break
        bench.tick()
        furthest = max(furthest, bench.world.body().pose.x)
    bench.run_for(0.5)
    assert max(furthest, bench.world.body().pose.x) <= 0.0623


def test_beyond_the_soft_margin_a_jog_may_lead_inward_only(bench: FaultBench) -> None:
    put(bench, 0.065, 0.0, EAST)
    bench.until(lambda snapshot: snapshot.tracking is Tracking.LOCKED)
    assert [fault.code for fault in bench.snapshot.faults] == ["margin"]
    bench.loop.arm(GAIT)
    bench.run_for(0.5)
    with pytest.raises(Refused, match="leads out"):
        bench.loop.jog(Jog(PIVOT_A, SWING))
    with pytest.raises(Refused, match="leads out"):
        bench.loop.jog(Jog(PIVOT_B, -SWING))
    before = bench.world.body().pose.x
    jog_for(bench, Jog(PIVOT_A, -SWING), 0.4)
    assert bench.world.body().pose.x < before - 0.0005
    assert bench.loop.state is RigState.ARMED


def test_a_run_that_would_lead_out_is_held_and_goes_on_inward(bench: FaultBench) -> None:
    """A controller that walks east for ever is held at the margin, however often the operator resumes."""
    put(bench, 0.060, 0.0, EAST)
    bench.arm()
    east = Selection(Choice("straight", {"distance_mm": 50.0}), Choice("eight"), GAIT)
    bench.loop.start("a run", RunRequest(east))
    snapshot = bench.until(lambda snapshot: snapshot.rig is RigState.HELD, within=20.0)
    assert "out of the workspace" in snapshot.reason
    assert "margin" in codes(bench)
    expect_no_current(bench)
    assert bench.world.body().pose.x <= 0.0623
    for _ in range(3):
        bench.loop.resume()
        bench.until(lambda snapshot: snapshot.rig is RigState.HELD, within=5.0)
    assert bench.world.body().pose.x <= 0.0626
    bench.loop.stop_run()
    bench.run_for(0.2)
    bench.loop.arm(GAIT)
    bench.run_for(0.5)
    jog_for(bench, Jog(PIVOT_A, -SWING), 0.35)
    assert bench.loop.state is RigState.ARMED, bench.snapshot.reason
    assert bench.world.body().pose.x < 0.0620


def test_a_robot_beyond_the_hard_margin_is_without_current_and_can_be_driven_back_in(
    bench: FaultBench,
) -> None:
    put(bench, 0.0675, 0.0, EAST)
    bench.loop.arm(GAIT)
    bench.run_for(0.5)
    for _ in range(20):
        pose = bench.world.body().pose
        bench.world.nudge(Pose(pose.x + 0.0001, pose.y, pose.heading))
        bench.tick()
        if bench.snapshot.rig is RigState.HELD:
            break
    assert bench.snapshot.rig is RigState.HELD
    assert "outside" in codes(bench)
    expect_no_current(bench)
    bench.loop.resume()
    assert bench.run_for(0.5).rig is RigState.ARMED
    with pytest.raises(Refused, match="leads out"):
        bench.loop.jog(Jog(PIVOT_A, SWING))
    jog_for(bench, Jog(PIVOT_A, -SWING), 0.35)
    jog_for(bench, Jog(PIVOT_B, SWING * 0.01), 0.02)
    assert bench.loop.state is RigState.ARMED, bench.snapshot.reason
    assert bench.world.body().pose.x < 0.0675


def test_a_way_back_in_is_open_for_one_resume_only(bench: FaultBench) -> None:
    """Whoever disarms a robot beyond the hard margin brings it back by hand."""
    put(bench, 0.0675, 0.0, EAST)
    bench.loop.arm(GAIT)
    bench.run_for(0.5)
    while bench.snapshot.rig is not RigState.HELD:
        pose = bench.world.body().pose
        bench.world.nudge(Pose(pose.x + 0.0001, pose.y, pose.heading))
        bench.tick()
    expect_no_current(bench)
    bench.loop.resume()
    assert bench.run_for(0.1).rig is RigState.ARMED
    bench.loop.disarm()
    bench.tick()
    with pytest.raises(Refused, match="bring it back in"):
        bench.loop.arm(GAIT)


def test_a_disarmed_robot_beyond_the_hard_margin_is_put_back_by_hand(bench: FaultBench) -> None:
    put(bench, 0.070, 0.0, EAST)
    with pytest.raises(Refused, match="bring it back in"):
        bench.loop.arm(GAIT)


# Heat --------------------------------------------------------------------------------------------


def test_a_hot_coil_warns_then_holds_and_cools_before_it_may_go_on(bench: FaultBench) -> None:
    bench.loop.coil_heat = CoilHeat((0.5, 0.85, 0.1))
    bench.run_for(0.5)
    bench.loop.arm(GAIT)
    bench.loop.start("a run", RunRequest(EIGHT))
    assert bench.run_for(1.0).rig is RigState.RUNNING
    warnings = [e for e in bench.trace.events if (e.severity, e.code) == ("warn", "heat")]
    assert len(warnings) == 1
    assert warnings[0].message.startswith("coil y is at 85%")
    bench.loop.coil_heat = CoilHeat((0.5, 1.001, 0.1))
    snapshot = bench.until(lambda snapshot: snapshot.rig is RigState.HELD, within=0.1)
    assert "it must cool to 80%" in snapshot.reason
    assert snapshot.coil_heat[1] == pytest.approx(1.0, abs=2e-3)
    expect_no_current(bench)
    bench.loop.coil_heat = CoilHeat((0.5, 0.81, 0.1), is_too_hot=True)
    bench.tick()
    with pytest.raises(Refused, match="must cool"):
        bench.loop.resume()
    bench.loop.coil_heat = CoilHeat((0.5, 0.79, 0.1), is_too_hot=True)
    bench.run_for(0.1)
    bench.loop.resume()
    assert bench.run_for(0.5).rig is RigState.RUNNING


def test_the_heat_follows_what_flows_and_goes_on_while_disarmed(bench: FaultBench) -> None:
    bench.walk()
    bench.run_for(3.0)
    warmed = bench.loop.coil_heat.shares
    assert all(1e-5 < share < 0.01 for share in warmed)
    bench.loop.disarm()
    bench.run_for(1.0)
    after = bench.loop.coil_heat.shares
    bench.run_for(5.0)
    assert all(late < early for late, early in zip(bench.loop.coil_heat.shares, after, strict=True))


def test_an_hour_of_sleep_cools_the_coils_however_much_they_carried_before_it(bench: FaultBench) -> None:
    bench.walk()
    bench.loop.coil_heat = CoilHeat((0.5, 0.5, 0.5))
    bench.loop.tick(None, bench.now + 3600.0)
    constants = bench.loop.parts.thermal.time_constants
    assert bench.loop.coil_heat.shares == pytest.approx(
        [0.5 * math.exp(-3600.0 / t) for t in constants], abs=5e-3
    )


def test_a_run_from_the_command_line_is_not_kept_from_walking_by_a_warning() -> None:
    """Warm coils are told of; they are no reason to say that the rig is not ready."""
    machine = build_machine(RigFile(), realtime=False)
    machine.loop.coil_heat = CoilHeat((0.9, 0.9, 0.9))
    told: set[str] = set()
    watch = lambda snapshot: told.update(fault.code for fault in snapshot.faults)  # noqa: E731
    done = run_headless(machine, "a run", RunRequest(EIGHT, duration=1.0), watch)
    assert done.ended.state is RunState.FINISHED
    assert "heat" in told


def test_a_run_from_the_command_line_says_what_keeps_the_rig_from_walking() -> None:
    machine = build_machine(RigFile(), realtime=False)
    machine.loop.coil_heat = CoilHeat((1.1, 0.9, 0.9))
    with pytest.raises(Refused, match="the rig is not ready: coil x is at 110% of the heat"):
        run_headless(machine, "a run", RunRequest(EIGHT, duration=1.0))


# Currents ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("fault", "parameters", "code", "words"),
    [
        ("coil_open", {"coil": "y"}, "coil", "coil y shows no current: check its leads"),
        ("sense_dead", {"coil": "x"}, "coil", "coil x shows no current"),
        ("supply_off", {}, "supply", "switch it on"),
    ],
)
def test_a_current_that_is_missing_disarms_and_names_its_cause(bench, fault, parameters, code, words) -> None:
    bench.walk()
    bench.inject(fault, **parameters)
    snapshot = bench.until(lambda snapshot: snapshot.rig is not RigState.RUNNING, within=6.0)
    assert snapshot.rig is RigState.DISARMED
    assert code in codes(bench)
    assert words in snapshot.reason
    expect_no_current(bench)


# The sense of turning ----------------------------------------------------------------------------


@pytest.mark.parametrize(("fault", "parameters"), [
    ("coil_swapped", {"coil": "x"}), ("coil_swapped", {"coil": "y"}), ("camera_mirrored", {}),
])  # fmt: skip
@pytest.mark.parametrize("heading_deg", [0.0, 30.0, -60.0])
def test_a_robot_that_turns_against_its_command_is_disarmed(bench, fault, parameters, heading_deg) -> None:
    """A coil with swapped leads or a mirrored picture: the robot moves away from its command, and is let go."""
    put(bench, 0.0, 0.0, math.radians(heading_deg))
    bench.inject(fault, **parameters)
    bench.run_for(1.0)
    bench.until(lambda snapshot: snapshot.tracking is Tracking.LOCKED)
    bench.loop.arm(GAIT)
    bench.run_for(0.6)
    if bench.loop.state is RigState.ARMED:
        bench.loop.start("a run", RunRequest(EIGHT))
    snapshot = bench.until(lambda s: s.rig not in (RigState.ARMED, RigState.RUNNING), within=3.0)
    assert snapshot.rig is RigState.DISARMED, snapshot.reason
    assert "sign" in codes(bench)
    assert "turns against the field" in snapshot.reason
    expect_no_current(bench)


# Clocks ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("gap", "code"), [(0.4, "stall"), (3.0, "clock")])
def test_a_gap_in_time_holds_and_the_operator_goes_on(bench: FaultBench, gap: float, code: str) -> None:
    bench.walk()
    bench.world.advance_to(bench.world.now + gap)
    snapshot = bench.until(lambda snapshot: snapshot.rig is not RigState.RUNNING, within=0.1)
    assert snapshot.rig is RigState.HELD
    assert code in codes(bench)
    expect_no_current(bench)
    bench.run_for(0.5)
    bench.loop.resume()
    assert bench.run_for(0.5).rig is RigState.RUNNING


@pytest.mark.parametrize("now", [math.nan, math.inf, -math.inf])
def test_a_time_that_is_none_holds_and_is_forgotten(bench: FaultBench, now: float) -> None:
    bench.walk()
    snapshot = bench.loop.tick(None, now)
    assert snapshot.rig is RigState.HELD
    assert math.isfinite(snapshot.time)
    expect_no_current(bench)


# Nonsense at the seams ---------------------------------------------------------------------------


def test_a_picture_of_another_size_is_refused_and_disarms(bench: FaultBench) -> None:
    bench.walk()
    bench.inject("camera_cropped")
    snapshot = bench.until(lambda snapshot: snapshot.rig is not RigState.RUNNING, within=0.2)
    assert snapshot.rig is RigState.DISARMED
    assert "(240, 320, 3)" in snapshot.reason
    assert snapshot.refusals.frames >= 1
    expect_no_current(bench)
    with pytest.raises(Refused, match="is it this rig's camera"):
        bench.loop.arm(GAIT)


@pytest.mark.parametrize("image", [
    np.zeros((480, 640), np.uint8), np.zeros((480, 640, 4), np.uint8), np.zeros((480, 640, 3), np.float32),
    np.zeros((0, 0, 3), np.uint8), np.zeros((640, 480, 3), np.uint8),
])  # fmt: skip
def test_what_is_no_picture_of_this_camera_is_never_looked_at(bench: FaultBench, image) -> None:
    seen = bench.snapshot.observation
    snapshot = bench.loop.tick(Frame(image, bench.now, 99), bench.now)
    assert snapshot.refusals.frames == 1
    assert snapshot.observation is seen
    assert "frame" in [fault.code for fault in snapshot.faults]


def test_a_picture_without_a_time_is_refused_and_only_the_next_good_one_counts(bench: FaultBench) -> None:
    bench.walk()
    bench.inject("camera_timeless")
    snapshot = bench.until(lambda snapshot: snapshot.rig is not RigState.RUNNING, within=0.3)
    assert snapshot.rig is RigState.HELD
    assert snapshot.reason.startswith("no frame for")
    assert snapshot.refusals.frames >= 5


def test_a_sighting_that_is_no_number_is_refused_and_counted(bench: FaultBench) -> None:
    bench.walk()
    bench.inject("sighting_nan")
    snapshot = bench.until(lambda snapshot: snapshot.rig is not RigState.RUNNING, within=0.5)
    assert snapshot.rig is RigState.HELD
    assert snapshot.refusals.sightings >= 5
    assert snapshot.observation is not None
    assert snapshot.observation.measurement is None


def test_a_report_that_is_no_number_is_refused_and_counted(bench: FaultBench) -> None:
    bench.walk()
    bench.inject("report_nan")
    snapshot = bench.until(lambda snapshot: snapshot.rig is not RigState.RUNNING, within=0.5)
    assert snapshot.rig is RigState.DISARMED
    assert "no word from the board" in snapshot.reason
    assert snapshot.refusals.reports >= 5
    assert all(math.isfinite(share) for share in snapshot.coil_heat)
    expect_no_current(bench)


# Limits ------------------------------------------------------------------------------------------


def test_a_field_that_needs_too_much_is_scaled_back_and_says_why(bench: FaultBench) -> None:
    put(bench, 0.0, 0.0, EAST)
    bench.loop.arm(Gait(field=0.015, tilt=math.radians(20.0)))
    snapshot = bench.run_for(1.0)
    assert snapshot.limited_by == "current of coil y"
    assert snapshot.command.field < 0.011
    assert max(map(abs, bench.world.currents)) <= 8.0 * 1.01
    bench.loop.disarm()
    assert bench.tick().limited_by == ""


# Warnings and consent ----------------------------------------------------------------------------


class Walled(SlipPlant):
    """A robot that a wall keeps from following the field any further round."""

    wall = math.inf

    def step(self, field, dt) -> None:
        bx, by, bz = field
        if math.atan2(-bx, by) > self.wall:
            level = math.hypot(bx, by)
            bx, by = -level * math.sin(self.wall), level * math.cos(self.wall)
        super().step((bx, by, bz), dt)


def test_a_robot_that_sticks_is_told_of_and_walking_goes_on(bench: FaultBench) -> None:
    plant = bench.world.plant = Walled(SLIP_TABLE, 0.010, bench.world.body().pose, seed=3)
    put(bench, 0.0, 0.0, EAST)
    bench.arm()
    slowly = Choice("straight", {"rate_deg_s": 30.0})
    bench.loop.start("a run", RunRequest(Selection(slowly, Choice("eight"), GAIT)))
    headings = []
    for _ in range(200):
        bench.tick()
        headings.append(bench.loop.field_at(bench.now)[0])
    plant.wall = max(headings) - math.radians(5.0)
    bench.until(lambda snapshot: "stuck" in [fault.code for fault in snapshot.faults], within=10.0)
    bench.run_for(1.0)
    assert bench.snapshot.rig is RigState.RUNNING, bench.snapshot.reason
    told = [event for event in bench.trace.events if event.code == "stuck"]
    assert [event.severity for event in told] == ["warn"]
    assert "sign" not in codes(bench)


def test_a_decision_cannot_leave_the_limits(bench: FaultBench) -> None:
    """Whatever rate a law asks for, the gait's own limit is what is driven."""
    assert Decision(PIVOT_A, 1e9).rate == 1e9
    bench.walk()
    assert abs(bench.snapshot.command.rate) <= GAIT.max_rate

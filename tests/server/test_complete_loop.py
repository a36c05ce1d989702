"""The whole program on the simulated rig, headless: real pixels, real bytes, every state."""

import math
from collections.abc import Callable, Iterator

import pytest

from control.controllers import Decision, Situation, controllers
from control.gait import Gait
from control.model import Frame, Pose, Tracking
from control.registry import Parameters
from control.runs import Choice, RunRequest, RunState, Selection
from control.safety import Refused
from control.simulation.board import TwinBoard
from control.simulation.world import World
from control.snapshot import RigState, Snapshot
from control.trajectories import Circle, OutsideWorkspace, trajectories
from server.assembly import Machine, build_machine
from server.settings import RigFile
from vision.simulated.camera import Disturbance, SyntheticCamera

GAIT = Gait(sweep=math.radians(10.0), tilt=math.radians(25.0))
EIGHT = Selection(Choice("geometric"), Choice("eight"), GAIT)
FULL_CURRENT = 8.0
CURRENT_GONE = 0.05 * FULL_CURRENT
"""faults.md I2: current under 5 % of its limit after three times the coil's L/R."""


class Bench:
    """A machine that is stepped by hand, with the truth beside it."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.loop = machine.loop
        self.ended: list[RunState] = []
        machine.open()
        self.snapshot = self.tick()

    @property
    def disturbance(self) -> Disturbance:
        assert isinstance(self.machine.camera, SyntheticCamera)
        return self.machine.camera.disturbance

    @property
    def world(self) -> World:
        assert self.machine.world is not None
        return self.machine.world

    @property
    def board(self) -> TwinBoard:
        assert isinstance(self.world.board, TwinBoard)
        return self.world.board

    def tick(self) -> Snapshot:
        frame = self.machine.camera.read(0.05)
        self.snapshot = self.loop.tick(frame, self.machine.camera.now())
        self.ended += [ended.state for ended in self.loop.take_ended()]
        return self.snapshot

    def run_for(self, duration: float) -> Snapshot:
        until = self.machine.camera.now() + duration
        while self.machine.camera.now() < until:
            self.tick()
        return self.snapshot

    def until(self, condition: Callable[[Snapshot], bool], within: float = 3.0) -> Snapshot:
        give_up = self.machine.camera.now() + within
        while not condition(self.tick()):
            assert self.machine.camera.now() < give_up, f"still {self.snapshot.rig}: {self.snapshot.reason}"
        return self.snapshot

    def arm(self) -> None:
        self.until(lambda snapshot: not snapshot.faults and snapshot.tracking is Tracking.LOCKED)
        self.loop.arm(GAIT)

    def walk(self, request: RunRequest | None = None) -> None:
        self.arm()
        self.loop.start("a run", request or RunRequest(EIGHT))
        self.run_for(2.0)
        assert self.snapshot.rig is RigState.RUNNING

    @property
    def largest_current(self) -> float:
        return max(abs(current) for current in self.world.currents)

    def expect_no_current(self) -> None:
        """Drive at zero now, current gone after three time constants of the slowest coil (50 ms)."""
        self.run_for(0.15)
        assert self.board.drive_is_zero
        assert self.largest_current < CURRENT_GONE


@pytest.fixture
def bench() -> Iterator[Bench]:
    machine = build_machine(RigFile().with_simulation(seed=3), realtime=False)
    yield Bench(machine)
    machine.close()


def test_arming_brings_the_field_up_without_turning_the_robot(bench: Bench) -> None:
    bench.run_for(0.5)
    before = bench.world.body().pose
    bench.arm()
    bench.run_for(0.15)
    assert 1.0 < 1e3 * math.hypot(*bench.world.field) < 9.0, "on its way up"
    bench.run_for(0.5)
    after = bench.world.body().pose
    assert 1e3 * math.hypot(*bench.world.field) == pytest.approx(10.0, rel=0.03)
    assert abs(math.degrees(after.heading - before.heading)) < 1.0
    assert after.distance_to(before.x, before.y) < 2e-4


def test_a_rig_that_does_not_see_its_robot_does_not_arm(bench: Bench) -> None:
    bench.disturbance.hidden = True
    bench.run_for(0.5)
    with pytest.raises(Refused, match="not seen"):
        bench.loop.arm(GAIT)
    assert bench.snapshot.rig is RigState.DISARMED
    assert bench.board.drive_is_zero


def test_a_run_needs_an_armed_rig(bench: Bench) -> None:
    bench.run_for(0.5)
    with pytest.raises(Refused, match="cannot start while the rig is disarmed: arm it first"):
        bench.loop.start("a run", RunRequest(EIGHT))


def test_a_path_outside_the_workspace_changes_nothing(bench: Bench) -> None:
    bench.arm()
    far = Selection(Choice("geometric"), Choice("circle", {"radius_mm": 70.0}), GAIT)
    with pytest.raises(OutsideWorkspace):
        bench.loop.start("a run", RunRequest(far))
    assert bench.tick().rig is RigState.ARMED


def test_every_current_stays_within_its_limit_all_the_way(bench: Bench) -> None:
    bench.walk()
    worst = 0.0
    for _ in range(600):
        bench.tick()
        worst = max(worst, bench.largest_current)
    assert 5.0 < worst <= FULL_CURRENT


def test_the_run_ends_after_its_passes_and_the_rig_stays_armed(bench: Bench) -> None:
    circle = Selection(Choice("geometric"), Choice("circle", {"radius_mm": 5.0, "speed_mm_s": 10.0}), GAIT)
    bench.arm()
    bench.loop.start("a run", RunRequest(circle, passes=0.5))
    bench.until(lambda snapshot: snapshot.rig is RigState.ARMED, within=5.0)
    assert bench.ended == [RunState.FINISHED]


@pytest.mark.parametrize("fault", ["hidden", "frozen", "unplugged"])
def test_a_blind_rig_holds_and_goes_on_only_when_told(bench: Bench, fault: str) -> None:
    bench.walk()
    setattr(bench.disturbance, fault, True)
    began = bench.machine.camera.now()
    bench.until(lambda snapshot: snapshot.rig is RigState.HELD, within=0.5)
    assert bench.machine.camera.now() - began <= 0.30
    bench.expect_no_current()
    with pytest.raises(Refused):
        bench.loop.resume()
    setattr(bench.disturbance, fault, False)
    bench.until(lambda snapshot: not snapshot.faults and snapshot.tracking is Tracking.LOCKED)
    assert bench.run_for(0.5).rig is RigState.HELD
    bench.expect_no_current()
    bench.loop.resume()
    bench.run_for(1.0)
    assert bench.snapshot.rig is RigState.RUNNING
    assert bench.ended == []


def test_the_robot_found_elsewhere_after_a_teleport_is_not_followed_while_driven(bench: Bench) -> None:
    bench.walk()
    there = Pose(0.03, 0.03, 0.0)
    bench.world.nudge(there)
    bench.until(lambda snapshot: snapshot.rig is RigState.HELD, within=0.5)
    bench.expect_no_current()


def test_the_emergency_stop_latches_and_two_acts_lead_back(bench: Bench) -> None:
    bench.walk()
    bench.loop.estop()
    bench.tick()
    assert bench.snapshot.rig is RigState.FAULT
    assert bench.ended == [RunState.ABORTED]
    bench.expect_no_current()
    for forbidden in (lambda: bench.loop.arm(GAIT), bench.loop.resume):
        with pytest.raises(Refused, match="reset it first"):
            forbidden()
    bench.loop.reset()
    assert bench.tick().rig is RigState.DISARMED
    bench.expect_no_current()
    bench.loop.arm(GAIT)
    assert bench.run_for(0.5).rig is RigState.ARMED


def test_the_robot_stays_in_sight_while_the_field_collapses(bench: Bench) -> None:
    bench.walk()
    bench.loop.estop()
    for _ in range(60):
        assert bench.tick().tracking is not Tracking.LOST
    assert bench.snapshot.faults[0].code == "estop"


def test_a_pause_holds_and_the_reference_waits(bench: Bench) -> None:
    bench.walk()
    bench.loop.pause()
    bench.tick()
    assert bench.snapshot.run is not None
    before = bench.snapshot.run.passes_done
    bench.run_for(1.0)
    bench.expect_no_current()
    assert bench.snapshot.rig is RigState.HELD
    assert bench.snapshot.run.passes_done == before
    bench.loop.resume()
    bench.run_for(0.5)
    assert bench.snapshot.rig is RigState.RUNNING


def test_a_board_that_is_unplugged_disarms_and_comes_back_disarmed(bench: Bench) -> None:
    bench.walk()
    bench.board.unplug()
    bench.until(lambda snapshot: snapshot.rig is RigState.DISARMED, within=0.5)
    assert bench.ended == [RunState.ABORTED]
    bench.board.plug()
    bench.until(lambda snapshot: snapshot.link.state == "ready", within=10.0)
    assert bench.run_for(0.5).rig is RigState.DISARMED
    assert bench.board.drive_is_zero


def test_a_supply_that_dips_disarms_and_the_rig_arms_again_once_it_is_back(bench: Bench) -> None:
    bench.walk()
    bench.board.supply = 12.0
    snapshot = bench.until(lambda snapshot: snapshot.rig is not RigState.RUNNING, within=0.5)
    assert snapshot.rig is RigState.DISARMED
    assert "supply" in snapshot.reason
    bench.expect_no_current()
    with pytest.raises(Refused, match="supply"):
        bench.loop.arm(GAIT)
    bench.board.supply = 24.0
    bench.arm()
    assert bench.run_for(0.5).rig is RigState.ARMED


@pytest.mark.parametrize("tilt_deg", [10.0, 20.0, 35.0, 45.0])
def test_the_rig_arms_at_every_tilt_and_keeps_the_robot(bench: Bench, tilt_deg: float) -> None:
    bench.run_for(0.5)
    bench.loop.arm(Gait(tilt=math.radians(tilt_deg)))
    for _ in range(60):
        assert bench.tick().rig is RigState.ARMED, bench.snapshot.reason


def test_a_hold_stays_a_hold_while_the_currents_decay(bench: Bench) -> None:
    bench.walk()
    bench.disturbance.hidden = True
    bench.until(lambda snapshot: snapshot.rig is RigState.HELD, within=0.5)
    bench.run_for(1.0)
    assert bench.snapshot.rig is RigState.HELD
    assert bench.ended == []


def test_a_board_that_restarts_latches_and_says_so(bench: Bench) -> None:
    bench.walk()
    bench.board.reset()
    snapshot = bench.until(lambda snapshot: snapshot.rig is RigState.FAULT, within=0.5)
    assert "reset" in snapshot.reason
    bench.expect_no_current()


def test_a_frame_from_before_the_last_one_is_not_looked_at(bench: Bench) -> None:
    bench.arm()
    bench.run_for(0.3)
    newest = bench.machine.camera.read(0.05)
    assert newest is not None
    before = bench.snapshot.pose
    assert before is not None
    older = Frame(newest.image, newest.captured_at - 0.1, newest.index)
    snapshot = bench.loop.tick(older, bench.machine.camera.now())
    assert snapshot.pose is not None
    assert snapshot.pose.distance_to(before.x, before.y) < 1e-3


def test_a_gait_beyond_the_rigs_limits_is_refused_in_the_labs_units(bench: Bench) -> None:
    bench.run_for(0.5)
    with pytest.raises(Refused, match="field of 16 mT is beyond this rig's 15 mT"):
        bench.loop.arm(Gait(field=0.016))
    with pytest.raises(Refused, match="400 degrees/s is beyond this rig's 360 degrees/s"):
        bench.loop.arm(Gait(max_rate=math.radians(400.0)))


def test_a_loop_that_stands_still_is_held(bench: Bench) -> None:
    bench.walk()
    bench.world.advance_to(bench.world.now + 0.3)
    bench.tick()
    assert bench.snapshot.rig is not RigState.RUNNING
    bench.expect_no_current()


class Broken:
    """A controller that fails after a while."""

    name = "broken after a second"
    title = summary = "fails"
    Parameters = Parameters

    def __init__(self, _: Parameters) -> None:
        self._left = 60

    def step(self, situation: Situation) -> Decision:
        self._left -= 1
        return Decision(situation.pivot, 0.5 if self._left > 0 else math.nan)


def test_a_controller_that_returns_nonsense_latches_with_zero_current(bench: Bench) -> None:
    if Broken.name not in controllers:
        controllers.register(Broken)
    bench.arm()
    bench.loop.start("a run", RunRequest(Selection(Choice(Broken.name), Choice("eight"), GAIT)))
    snapshot = bench.until(lambda snapshot: snapshot.rig is RigState.FAULT, within=4.0)
    assert "broken after a second" in snapshot.reason
    bench.expect_no_current()


class Cracked(Circle):
    """A path that fails half-way."""

    name = "cracked"

    def point(self, time: float) -> tuple[float, float]:
        if time > 1.0 and self.is_walked:
            raise ZeroDivisionError("cracked")
        return super().point(time)

    is_walked = False


def test_a_path_that_raises_latches_with_zero_current(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    if Cracked.name not in trajectories:
        trajectories.register(Cracked)
    bench.arm()
    bench.loop.start("a run", RunRequest(Selection(Choice("geometric"), Choice(Cracked.name), GAIT)))
    monkeypatch.setattr(Cracked, "is_walked", True)
    snapshot = bench.until(lambda snapshot: snapshot.rig is RigState.FAULT, within=4.0)
    assert "cracked" in snapshot.reason
    bench.expect_no_current()


def test_parameters_change_while_the_robot_walks(bench: Bench) -> None:
    bench.walk()
    slow = Gait(sweep=math.radians(20.0), tilt=math.radians(25.0), max_rate=0.2)
    bench.loop.change(Selection(Choice("geometric", {"gain": 1.0}), Choice("eight"), slow))
    bench.run_for(0.5)
    assert abs(bench.snapshot.command.rate) <= 0.2
    assert bench.snapshot.rig is RigState.RUNNING

"""The compiled walks of a batch against the plain loop, run by run, and each run by itself."""

import ast
import inspect
import math
import random
import subprocess
import sys
import threading
from dataclasses import asdict, replace
from pathlib import Path
from types import ModuleType

import pytest
from batch_runs import BOTTOM, planned
from hypothesis import given, settings
from hypothesis import strategies as st

from control.gait import Gait, TimeLaw
from control.metrics import Metrics
from control.model import Pose
from control.runs import Choice
from control.simulation.plants import PlantChoice
from control.studies.batch import Failed, RunFailed, plain_walk, simulate
from control.studies.batch.compiled import prepared
from control.studies.batch.courses import Courses, Wanted
from control.studies.batch.kernel import LOCK, alone_in, walk_compiled
from control.studies.batch.laws import FORMULAS, LAWS, MODULES, OWN, fingerprint
from control.studies.plan import PlannedRun
from control.studies.settings import Setup

SAME = 1e-9
"""m and s: an atom's width. Where compiler and interpreter share their sines, as here, the runs are equal."""

laws = st.one_of(
    st.floats(0.5, 20.0).map(lambda gain: Choice("geometric", {"gain": gain})),
    st.floats(0.3, 1.5).map(lambda ahead: Choice("gradient", {"look_ahead_s": ahead})),
    st.just(Choice("gradient")),
)
robots = st.one_of(
    st.just(PlantChoice("noslip")),
    st.builds(
        lambda slip, scatter, play: PlantChoice(
            "slip", {"slip_scale": slip, "scatter_scale": scatter, "play_scale": play}
        ),
        *(st.floats(0.0, 2.0),) * 3,
    ),
)
gaits = st.builds(
    Gait,
    sweep=st.floats(math.radians(8.0), math.radians(90.0)),
    tilt=st.floats(math.radians(5.0), math.radians(40.0)),
    max_rate=st.floats(0.5, 3.0),
    path_step=st.floats(0.02, 0.4),
    time_law=st.sampled_from([TimeLaw.PATH_STEP, TimeLaw.CONSTANT_SPEED, TimeLaw.TRAPEZOIDAL]),
)
places = st.one_of(st.just(0), st.floats(-0.02, 0.02))
starts = st.builds(Pose, places, st.floats(-0.05, -0.03), st.floats(-10.0, 10.0))
ROUND = Choice("circle", {"radius_mm": 5.0})
paths = st.sampled_from([Choice("eight"), Choice("polygon"), ROUND])


@given(
    law=laws,
    robot=robots,
    gait=gaits,
    path=paths,
    start=starts,
    seed=st.integers(0, 2**53),
    length=st.floats(0.004, 0.02),
    ramp=st.floats(0.005, 0.2),
)
@settings(deadline=None, max_examples=20, derandomize=True)
def test_a_compiled_walk_is_the_plain_walk(
    law: Choice,
    robot: PlantChoice,
    gait: Gait,
    path: Choice,
    start: Pose,
    seed: int,
    length: float,
    ramp: float,
) -> None:
    setup = Setup(length, 0.06, ramp)
    run = planned(law, robot, gait, path, start=start, seed=seed, setup=setup, duration=3.0)
    assert prepared(run) is not None
    assert_same(simulate([run])[0], walked_plainly(run))


def walked_plainly(run: PlannedRun) -> Metrics | Failed:
    try:
        return plain_walk(run)
    except RunFailed as failed:
        return Failed(str(failed))


def assert_same(outcome: Metrics | Failed, expected: Metrics | Failed) -> None:
    if isinstance(expected, Failed):
        assert outcome == expected
        return
    assert isinstance(outcome, Metrics)
    assert (outcome.steps, outcome.sweeps, outcome.reversals) == (
        expected.steps,
        expected.sweeps,
        expected.reversals,
    )
    assert asdict(outcome) == pytest.approx(asdict(expected), abs=SAME)


@pytest.mark.parametrize("controller", ["geometric", "gradient"])
@pytest.mark.parametrize("plant", ["slip", "noslip"])
def test_they_agree_to_the_end_of_a_whole_eight(controller: str, plant: str, full: bool) -> None:
    gait = Gait(path_step=0.1 if full else 0.3)
    run = planned(controller, plant, gait, duration=None)
    assert_same(simulate([run])[0], plain_walk(run))


def mixed_runs() -> list[PlannedRun]:
    tilts = [math.radians(tilt) for tilt in (20.0, 25.0, 30.0)]
    return [
        planned(controller, plant, Gait(tilt=tilt), seed=seed)
        for controller in ("geometric", "gradient")
        for plant in ("slip", "noslip")
        for tilt in tilts
        for seed in (1, 2)
    ]


def test_a_run_does_not_depend_on_its_company() -> None:
    runs = mixed_runs()
    alone = [simulate([run])[0] for run in runs]
    order = list(range(len(runs)))
    random.Random(3).shuffle(order)
    together = simulate([runs[index] for index in order])
    assert [together[order.index(index)] for index in range(len(runs))] == alone


def test_another_seed_is_another_walk_on_the_slip_plant_alone() -> None:
    slip, noslip = (
        simulate([planned(plant=plant, seed=seed) for seed in (1, 2)]) for plant in ("slip", "noslip")
    )
    assert slip[0] != slip[1]
    assert noslip[0] == noslip[1]


def test_a_robot_that_leaves_the_plate_fails_in_the_same_words() -> None:
    run = planned(gait=Gait(path_step=0.3), duration=None, setup=Setup(workspace=0.031))
    run = replace(run, start=Pose(0.0, -0.025, 0.0))
    outcome = simulate([run])[0]
    assert isinstance(outcome, Failed)
    assert outcome == walked_plainly(run)
    assert "±31 mm" in outcome.reason


def test_more_random_numbers_are_drawn_for_a_robot_that_rocks_on_the_spot() -> None:
    run = planned(
        "geometric", gait=Gait(path_step=0.01, sweep=math.radians(15.0)), trajectory=ROUND, duration=40.0
    )
    gained = replace(run.selection, controller=Choice("geometric", {"gain": 40.0}))
    run = replace(run, selection=gained, start=Pose(0.01, 0.0, 0.0))
    assert_same(simulate([run])[0], plain_walk(run))


@pytest.mark.parametrize(
    "other",
    [
        planned("planner"),
        planned(Choice("gradient", {"heading": "along"})),
        planned(gait=Gait(time_law=TimeLaw.WAIT)),
        planned(gait=Gait(approach=True)),
        planned(gait=Gait(tilt=math.radians(1.5))),
        planned(gait=Gait(field=0.0004)),
    ],
    ids=["planner", "heading", "wait", "approach", "hardly tilted", "hardly a field"],
)
def test_what_the_kernel_cannot_do_goes_through_the_plain_loop(other: PlannedRun) -> None:
    assert prepared(other) is None
    assert simulate([other]) == [plain_walk(other)]


def test_one_run_that_cannot_be_walked_does_not_take_the_others_along() -> None:
    wrong = planned(Choice("geometric", {"gain": -1.0}))
    outcomes = simulate([planned(), wrong, planned()])
    assert outcomes[0] == outcomes[2]
    assert isinstance(outcomes[0], Metrics)
    assert isinstance(outcomes[1], Failed)
    assert "gain" in outcomes[1].reason


def test_courses_are_shared_and_their_number_of_ticks_is_bounded() -> None:
    courses = Courses(most_ticks=1000)
    wanted = [Wanted(planned(gait=Gait(path_step=0.1 * k)).selection, 1.0, 6.0, None) for k in (1, 2, 3)]
    first = courses.get(wanted[0])
    assert courses.get(replace(wanted[0])) is first
    for each in wanted[1:]:
        courses.get(each)
    assert courses.ticks <= 1000
    assert courses.get(wanted[0]) is not first


def test_courses_may_be_asked_for_by_many_threads_at_once() -> None:
    courses, mistakes = Courses(most_ticks=300), list[Exception]()
    wanted = [Wanted(planned(gait=Gait(path_step=0.1 * k)).selection, 1.0, 1.0, None) for k in range(1, 12)]

    def ask(stride: int) -> None:
        try:
            for k in range(100):
                courses.get(wanted[k * stride % 11])
        except (RuntimeError, KeyError) as error:
            mistakes.append(error)

    threads = [threading.Thread(target=ask, args=(stride,)) for stride in (1, 2, 3, 5)]
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(before)
    assert not mistakes


def test_a_kept_kernel_is_known_by_the_laws_that_it_was_made_of() -> None:
    assert fingerprint() == LAWS
    closure = walk_compiled.py_func.__closure__
    assert closure is not None
    assert [cell.cell_contents for cell in closure] == [LAWS]


def test_the_laws_include_every_module_that_a_formula_takes_a_figure_from() -> None:
    known = {name for module in MODULES for name in set(vars(module)) - imported_by(module)}
    for formula in (*FORMULAS, *OWN):
        used = {name for name in formula.__code__.co_names if name in formula.__globals__}
        foreign = used - known - LIBRARIES
        assert not foreign, f"{formula.__name__} rests on {foreign}"


LIBRARIES = {"math", "np"}


def imported_by(module: ModuleType) -> set[str]:
    imports = [
        node for node in ast.walk(ast.parse(inspect.getsource(module))) if isinstance(node, ast.ImportFrom)
    ]
    return {alias.name for node in imports for alias in node.names}


def test_of_several_that_begin_at_once_one_compiles_and_the_others_wait(tmp_path: Path) -> None:
    entered = threading.Event()

    def come_second() -> None:
        with alone_in(str(tmp_path)):
            entered.set()

    second = threading.Thread(target=come_second)
    with alone_in(str(tmp_path)):
        second.start()
        assert not entered.wait(0.05)
    second.join()
    assert entered.is_set()


def test_nobody_waits_where_nothing_can_be_locked(tmp_path: Path) -> None:
    (tmp_path / LOCK).mkdir()
    for folder in (None, str(tmp_path), str(tmp_path / "gone")):
        with alone_in(folder), alone_in(folder):
            pass


def test_the_compiler_is_not_loaded_before_a_run_needs_it() -> None:
    program = "import sys; import control.studies.batch; print({'numba', 'mujoco'} & set(sys.modules))"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "set()"


def test_the_robot_starts_where_the_plan_says_or_at_the_beginning_of_its_path() -> None:
    steps = []
    plain_walk(planned(duration=0.1), steps.append)
    assert (steps[0].pose.x, steps[0].pose.y) == (BOTTOM.x, BOTTOM.y)
    steps.clear()
    plain_walk(planned(duration=0.1, start=None), steps.append)
    assert steps[0].pose.distance_to(BOTTOM.x, BOTTOM.y) < SAME
    assert abs(steps[0].pose.heading) == pytest.approx(math.pi, abs=1e-3)

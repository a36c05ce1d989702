"""What the soak holds the rig to: each of its rules lets pass what is right and notices what is not."""

from __future__ import annotations

from itertools import islice
from typing import Any

import pytest

from control.simulation.faults.injection import KINDS
from server.settings import RigFile
from tests.faults.fault_bench import electrics_in
from tests.faults.invariants import LONGEST_PERIOD
from tests.soak.growth import Growth, Look, growth_of
from tests.soak.live_rules import LiveRules
from tests.soak.process import Belongings, Memory
from tests.soak.reactions import Reactions
from tests.soak.recordings import Pace, Rest
from tests.soak.report import broken_words
from tests.soak.schedule import PER_ROUND, What, acts
from tests.soak.soak import Outcome, Plan, check_left

ROUND = len(KINDS) + sum(PER_ROUND.values())
ZERO = [0.0, 0.0, 0.0]
SOME = [3.0, 0.0, 0.0]


def tick(
    rig: str, time: float, measured: list[float] = ZERO, commanded: list[float] | None = None
) -> dict[str, Any]:
    currents = measured if commanded is None else commanded
    return {
        "rig": rig,
        "reason": "as told",
        "time_s": time,
        "currents_A": currents,
        "measured_currents_A": measured,
        "link": {"state": "ready"},
    }


@pytest.fixture
def rules() -> LiveRules:
    return LiveRules(electrics_in(RigFile()))


def test_a_seed_gives_the_same_schedule_again_and_another_one_another() -> None:
    first, again, other = (list(islice(acts(seed), 200)) for seed in (4, 4, 5))
    assert first == again
    assert first != other


def test_each_fault_and_each_act_comes_in_every_round() -> None:
    schedule = acts(1)
    for _ in range(3):
        one_round = list(islice(schedule, ROUND))
        single = [act.faults[0].name for act in one_round if act.what is What.FAULT]
        assert sorted(single) == sorted(KINDS)
        assert {act.what for act in one_round} == set(What)


def test_a_rig_that_rests_without_current_and_walks_when_asked_is_as_it_should_be(rules: LiveRules) -> None:
    rules.tick(tick("running", 10.0, SOME), arrived=110.0, asked=105.0)
    rules.tick(tick("held", 10.1, SOME), arrived=110.1, asked=105.0)
    rules.tick(tick("held", 12.0), arrived=112.0, asked=105.0)
    rules.tick(tick("running", 13.0, SOME), arrived=113.0, asked=112.5)


def test_current_in_a_rig_at_rest_is_noticed(rules: LiveRules) -> None:
    rules.tick(tick("disarmed", 10.0), arrived=110.0, asked=105.0)
    with pytest.raises(AssertionError, match="I3"):
        rules.tick(tick("disarmed", 12.0, SOME), arrived=112.0, asked=105.0)


def test_a_command_in_a_rig_at_rest_is_noticed_also_where_no_current_flows(rules: LiveRules) -> None:
    rules.tick(tick("held", 10.0), arrived=110.0, asked=105.0)
    with pytest.raises(AssertionError, match=r"I3.*commanded"):
        rules.tick(tick("held", 12.0, ZERO, SOME), arrived=112.0, asked=105.0)


@pytest.mark.parametrize("rig", ["armed", "running"])
def test_a_rig_that_goes_on_without_being_asked_is_noticed(rules: LiveRules, rig: str) -> None:
    rules.tick(tick("held", 10.0), arrived=110.0, asked=105.0)
    with pytest.raises(AssertionError, match=r"I3.*without being asked"):
        rules.tick(tick(rig, 12.0), arrived=112.0, asked=105.0)


def test_too_much_current_is_noticed(rules: LiveRules) -> None:
    limit = RigFile().limits.current_A[0]
    rules.tick(tick("running", 10.0, [limit, 0.0, 0.0]), arrived=110.0, asked=105.0)
    with pytest.raises(AssertionError, match="I1"):
        rules.tick(tick("running", 10.1, [1.02 * limit, 0.0, 0.0]), arrived=110.1, asked=105.0)


def test_a_board_that_measures_wrong_says_nothing_of_the_current(rules: LiveRules) -> None:
    rules.begin(frozenset({"sense_wrong"}))
    rules.tick(tick("running", 10.0, [20.0, 0.0, 0.0], SOME), arrived=110.0, asked=105.0)
    rules.end()
    with pytest.raises(AssertionError, match="I1"):
        rules.tick(tick("running", 11.0, [20.0, 0.0, 0.0], SOME), arrived=111.0, asked=105.0)


def test_a_line_of_the_log_that_comes_late_is_noticed(rules: LiveRules) -> None:
    rules.tick(tick("running", 10.0), arrived=110.0, asked=105.0)
    rules.event({"time_s": 9.1, "code": "lost"})
    with pytest.raises(AssertionError, match="I4"):
        rules.event({"time_s": 8.9, "code": "lost"})


def entry(
    verdict: str, became: str | None = "held", noticed: float = 100.0, gone: float = 250.0
) -> dict[str, Any]:
    promise = {"states": ["held"], "noticed_ms": 104.0, "gone_ms": 255.0}
    reaction = {"verdict": verdict, "became": became, "reason": "", "noticed_ms": noticed, "gone_ms": gone}
    return {"name": "camera_unplugged", "promise": promise, "reaction": reaction}


def test_a_promise_that_is_not_kept_breaks_a_soak_unless_the_machine_was_late_itself() -> None:
    reactions = Reactions()
    assert reactions.judge(entry("kept"), 0.0, is_usual=True) == "kept"
    late = entry("broken", noticed=104.0 + 60.0 + 50.0)
    assert reactions.judge(late, 0.05, is_usual=True) == "starved"
    with pytest.raises(AssertionError, match="camera_unplugged"):
        reactions.judge(late, 0.04, is_usual=True)
    with pytest.raises(AssertionError, match="camera_unplugged"):
        reactions.judge(entry("broken", became=None), 1.0, is_usual=True)
    assert reactions.kinds["camera_unplugged"].noticed_ms == 100.0


def test_a_board_at_rest_may_not_drive_once_it_must_have_heard() -> None:
    rest = Rest()
    assert not rest.forbids(True, 10.0, 9.99)
    assert not rest.forbids(False, 10.1, 10.09)
    assert not rest.forbids(False, 12.0, 10.09), "an old report says nothing"
    assert rest.forbids(False, 12.0, 11.9)


def test_a_loop_that_is_often_late_without_a_fault_is_noticed() -> None:
    pace = Pace()
    pace.add([0.0, 1.0, 1.02, 1.04], except_for=[(0.5, 1.01)])
    pace.check(0.0)
    late = [number * (LONGEST_PERIOD + 0.01) for number in range(10)]
    pace.add(late, except_for=())
    pace.check(starved=0.5)
    with pytest.raises(AssertionError, match="I6"):
        pace.check(starved=0.1)


def looks(growth: float, minutes: int) -> Growth:
    end = 60.0 * minutes
    memory = {at: Memory(round(300e6 * (1.0 + growth * at / end)), 1) for at in range(0, int(end) + 1, 5)}
    return growth_of([Look(at, each) for at, each in memory.items()])


def test_memory_that_grows_is_noticed_and_a_short_soak_judges_none() -> None:
    looks(0.04, 60).check()
    with pytest.raises(AssertionError, match="memory"):
        looks(0.08, 60).check()
    assert not looks(0.5, 1).is_judged
    looks(0.5, 1).check()


def test_what_is_left_behind_is_noticed() -> None:
    check_left(Belongings(20, 30, 0), Belongings(22, 31, 0))
    for left in (Belongings(40, 30, 0), Belongings(20, 60, 0), Belongings(20, 30, 1)):
        with pytest.raises(AssertionError, match="I7"):
            check_left(Belongings(20, 30, 0), left)


def test_whoever_reads_of_a_broken_invariant_can_see_it_again() -> None:
    outcome = Outcome(Plan(600.0, seed=77), act=next(acts(77)), broken="I3: current at rest", broken_at=83.0)
    said = broken_words(outcome)
    assert "I3: current at rest" in said
    assert "01:23" in said
    assert "--seed 77 --load light --minutes 10" in said

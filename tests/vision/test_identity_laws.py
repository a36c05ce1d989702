"""Telling blobs apart: the likeliest way, or none."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st

from vision.tracking.identity import GATE, ODDS, Owner, Question, Verdict

SPAN = 277.0
"""A picture of 640 x 480, px."""
HERE, THERE, FAR = (100.0, 100.0), (140.0, 100.0), (400.0, 300.0)
SIGMA = 5.0

coordinates = st.floats(0.0, 640.0)
places = st.tuples(coordinates, coordinates)
owners = st.builds(Owner, places, st.floats(1.0, 60.0) | st.just(math.inf), st.booleans())


def ask(
    robot: Owner, rivals: list[Owner], blobs: list[tuple[float, float]], unlike: list[float] | None = None
) -> Verdict:
    return Question(robot, rivals, blobs, unlike or [0.0] * len(blobs), SPAN).answer()


def known(place: tuple[float, float], sigma: float = SIGMA, *, in_view: bool = True) -> Owner:
    return Owner(place, sigma, in_view)


def test_a_blob_at_the_robots_place_is_the_robot_and_one_beyond_the_gate_is_not():
    edge = HERE[0] + SIGMA * math.sqrt(GATE)
    assert ask(known(HERE), [], [(edge - 0.1, 100.0)]).robot == 0
    assert ask(known(HERE), [], [(edge + 0.1, 100.0)]) == Verdict(None, (), {})


def test_of_two_the_one_at_the_robots_place_is_taken_when_the_other_is_a_thousand_times_less_likely():
    near, twice = (HERE[0] + 1.0, 100.0), (HERE[0] + 3.6 * SIGMA, 100.0)
    assert set(ask(known(HERE), [], [twice, HERE]).doubtful) == {0, 1}
    assert ask(known(HERE), [known(twice)], [twice, near]).robot == 1


def test_two_alike_of_which_nothing_is_known_are_not_told_apart():
    verdict = ask(Owner((0.0, 0.0), math.inf, in_view=False), [], [HERE, FAR])
    assert verdict.robot is None
    assert set(verdict.doubtful) == {0, 1}


def test_one_blob_of_which_nothing_is_known_is_the_robot():
    assert ask(Owner((0.0, 0.0), math.inf, in_view=False), [], [FAR]).robot == 0


def test_a_rival_in_view_stays_what_it_is_although_the_robot_may_be_anywhere():
    anywhere = Owner(HERE, math.inf, in_view=False)
    assert ask(anywhere, [known(FAR)], [FAR]) == Verdict(None, (), {0: 0})
    assert ask(anywhere, [known(FAR)], [FAR, THERE]) == Verdict(1, (), {0: 0})


def test_a_rival_out_of_sight_owns_no_blob_any_more_once_the_robot_may_be_anywhere():
    """The other one walked off while nobody could tell them apart; what stands here is the robot as likely as not."""
    verdict = ask(Owner(HERE, math.inf, in_view=False), [known(HERE, 15.0, in_view=False)], [HERE, FAR])
    assert verdict.robot is None
    assert set(verdict.doubtful) == {0, 1}


def test_a_rival_that_was_hidden_with_the_robot_may_be_what_comes_out():
    hidden = known(HERE, 20.0, in_view=False), [known(THERE, 20.0, in_view=False)]
    assert ask(*hidden, [(120.0, 100.0)]).doubtful == (0,)
    both = ask(known(HERE, 8.0, in_view=False), [known(THERE, 8.0, in_view=False)], [HERE, THERE])
    assert both == Verdict(0, (), {0: 1})


def test_a_blob_that_does_not_look_like_the_robot_makes_its_neighbour_doubtful():
    """The robot, half covered, and another one beside it, must not become the other one."""
    beside = (HERE[0] + 4.0 * SIGMA, 100.0)
    rivals = [known(beside, 2.0 * SIGMA, in_view=False)]
    verdict = ask(known(HERE, 2.0 * SIGMA, in_view=False), rivals, [HERE, beside], [18.5, 0.0])
    assert verdict.robot is None
    assert set(verdict.doubtful) == {0, 1}


@given(owners, st.lists(owners, max_size=3), st.lists(places, min_size=1, max_size=4))
def test_nothing_is_told_of_a_blob_out_of_reach_and_no_blob_is_told_twice(
    robot: Owner, rivals: list[Owner], blobs: list[tuple[float, float]]
):
    verdict = ask(robot, rivals, blobs)
    if verdict.robot is not None:
        assert robot.reaches(blobs[verdict.robot])
        assert verdict.doubtful == ()
        assert verdict.robot not in verdict.rivals.values()
    assert len(set(verdict.rivals.values())) == len(verdict.rivals)
    assert all(rivals[rival].reaches(blobs[blob]) for rival, blob in verdict.rivals.items())
    assert all(robot.reaches(blobs[blob]) for blob in verdict.doubtful)


@given(
    owners, st.lists(owners, max_size=3), st.lists(places, min_size=1, max_size=4, unique=True), st.randoms()
)
def test_the_order_of_the_blobs_does_not_matter(
    robot: Owner, rivals: list[Owner], blobs: list[tuple[float, float]], random
):
    shuffled = random.sample(blobs, len(blobs))
    one, other = ask(robot, rivals, blobs), ask(robot, rivals, shuffled)
    assert (one.robot is None) == (other.robot is None)
    if one.robot is not None and other.robot is not None:
        assert blobs[one.robot] == shuffled[other.robot]


def test_the_odds_are_a_thousand_to_one():
    assert math.exp(0.5 * ODDS) > 990.0

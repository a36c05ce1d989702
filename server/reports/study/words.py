"""What was found, in sentences with intervals."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from control.studies.analysis.comparison import Comparison, Order
from control.studies.analysis.distribution import REFUSED
from control.studies.analysis.drift import Drift
from control.studies.analysis.intervals import Interval
from control.studies.analysis.optimum import FEWEST_LEVELS, Kind, Optimum
from control.studies.analysis.sets import SetSummary, as_good_as_best
from control.studies.analysis.whole import DISTRIBUTED, Analysis
from control.studies.definition import StudyDefinition
from control.studies.table import StudyTable
from server.reports.study.naming import (
    axis_name,
    axis_unit,
    chance_text,
    number,
    point_text,
    short_metric,
    value_text,
    with_interval,
)

if TYPE_CHECKING:
    from control.studies.analysis.joint import JointOptimum
    from control.studies.tuning.answer import Answer
    from control.studies.tuning.answer import Interval as Tuned

MATTERS = 0.01
"""p below which an effect is called one: few enough false ones among a dozen terms. A choice."""
MOST_NAMED = 4


def sentences(found: Analysis, table: StudyTable) -> list[str]:
    return [
        *_counts(found, table),
        *_best(found),
        *(_optimum(found, one) for one in found.overall),
        *_apart(found),
        *([] if found.joint is None else [_joint(found, found.joint)]),
        *_effects(found),
        *_comparisons(found.comparisons),
        *_distributions(found),
        *([_drift(found, found.drift)] if found.drift is not None else []),
    ]


def _counts(found: Analysis, table: StudyTable) -> Iterator[str]:
    sets = len(found.summaries)
    yield f"{_runs(found.finished)} in {sets} {'set' if sets == 1 else 'sets'} finished; {found.failed} failed."
    reasons = Counter(row.reason for row in table.rows if row.state == "failed")
    for reason, count in reasons.most_common(MOST_NAMED):
        yield f"Failed, {'once' if count == 1 else f'{count} times'}: {reason}. Failed runs are counted and in no mean."
    unknown = sum(one.runs == 1 for one in found.summaries)
    if unknown:
        yield f"Sets with one finished run only: {unknown}; such a mean has no interval."


def unfinished(table: StudyTable, definition: StudyDefinition) -> Iterator[str]:
    """What was found before the end is preliminary."""
    plan = definition.plan()
    if plan.next({row.index: row for row in table.rows}):
        yield (
            f"The study is not over: {len(table.rows)} of at most {plan.total} runs are in this report, and what "
            "follows may change."
        )


def _runs(count: int) -> str:
    return "1 run" if count == 1 else f"{count} runs"


def _best(found: Analysis) -> Iterator[str]:
    best, metric = found.best, short_metric(found.samples.metric)
    if best is None:
        yield "No run has finished, so there is nothing to compare."
        return
    where = point_text({axis: best.values[axis] for axis in found.samples.varied()})
    if not where:
        yield f"{metric} is {with_interval(best.mean)}."
        return
    yield f"{metric} is smallest at {where}: {with_interval(best.mean)}.{_survivors(best)}"
    others = len(as_good_as_best(found.summaries)) - 1
    if others > 0:
        sets = (
            "interval of one other set reaches" if others == 1 else f"intervals of {others} other sets reach"
        )
        yield f"The {sets} as low: the data do not part the best set from what lies there."


def _survivors(best: SetSummary) -> str:
    """A mean of the runs that came through is no fair comparison with a set that lost none."""
    if not best.failed:
        return ""
    return f" But {best.failed} of its {best.runs + best.failed} runs failed, and the mean is of those that did not."


def _optimum(found: Analysis, one: Optimum) -> str:
    metric, name, unit = short_metric(found.samples.metric), axis_name(one.axis), axis_unit(one.axis)
    at = f" ({point_text(one.fixed)})" if one.fixed else ""
    others = [axis for axis in found.samples.varied() if axis != one.axis and axis not in one.fixed]
    mean = f", mean over {' and '.join(axis_name(axis) for axis in others)}" if others else ""
    levels = found.samples.levels(one.axis)
    span = f"{value_text(one.axis, levels[0])} to {value_text(one.axis, levels[-1])}"
    begin = f"Over {name} {span}{at}{mean}: "
    if one.kind is Kind.UNKNOWN:
        best = value_text(one.axis, one.measured)
        return f"{begin}the best level is {best}; how surely needs repeats of every set, at {FEWEST_LEVELS} levels."
    if one.value.half_width == 0.0:
        where, value = value_text(one.axis, round(one.where.value, 3)), number(one.value.value)
        return (
            f"{begin}a smooth line through the levels is lowest {one.kind.value}, at {where}, where it is {value}; "
            "runs of the same set do not differ, so there is no interval."
        )
    where, value = with_interval(one.where, unit), with_interval(one.value)
    if one.kind is Kind.FLAT:
        return f"{begin}{metric} is flat; where it is smallest cannot be told ({where})."
    if one.kind is Kind.INSIDE:
        beyond = "; the interval reaches an end of what was tried, so a better value may lie beyond"
        return (
            f"{begin}{metric} is smallest at {where}, where it is {value}{beyond if one.open_ended else ''}."
        )
    ends = f"{number(float(one.line[0]))} to {number(float(one.line[-1]))}"
    return (
        f"{begin}{metric} is smallest {one.kind.value} of what was tried, {where}, where it is {value}; "
        f"from end to end it goes from {ends}, and a better value may lie beyond."
    )


def _joint(found: Analysis, joint: JointOptimum) -> str:
    places = [
        f"{axis_name(axis)} {with_interval(where, axis_unit(axis))}" for axis, where in joint.where.items()
    ]
    places += [
        f"{axis_name(axis)} {value} ({_percent(share)} of the drawn surfaces agree)"
        for axis, (value, share) in joint.words.items()
    ]
    metric = short_metric(found.samples.metric)
    return (
        f"By a smooth surface through the sets, {metric} is smallest at {', '.join(places)}, where "
        f"{with_interval(joint.value)} is expected. An interval as wide as its axis says that the place cannot be told."
    )


def of_search(found: Answer) -> str:
    """What an auto-tune answers."""
    metric = short_metric(found.metric)
    said = f"The search's answer is {point_text(found.values)}: {_tuned(found.expected)} is the {metric} expected there"
    if found.measured is None and found.left:
        return f"{said}; the runs that are to confirm it are still to come."
    if found.measured is None:
        return f"{said}; no finished run confirms it."
    return f"{said}, and {_tuned(found.measured)} was measured in {_runs(found.runs)} that had no part in choosing it."


def _tuned(one: Tuned) -> str:
    low, high = (math.nan if edge is None else edge for edge in (one.low, one.high))
    return with_interval(Interval(one.mean, low, high))


def _apart(found: Analysis) -> Iterator[str]:
    """In how many combinations of the other axes the optimum lies where."""
    for axis in dict.fromkeys(one.axis for one in found.apart):
        each = [one for one in found.apart if one.axis == axis]
        kinds = Counter(one.kind for one in each)
        parts = ", ".join(f"{kind.value} in {count}" for kind, count in kinds.most_common())
        inner = [one for one in each if one.kind is Kind.INSIDE]
        inside = sorted(one.where.value for one in inner)
        ends = f"; the inner ones lie from {_ends(axis, inside)}" if inside else ""
        unsure = sum(one.open_ended for one in inner)
        ends += f", {unsure} of them with an interval that reaches an end of what was tried" if unsure else ""
        name = axis_name(axis)
        yield f"Along {name} at each of the {len(each)} combinations of the others, the optimum is {parts}{ends}."


def _ends(axis: str, ascending: Sequence[float]) -> str:
    return f"{value_text(axis, round(ascending[0], 3))} to {value_text(axis, round(ascending[-1], 3))}"


def _effects(found: Analysis) -> Iterator[str]:
    metric = short_metric(found.samples.metric)
    if found.effects is not None:
        told = [one for one in found.effects.effects if one.p < MATTERS]
        parts = [
            f"{' with '.join(axis_name(axis) for axis in one.axes)} {_percent(one.share.value)} "
            f"({_percent(one.share.low)} to {_percent(one.share.high)})"
            for one in told[:MOST_NAMED]
        ]
        if parts:
            yield (
                f"Of the variance of {metric}, so much goes with: {'; '.join(parts)}. "
                f"Runs of the same set differ by {_percent(found.effects.noise)}."
            )
        elif all(math.isnan(one.p) for one in found.effects.effects):
            yield f"Which axis has an effect on {metric} cannot be tested without repeats."
        else:
            yield f"No axis has an effect on {metric} that could be told from the scatter of the runs."
    if found.influences:
        told = [one for one in found.influences if min(one.p, one.p_monotone) < MATTERS]
        parts = [
            f"{axis_name(one.axis)} {_percent(one.share)} (rank correlation {number(one.rank_correlation, 2)})"
            for one in told[:MOST_NAMED]
        ]
        names = "; ".join(parts) if parts else "none that could be told from chance"
        yield f"Axes by their share of the differences in {metric} between sets: {names}."


def _comparisons(found: Sequence[Comparison]) -> Iterator[str]:
    for axis, *names in dict.fromkeys((each.axis, each.one, each.other) for each in found):
        one, other = (value_text(axis, name) for name in names)
        pairs = [each for each in found if (each.axis, each.one, each.other) == (axis, *names)]
        orders = Counter(each.order for each in pairs)
        ratios = sorted(each.ratio for each in pairs)
        below, above = orders[Order.LOWER], orders[Order.HIGHER]
        if above > below:
            one, other, below, above = other, one, above, below
            ratios = sorted(each.inverse_ratio for each in pairs)
        yield (
            f"{one} lies below {other} at {below} of {len(pairs)} points, above at {above}, and at "
            f"{orders[Order.OPEN]} it cannot be told; its mean is {number(ratios[0])} to {number(ratios[-1])} times "
            "the other's."
        )


def _distributions(found: Analysis) -> Iterator[str]:
    fits = [one for one in found.distributions.values() if one.weibull is not None]
    if not fits:
        return
    refused = sum(one.weibull.p_anderson < REFUSED for one in fits if one.weibull is not None)
    located = sum(one.located.p_anderson < REFUSED for one in fits if one.located is not None)
    winners = Counter(min(one.preference, key=lambda name: one.preference[name]) for one in fits)
    yield (
        f"Of {len(fits)} sets with at least {DISTRIBUTED} runs, a Weibull law from 0 is refused in {refused} and one "
        f"with a location of its own in {located} (p < {REFUSED}, Anderson and Darling). Fits best: "
        + ", ".join(f"{name} in {count}" for name, count in winners.most_common())
        + "."
    )


def _drift(found: Analysis, drift: Drift) -> str:
    metric = short_metric(found.samples.metric)
    change = with_interval(drift.slope)
    if drift.noticed:
        return (
            f"{metric} drifted while the study went on: by {change} from the first run to the last, whatever the set "
            f"(p {chance_text(drift.p)}). Blocked or random order keeps that from looking like an effect."
        )
    return (
        f"No drift over the order of the runs is noticed: {change} over the study (p {chance_text(drift.p)})."
    )


def _percent(share: float) -> str:
    percent = 100.0 * share
    return f"{percent:.0f} %" if percent >= 10.0 else f"{percent:.2g} %"

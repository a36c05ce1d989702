"""What a soak tells: a line for each act while it goes on, a table and a JSON file at the end."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from tests.soak.growth import Growth
from tests.soak.reactions import Kept
from tests.soak.soak import Outcome

MB = 1e6
EVENTS_SHOWN = 40
LOG_SHOWN = 4000
"""Characters of what the server said."""


def tell(outcome: Outcome) -> None:
    """On stderr: the act that comes."""
    memory = f"{outcome.looks[-1].memory.held / MB:.0f} MB" if outcome.looks else ""
    act = outcome.act
    if act is not None:
        at, of = clock(outcome.elapsed), clock(outcome.plan.seconds)
        print(f"{at} of {of}  {memory:>7}  {act.number:4}  {act.title}", file=sys.stderr, flush=True)


def clock(seconds: float) -> str:
    return f"{int(seconds) // 60:02}:{int(seconds) % 60:02}"


def show(outcome: Outcome) -> None:
    """On stdout; of a broken invariant on stderr."""
    console = Console()
    for table in _tables(outcome):
        console.print(table)
    if outcome.broken:
        print(broken_words(outcome), file=sys.stderr)
    else:
        print(f"soak: {clock(outcome.elapsed)} with seed {outcome.plan.seed}, every invariant held")


def broken_words(outcome: Outcome) -> str:
    """What broke, when, how to see it again, and what the log said around it."""
    plan, act, stage = outcome.plan, outcome.act, outcome.stage
    number, title = (act.number, act.title) if act is not None else (0, "the start")
    lines = [
        f"soak: an invariant broke {clock(outcome.broken_at)} after the beginning, in act {number} ({title}):",
        f"  {outcome.broken}",
        f"again: python -m tests.soak --seed {plan.seed} --load {plan.load} --minutes {plan.seconds / 60:g}"
        f" (or --first {max(1, number - 3)}, from three acts before it)",
        "the event log until then:",
    ]
    events = list(stage.watcher.events)[-EVENTS_SHOWN:] if stage is not None else []
    lines += [
        f"  {event['time_s']:9.3f} {event['severity']:5} {event['code']}: {event['message']}"
        for event in events
    ]
    return "\n".join([*lines, "the server said:", outcome.log[-LOG_SHOWN:]])


def _tables(outcome: Outcome) -> Iterator[Table]:
    yield _figures(outcome)
    if outcome.stage is None:
        return
    table = Table(
        "fault", "verdicts", "noticed, ms", "no current, ms", "promised, ms", title="worst reactions"
    )
    for name, kept in sorted(outcome.stage.reactions.kinds.items()):
        verdicts = ", ".join(f"{count} {verdict}" for verdict, count in kept.verdicts.items())
        table.add_row(name, verdicts, *map(_number, (kept.noticed_ms, kept.gone_ms, kept.promised_ms)))
    yield table


def _figures(outcome: Outcome) -> Table:
    table = Table("what", "figure", title=f"soak of {clock(outcome.elapsed)}, seed {outcome.plan.seed}")
    for name, value in result(outcome)["figures"].items():
        table.add_row(name, _number(value) if isinstance(value, float) else str(value))
    for name, count in sorted((outcome.stage.counts if outcome.stage else {}).items()):
        table.add_row(name, str(count))
    for name, count in sorted((outcome.load.counts if outcome.load else {}).items()):
        table.add_row(f"load: {name}", str(count))
    return table


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.4g}"


def figures(outcome: Outcome) -> dict[str, Any]:
    """Of memory, pace and what was left behind."""
    found = {**_memory(outcome.growth), **_pace(outcome)}
    if (stage := outcome.stage) is not None:
        rules = stage.watcher.rules
        found["robot put back by hand"] = stage.hand.put_back
        found["largest current, %"] = 100.0 * rules.largest
        found["slowest line of the log, s"] = rules.slowest_line
    for name, each in zip(("warm", "at the end"), outcome.belongings, strict=False):
        found[f"left at rest, {name}"] = ", ".join(f"{value} {what}" for what, value in asdict(each).items())
    return found | {"gone after SIGTERM, s": outcome.ended_in}


def _memory(growth: Growth | None) -> dict[str, Any]:
    if growth is None:
        return {}
    return {
        "memory when warm, MB": growth.warm.held / MB,
        "memory at the end, MB": growth.last.held / MB,
        "growth, %": 100.0 * growth.share,
        "anonymous when warm, MB": growth.warm.anonymous / MB,
        "anonymous at the end, MB": growth.last.anonymous / MB,
        "memory judged": growth.is_judged,
    }


def _pace(outcome: Outcome) -> dict[str, Any]:
    if outcome.auditor is None or not outcome.auditor.pace.periods:
        return {}
    pace = outcome.auditor.pace
    return {
        "rate, Hz": pace.rate,
        "late ticks, %": 100.0 * pace.long_share,
        "longest period, ms": 1e3 * pace.worst,
        "kept from the processor, s": outcome.starved,
    }


def result(outcome: Outcome) -> dict[str, Any]:
    """What the JSON file has."""
    stage, load = outcome.stage, outcome.load
    kinds = stage.reactions.kinds if stage is not None else {}
    return {
        "seed": outcome.plan.seed,
        "seconds": outcome.elapsed,
        "load": outcome.plan.load,
        "broken": outcome.broken or None,
        "broken_at_s": outcome.broken_at if outcome.broken else None,
        "act": outcome.act.number if outcome.act else None,
        "figures": figures(outcome),
        "counts": dict(stage.counts) if stage is not None else {},
        "load_counts": dict(load.counts) if load is not None else {},
        "reactions": {name: kept_json(kept) for name, kept in kinds.items()},
        "memory": [[round(look.at, 1), look.memory.held, look.memory.anonymous] for look in outcome.looks],
    }


def kept_json(kept: Kept) -> dict[str, Any]:
    return {
        "verdicts": dict(kept.verdicts),
        "noticed_ms": kept.noticed_ms,
        "gone_ms": kept.gone_ms,
        "promised_ms": kept.promised_ms,
    }


def write(outcome: Outcome, path: Path) -> None:
    path.write_text(json.dumps(result(outcome), indent=1) + "\n")

"""Tries every fault out in simulated time and writes the table "What happens when…" into SAFETY.md.

python -m tests.faults.table
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

from control.simulation.faults.promises import FAULT, GO_ON
from control.snapshot import RigState
from tests.faults.promises import PROMISES
from tests.faults.trial import Trial, try_out

DOCUMENT = Path(__file__).parents[2] / "SAFETY.md"
BEGIN = "<!-- the table is written by `make safety` -->"
END = "<!-- end of the table -->"
HEAD = (
    "fault", "what you see", "state after", "noticed, ms", "zero promised, ms", "zero measured, ms", "how to go on",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class OutsideEvent:
    """What cannot be injected from inside: tried with real processes and signals by the tests it names."""

    title: str
    sees: str
    after: str
    promised: str
    go_on: str
    tests: str


EVENTS = (
    OutsideEvent(
        "Program or computer dies", "the page is gone", "board alone", "200",
        "start pivotrig; it is disarmed, and mends the recording", "test_computer_dies",
    ),
    OutsideEvent(
        "Program or computer freezes", "the page stands still", "held or disarmed", "200", "resume or arm",
        "test_computer_dies",
    ),
    OutsideEvent(
        "Ctrl-C, SIGTERM, terminal closed", "the page says that the server is gone", "ended",
        "at once, before anything is closed", "start pivotrig; it is disarmed", "test_ending_with_viewers",
    ),
    OutsideEvent(
        "Emergency stop: page, `POST /api/v1/estop`, `kill -USR1`", "emergency stop", "fault", "at once", GO_ON[FAULT],
        "test_computer_dies",
    ),
    OutsideEvent(
        "Operator's page lost, asleep, hidden, or not reading", "who has not been heard for 2 s", "held",
        "2000 after it was last heard",
        "resume, or take over and resume", "test_operator_lost",
    ),
    OutsideEvent(
        "Two operators", "who operates; late commands of the former one are refused", "as it is", "–",
        "ask for it, or take it over", "test_lease_race",
    ),
    OutsideEvent(
        "Somebody without a token, from elsewhere", "that a token is needed", "as it is", "–", "log in",
        "test_access_door",
    ),
    OutsideEvent(
        "A page of another site in the operator's browser", "nothing: it is refused", "as it is", "–", "nothing to do",
        "test_dashboard_login",
    ),
    OutsideEvent(
        "Huge uploads, slow bodies, floods", "nothing: they are refused", "as it is", "–", "nothing to do",
        "test_floods",
    ),
    OutsideEvent(
        "Study interrupted", "how far it came; finished runs stay as they are", "ended", "as for what interrupted it",
        "resume the study", "test_study_interrupted",
    ),
)  # fmt: skip


def document_rows(table: str) -> list[tuple[str, ...]]:
    """The cells of a table in Markdown, without its head."""
    lines = [line for line in table.splitlines() if line.startswith("|")]
    return [tuple(cell.strip() for cell in line.strip("|").split(" | ")) for line in lines[2:]]


def table_of(trials: list[Trial]) -> str:
    rows = [HEAD, tuple("---" for _ in HEAD), *map(_row, trials), *map(_outside_row, EVENTS)]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _row(trial: Trial) -> tuple[str, ...]:
    promise, reaction = trial.promise, trial.reaction
    walks_on = promise.after is RigState.RUNNING
    return (
        promise.kind.title,
        promise.sees,
        promise.state,
        "–" if walks_on else f"`{promise.watchdog}`" if promise.watchdog else str(reaction.noticed),
        "–" if walks_on else str(promise.zero),
        "–" if walks_on else str(reaction.zero),
        promise.go_on,
    )


def _outside_row(event: OutsideEvent) -> tuple[str, ...]:
    return event.title, event.sees, event.after, "–", event.promised, f"`{event.tests}`", event.go_on


def main() -> None:
    trials = []
    for promise in PROMISES.values():
        trials.append(try_out(promise))
        print(f"{promise.kind.title}: zero after {trials[-1].reaction.zero} ms", file=sys.stderr)
    text = DOCUMENT.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    DOCUMENT.write_text(f"{before}{BEGIN}\n{table_of(trials)}{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()

"""`python -m server.studies VERB JOBS DATA ID [PLUGIN ...]`: what the server has done for its studies beside the rig.

carry-out: all that is left of a batch, by so many processes (0: one a core); progress goes to stdout, one
JSON object a line.
report: its report into the study's folder.  plot: its figure, PNG, to stdout.  learned: what a search for the best
has learned, JSON, to stdout.
A process of its own, since it takes seconds to hours of Python and the control loop must not share its interpreter
with that. It ends with the server: its stdin does. What a plug-in prints goes nowhere. Exit status: 0 done,
3 impossible, with the reason on stderr.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from control import plugins
from control.studies.errors import StudyError
from server.exports.formats import IMPOSSIBLE
from server.studies.errors import StudyStoreError

if TYPE_CHECKING:
    from server.studies.progress import Progress
    from server.studies.study import Study

NICENESS = 10
"""A batch takes what the rig and the exports leave: a tenth of its share of a busy processor."""
ORPHANED = 1
BETWEEN_LINES = 0.2
"""Progress is told so often at most, s."""


def main(verb: str, jobs: str, data: str, id: str, *files: str) -> int:
    os.nice(NICENESS)
    signal.signal(
        signal.SIGINT, signal.default_int_handler
    )  # a server that runs in the background ignores it
    threading.Thread(target=_end_with_the_server, name="server's end", daemon=True).start()
    try:
        with _answer() as answer:
            _load(files)
            _do(Order(verb, int(jobs), Path(data), id), answer)
    except (StudyStoreError, StudyError, plugins.PluginError, OSError) as error:
        print(error, file=sys.stderr)
        return IMPOSSIBLE
    except KeyboardInterrupt:  # the study says so itself
        return 0
    return 0


@dataclass(frozen=True, slots=True)
class Order:
    verb: str
    jobs: int
    data: Path
    id: str


def _answer() -> BinaryIO:
    """What was stdout; nobody else of this process, or of its workers, can write between the lines any more."""
    answer = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), sys.stdout.fileno())
    return answer


def _end_with_the_server() -> None:
    """Whoever has started this closes its stdin at the latest when it dies."""
    while os.read(sys.stdin.fileno(), 1024):
        continue
    os._exit(ORPHANED)


def _load(files: Sequence[str]) -> None:
    plugins.load_installed()
    for file in files:
        plugins.load_file(Path(file))


def _do(order: Order, answer: BinaryIO) -> None:
    from server.catalogue.catalogue import Catalogue
    from server.studies.store import StudyStore

    with closing(Catalogue.open(order.data)) as catalogue:
        study = StudyStore(order.data, catalogue).open(order.id)
        if order.verb == "carry-out":
            _carry_out(study, order.jobs, answer)
        else:
            answer.write({"report": _report, "plot": _plot, "learned": _learned}[order.verb](study))


def _carry_out(study: Study, jobs: int, answer: BinaryIO) -> None:
    from server.studies.carrying_out import Workforce, carry_out_batch

    carry_out_batch(study, Workforce(jobs or _jobs_worth_starting(study)), Telling(answer).heed)


def _jobs_worth_starting(study: Study) -> int:
    """What is done before further processes have begun is done in this one; the results are the same."""
    from control.studies.checking import survey
    from server.studies.expectation import READY, computing

    return 1 if computing(study.definition, survey(study.definition)) < READY else 0


def _report(study: Study) -> bytes:
    """It has the time of the newest row that is in it: who is asked for it again sees whether there are newer ones."""
    from server.catalogue.shelf import RECORDINGS
    from server.reports.study.report import write_report
    from server.studies.study import RESULTS

    of = (study.folder / RESULTS).stat().st_mtime_ns
    recordings = study.folder.parents[1] / RECORDINGS
    page = write_report(study.table(), study.definition, study.report_folder, recordings)
    os.utime(page, ns=(of, of))
    return b""


def _plot(study: Study) -> bytes:
    from server.reports.study.plot import plot_png

    return plot_png(study.table(), study.definition)


def _learned(study: Study) -> bytes:
    from control.studies.tuning import answer, learned_surface

    rows = {row.index: row for row in study.rows()}
    found, learned = answer(study.definition, rows), learned_surface(study.definition, rows)
    shown = {
        "answer": None if found is None else found.to_json(),
        "surface": None if learned is None else learned.to_json(),
    }
    return json.dumps(shown).encode()


class Telling:
    """Progress as lines, not more often than a page can show."""

    def __init__(self, answer: BinaryIO) -> None:
        self._answer = answer
        self._next = 0.0

    def heed(self, progress: Progress) -> None:
        now = time.monotonic()
        if now < self._next and progress.done < progress.total:
            return
        self._next = now + BETWEEN_LINES
        self._answer.write(json.dumps(progress.to_json()).encode() + b"\n")
        self._answer.flush()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

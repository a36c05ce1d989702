"""`python -m server.studies VERB JOBS DATA ID [PLUGIN ...]`: what the server has done for its studies beside the rig.

carry-out: all that is left of a batch, by so many processes (0: one a core); progress goes to stdout, one
JSON object a line.
report: its report into the study's folder.  plot: its figure, PNG, to stdout.  learned: what a search for the best
has learned, JSON, to stdout.
A process of its own, since it takes seconds to hours of Python and the control loop must not share its interpreter
with that. It ends with the server: its stdin does. Exit status: 0 done, 3 impossible, with the reason on stderr.
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
from pathlib import Path
from typing import TYPE_CHECKING

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
        _load(files)
        _do(verb, int(jobs), Path(data), id)
    except (StudyStoreError, StudyError, plugins.PluginError, OSError) as error:
        print(error, file=sys.stderr)
        return IMPOSSIBLE
    except KeyboardInterrupt:  # the study says so itself
        return 0
    return 0


def _end_with_the_server() -> None:
    """Whoever has started this closes its stdin at the latest when it dies."""
    while os.read(sys.stdin.fileno(), 1024):
        continue
    os._exit(ORPHANED)


def _load(files: Sequence[str]) -> None:
    plugins.load_installed()
    for file in files:
        plugins.load_file(Path(file))


def _do(verb: str, jobs: int, data: Path, id: str) -> None:
    from server.catalogue.catalogue import Catalogue
    from server.studies.store import StudyStore

    with closing(Catalogue.open(data)) as catalogue:
        study = StudyStore(data, catalogue).open(id)
        if verb == "carry-out":
            _carry_out(study, jobs)
        else:
            {"report": _report, "plot": _plot, "learned": _learned}[verb](study)


def _carry_out(study: Study, jobs: int) -> None:
    from server.studies.carrying_out import Workforce, carry_out_batch

    carry_out_batch(study, Workforce(jobs or _jobs_worth_starting(study)), Telling().heed)


def _jobs_worth_starting(study: Study) -> int:
    """What is done before further processes have begun is done in this one; the results are the same."""
    from control.studies.checking import survey
    from server.studies.duration import STARTING, wall_time

    quick = wall_time(study.definition, survey(study.definition)) < 2.0 * STARTING
    return 1 if quick else 0


def _report(study: Study) -> None:
    from server.catalogue.shelf import RECORDINGS
    from server.reports.study.report import write_report

    recordings = study.folder.parents[1] / RECORDINGS
    write_report(study.table(), study.definition, study.report_folder, recordings)


def _plot(study: Study) -> None:
    from server.reports.study.plot import plot_png

    sys.stdout.buffer.write(plot_png(study.table(), study.definition))
    sys.stdout.buffer.flush()


def _learned(study: Study) -> None:
    from control.studies.tuning import answer, learned_surface

    rows = {row.index: row for row in study.rows()}
    found, learned = answer(study.definition, rows), learned_surface(study.definition, rows)
    shown = {
        "answer": None if found is None else found.to_json(),
        "surface": None if learned is None else learned.to_json(),
    }
    print(json.dumps(shown), flush=True)


class Telling:
    """Progress as lines on stdout, not more often than a page can show."""

    def __init__(self) -> None:
        self._next = 0.0

    def heed(self, progress: Progress) -> None:
        now = time.monotonic()
        if now < self._next and progress.done < progress.total:
            return
        self._next = now + BETWEEN_LINES
        print(json.dumps(progress.to_json()), flush=True)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

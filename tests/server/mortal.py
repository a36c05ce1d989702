"""A program whose only purpose is to be killed while it records: `python mortal.py DATA_FOLDER`, ids on its input.

For each id a process of its own walks the simulated rig in real time, records it, and says its own number and then
the time of each tick of the run, in rig seconds. Forked, so that importing is paid for once.
"""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

from control.gait import Gait
from control.runs import Choice, RunRequest, Selection
from control.snapshot import Snapshot
from server.archive import Archive
from server.assembly import build_machine
from server.headless import Headless
from server.settings import RigFile

REQUEST = RunRequest(Selection(Choice("geometric"), Choice("eight"), Gait(sweep=math.radians(10.0))))


def say(words: object) -> None:
    """One line, whole or not at all, whatever ends this process."""
    os.write(sys.stdout.fileno(), f"{words}\n".encode())


def tell(snapshot: Snapshot) -> None:
    if snapshot.run is not None:
        say(snapshot.time)


def walk(data: Path, id: str) -> None:
    say(os.getpid())
    archive = Archive.open(data)
    Headless(build_machine(RigFile(), realtime=True), tell, archive.recorder).run(id, REQUEST)


def main(data: Path) -> None:
    for line in sys.stdin:
        child = os.fork()
        if child == 0:
            walk(data, line.strip())
        os.waitpid(child, 0)
        say("dead")


if __name__ == "__main__":
    main(Path(sys.argv[1]))

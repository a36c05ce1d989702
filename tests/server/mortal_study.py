"""A program whose only purpose is to be killed in the middle of a study: `python mortal_study.py NUMBER`.

For each line of its input, the arguments of `pivotrig` as JSON, a process of its own carries the command out. It says
that one's number and then how it ended, on the open file of that number. Forked, so that importing is paid for once.
"""

from __future__ import annotations

import json
import os
import sys
from typing import NoReturn

from control.studies import batch
from server import cli
from server.catalogue import catalogue, opening
from server.commands import studies, study_sitting
from server.studies import carrying_out, store

BROKEN = 70
"""Exit status of a command that raised."""
LOADED = (batch, catalogue, opening, studies, study_sitting, carrying_out, store)
"""What the commands load when they are needed."""


def say(words: object) -> None:
    os.write(int(sys.argv[1]), f"{words}\n".encode())


def carry_out() -> NoReturn:
    """Ends this process with the status of the command."""
    status = BROKEN
    try:
        cli.main()
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else 1
    finally:
        os._exit(status)


def main() -> None:
    for line in sys.stdin:
        child = os.fork()
        if child == 0:
            os.setsid()
            say(os.getpid())
            sys.argv[:] = ["pivotrig", *json.loads(line)]
            carry_out()
        say(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))


if __name__ == "__main__":
    main()

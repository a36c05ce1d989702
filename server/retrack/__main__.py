"""`python -m server.retrack RECORDING`: one run looked at again, as the server has it done.

The order comes on stdin (`Order` as JSON), progress and the result go to stdout, one JSON object a line (`Said`).
A process of its own, since it takes seconds to minutes of Python and the control loop must not share its interpreter
with that. Exit status: 0 done, 3 impossible, with the reason on stderr.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import msgspec

from control import plugins
from server.exports.__main__ import NICENESS
from server.exports.formats import IMPOSSIBLE
from server.retrack.changes import Changes, RetrackError
from server.retrack.order import Order
from server.retrack.retracking import retrack


def main(path: str) -> int:
    os.nice(NICENESS)
    try:
        order = msgspec.json.decode(sys.stdin.buffer.read(), type=Order)
        plugins.load_installed()
        for file in order.plugins:
            plugins.load_file(Path(file))
        say(retrack(Path(path), Changes.from_json(order.changes), lambda share: say({"progress": share})))
    except BrokenPipeError:  # whoever wanted it has gone; Python would try to flush once more at its end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return IMPOSSIBLE
    except (RetrackError, plugins.PluginError, OSError) as error:
        print(error, file=sys.stderr)
        return IMPOSSIBLE
    return 0


def say(words: object) -> None:
    sys.stdout.buffer.write(msgspec.json.encode(words) + b"\n")
    sys.stdout.buffer.flush()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

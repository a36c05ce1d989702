"""`python -m server.exports FORMAT RECORDING [--overlay]`: one export to stdout.

The server makes its exports this way, since reading an hour of ticks takes seconds of Python and the control
loop must not share its interpreter with that. Exit status: 0 done, 3 impossible, with the reason on stderr.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from server.exports.formats import IMPOSSIBLE, ExportError, Job, export

NICENESS = 5
"""So far the export stands back behind what walks: a quarter of its share of a busy processor, yet never starved."""


def main(format: str, path: str, *options: str) -> int:
    os.nice(NICENESS)
    try:
        export(Job(Path(path), format, overlay="--overlay" in options), sys.stdout.buffer)
        sys.stdout.buffer.flush()
    except BrokenPipeError:  # whoever wanted it has gone; Python would try to flush once more at its end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return IMPOSSIBLE
    except (ExportError, OSError) as error:
        print(error, file=sys.stderr)
        return IMPOSSIBLE
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

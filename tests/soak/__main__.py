"""`make soak`: the simulated rig under load, with random faults, for as long as is asked for.

Exit status 0 when every invariant held, else 1 with the one that did not, and how to see it again.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from tests.soak import report
from tests.soak.crowd import LOADS
from tests.soak.soak import MINUTE, Plan, Soak

RESULT = Path("build/soak.json")


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.soak", description=__doc__)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument(
        "--seed", type=int, default=int(time.time()) % 100_000, help="default: another each time"
    )
    parser.add_argument("--load", choices=LOADS, default="light")
    parser.add_argument("--first", type=int, default=1, help="number of the act to begin with")
    parser.add_argument("--json", type=Path, default=RESULT, help=f"where the figures go (default {RESULT})")
    given = parser.parse_args()
    outcome = Soak(Plan(given.minutes * MINUTE, given.seed, given.load, given.first), report.tell).run()
    report.show(outcome)
    given.json.parent.mkdir(parents=True, exist_ok=True)
    report.write(outcome, given.json)
    return 1 if outcome.broken else 0


if __name__ == "__main__":
    sys.exit(main())

"""`make bench`: how fast the program is, as ratios against a reference in the same run.

Each section prints its own table; nothing here passes or fails.
"""

from __future__ import annotations

import argparse

from tests.benchmarks import (
    crowd,
    decision_cost,
    live_loop,
    recording_cost,
    rigid_pace,
    simulation_pace,
    study_pace,
    tracking_cost,
)

SECTIONS = {
    "pace": simulation_pace.report,
    "rigid": rigid_pace.report,
    "loop": live_loop.report,
    "crowd": crowd.report,
    "recording": recording_cost.report,
    "tracking": tracking_cost.report,
    "decision": decision_cost.report,
    "studies": study_pace.report,
}


def main() -> None:
    parser = argparse.ArgumentParser(prog="make bench", description=__doc__)
    parser.add_argument("sections", nargs="*", choices=[*SECTIONS, []], help="default: all of them")
    for name in parser.parse_args().sections or SECTIONS:
        SECTIONS[name]()


main()

"""A host that does nothing but drive a board at full current, 60 times a second: `python -m tests.firmware.driving_host
PORT`. It prints "driving" when a coil carries 95 % of what it may, and is there to be killed."""

from __future__ import annotations

import math
import sys
import time
from dataclasses import replace

from control.link.conversion import DriveCommand
from control.link.port import Link
from tests.paper_board import CONFIGURATION

PERIOD = 1.0 / 60.0
FULL = 0.95
ALLOCATION = ((800.0, 0.0, 0.0), (0.0, 800.0, 0.0), (0.0, 0.0, 800.0))
COMMAND = DriveCommand(1, 0.0, 0.0, math.radians(10.0), 0.0101, ALLOCATION, 0.15)
"""8 A in coil 2, which a tilt of 10 degrees lets it just reach; the time to live is the program's own."""


def main(port: str) -> None:
    link = Link(port, 500_000, CONFIGURATION, time.monotonic)
    link.open()
    armed = announced = False
    while True:
        report = link.poll()
        if link.is_ready:
            link.drive(COMMAND if armed else replace(COMMAND, start_heading=0.0))
            armed = report is None or report.state in ("driving", "ready")
        if report is not None and not announced and max(map(abs, report.currents)) > FULL * 8.0:
            print("driving", flush=True)
            announced = True
        time.sleep(PERIOD)


if __name__ == "__main__":
    main(sys.argv[1])

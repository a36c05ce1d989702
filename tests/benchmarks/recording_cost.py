"""What recording costs the loop: on against off in turns, in one rig that walks in real time.

Recorded is every camera frame (60 Hz, 640x480), six times as many as by default.
"""

from __future__ import annotations

import asyncio
import math
import sys
import tempfile
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from control.gait import Gait
from control.runs import Choice, RunRequest, Selection
from control.snapshot import RigState
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.serving import TURN
from server.settings import RigFile

BLOCK = 10.0
"""Seconds of ticks that the loop's own log keeps."""
SETTLING = 1.0
"""Seconds at the beginning of a run that are not counted."""
ROUNDS = 5
RATE = 60.0
ENCODER = "encoder"
"""In the name of the thread that makes JPEG of the frames."""
RECORDER = "record"
"""In the names of all of the recorder's threads."""
WALK = Selection(Choice("geometric"), Choice("eight"), Gait(sweep=math.radians(10.0)))


@dataclass(slots=True)
class Side:
    """Frame-in to bytes-out of all ticks on one side, s, and shares of one core, by thread."""

    latencies: list[float] = field(default_factory=list)
    shares: list[dict[str, float]] = field(default_factory=list)

    def percentile(self, share: float) -> float:
        return float(np.percentile(self.latencies, share))

    def share(self, *, encoder: bool) -> float:
        """Of the recorder's threads, mean of all blocks, %."""
        blocks = [
            sum(value for name, value in block.items() if (ENCODER in name) is encoder)
            for block in self.shares
        ]
        return 100.0 * float(np.mean(blocks))


def report(rounds: int = ROUNDS, block: float = BLOCK) -> None:
    print(
        f"\nrecording every frame of 640x480 at {RATE:.0f} Hz, on and off in turns, {rounds} x {block:.0f} s each"
    )
    on, off = asyncio.run(measure(rounds, block))
    print(f"{'':12} {'latency p50':>12} {'latency p99':>12} {'ticks':>8}")
    for name, side in (("not recorded", off), ("recorded", on)):
        p50, p99 = side.percentile(50.0) * 1e3, side.percentile(99.0) * 1e3
        print(f"{name:12} {p50:9.3f} ms {p99:9.3f} ms {len(side.latencies):8d}")
    p50, p99 = (on.percentile(share) / off.percentile(share) for share in (50.0, 99.0))
    print(f"{'ratio':12} {p50:12.3f} {p99:12.3f}   (at most 1.03 and 1.10)")
    print(f"recorder, without its encoder: {on.share(encoder=False):.1f} % of one core (at most 10 %)")
    print(f"its JPEG encoder:              {on.share(encoder=True):.1f} % of one core")


async def measure(rounds: int, block: float) -> tuple[Side, Side]:
    """With recording, and without."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(TURN)
    try:
        with tempfile.TemporaryDirectory() as folder:
            return await _in_turns(Path(folder), rounds, block)
    finally:
        sys.setswitchinterval(before)


async def _in_turns(folder: Path, rounds: int, block: float) -> tuple[Side, Side]:
    archive = Archive.open(folder)
    rig = Rig(build_machine(_settings(enabled=True), realtime=True), recorder=archive.recorder)
    on, off = Side(), Side()
    await rig.start()
    try:
        for _ in range(rounds):
            for side, enabled in ((on, True), (off, False)):
                await _block(rig, archive, side, enabled=enabled, duration=block)
    finally:
        await rig.stop()
        archive.close()
    return on, off


def _settings(*, enabled: bool) -> RigFile:
    recording = {"enabled": enabled, "frames_Hz": RATE}
    return RigFile.model_validate({"recording": recording})


async def _block(rig: Rig, archive: Archive, side: Side, *, enabled: bool, duration: float) -> None:
    """One run; its ticks, and what the recorder's threads worked meanwhile."""
    rig.machine.settings = _settings(enabled=enabled)
    run = await _walk(rig)
    await asyncio.sleep(SETTLING)
    kept = rig.machine.loop._timing._latencies
    kept.clear()
    before = _worked()
    await asyncio.sleep(duration)
    worked = {name: (seconds - before.get(name, 0.0)) / duration for name, seconds in _worked().items()}
    side.latencies += kept
    side.shares.append(worked)
    await rig.disarm()
    await asyncio.to_thread(archive.recorder.written, run, 10.0)


async def _walk(rig: Rig) -> str:
    """Start a run that does not end by itself; its id."""
    while rig.snapshot.faults or rig.snapshot.pose is None or rig.snapshot.rig is not RigState.DISARMED:
        await asyncio.sleep(0.05)
    await rig.arm()
    await asyncio.sleep(0.5)
    return (await rig.start_run(RunRequest(WALK, passes=1000.0))).id


def _worked() -> dict[str, float]:
    """Processor time of each of the recorder's threads, s."""
    threads = [thread for thread in threading.enumerate() if RECORDER in thread.name]
    return {thread.name: _seconds(thread) for thread in threads}


def _seconds(thread: threading.Thread) -> float:
    assert thread.ident is not None
    return time.clock_gettime(time.pthread_getcpuclockid(thread.ident))

"""The crowd's process, from the side of the soak."""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from tests.soak.broken import InvariantBroken

LEAVES_WITHIN = 15.0
"""Seconds."""


@dataclass(slots=True)
class Load:
    """People who watch; `None` of them while `process` is."""

    address: str
    kind: str
    seed: int
    counts: Counter[str] = field(default_factory=Counter)
    process: subprocess.Popen[str] | None = None

    def come(self) -> None:
        self.seed += 1
        command = [sys.executable, "-m", "tests.soak.crowd", self.address, "--load", self.kind]
        self.process = subprocess.Popen(
            [*command, "--seed", str(self.seed)], stdout=subprocess.PIPE, text=True
        )

    def check(self) -> None:
        if self.process is not None and self.process.poll() is not None:
            self.leave()
            raise InvariantBroken("the load has ended before the soak")

    def leave(self) -> None:
        """Raises `InvariantBroken` for what they have seen and should not have."""
        if self.process is None:
            return
        process, self.process = self.process, None
        process.terminate()
        try:
            said, _ = process.communicate(timeout=LEAVES_WITHIN)
        finally:
            process.kill()
        if not said:
            return
        seen = json.loads(said)
        self.counts.update(seen["counts"])
        if seen["wrong"]:
            raise InvariantBroken(f"a client of the load has seen: {'; '.join(seen['wrong'][:3])}")


@contextmanager
def load_on(address: str, kind: str, seed: int) -> Iterator[Load]:
    load = Load(address, kind, seed)
    try:
        load.come()
        yield load
    finally:
        if load.process is not None:
            load.process.kill()
            load.process.communicate()

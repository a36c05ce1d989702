"""The other end of `camera_reader`: what a camera in another process gives and says."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

PATIENCE = 20.0
"""Seconds until what is waited for has happened, on a busy machine."""

Line = dict[str, Any]


@dataclass(slots=True)
class Watch:
    """lines: all that has been said so far."""

    process: subprocess.Popen[str]
    lines: list[Line] = field(default_factory=list)

    def next(self) -> Line:
        assert self.process.stdout is not None
        text = self.process.stdout.readline()
        if not text:
            raise EOFError(
                f"the reader has ended with {self.process.wait(5)}; last it said {self.lines[-3:]}"
            )
        self.lines.append(json.loads(text))
        return self.lines[-1]

    def until(self, condition: Callable[[Line], bool]) -> Line:
        """The first line from now on that fulfils the condition."""
        give_up = time.monotonic() + PATIENCE
        while not condition(line := self.next()):
            if time.monotonic() > give_up:
                raise TimeoutError(f"it says {line}")
        return line

    def frame(self) -> Line:
        return self.until(lambda line: "index" in line)

    def frames(self, count: int) -> list[Line]:
        return [self.frame() for _ in range(count)]

    def trouble(self, words: str) -> Line:
        return self.until(lambda line: words in line.get("trouble", ""))

    def note(self, words: str) -> Line:
        return self.until(lambda line: words in line.get("note", ""))

    @property
    def notes(self) -> list[str]:
        return [line["note"] for line in self.lines if "note" in line]

    def close(self) -> float:
        """How long the camera took to close, s."""
        assert self.process.stdin is not None
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        return self.until(lambda line: "closed_after" in line)["closed_after"]


@contextmanager
def watched(uri: str, *arguments: object, **environment: str) -> Iterator[Watch]:
    """A camera in a process of its own; arguments: width, height, rate and exposure as asked."""
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.vision.camera_reader", uri, *map(str, arguments)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, **environment},
    )
    with process:
        try:
            yield Watch(process)
        finally:
            process.kill()

"""A person's answers while something is held: waited for in short pieces, so that nothing else has to wait.

A plain read of the terminal that begins just after a signal came would sleep on with the coils under current.
"""

from __future__ import annotations

import io
import math
import os
import select
import sys
from collections.abc import Callable

import typer

from server.commands.outcome import console

PIECE = 0.1
"""Longest wait at once, s."""
MOST_BYTES = 4096


def one_line() -> str:
    """A line of standard input, "" at its end, and not a byte more: what follows is for others."""
    if sys.stdin is None:
        return ""
    try:
        source = sys.stdin.fileno()
    except io.UnsupportedOperation:
        return sys.stdin.readline()
    line = b""
    while not line.endswith(b"\n") and (letter := os.read(source, 1)):
        line += letter
    return line.decode(errors="replace")


class Answers:
    """Lines from standard input."""

    def __init__(self) -> None:
        self._rest = b""

    def number(self, question: str, is_held: Callable[[], bool]) -> float:
        """A finite number; `typer.Abort` when the input ends or what is measured is not held any more."""
        while True:
            typer.echo(f"{question}: ", nl=False, err=True)
            text = self._line(is_held)
            try:
                value = float(text)
            except ValueError:
                value = math.nan
            if math.isfinite(value):
                return value
            console.print(f"{text.strip()!r} is no number; type one such as -1.25", highlight=False)

    def _line(self, is_held: Callable[[], bool]) -> str:
        if sys.stdin is None:  # closed by who started the program
            raise typer.Abort
        try:
            source = sys.stdin.fileno()
        except io.UnsupportedOperation:  # an input without a file has its lines at once
            return self._whole(sys.stdin.readline().encode())
        while b"\n" not in self._rest:
            if not is_held():
                raise typer.Abort
            if select.select([source], [], [], PIECE)[0]:
                piece = os.read(source, MOST_BYTES)
                if not piece:
                    raise typer.Abort
                self._rest += piece
        line, _, self._rest = self._rest.partition(b"\n")
        return line.decode(errors="replace")

    @staticmethod
    def _whole(line: bytes) -> str:
        if not line:
            raise typer.Abort
        return line.decode()

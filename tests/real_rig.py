"""A rig that is not simulated, without one: a board behind a real serial port, and a film for a camera."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np

from tests.processes import started

SIZE = 64


@contextmanager
def real_rig(folder: Path) -> Iterator[Path]:
    """Its rig file; no robot is in the film."""
    film, rig_file = folder / "plate.avi", folder / "real.toml"
    _write_film(film)
    with started("control.simulation.board_process", "--control-port", "0", "--linger", "60") as (_, line):
        port = line.split()[1].removeprefix("serial=")
        rig_file.write_text(
            f'name = "Bench 3"\n[camera]\nuri = "file://{film}?loop=1"\nsize_px = [{SIZE}, {SIZE}]\nrate_Hz = 30.0\n'
            f'[link]\nport = "{port}"\n'
        )
        yield rig_file


def _write_film(path: Path) -> None:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 30.0, (SIZE, SIZE))
    for shade in range(30):
        writer.write(np.full((SIZE, SIZE, 3), 4 * shade, np.uint8))
    writer.release()

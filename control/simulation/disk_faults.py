"""Faults of the disk that recordings go to: full, read-only, slow. All switches are off at first."""

from __future__ import annotations

import errno
import os
import time
from collections.abc import Callable
from dataclasses import dataclass

LOOK = 0.005
"""A disk that makes its writer wait looks this often whether it may go on, s."""


@dataclass(slots=True)
class DiskFaults:
    """clock: of the rig, s.  full: nothing more fits.  read_only: nothing can be written or made.

    delay: until what was written is on the disk, s.
    """

    clock: Callable[[], float]
    full: bool = False
    read_only: bool = False
    delay: float = 0.0

    def check_writable(self) -> None:
        """Raises OSError as a read-only disk does."""
        if self.read_only:
            raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    def check_room(self) -> None:
        """Raises OSError as a full disk does."""
        if self.full:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def wait(self) -> None:
        """As long as a slow disk takes: by the rig's clock, but no longer than that by everybody's, since a rig that
        has been closed has no time any more. Taking the fault away ends it."""
        began, began_outside = self.clock(), time.monotonic()
        while self.clock() - began < self.delay and time.monotonic() - began_outside < self.delay:
            time.sleep(LOOK)

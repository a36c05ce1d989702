"""Keeps Python's search for garbage from holding the rig up.

A full search looks at every object of the program while no thread may run: 0.15 s with all that a server has loaded,
in which no command reaches the board. It comes when enough new objects have been made, so often just when a run
begins. What is there for as long as the program runs need not be looked at, and what comes later is little.
"""

from __future__ import annotations

import gc


def set_aside() -> None:
    """No later search looks at what there is now; takes as long as one full search, so no current may flow yet.

    An object that is set aside still goes when nothing refers to it any more, unless it is part of a circle.
    """
    gc.collect()
    gc.freeze()
    gc.collect()  # Python waits with the next one for a quarter as much again as this one has found: nothing

"""The rig file's [recording]: what is kept of each run, and for how long."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from server.section import Section

LARGEST_MB = 1_000_000
"""Of space that can be kept free: a terabyte."""


class RecordingSection(Section):
    """What is kept of each run; pinned runs are never deleted by themselves."""

    enabled: bool = True
    """Without it runs are listed, with their figures, and nothing else of them is kept."""
    frames_Hz: Annotated[float, Field(ge=0.0, le=240.0)] = 10.0
    """Pictures kept, at most the camera's own; 0: none."""
    quality: Annotated[int, Field(ge=10, le=100)] = 85
    """Of the pictures: JPEG's."""
    keep_free_MB: Annotated[int, Field(ge=0, le=LARGEST_MB)] = 500
    """With less than this free on the disk no run starts, and one that goes on ends."""
    keep_days: Annotated[float, Field(ge=0.0, le=36_500.0)] = 0.0
    """Older runs are deleted at start and after a run; 0: kept for ever."""
    keep_GB: Annotated[float, Field(ge=0.0, le=1e6)] = 0.0
    """The oldest runs are deleted while all recordings together are larger; 0: never."""

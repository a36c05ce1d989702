"""The folder where everything lives that pivotrig keeps: recordings, calibrations, the saved rig file."""

from __future__ import annotations

from pathlib import Path

import platformdirs

from server.rig_file import NAME


def data_folder(chosen: Path | None = None) -> Path:
    """The chosen folder, or the platform's for this user's data; it need not be there yet."""
    return chosen or Path(platformdirs.user_data_dir("pivotrig"))


def rig_path(chosen: Path | None, data: Path | None = None) -> Path:
    """The rig file that was named, or the place of the saved one."""
    return chosen or data_folder(data) / NAME

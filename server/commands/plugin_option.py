"""Controllers and trajectories of other people's, for the commands that take some."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from server.commands.outcome import USAGE, fail, warn

PluginOption = Annotated[
    list[Path] | None,
    typer.Option("--plugin", help="Python file with a controller or trajectory; may be given again."),
]


def load_plugins(files: list[Path] | None) -> None:
    """Installed plug-ins that are broken are left out with a word; a broken one that was asked for ends the command."""
    from control import plugins

    for problem in plugins.load_installed():
        warn(str(problem))
    for file in files or []:
        try:
            plugins.load_file(file)
        except plugins.PluginError as error:
            raise fail(str(error), USAGE) from error

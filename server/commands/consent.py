"""Nobody puts current into real coils without having been asked."""

from __future__ import annotations

from typing import Annotated

import typer

from server.commands.answers import one_line
from server.commands.outcome import REFUSED, console, fail
from server.settings import RigFile

YesOption = Annotated[
    bool,
    typer.Option("--yes", help="Consent to current through the coils of a real rig, instead of being asked."),
]


def ask_for_consent(rig_file: RigFile, *, yes: bool) -> bool:
    """True once the person at the terminal agrees, or has said --yes; a simulated rig needs none.

    Ends the command otherwise.
    """
    if rig_file.is_simulated or yes:
        return True
    console.print("This puts current through the coils of a real rig.", style="yellow")
    console.print("Hands, tools and cards are away from the coils, and somebody watches them? (y/N)", end=" ")
    if one_line().strip().lower() in ("y", "yes"):
        return True
    raise fail("nothing was driven; agree when asked, or say --yes", REFUSED)

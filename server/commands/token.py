"""`pivotrig token …`: make, list and revoke the tokens that let others in."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from server.access import tokens
from server.access.roles import Role
from server.commands.outcome import FAILED, DataOption, console, fail
from server.data_folder import data_folder

app = typer.Typer(
    no_args_is_help=True, help="Who may come in: one token a role, made anew whenever you like."
)


class RoleName(StrEnum):
    VIEWER = "viewer"
    OPERATOR = "operator"
    ADMIN = "admin"

    @property
    def role(self) -> Role:
        return Role[self.name]


RoleArgument = Annotated[RoleName, typer.Argument(help="What it lets its holder do.")]


@app.callback()
def token() -> None:
    """Who may come in: one token a role."""


@app.command()
def new(role: RoleArgument = RoleName.ADMIN, data: DataOption = None) -> None:
    """Print a new token of the role. The one before it, and all that it had opened, ends at once."""
    try:
        made = tokens.make(_file(data), role.role)
    except tokens.TokenFileError as error:
        raise fail(str(error), FAILED) from error
    console.print(f"The {role.value} token; it is shown this once, and only its digest is kept:")
    print(made)


@app.command()
def revoke(role: RoleArgument, data: DataOption = None) -> None:
    """Take the role's token away, and end all that it had opened."""
    try:
        was = tokens.revoke(_file(data), role.role)
    except tokens.TokenFileError as error:
        raise fail(str(error), FAILED) from error
    console.print(f"The {role.value} token is revoked." if was else f"There was no {role.value} token.")


@app.command("list")
def list_roles(data: DataOption = None) -> None:
    """Print the roles that have a token."""
    try:
        kept = tokens.load(_file(data))
    except tokens.TokenFileError as error:
        raise fail(str(error), FAILED) from error
    for role in sorted(kept):
        print(role.name.lower())


def _file(data: Path | None) -> Path:
    return data_folder(data) / tokens.FILE

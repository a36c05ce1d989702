"""Bring a catalogue of an older layout up to date, in the transaction that it is given."""

from __future__ import annotations

from pathlib import Path

from alembic import command
from alembic.config import Config
from sqlalchemy import Connection

FOLDER = Path(__file__).parent


def configuration() -> Config:
    configuration = Config()
    configuration.set_main_option("script_location", str(FOLDER).replace("%", "%%"))
    return configuration


def upgrade(connection: Connection) -> None:
    """All of it or, where it fails, nothing: SQLite changes tables in transactions, too."""
    found = configuration()
    found.attributes["connection"] = connection
    command.upgrade(found, "head")

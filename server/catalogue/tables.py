"""The tables of the catalogue."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import JSON, DateTime, Dialect, Double, ForeignKey, Index, String, TypeDecorator
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, relationship

REVISIONS = ("0001",)
"""The layouts that this program knows, oldest first: those under migrations/versions."""
VERSION = REVISIONS[-1]
"""A new catalogue is made in this layout at once."""
UNIX_YEAR = 1970


def utc(time: datetime) -> datetime:
    """The same instant in UTC; one that no calendar has there, in the first or the last year, is the nearest."""
    try:
        return time.astimezone(UTC)
    except OverflowError:
        return (datetime.min if time.year < UNIX_YEAR else datetime.max).replace(tzinfo=UTC)


class UtcTime(TypeDecorator[datetime]):
    """An aware time, kept as UTC text that sorts and that a person can read."""

    impl = DateTime
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002
        return None if value is None else utc(value).replace(tzinfo=None)

    def process_result_value(self, value: Any, dialect: Dialect) -> datetime | None:  # noqa: ARG002
        return None if value is None else value.replace(tzinfo=UTC)


class Base(DeclarativeBase):
    """What all tables are declared from."""


class RunRow(Base):
    """words: what free text is looked for in.  deleting: its recording is being removed; it is shown no more."""

    __tablename__ = "runs"

    id: Mapped[str] = mapped_column(String(80), primary_key=True)
    started_at: Mapped[datetime] = mapped_column(UtcTime)
    ended_at: Mapped[datetime | None] = mapped_column(UtcTime)
    state: Mapped[str] = mapped_column(String(20))
    reason: Mapped[str]
    label: Mapped[str]
    notes: Mapped[str]
    pinned: Mapped[bool]
    controller: Mapped[str]
    trajectory: Mapped[str]
    selection: Mapped[dict[str, Any]] = mapped_column(JSON)
    passes: Mapped[float] = mapped_column(Double)
    duration_s: Mapped[float | None] = mapped_column(Double)
    unattended: Mapped[bool]
    metrics: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    simulated: Mapped[bool]
    plant: Mapped[str]
    seed: Mapped[int | None]
    rig: Mapped[str]
    version: Mapped[str]
    study: Mapped[str]
    recording_state: Mapped[str] = mapped_column(String(20))
    size_bytes: Mapped[int]
    frames: Mapped[int]
    sparkline: Mapped[list[float]] = mapped_column(JSON)
    words: Mapped[str]
    deleting: Mapped[bool]
    tags: Mapped[list[TagRow]] = relationship(
        cascade="all, delete-orphan", order_by="TagRow.position", lazy="selectin", passive_deletes=True
    )


class TagRow(Base):
    __tablename__ = "run_tags"

    run_id: Mapped[str] = mapped_column(ForeignKey("runs.id", ondelete="CASCADE"), primary_key=True)
    tag: Mapped[str] = mapped_column(primary_key=True)
    position: Mapped[int]


class SettingsRow(Base):
    """What made a run: large, and wanted of one run at a time."""

    __tablename__ = "run_settings"

    run_id: Mapped[str] = mapped_column(ForeignKey("runs.id", ondelete="CASCADE"), primary_key=True)
    settings: Mapped[dict[str, Any]] = mapped_column(JSON)


class StudyRow(Base):
    """A series of runs; they name it in `runs.study`."""

    __tablename__ = "studies"

    id: Mapped[str] = mapped_column(String(80), primary_key=True)
    name: Mapped[str]
    definition: Mapped[dict[str, Any]] = mapped_column(JSON)
    state: Mapped[str] = mapped_column(String(20))
    created_at: Mapped[datetime] = mapped_column(UtcTime)


SHOWN = RunRow.deleting.is_(False)
"""What every query asks; the indexes hold nothing else."""

Index(
    "runs_newest_first",
    RunRow.started_at,
    RunRow.id,
    RunRow.state,
    RunRow.controller,
    RunRow.trajectory,
    RunRow.simulated,
    RunRow.pinned,
    RunRow.study,
    RunRow.words,
    sqlite_where=SHOWN,
)
"""Holds all that a query asks for, so that any filter reads this index alone, once, and never the wide rows."""
Index("runs_by_size", RunRow.pinned, RunRow.size_bytes, sqlite_where=SHOWN)
Index("tags_by_name", TagRow.tag, TagRow.run_id)

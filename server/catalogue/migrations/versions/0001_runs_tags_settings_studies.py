"""Runs with their tags and settings, and studies."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None


def upgrade() -> None:
    op.create_table(
        "runs",
        sa.Column("id", sa.String(80), primary_key=True),
        sa.Column("started_at", sa.DateTime, nullable=False),
        sa.Column("ended_at", sa.DateTime),
        sa.Column("state", sa.String(20), nullable=False),
        *(sa.Column(name, sa.String, nullable=False) for name in ("reason", "label", "notes")),
        sa.Column("pinned", sa.Boolean, nullable=False),
        sa.Column("controller", sa.String, nullable=False),
        sa.Column("trajectory", sa.String, nullable=False),
        sa.Column("selection", sa.JSON, nullable=False),
        sa.Column("passes", sa.Double, nullable=False),
        sa.Column("duration_s", sa.Double),
        sa.Column("unattended", sa.Boolean, nullable=False),
        sa.Column("metrics", sa.JSON),
        sa.Column("simulated", sa.Boolean, nullable=False),
        sa.Column("plant", sa.String, nullable=False),
        sa.Column("seed", sa.Integer),
        *(sa.Column(name, sa.String, nullable=False) for name in ("rig", "version", "study")),
        sa.Column("recording_state", sa.String(20), nullable=False),
        sa.Column("size_bytes", sa.Integer, nullable=False),
        sa.Column("frames", sa.Integer, nullable=False),
        sa.Column("sparkline", sa.JSON, nullable=False),
        sa.Column("words", sa.String, nullable=False),
        sa.Column("deleting", sa.Boolean, nullable=False),
    )
    op.create_table(
        "run_tags",
        sa.Column("run_id", sa.String(80), sa.ForeignKey("runs.id", ondelete="CASCADE"), primary_key=True),
        sa.Column("tag", sa.String, primary_key=True),
        sa.Column("position", sa.Integer, nullable=False),
    )
    op.create_table(
        "run_settings",
        sa.Column("run_id", sa.String(80), sa.ForeignKey("runs.id", ondelete="CASCADE"), primary_key=True),
        sa.Column("settings", sa.JSON, nullable=False),
    )
    op.create_table(
        "studies",
        sa.Column("id", sa.String(80), primary_key=True),
        sa.Column("name", sa.String, nullable=False),
        sa.Column("definition", sa.JSON, nullable=False),
        sa.Column("state", sa.String(20), nullable=False),
        sa.Column("created_at", sa.DateTime, nullable=False),
    )
    filtered = ("state", "controller", "trajectory", "simulated", "pinned", "study", "words")
    shown = sa.text("deleting IS 0")
    op.create_index("runs_newest_first", "runs", ["started_at", "id", *filtered], sqlite_where=shown)
    op.create_index("runs_by_size", "runs", ["pinned", "size_bytes"], sqlite_where=shown)
    op.create_index("tags_by_name", "run_tags", ["tag", "run_id"])

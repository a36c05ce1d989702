"""The catalogue's list of studies: which runs of a study belong together, and what they are called."""

from __future__ import annotations

from collections.abc import Collection

from sqlalchemy import delete, select

from server.catalogue.records import StudyRecord
from server.catalogue.sessions import Sessions
from server.catalogue.tables import StudyRow


class StudyList:
    """An index of the folders of the studies. Every method raises `CatalogueError` as the catalogue's do."""

    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions

    def put(self, record: StudyRecord) -> None:
        """A new study, or what has become of one."""
        with self._sessions.changing() as session:
            session.merge(
                StudyRow(
                    id=record.id,
                    name=record.name,
                    definition=record.definition,
                    state=record.state,
                    created_at=record.created_at,
                )
            )

    def all(self) -> list[StudyRecord]:
        """Newest first."""
        newest = select(StudyRow).order_by(StudyRow.created_at.desc(), StudyRow.id.desc())
        with self._sessions.reading() as session:
            return [
                StudyRecord(row.id, row.name, row.definition, row.state, row.created_at)
                for row in session.scalars(newest)
            ]

    def keep_only(self, ids: Collection[str]) -> None:
        """Studies whose folders are gone are listed no more."""
        with self._sessions.changing() as session:
            listed = set(session.scalars(select(StudyRow.id)))
            for id in listed.difference(ids):
                session.execute(delete(StudyRow).where(StudyRow.id == id))

    def delete(self, id: str) -> None:
        with self._sessions.changing() as session:
            session.execute(delete(StudyRow).where(StudyRow.id == id))

"""Catalogues for tests: a hundred thousand runs in some seconds, as a lab of many years would have them."""

from __future__ import annotations

import json
import random
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from datetime import UTC, datetime, timedelta
from multiprocessing.synchronize import Barrier
from pathlib import Path

from server.catalogue.catalogue import Catalogue
from server.catalogue.opening import NAME
from server.catalogue.records import RunRecord
from server.catalogue.rows import row_of
from server.catalogue.tables import RunRow

BEGINNING = datetime(2020, 1, 1, 8, 0, tzinfo=UTC)
CONTROLLERS = ("geometric", "gradient", "planner", "manual", "star")
TRAJECTORIES = ("eight", "circle", "line", "square", "spiral", "My path")
STATES = ("finished", "finished", "finished", "stopped", "aborted", "interrupted")
TAGS = ("paper", "slip", "demo", "student", "glass")
WORDS = ("first", "magnet", "new plate", "Größe", "oil", "dry", "repeat of last week", "careful")
METRICS = {"mean_error_mm": 1.234567, "normalized_mean_error": 0.123457, "duration_s": 125.66, "ticks": 7540}
SELECTION = {
    "controller": {"name": "geometric", "parameters": {"gain": 2.5, "lookahead_s": 0.4, "deadband_mm": 0.2}},
    "trajectory": {"name": "eight", "parameters": {"radius_mm": 21.0, "period_s": 125.66}},
    "gait": {"sweep_deg": 30.0, "tilt_deg": 25.0, "field_mT": 10.0, "max_rate_deg_s": 114.6},
}


def started(index: int) -> datetime:
    return BEGINNING + timedelta(minutes=11 * index)


def id_of(index: int) -> str:
    return f"{started(index):%Y%m%d-%H%M%S}-{index % 65536:04x}"


def record(index: int, **changes: object) -> RunRecord:
    """The `index`-th run of a lab that starts one every eleven minutes."""
    chance = random.Random(index)
    started_at = started(index)
    values: dict[str, object] = {
        "id": id_of(index),
        "started_at": started_at,
        "ended_at": started_at + timedelta(seconds=126),
        "state": chance.choice(STATES),
        "label": f"{chance.choice(WORDS)} {index}",
        "notes": " ".join(chance.choices(WORDS, k=12)) if index % 4 == 0 else "",
        "tags": tuple(chance.sample(TAGS, k=chance.randrange(3))),
        "pinned": index % 50 == 0,
        "controller": chance.choice(CONTROLLERS),
        "trajectory": chance.choice(TRAJECTORIES),
        "selection": SELECTION,
        "metrics": METRICS,
        "simulated": index % 3 != 0,
        "plant": "slip",
        "seed": index,
        "rig": "The paper's rig",
        "version": "0.1.0",
        "study": f"study-{index // 100}" if index % 2 else "",
        "recording_state": "complete",
        "size_bytes": 20_000_000 + index,
        "frames": 1250,
        "sparkline": tuple(round(chance.random() * 3.0, 3) for _ in range(60)),
    }
    return RunRecord(**{**values, **changes})  # type: ignore[arg-type]


KINDS = [record(index) for index in range(1000)]
NEWLINE = "\n"


def many(data: Path, runs: int) -> Catalogue:
    """A catalogue of that many runs, written past the catalogue's own one-by-one."""
    Catalogue.open(data).close()
    columns = [column.name for column in RunRow.__table__.columns]
    database = sqlite3.connect(data / NAME)
    database.execute("PRAGMA synchronous = OFF")
    with database:
        database.executemany(
            f"INSERT INTO runs VALUES ({', '.join(f':{name}' for name in columns)})", rows(runs, columns)
        )
        database.executemany("INSERT INTO run_tags VALUES (?, ?, ?)", tags(runs))
    database.close()
    return Catalogue.open(data)


def rows(runs: int, columns: list[str]) -> Iterator[dict[str, object]]:
    """Each run has the values of one of a thousand, and its own time, id and label."""
    kinds = [{name: stored(getattr(row, name)) for name in columns} for row in map(row_of, KINDS)]
    for index in range(runs):
        kind = kinds[index % len(KINDS)]
        id, started_at = id_of(index), stored(started(index))
        label = f"{kind['label']}.{index}"
        words = f" {id}\n {label.casefold()}\n{str(kind['words']).split(NEWLINE, 2)[2]}"
        yield {**kind, "id": id, "started_at": started_at, "label": label, "words": words}


def stored(value: object) -> object:
    if isinstance(value, datetime):
        return f"{value:%Y-%m-%d %H:%M:%S.%f}"
    return json.dumps(value) if isinstance(value, dict | list) else value


def tags(runs: int) -> Iterator[tuple[str, str, int]]:
    for index in range(runs):
        kind = KINDS[index % len(KINDS)]
        yield from ((id_of(index), tag, position) for position, tag in enumerate(kind.tags))


def schema(path: Path) -> list[tuple[str, str]]:
    with closing(sqlite3.connect(path)) as database:
        columns = "SELECT m.name, c.name || ' ' || c.type || ' ' || c.[notnull] || ' ' || c.pk"
        tables = f"{columns} FROM sqlite_master m, pragma_table_info(m.name) c"
        indexes = "SELECT name, sql FROM sqlite_master WHERE type = 'index' AND sql IS NOT NULL"
        return sorted((*database.execute(tables), *database.execute(indexes)))


def add_to(data: Path, index: int, together: Barrier, answers) -> None:
    """One of several programs that begin at once."""
    together.wait(timeout=30.0)
    catalogue = Catalogue.open(data)
    catalogue.add(record(index))
    catalogue.close()
    answers.put(catalogue.is_new)

"""What differs between two definitions of a study, in words."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from control.studies.definition import StudyDefinition

ABSENT = "not there"


def differences(before: StudyDefinition, now: StudyDefinition) -> list[str]:
    """`axes[0].values was [20, 25] and is [20]`, one for each value."""
    return list(_differences("", before.to_json(), now.to_json()))


def _differences(name: str, before: Any, now: Any) -> Iterator[str]:
    if before == now:
        return
    if isinstance(before, Mapping) and isinstance(now, Mapping):
        for key in dict.fromkeys((*before, *now)):
            yield from _differences(f"{name}.{key}" if name else key, before.get(key), now.get(key))
    elif _are_tables(before, now) and len(before) == len(now):
        for place, (one, other) in enumerate(zip(before, now, strict=True)):
            yield from _differences(f"{name}[{place}]", one, other)
    else:
        yield f"{name} was {_shown(before)} and is {_shown(now)}"


def _are_tables(before: Any, now: Any) -> bool:
    """Lists of tables, as the axes are."""
    return all(
        isinstance(each, Sequence) and not isinstance(each, str) and all(isinstance(x, Mapping) for x in each)
        for each in (before, now)
    )


def _shown(value: Any) -> str:
    return ABSENT if value is None else json.dumps(value, ensure_ascii=False)

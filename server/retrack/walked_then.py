"""What a recorded run was asked to do, as far as that is still possible."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pydantic import ValidationError

from control.registry import UnknownName
from control.runs import RunRequest, Selection
from server.api.choices import select
from server.api.problems import Rejected
from server.api.schemas import SelectionBody
from server.replay.then import exact_gait
from server.retrack.changes import RetrackError


def request_then(settings: Mapping[str, Any]) -> RunRequest:
    """What was asked for, by settings.json; raises `RetrackError` where that is lost or no longer possible."""
    try:
        run = settings["run"]
        parts = {name: run[name] for name in ("controller", "trajectory", "gait")}
        body = SelectionBody.model_validate_json(json.dumps(parts))
        selection = replace(select(body), gait=exact_gait(settings, body.gait))
        return RunRequest(selection, passes=float(run["passes"]), duration=run["duration_s"])
    except (KeyError, TypeError, ValidationError) as error:
        raise RetrackError("what this run was asked to do is lost, so no controller can be asked") from error
    except (Rejected, UnknownName) as error:
        raise RetrackError(f"what this run was asked to do is no longer possible: {error}") from error


def selection_of(message: Mapping[str, Any]) -> Selection:
    """Of a message of /selection; raises `RetrackError`."""
    try:
        body = SelectionBody.model_validate(
            {
                "gait": json.loads(message["gait"]),
                **{
                    part: {"name": message[part], "parameters": json.loads(message[f"{part}_parameters"])}
                    for part in ("controller", "trajectory")
                },
            }
        )
        return select(body)
    except (KeyError, TypeError, ValueError, Rejected) as error:
        raise RetrackError(f"what this run was changed to cannot be understood: {error}") from error

"""The OpenAPI document: FastAPI's, with every answer that a request may get, and what the most used ones hold."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from fastapi.routing import APIRoute
from pydantic import BaseModel, TypeAdapter

from server.access.guard import COOKIE
from server.access.policy import PREFIX, is_open
from server.api.document import answers

Json = dict[str, Any]

ANSWERS: dict[tuple[str, str], Any] = {
    ("get", "/health"): answers.Health,
    ("post", "/login"): answers.Role,
    ("get", "/state"): answers.State,
    ("post", "/arm"): answers.State,
    ("post", "/disarm"): answers.State,
    ("post", "/estop"): answers.State,
    ("post", "/reset"): answers.State,
    ("post", "/manual"): answers.State,
    ("get", "/events"): answers.EventPage,
    ("get", "/operator"): answers.Operator,
    ("post", "/operator"): answers.Operator,
    ("delete", "/operator"): answers.Operator,
    ("get", "/selection"): answers.Selection,
    ("put", "/selection"): answers.Selection,
    ("get", "/controllers"): list[answers.Kind],
    ("get", "/trajectories"): list[answers.Kind],
    ("post", "/trajectories/preview"): answers.Preview,
    ("post", "/runs"): answers.Run,
    ("patch", "/runs/current"): answers.Run,
    ("get", "/runs"): answers.RunPage,
    ("get", "/runs/{run_id}"): answers.Run,
}

FILES = {
    "csv": "text/csv",
    "parquet": "application/vnd.apache.parquet",
    "mat": "application/x-matlab-data",
    "mcap": "application/octet-stream",
    "png": "image/png",
    "svg": "image/svg+xml",
    "mp4": "video/mp4",
    "toml": "application/toml",
    "zip": "application/zip",
    "mjpg": "multipart/x-mixed-replace",
    "report": "text/html",
}
"""Content of a place by how its address ends."""

REFUSALS = {
    400: "The request cannot be read.",
    401: "A token is needed, or this one is wrong.",
    403: "Not your role, not from here, or not under this name.",
    404: "There is no such thing.",
    408: "The body did not come in time.",
    409: "Not now: an interlock, another state, or somebody else operates. The detail says what to do.",
    413: "The body is too large.",
    415: "The body is not JSON.",
    422: "A field is not acceptable; nothing has been changed.",
    429: "Too many requests or wrong tokens; Retry-After says how long to wait.",
    503: "Not at this moment: no picture, no catalogue, or the server is going down.",
}
OF_A_BODY = frozenset({400, 408, 413, 415})

SECURITY = {
    "bearer": {"type": "http", "scheme": "bearer", "description": "For scripts; from `pivotrig token new`."},
    "session": {
        "type": "apiKey",
        "in": "cookie",
        "name": COOKIE,
        "description": "For browsers; from /login.",
    },
}

DESCRIPTION = f"""
See, control and record a magnetic pivot walker.

Errors are problem documents (RFC 9457). Unknown fields are refused, and numbers are finite. On loopback no token is
needed; elsewhere send `Authorization: Bearer TOKEN`. Name yourself with the header `X-Client`: one client operates the
rig at a time, and every call of yours is a sign of life; an attended run is held when you are not heard for 2 s.

WebSockets, which this document cannot describe: `{PREFIX}/telemetry` (text: `tick`, `event`, `run`, `rig`, `operator`,
`server`, `clock`; `?rate_Hz=` up to 30, `?client=` your name), `{PREFIX}/camera?view=raw|overlay|mask` (one JPEG, then
the newest after each message of yours), `{PREFIX}/replay` and `/scene`.
"""


def operation_id(route: APIRoute) -> str:
    """From the route's room and function, so that a generated client reads like the interface."""
    room = str(route.tags[0]).replace(" ", "_") if route.tags else "pivotrig"
    return f"{room}_{route.name}"


def install(app: FastAPI) -> None:
    app.description = DESCRIPTION

    def document() -> Json:
        if app.openapi_schema is None:
            app.openapi_schema = completed(
                get_openapi(title=app.title, version=app.version, description=DESCRIPTION, routes=app.routes)
            )
        return app.openapi_schema

    app.openapi = document  # type: ignore[method-assign]


def completed(document: Json) -> Json:
    components = document.setdefault("components", {})
    schemas = components.setdefault("schemas", {})
    components["securitySchemes"] = SECURITY
    components["responses"] = {f"Refused{status}": refusal(words) for status, words in REFUSALS.items()}
    schemas["Problem"] = schema_of(answers.Problem, schemas)
    for place, method, operation in operations(document):
        describe(operation, method, place, schemas)
    return document


def operations(document: Json) -> Iterator[tuple[str, str, Json]]:
    for place, methods in document["paths"].items():
        for method, operation in methods.items():
            yield place, method, operation


def describe(operation: Json, method: str, place: str, schemas: Json) -> None:
    operation["security"] = [] if is_open(place) else [{"bearer": []}, {"session": []}, {}]
    found: Json = operation["responses"]
    success = next(status for status in found if status.startswith("2"))
    kind = ANSWERS.get((method, place.removeprefix(PREFIX)))
    if kind is not None:
        schema = schema_of(kind, schemas)
        for status in [each for each in found if each.startswith("2")]:
            found[status]["content"] = {"application/json": {"schema": schema}}
    elif (ending := place.rsplit(".", 1)[-1].rsplit("/", 1)[-1]) in FILES:
        found[success]["content"] = {FILES[ending]: {"schema": {"type": "string", "format": "binary"}}}
    elif success != "204" and not found[success].get("content"):
        found[success]["content"] = {"application/json": {"schema": {"type": "object"}}}
    for status in REFUSALS:
        known = str(status) in found and "application/json" in found[str(status)].get("content", {})
        if not known and (status not in OF_A_BODY or method != "get"):
            found[str(status)] = {"$ref": f"#/components/responses/Refused{status}"}


def refusal(words: str) -> Json:
    problem = {"$ref": "#/components/schemas/Problem"}
    return {"description": words, "content": {"application/problem+json": {"schema": problem}}}


def schema_of(kind: Any, schemas: Json) -> Json:
    """A reference to the model's schema, which is put among `schemas` with those that it is made of."""
    made = TypeAdapter(kind).json_schema(ref_template="#/components/schemas/{model}", mode="serialization")
    schemas.update(made.pop("$defs", {}))
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        schemas[kind.__name__] = made
        return {"$ref": f"#/components/schemas/{kind.__name__}"}
    return made

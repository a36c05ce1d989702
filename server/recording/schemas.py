"""JSON schemas of what is recorded, made of the message types, in the plain subset that Foxglove understands.

No references, no alternatives: a value that may be unknown is left out of its message instead.
"""

from __future__ import annotations

from typing import Any

import msgspec
from msgspec import Meta

Schema = dict[str, Any]

NO_UNIT = "1"
"""The unit of counts, ratios and words."""


def quantity(description: str, unit: str = NO_UNIT, length: int | None = None) -> Meta:
    """What a field means, in which unit; length: of an array."""
    extra = {"unit": unit}
    return Meta(description=description, extra_json_schema=extra, min_length=length, max_length=length)


def schema_of(kind: type[msgspec.Struct]) -> Schema:
    """The schema of a message type; what has a default may be missing."""
    whole = msgspec.json.schema(kind)
    return {"$schema": "http://json-schema.org/draft-07/schema#", **_plain(whole, whole.get("$defs", {}))}


def _plain(schema: Schema, definitions: Schema) -> Schema:
    """With references put in place, and without the alternative of being null."""
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        own = {key: value for key, value in schema.items() if key not in ("$ref", "$defs")}
        return {**_plain(definitions[name], definitions), **own}
    if "anyOf" in schema:
        (known,) = (each for each in schema["anyOf"] if each != {"type": "null"})
        own = {key: value for key, value in schema.items() if key not in ("anyOf", "default")}
        return {**_plain(known, definitions), **own}
    plain = {key: value for key, value in schema.items() if key not in ("$defs", "default")}
    if "properties" in plain:
        named = plain["properties"].items()
        plain["properties"] = {name: _plain(each, definitions) for name, each in named}
    if plain.get("items"):
        plain["items"] = _plain(plain["items"], definitions)
    return plain

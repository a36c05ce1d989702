"""The rig file as a JSON schema that a form can be made from: titles, units, ranges, defaults, what may change when.

Units stand in the names of the fields (style of the whole rig file); here they become `unit`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from typing import Any

from server.rig_changes import LIVE
from server.settings import RigFile
from vision.simulated.scene_names import FOR_ANY_LENS

UNITS = {
    "A_s": "A/s", "deg_s": "°/s", "mm_rad": "mm/rad", "mA_per_count": "mA per count", "mA_m2": "mA·m²",
    "px_mm": "px/mm",    "mm2": "mm²", "ohm": "Ω", "deg": "°", "percent": "%", "days": "days",
    **{unit: unit for unit in ("mm", "mT", "mH", "mg", "mN", "ms", "px", "Hz", "MB", "GB", "A", "V", "W", "K", "s")},
}  # fmt: skip
"""Endings of names and the units they stand for; the longer ones first."""
TITLES = {
    "uri": "Source", "baud": "Baud rate", "on": "Tell of", "webhook_url": "Webhook", "keep_free": "Keep free",
    "x": "x", "y": "y", "sense": "Current sense", "continuous": "Continuous current", "timeout": "Time-out",
    "quality": "JPEG quality", "frames": "Pictures kept", "keep": "Keep at most", "rate": "Rate", "size": "Picture",
}  # fmt: skip
"""Of names that say little by themselves."""
LABELS = {
    "on": ("faults", "the end of a study", "the end of an unattended run"),
    "current_A": "xyz", "current_slew_A_s": "xyz", "continuous_A": "xyz", "heat_time_constant_s": "xyz",
    "wiring": "xyz", "field_gain": "xyz", "size_px": ("width", "height"), "hue_deg": ("from", "to"),
    "saturation": ("from", "to"), "value": ("from", "to"), "area_mm2": ("from", "to"),
    "tilt_deg": ("about x", "about y"), "distortion": ("k1", "k2", "p1", "p2", "k3"),
    "sense_mA_per_count": ("positive", "negative"),
}  # fmt: skip
"""What the numbers of a list are."""
FOUND = {
    "camera.lens", "camera.plane", "vision.profiles", "vision.end_mark", "simulation.registration",
    "camera.latency_source", "coils.field_source", "gait.source", "version",
}  # fmt: skip
"""What a calibration writes, and no form does."""
SECTIONS = {
    "robot": "Robot", "coils": "Coils", "limits": "Limits", "camera": "Camera", "link": "Board and link",
    "vision": "Vision", "estimator": "Estimator", "gait": "Gait", "recording": "Recording",
    "notifications": "Notifications", "simulation": "Simulation",
}  # fmt: skip


@cache
def rig_schema() -> dict[str, Any]:
    """Whole, without references. Each value has a `title` and a `default`, and a `unit` and `labels` where it has any.

    live: it may change in any state; else the rig must be disarmed.  found: a calibration writes it.
    """
    raw = RigFile.model_json_schema()
    defaults = RigFile().model_dump(mode="json")
    return _described("", raw, raw["$defs"], defaults)


def _described(path: str, node: Mapping[str, Any], known: Mapping[str, Any], default: Any) -> dict[str, Any]:
    plain = _resolved(node, known)
    name = path.rpartition(".")[2]
    described = {
        key: value
        for key, value in plain.items()
        if key not in ("$defs", "properties", "required", "additionalProperties")
    }
    described |= _words(path, name, plain)
    if "properties" in plain and path not in FOUND:
        described.pop("default", None)
        described["properties"] = {
            field: _described(f"{path}.{field}".lstrip("."), child, known, _part(default, field))
            for field, child in plain["properties"].items()
        }
        return described
    described["default"] = default
    described["live"] = path in LIVE
    described["found"] = path in FOUND
    if name in LABELS and plain.get("type") == "array":
        described["labels"] = list(LABELS[name])
    if path == "simulation.scene":
        described["enum"] = list(FOR_ANY_LENS)
    return described


def _words(path: str, name: str, node: Mapping[str, Any]) -> dict[str, Any]:
    stem, unit = _without_unit(name)
    given = None if node.get("title") in (None, _pydantic_title(name)) or path in SECTIONS else node["title"]
    words = {
        "title": SECTIONS.get(path) or given or TITLES.get(stem) or TITLES.get(name) or _sentence(stem),
        "description": " ".join(node.get("description", "").split()),
    }
    unit = node.get("unit", unit)
    return {**words, "unit": unit} if unit else words


def _pydantic_title(name: str) -> str:
    return name.replace("_", " ").title()


def _without_unit(name: str) -> tuple[str, str]:
    ending = next((ending for ending in UNITS if name.endswith(f"_{ending}")), "")
    return (name.removesuffix(f"_{ending}"), UNITS[ending]) if ending else (name, "")


def _sentence(name: str) -> str:
    text = re.sub(r"_+", " ", name).strip()
    return text[:1].upper() + text[1:]


def _part(value: Any, name: str) -> Any:
    return value.get(name) if isinstance(value, Mapping) else None


def _resolved(node: Mapping[str, Any], known: Mapping[str, Any]) -> dict[str, Any]:
    """Without references; a value that may be left out is `optional`, and else what it is when it is there."""
    if "$ref" in node:
        target = known[node["$ref"].rpartition("/")[2]]
        return {**_resolved(target, known), **{key: value for key, value in node.items() if key != "$ref"}}
    variants = node.get("anyOf")
    if variants is None:
        items = {key: _resolved(node[key], known) for key in ("items",) if isinstance(node.get(key), Mapping)}
        prefix = (
            {"prefixItems": [_resolved(each, known) for each in node["prefixItems"]]}
            if "prefixItems" in node
            else {}
        )
        return {**node, **items, **prefix}
    first = next(variant for variant in variants if variant.get("type") != "null")
    rest = {key: value for key, value in node.items() if key != "anyOf"}
    return {**_resolved(first, known), **rest, "optional": True}

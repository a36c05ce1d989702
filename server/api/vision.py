"""What the robot looks like: colours by a click on it, one profile for each light, and which blob is meant."""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping
from typing import Annotated, Any

from fastapi import APIRouter, Depends
from pydantic import Field
from starlette.requests import HTTPConnection

from control.safety import Refused
from server.api.access import TheChanges, TheRig
from server.api.body import StrictRoute
from server.api.operator import TheHand
from server.api.problems import Problem, Rejected, invalid_field, not_found
from server.api.rig_file import served, told
from server.api.schemas import Edge
from server.colour_picker import ColourPicker, NoPicture
from server.lease.desk import Hand
from server.rig import Rig
from server.rig_changes import RigChanges
from server.vision_section import DEFAULT_PROFILE, ColourSection, ProfileName, VisionSection
from server.vision_settings import colour_section
from vision.encoding import encode_mask
from vision.tracking.picking import Part, PickError, Proposal

router = APIRouter(prefix="/vision", tags=["vision"], route_class=StrictRoute)

MM2 = 1e-6
Pixel = Annotated[float, Field(ge=-0.5, le=8192.0)]
Hues = Annotated[list[Annotated[float, Field(ge=0.0, le=360.0)]], Field(min_length=2, max_length=2)]
Levels = Annotated[list[Annotated[int, Field(ge=0, le=255)]], Field(min_length=2, max_length=2)]
Areas = Annotated[
    list[Annotated[float, Field(gt=0.0, le=10_000.0)]],
    Field(min_length=2, max_length=2, json_schema_extra={"unit": "mm²"}),
]


class ColourBody(Edge):
    """Thresholds; a low hue above the high one means the way through red."""

    hue_deg: Hues
    saturation: Levels
    value: Levels


class VisionChange(Edge):
    """What is left out stays as it is. The colours are those of the profile in use, or of the one switched to."""

    profile: ProfileName | None = None
    colour: ColourBody | None = None
    end_mark: ColourBody | None = Field(default=None, description="null: the robot bears no mark.")
    area_mm2: Areas | None = None
    heading_hint_deg: Annotated[float, Field(ge=-360.0, le=360.0)] | None = None


class PlaceBody(Edge):
    """A place in the picture, px."""

    u: Pixel
    v: Pixel


class PickBody(PlaceBody):
    part: Part = "body"


class ProfileBody(Edge):
    name: ProfileName


async def the_picker(connection: HTTPConnection) -> ColourPicker:
    return connection.app.state.colour_picker


ThePicker = Annotated[ColourPicker, Depends(the_picker)]


@router.get("")
async def looks(rig: TheRig) -> dict[str, Any]:
    """What the robot is looked for by, and whether it is seen."""
    return vision_json(rig)


@router.patch("")
async def alter(body: VisionChange, rig: TheRig, changes: TheChanges, hand: TheHand) -> dict[str, Any]:
    """Use other colours, sizes or another profile from the next frame on, and save them; on a disarmed rig."""
    await save(changes, lambda vision: changed(body, vision), hand)
    return vision_json(rig)


@router.post("/pick")
async def pick_colour(body: PickBody, picker: ThePicker) -> dict[str, Any]:
    """What was clicked on in the newest picture, as thresholds that would find it; changes nothing."""
    try:
        proposal = await picker.pick((body.u, body.v), body.part)
    except NoPicture as error:
        raise Rejected(Problem(503, "No picture", str(error))) from error
    except PickError as error:
        raise Rejected(invalid_field(("u",), str(error))) from error
    return proposal_json(proposal)


@router.post("/profiles", status_code=201)
async def save_profile(body: ProfileBody, rig: TheRig, changes: TheChanges, hand: TheHand) -> dict[str, Any]:
    """Save the colours in use under a name, and use them by it from now on."""
    await save(changes, lambda vision: with_profile(body.name, vision), hand)
    return vision_json(rig)


@router.delete("/profiles/{name}")
async def delete_profile(name: str, rig: TheRig, changes: TheChanges, hand: TheHand) -> dict[str, Any]:
    """Forget a profile that is not in use."""
    await save(changes, lambda vision: without_profile(name, vision), hand)
    return vision_json(rig)


@router.post("/follow")
async def follow(body: PlaceBody, rig: TheRig, hand: TheHand) -> dict[str, Any]:
    """The robot is there in the picture; blobs elsewhere are others. While the rig is disarmed or held."""
    width, height = rig.machine.camera_model.size
    if not (body.u <= width - 0.5 and body.v <= height - 0.5):
        words = f"({body.u:g}, {body.v:g}) px is outside the picture, which is {width}x{height} px"
        raise Rejected(invalid_field(("u",), words))
    await rig.follow(body.u, body.v, hand.require)
    return vision_json(rig)


async def save(
    changes: RigChanges | None, make: Callable[[VisionSection], Mapping[str, Any]], hand: Hand
) -> None:
    """make: of the rig file's [vision] as it is when no other change is under way, what changes in it."""
    with told():
        await served(changes).alter(lambda settings: {"vision": make(settings.vision)}, hand.require)


def with_profile(name: str, vision: VisionSection) -> dict[str, Any]:
    """The colours in use under a new name, and in use by it; raises `Refused`."""
    if name == DEFAULT_PROFILE or name in vision.profiles:
        raise Refused(f'there is a profile "{name}" already; choose another name, or delete it first')
    colours = vision.in_use.model_dump(mode="json", include={*ColourSection.model_fields, "end_mark"})
    return {"profile": name, "profiles": {name: colours}}


def without_profile(name: str, vision: VisionSection) -> dict[str, Any]:
    """Raises `Refused` for one that must stay."""
    if name == DEFAULT_PROFILE:
        raise Refused(f'"{DEFAULT_PROFILE}" stands for the colours of the rig file\'s [vision] and stays')
    if name not in vision.profiles:
        there = ", ".join([DEFAULT_PROFILE, *vision.profiles])
        raise not_found(f'There is no profile "{name}"; there are: {there}.')
    if name == vision.profile:
        raise Refused(f'the profile "{name}" is in use; switch to another one first')
    return {"profiles": {name: None}}


def changed(body: VisionChange, vision: VisionSection) -> dict[str, Any]:
    """The rig file's [vision] as the body wants it: only what differs."""
    values = body.model_dump(mode="json", exclude_unset=True)
    colours = values.pop("colour", None) or {}
    if "end_mark" in values:
        colours["end_mark"] = values.pop("end_mark")
    result = {name: value for name, value in values.items() if value is not None}
    profile = result.get("profile", vision.profile)
    if profile == DEFAULT_PROFILE:
        return {**result, **colours}
    if profile not in vision.profiles:
        there = ", ".join([DEFAULT_PROFILE, *vision.profiles])
        raise Rejected(invalid_field(("profile",), f'there is no profile "{profile}"; there are: {there}'))
    return {**result, "profiles": {profile: colours}} if colours else result


def vision_json(rig: Rig) -> dict[str, Any]:
    vision, snapshot = rig.settings.vision, rig.snapshot
    in_use, observation = vision.in_use, snapshot.observation
    return {
        "profile": vision.profile,
        "profiles": [DEFAULT_PROFILE, *sorted(vision.profiles)],
        "colour": colour_json(in_use),
        "end_mark": None if in_use.end_mark is None else colour_json(in_use.end_mark),
        "area_mm2": list(vision.area_mm2),
        "heading_hint_deg": vision.heading_hint_deg,
        "latency_ms": rig.settings.camera.latency_ms,
        "tracking": snapshot.tracking,
        "reason": "" if observation is None else observation.reason,
    }


def colour_json(section: ColourSection) -> dict[str, Any]:
    return section.model_dump(mode="json", include={"hue_deg", "saturation", "value"})


def proposal_json(proposal: Proposal) -> dict[str, Any]:
    area = proposal.region.area_min, proposal.region.area_max
    return {
        "colour": colour_json(colour_section(proposal.colour)),
        "area_mm2": [round(end / MM2, 2) for end in area],
        "separation": round(proposal.separation, 3),
        "light_change": proposal.light_change,
        "warnings": list(proposal.warnings),
        "box_px": list(proposal.box),
        "mask_png": "data:image/png;base64," + base64.b64encode(encode_mask(proposal.mask)).decode("ascii"),
    }

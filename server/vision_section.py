"""The rig file's [vision]: which colours the robot has, in each light that has a profile of its own, and its size."""

from __future__ import annotations

import re
from typing import Annotated, Self

from pydantic import AfterValidator, Field, model_validator

from server.section import Positive, Section

HueSpan = tuple[Annotated[float, Field(ge=0, le=360)], Annotated[float, Field(ge=0, le=360)]]
LevelSpan = tuple[Annotated[int, Field(ge=0, le=255)], Annotated[int, Field(ge=0, le=255)]]


class ColourSection(Section):
    """Thresholds: hue 0..360 degrees, the low end above the high one through red; the rest 0..255, low to high."""

    hue_deg: HueSpan = (340.0, 20.0)
    saturation: LevelSpan = (110, 255)
    value: LevelSpan = (60, 255)

    @model_validator(mode="after")
    def _from_low_to_high(self) -> Self:
        for name, (low, high) in (("saturation", self.saturation), ("value", self.value)):
            if not low <= high:
                raise ValueError(f"{name} must go from low to high, not [{low}, {high}]")
        return self


class ProfileSection(ColourSection):
    """The robot's colours in one light. end_mark: of the mark on its end A, if it bears one."""

    end_mark: ColourSection | None = None


DEFAULT_PROFILE = "default"
"""Name of the colours that stand in [vision] itself."""
_NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9 _-]{0,38}[A-Za-z0-9_-])?")


def _plain(name: str) -> str:
    if not _NAME.fullmatch(name):
        raise ValueError(
            "a profile's name has 1 to 40 letters a-z, digits, spaces, - and _, the first one a letter or a digit and "
            "the last one no space"
        )
    return name


ProfileName = Annotated[str, AfterValidator(_plain)]


class VisionSection(ProfileSection):
    """Which colour is the robot, in each light that has a profile of its own, and how big it is."""

    profile: ProfileName = DEFAULT_PROFILE
    """The colours in use: "default" for those of this section, or one of the profiles."""
    profiles: dict[ProfileName, ProfileSection] = Field(default={}, max_length=30)
    area_mm2: tuple[Positive, Positive] = (12.0, 90.0)
    heading_hint_deg: Annotated[float, Field(ge=-360, le=360)] = 90.0
    """Which way the robot is put down: tells its two ends apart at the first sighting."""
    heading_offset_deg: Annotated[float, Field(ge=-45.0, le=45.0)] = 0.0
    """From the heading that the coloured body shows to that of the pivots, from `pivotrig calibrate gait`."""

    @property
    def in_use(self) -> ProfileSection:
        """The colours that the robot is looked for with."""
        return self if self.profile == DEFAULT_PROFILE else self.profiles[self.profile]

    @model_validator(mode="after")
    def _profile_is_there(self) -> Self:
        if DEFAULT_PROFILE in self.profiles:
            raise ValueError(
                f'"{DEFAULT_PROFILE}" is the colour of [vision] itself: give the profile another name'
            )
        if self.profile != DEFAULT_PROFILE and self.profile not in self.profiles:
            there = ", ".join([DEFAULT_PROFILE, *self.profiles])
            raise ValueError(f'there is no profile "{self.profile}"; there are: {there}')
        return self

    @model_validator(mode="after")
    def _area_goes_from_low_to_high(self) -> Self:
        if not self.area_mm2[0] < self.area_mm2[1]:
            raise ValueError(f"area_mm2 must go from low to high, not {list(self.area_mm2)}")
        return self

"""The rig file: one lab's rig in one TOML file, lab units in the names, validated whole.

The defaults are the paper's rig, simulated (paper, section 6; what is assumed there is assumed here).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError, field_validator, model_validator

from control.simulation.wiring import Wiring
from server.camera_sections import BoardSection, LensSection, PlaneSection
from server.section import Positive, Section
from server.vision_section import VisionSection
from vision.simulated.scenes import FOR_ANY_LENS
from vision.sources.addresses import shown

MM = 1e-3
MS = 1e-3

FORMAT = 1
"""Version of the rig file's layout that this program reads and writes."""

Sigma = Annotated[float, Field(gt=0.0, le=1000.0)]
PerCoil = Annotated[list[Annotated[float, Field(gt=0.0, le=30.0)]], Field(min_length=3, max_length=3)]
"""A VNH5019 carries 30 A for a moment and 12 A for long."""


Lead = Literal["x", "y", "z", "-x", "-y", "-z"]


LIVE = ("v4l:", "rtsp:", "http:", "https:")
"""How the addresses of cameras begin whose frames bear the time of their arrival; a recording has its own."""
NOT_MEASURED = "not measured"
"""What stands for the source of figures that are assumed."""


class Robot(Section):
    """length: between the two pivots; the body is what the camera sees."""

    length_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 10.0
    body_length_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 10.0
    body_width_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 4.0
    body_height_mm: Annotated[float, Field(ge=0.0, le=50.0)] = 3.0
    lift_ratio: Annotated[float, Field(gt=0.0, le=1000.0)] = 3.2
    """2 m B / (W L): magnet torque over weight; decides how far the free end lifts."""


SenseGain = Annotated[float, Field(ge=17.5, le=43.5)]
"""The driver's 34.88 mA per count of the UNO's ADC is known to be off by up to 25 %."""


class Coil(Section):
    diameter_mm: Positive
    separation_mm: Positive
    turns: Annotated[int, Field(gt=0)]
    resistance_ohm: Positive
    inductance_mH: Positive
    sense_mA_per_count: tuple[SenseGain, SenseGain] = (34.88, 34.88)
    """Of the bridge's current sense, for positive and for negative current."""
    field_gain: Annotated[float, Field(ge=0.2, le=5.0)] = 1.0
    """Measured field over the geometry's, from `pivotrig calibrate coils`."""


class RegistrationSection(Section):
    """Where the coils stand in the camera's workspace, from `pivotrig calibrate registration`."""

    x_mm: Annotated[float, Field(ge=-200.0, le=200.0)] = 0.0
    """The coils' centre."""
    y_mm: Annotated[float, Field(ge=-200.0, le=200.0)] = 0.0
    rotation_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 0.0
    """From the workspace's x axis to that of the x coils, counter-clockwise."""
    magnet_reversed: bool = False
    """The magnet's north is at end B."""


class Coils(Section):
    """Outer diameters and separations are the paper's; turns, resistances and inductances are assumed."""

    x: Coil = Coil(diameter_mm=390, separation_mm=240, turns=314, resistance_ohm=2.5, inductance_mH=125)
    y: Coil = Coil(diameter_mm=305, separation_mm=190, turns=248, resistance_ohm=2.0, inductance_mH=55)
    z: Coil = Coil(diameter_mm=225, separation_mm=110, turns=154, resistance_ohm=1.5, inductance_mH=14)
    supply_V: Annotated[float, Field(gt=0.0, le=60.0)] = 24.0
    supply_full_scale_V: Annotated[float, Field(ge=0.0, le=65.0)] = 55.0
    """The supply that fills the board's ADC: 5 V times the divider on A5; 0 where none is wired."""
    allocation: Literal["local", "centre"] = "local"
    """local: field and tilt hold over the whole plate; centre: the paper's, exact at the centre only."""
    field_source: Annotated[str, Field(max_length=120)] = "geometry"
    """Where the field gains come from: the geometry, or the date and the residual of a measurement."""
    registration: RegistrationSection = RegistrationSection()


class LimitsSection(Section):
    """What one coil, all of them, the robot and its field may do; what is heard of them is held against it."""

    current_A: PerCoil = Field(default=[8.0, 8.0, 8.0])
    power_W: Annotated[float, Field(gt=0.0, le=10_000.0)] = 300.0
    """Heat of all coils together: what a 24 V supply of 12.5 A gives (assumed)."""
    current_slew_A_s: Annotated[
        list[Annotated[float, Field(gt=0.0, le=1e6)]], Field(min_length=3, max_length=3)
    ] = Field(default=[192.0, 436.0, 1714.0])
    """V / L of each coil at 24 V: no bridge of that supply changes its current faster."""
    continuous_A: PerCoil = Field(default=[9.0, 7.9, 6.1])
    """What each coil bears for ever, 40 K above the room; estimated from its size and wire."""
    heat_time_constant_s: Annotated[
        list[Annotated[float, Field(ge=1.0, le=1e6)]], Field(min_length=3, max_length=3)
    ] = Field(default=[2700.0, 2100.0, 1300.0])
    field_mT: Annotated[float, Field(gt=0.0, le=50.0)] = 15.0
    rate_deg_s: Annotated[float, Field(gt=0.0, le=3600.0)] = 360.0
    workspace_mm: Annotated[float, Field(gt=0.0, le=1000.0)] = 120.0
    soft_margin_mm: Annotated[float, Field(ge=0.0, le=100.0)] = 2.0
    """How far outside the workspace the robot's centre may be driven."""
    hard_margin_mm: Annotated[float, Field(ge=0.0, le=100.0)] = 8.0
    """How far outside the workspace the coils are switched off."""

    @model_validator(mode="after")
    def _margins_are_ordered(self) -> LimitsSection:
        if self.soft_margin_mm > self.hard_margin_mm:
            raise ValueError(
                f"soft_margin_mm ({self.soft_margin_mm}) must not exceed hard_margin_mm ({self.hard_margin_mm})"
            )
        return self


SIMULATED_CAMERA = "simulated camera"
"""The identity of the camera that is none."""


class CameraSection(Section):
    """Where the pictures come from, and a camera that looks straight down until it is calibrated."""

    uri: str = "sim://"
    size_px: tuple[Annotated[int, Field(ge=64, le=8192)], Annotated[int, Field(ge=64, le=8192)]] = (640, 480)
    rate_Hz: Annotated[float, Field(ge=1.0, le=500.0)] = 60.0
    exposure_ms: Annotated[float, Field(ge=0.05, le=1000.0)] | None = None
    """Of a real camera, like the next two; without it, it is the camera's own automatic."""
    gain: Annotated[float, Field(ge=0.0, le=100_000.0)] | None = None
    """In the steps of the camera's driver."""
    white_balance_K: Annotated[float, Field(ge=1000.0, le=20_000.0)] | None = None
    height_mm: Annotated[float, Field(gt=0.0, le=10_000.0)] = 350.0
    picture_height_mm: Annotated[float, Field(gt=0.0, le=10_000.0)] = 130.0
    """Length on the plate that fills the picture's height."""
    tilt_deg: tuple[Annotated[float, Field(ge=-30, le=30)], Annotated[float, Field(ge=-30, le=30)]] = (
        1.5,
        0.0,
    )
    distortion: tuple[float, float, float, float, float] = (-0.12, 0.02, 0.0, 0.0, 0.0)
    latency_ms: Annotated[float, Field(ge=0.0, le=200.0)] = 0.0
    """From mid-exposure to the time that a frame is stamped with; subtracted from the stamps."""
    latency_source: Annotated[str, Field(max_length=120)] = NOT_MEASURED
    """Where the latency comes from: the date and the standard error of a measurement."""
    lens: LensSection | None = None
    """Without it, as assumed above."""
    plane: PlaneSection | None = None
    """Without it, the camera hangs as assumed above."""
    board: BoardSection = BoardSection()


class LinkSection(Section):
    port: str = "sim://"
    """A device, best by its lasting name under /dev/serial/by-id; "auto" is the one board that is plugged in."""
    baud: Annotated[int, Field(ge=9600, le=2_000_000)] = 500_000
    dead_man_ms: Annotated[int, Field(ge=20, le=500)] = 200
    time_to_live_ms: Annotated[int, Field(ge=20, le=500)] = 150
    """Of one drive command: nine frames at 60 Hz."""
    ramp_ms: Annotated[int, Field(ge=1, le=1000)] = 50
    """Elevation ramp at a pivot switch; the heading is held meanwhile."""
    field_ramp_ms: Annotated[int, Field(ge=1, le=10_000)] = 300
    """From zero to 10 mT at arming."""
    traffic_log: bool = False
    """Every byte both ways goes to link-traffic.log in the data folder: at most 80 MiB."""


class EstimatorSection(Section):
    """Standard deviations of the filter's model and of one sighting."""

    measured_position_mm: Sigma = 0.04
    measured_heading_deg: Sigma = 0.35
    drift_position_mm: Sigma = 0.2
    """Per root second at rest."""
    drift_heading_deg: Sigma = 2.0
    slip_mm: Sigma = 0.5
    """Per pivot switch."""
    swing_share: Annotated[float, Field(gt=0.0, le=1.0)] = 0.12
    """Of the angle that the field turns, once it pulls the body along."""
    loose_share: Annotated[float, Field(gt=0.0, le=2.0)] = 0.6
    """The same while the field may still be taking up the play after a reversal."""
    actuation_delay_ms: Annotated[float, Field(ge=0.0, le=200.0)] = 1.0
    backlash_deg: Annotated[float, Field(ge=0.0, le=20.0)] = 0.0
    """First guess of the play between field and body; it is identified while walking."""


Slip = Annotated[float, Field(ge=-10.0, le=10.0)]


class GaitSection(Section):
    """What a pivot switch does to this robot, from `pivotrig calibrate gait`; zero until that has been done."""

    out_mm: Slip = 0.0
    """The new pivot lands this far out of its place, along the body."""
    forward_base_mm: Slip = 0.0
    """It lands this far ahead in the direction of walking,"""
    forward_per_sweep_mm_rad: Slip = 0.0
    """and this much further for each radian of the sweep."""
    source: Annotated[str, Field(max_length=160)] = NOT_MEASURED
    """Where these figures, the robot's length and its play come from: date and standard errors."""


class SimulationSection(Section):
    """The simulated rig; only read where the camera or the port is simulated."""

    plant: Literal["slip", "noslip"] = "slip"
    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 1
    board: str = Field(default="twin", pattern=r"^(twin|emulated|tcp://\S+)$")
    """twin: the board's twin in this process; emulated: the compiled firmware in an emulator, which is built and
    started; tcp://HOST:PORT: another board behind its lock-step port."""
    latency_ms: Annotated[float, Field(ge=0.0, le=120.0)] = 35.0
    """The rig holds when frames get older than 150 ms."""
    stamps: Literal["capture", "arrival"] = "capture"
    """capture: frames bear the true time of their exposure; arrival: that at which they come, less
    camera.latency_ms, as a real camera's do."""
    scene: str = "clean"
    """What is in front of the camera beside the robot, and in which light; the lens stays that of [camera]."""
    noise: Annotated[float, Field(ge=0.0, le=50.0)] = 3.0
    """Grey levels."""
    blur_px: Annotated[float, Field(ge=0.0, le=10.0)] = 0.7
    start_x_mm: Annotated[float, Field(ge=-60.0, le=60.0)] = 0.0
    start_y_mm: Annotated[float, Field(ge=-60.0, le=60.0)] = -42.0
    start_heading_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 90.0
    wiring: tuple[Lead, Lead, Lead] = ("x", "y", "z")
    """The pairs that the three bridges truly drive; -x: with swapped leads."""
    field_gain: PerCoil | None = None
    """The true gains of the fields x, y, z; without it those that the rig file gives the coils."""
    registration: RegistrationSection | None = None
    """Where the coils truly stand; without it where the rig file says."""

    @field_validator("scene")
    @classmethod
    def _scene_is_known(cls, scene: str) -> str:
        if scene not in FOR_ANY_LENS:
            raise ValueError(f"there is no scene called {scene!r}; choose one of: {', '.join(FOR_ANY_LENS)}")
        return scene

    @model_validator(mode="after")
    def _each_pair_has_one_bridge(self) -> SimulationSection:
        Wiring(self.wiring)
        return self


REAL_PORTS = ("/dev/ttyACM", "/dev/ttyUSB", "/dev/serial/", "/dev/cu.", "auto")
"""Names that a real board's port begins with."""


class RigFile(Section):
    """One rig."""

    version: Literal[1] = FORMAT
    """Of the file's layout; a file without it has the first."""
    name: Annotated[str, Field(min_length=1, max_length=80)] = "The paper's rig"
    robot: Robot = Robot()
    coils: Coils = Coils()
    limits: LimitsSection = LimitsSection()
    camera: CameraSection = CameraSection()
    link: LinkSection = LinkSection()
    vision: VisionSection = VisionSection()
    estimator: EstimatorSection = EstimatorSection()
    gait: GaitSection = GaitSection()
    simulation: SimulationSection = SimulationSection()

    @property
    def is_simulated(self) -> bool:
        return self.camera.uri.startswith("sim://")

    @property
    def latency_is_known(self) -> bool:
        """Whether the frames' stamps can be believed: what they are late by is known, or they are not late."""
        camera = self.camera
        if camera.latency_source != NOT_MEASURED or camera.latency_ms > 0.0:
            return True
        if self.is_simulated:
            return self.simulation.stamps == "capture"
        return not camera.uri.startswith(LIVE)

    @property
    def subtracted_latency_ms(self) -> float:
        """What the frames' stamps have been corrected by; nothing where a simulated camera knows the true time."""
        knows_better = self.is_simulated and self.simulation.stamps == "capture"
        return 0.0 if knows_better else self.camera.latency_ms

    @model_validator(mode="after")
    def _camera_and_port_share_a_world(self) -> RigFile:
        if self.link.port.startswith("sim://") and not self.is_simulated:
            raise ValueError(
                'a simulated port (link.port) needs the simulated camera (camera.uri = "sim://")'
            )
        if (
            self.is_simulated
            and self.simulation.board.startswith("tcp://")
            and self.link.port.startswith(REAL_PORTS)
        ):
            raise ValueError(
                f"link.port is {self.link.port!r}, a real board's, and camera.uri is simulated: coils would carry "
                "current for a robot that nobody sees. Give the port that the board process has printed"
            )
        return self

    def to_public(self) -> dict[str, Any]:
        """The values as the outside sees them: without the login of a network camera."""
        values = {**self.model_dump(mode="json"), "simulated": self.is_simulated}
        values["camera"]["uri"] = shown(self.camera.uri)
        return values

    def with_simulation(self, **changes: Any) -> RigFile:
        """The same rig with other values in its simulation section, validated."""
        whole = self.model_dump(mode="json")
        whole["simulation"] = {**whole["simulation"], **changes}
        return RigFile.model_validate(whole)

    def as_simulated(self) -> RigFile:
        """The same rig with its camera and port simulated."""
        whole = self.model_dump(mode="json")
        whole["camera"]["uri"] = whole["link"]["port"] = "sim://"
        for part in ("lens", "plane"):
            if whole["camera"][part] and whole["camera"][part]["identity"] != SIMULATED_CAMERA:
                whole["camera"][part] = None
        whole["simulation"]["board"] = "twin"
        return RigFile.model_validate(whole)


def _nowhere(_: tuple[str | int, ...]) -> str:
    return ""


def in_words(error: ValidationError, place: Callable[[tuple[str | int, ...]], str] = _nowhere) -> str:
    """One line for each wrong value: its name, what is wrong with it, what was given, and where `place` finds it."""
    lines = []
    for problem in error.errors(include_url=False):
        where = ".".join(str(part) for part in problem["loc"]) or "the whole file"
        is_one_value = problem["type"] not in ("missing", "extra_forbidden") and not isinstance(
            problem["input"], dict
        )
        given = f" (given: {problem['input']!r})" if is_one_value else ""
        lines.append(f"  {where}: {problem['msg']}{given}{place(problem['loc'])}")
    return "\n".join(lines)


def radians(pair: tuple[float, float]) -> tuple[float, float]:
    return math.radians(pair[0]), math.radians(pair[1])
